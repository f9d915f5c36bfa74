"""Printed lines, the runs that they belong to, and what ended each run."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby
from operator import attrgetter

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.recording import Specimen

RUN_COLUMNS = ("batch", "mixed_at")  # what tells two runs of one material apart


@dataclass(frozen=True, slots=True)
class Line:
    """One printed line.

    Parameters
    ----------
    run : the batch that it was printed from, empty where the register tells none
    time_s : since mixing
    defect, limit : as the register calls them; `limit` is None where it tells none
    defective : it was seen to be
    limited : a limit of the equipment was met while it was printed
    """

    specimen: Specimen
    run: str
    time_s: float
    defect: str
    limit: str | None
    defective: bool
    limited: bool

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Time and what was seen, shape (1,) each."""
        numbers = {"time_s": self.time_s, "defective": self.defective, "limited": self.limited}
        return {name: np.array([value], np.float64) for name, value in numbers.items()}


@dataclass(frozen=True, slots=True)
class Run:
    """One mixture, printed line after line until something ended it.

    Parameters
    ----------
    name : of the batch, empty where the register tells none
    lines : in the order of time
    clean_until_s : last time before the end at which every line was clean; minus infinity if there
        is none
    defective_from_s : time of the first defective line, infinite where none was seen
    ended_by : the line that ended it, None where the printing simply stopped
    """

    name: str
    lines: tuple[Line, ...]
    clean_until_s: float
    defective_from_s: float
    ended_by: Line | None

    @property
    def clean_again(self) -> tuple[Line, ...]:
        """Clean lines that were printed after the run had ended."""
        end = math.inf if self.ended_by is None else self.ended_by.time_s
        return tuple(line for line in self.lines if line.time_s > end and not line.defective)


def runs_of(lines: Iterable[Line]) -> tuple[Run, ...]:
    """Part the lines of one material into runs and find the end of each.

    A run ends with its first defective line, or with a line at which a limit of the equipment was
    met: nothing is known of the silicone from there on, and a defect of that very line is the
    equipment's.
    """
    ordered = sorted(lines, key=lambda line: (line.run, line.time_s, line.specimen.line))
    return tuple(_run(name, tuple(run)) for name, run in groupby(ordered, attrgetter("run")))


def _run(name: str, lines: tuple[Line, ...]) -> Run:
    clean_until = -math.inf
    for time_s, together in groupby(lines, attrgetter("time_s")):
        printed = tuple(together)
        own = [line for line in printed if line.defective and not line.limited]
        if own:
            return Run(name, lines, clean_until, time_s, own[0])
        if not any(line.defective for line in printed):
            clean_until = time_s
        limited = [line for line in printed if line.limited]
        if limited:
            return Run(name, lines, clean_until, math.inf, limited[0])
    return Run(name, lines, clean_until, math.inf, None)
