"""deamat: from raw laboratory files of soft dielectric elastomers to material cards."""

__version__ = "0.1.0"
