"""What an LCR meter sees of a film: impedance, edge field, squeeze, frequency sweeps."""
