"""`deamat add`: files of a folder become rows to fill in, and filled-in rows become specimens."""

from __future__ import annotations

from deamat.run.add.folder import Added, add

__all__ = ["Added", "add"]
