"""What is measured: speed against rivals, as ratios within one run, never as bare seconds."""
