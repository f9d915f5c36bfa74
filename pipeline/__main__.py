"""`python -m deamat` is the command `deamat`."""

from deamat.cli import main

main()
