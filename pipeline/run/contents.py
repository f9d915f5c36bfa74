"""What a release says, told apart from what made it and from how it is stored and drawn."""

from __future__ import annotations

import hashlib
from pathlib import Path

from deamat.materials.curves import curves_digest


def contents_id(place: Path) -> str:
    """Name a release after its contents: the cards, the curves, the accounts of files and errors.

    Of the database no row is counted by itself: its tables hold these cards and this account, and
    beside them what made the release. Figures are drawn from the cards and the curves.

    Parameters
    ----------
    place : folder of a whole release, published or not
    """
    digest = hashlib.sha256()
    if (place / "curves.h5").is_file():  # an internal error may have left it out
        digest.update(curves_digest(place / "curves.h5").encode())
    for path in sorted([*(place / "cards").glob("*.json"), *(place / "audit").glob("*.json")]):
        digest.update(f"{path.name} {hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return digest.hexdigest()[:12]
