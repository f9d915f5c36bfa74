"""`deamat watch`: a run as soon as a file is complete; half-written ones wait."""

from __future__ import annotations

from deamat.run.watch.arrivals import Patience
from deamat.run.watch.loop import Watching, follow

__all__ = ["Patience", "Watching", "follow"]
