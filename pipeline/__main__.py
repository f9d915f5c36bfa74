"""`python -m pipeline` is the command `deamat`."""

from pipeline.cli import main

main()
