"""deamat: from raw laboratory files of soft dielectric elastomers to material cards."""
