"""One printed number beside the recomputed one: a row of `paper.json`."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass

from deamat.report.paper import printed

CORRECTED = ".corrected"
_DIGITS = 10  # kept in the file: beyond them the last bits of a machine's arithmetic show


@dataclass(frozen=True, slots=True)
class Entry:
    """A printed number and what this project finds in its place, both in the printed unit.

    Parameters
    ----------
    id : dotted path of the printed number; `.corrected` behind it where an equation was corrected
    printed : None for a law as a whole of which nothing could be evaluated
    recomputed : None where there is nothing to compute, or nothing to compute it from
    standard_uncertainty : of the recomputed number; None where it is not known
    note : where the number comes from, or why there is none
    synthetic : it rests on simulated data
    campaign : the one that it comes from; empty where it comes from none
    missing : the database does not hold what it would be recomputed from
    lower_bound : what was recomputed is only known to be exceeded
    """

    id: str
    printed: float | None
    recomputed: float | None
    unit: str
    standard_uncertainty: float | None
    note: str
    synthetic: bool = False
    campaign: str = ""
    missing: bool = False
    lower_bound: bool = False

    @property
    def relative_difference(self) -> float | None:
        """Recomputed over printed, less 1."""
        if self.printed is None or self.recomputed is None or self.printed == 0:
            return None
        return self.recomputed / self.printed - 1.0

    @property
    def difference_in_u(self) -> float | None:
        """Recomputed less printed, in standard uncertainties of the recomputed number."""
        if self.printed is None or self.recomputed is None or not self.standard_uncertainty:
            return None
        return (self.recomputed - self.printed) / self.standard_uncertainty


def entry(
    path: str, recomputed: float | None, note: str, u: float | None = None, suffix: str = ""
) -> Entry:
    """Put a recomputed number, which is not synthetic, beside the printed one at a path."""
    return Entry(
        path + suffix, printed.value(path), recomputed, printed.unit(path), u, note, synthetic=False
    )


def to_json(entries: Iterable[Entry]) -> bytes:
    """Write the entries as `paper.json`."""
    rows = [
        {
            "id": e.id,
            "printed": _short(e.printed),
            "recomputed": _short(e.recomputed),
            "unit": e.unit,
            "standard_uncertainty": _short(e.standard_uncertainty),
            "note": f"not recomputed: {e.note}" if e.missing else e.note,
        }
        for e in entries
    ]
    return (json.dumps(rows, indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode()


def _short(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.{_DIGITS}g}")
