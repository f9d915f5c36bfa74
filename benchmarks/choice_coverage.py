"""How often intervals of viscosity hold the truth after a law was chosen: one run at a time.

`python -m benchmarks.choice_coverage` simulates runs of 12, 24 and 45 readings from 1 h to 12 h
with 3 % noise, from curves that are on offer and curves that are not, fits them as the room does
and asks at every hour. `--docs` writes `docs/methods/viscosity-coverage.md`.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import reduce
from operator import add
from pathlib import Path

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.mean import coverage_factor
from deamat.techniques.viscosity.config import ViscosityConfig
from deamat.techniques.viscosity.fitted import Fitted, OfLaw, OfReadings
from deamat.techniques.viscosity.pooled import fit_law
from deamat.techniques.viscosity.readings import Readings
from deamat.techniques.viscosity.time_law import Estimate
from deamat.techniques.viscosity.window import windowed
from deamat.twin.truth import SECONDS_PER_HOUR, true_viscosities

PAGE = Path(__file__).resolve().parents[1] / "docs" / "methods" / "viscosity-coverage.md"
FIRST_SEED = 700_000
COUNTS = (12, 24, 45)
NOISE = 0.03
HOURS = np.arange(1.0, 13.0)
_CONFIG = ViscosityConfig(reading_noise=NOISE, reading_calibration=0.0)
_TASK = 50
_FINE = 20_001
_MIDDLE = 5  # 6 h

Truth = Callable[[FloatArray], FloatArray]


def _table2(material: str) -> Truth:
    law = true_viscosities()[material]
    return lambda hours: law(SECONDS_PER_HOUR * hours, np.ones_like(hours))


TRUTHS: dict[str, Truth] = {
    "line: Sylgard 182 (10:1)": _table2("sylgard-182-10to1"),
    "cubic: Sylgard 184 (40:1)": _table2("sylgard-184-40to1"),
    "quartic: Sylgard 184 (10:1)": _table2("sylgard-184-10to1"),
    "power of time, not on offer: 2 t^0.6": lambda t: 2.0 * t**0.6,
    "growth that sets in, not on offer: 1.5 + 0.5 exp(0.25 t)": lambda t: (
        1.5 + 0.5 * np.exp(0.25 * t)
    ),
}


@dataclass(frozen=True, slots=True)
class Cell:
    """Runs of one truth and one number of readings.

    Parameters
    ----------
    runs, readings : how many
    held, law_held : runs in which the answer, and the published law, hold the truth at each hour,
        shape (12,)
    width : sum of half widths over the truth at each hour, shape (12,)
    doubled, asked : runs in which the doubling time holds, and gave one
    flags : runs that carry each flag
    """

    truth: str
    readings: int
    runs: int
    held: FloatArray
    law_held: FloatArray
    width: FloatArray
    doubled: int
    asked: int
    flags: Counter[str]

    def __add__(self, other: Cell) -> Cell:
        return Cell(
            self.truth, self.readings, self.runs + other.runs, self.held + other.held,
            self.law_held + other.law_held, self.width + other.width,
            self.doubled + other.doubled, self.asked + other.asked,
            self.flags + other.flags,
        )  # fmt: skip


def one(truth: str, count: int, seed: int) -> Cell:
    """Simulate one run, fit it and ask."""
    rng = np.random.default_rng([seed, count, *truth.encode()])
    hours = np.linspace(HOURS[0], HOURS[-1], count)
    shown = TRUTHS[truth](hours) * (1.0 + NOISE * rng.normal(size=count))
    window = windowed(_readings(hours, shown), _CONFIG)
    fitted = fit_law([window], _CONFIG)
    true = TRUTHS[truth](HOURS)
    held, law_held, width = np.zeros(len(HOURS)), np.zeros(len(HOURS)), np.zeros(len(HOURS))
    for i, hour in enumerate(HOURS.tolist()):
        value, half = _interval(fitted.answer(*_viscosity(hour * SECONDS_PER_HOUR)))
        held[i] = abs(value - true[i]) <= half
        width[i] = half / true[i]
        law = fitted.law
        own, half = _interval(law.estimate(*law.at(hour * SECONDS_PER_HOUR)))
        law_held[i] = abs(own - true[i]) <= half
    asked, doubled = _doubling(fitted, TRUTHS[truth])
    names = {f.name for f in (*window.readings.flags, *fitted.law.flags)}
    return Cell(truth, count, 1, held, law_held, width, doubled, asked, Counter(names))


def _readings(hours: FloatArray, shown_Pas: FloatArray) -> Readings:
    """A log without rotor and speed, as the room holds it."""
    none = np.zeros(len(hours))
    return Readings(
        SECONDS_PER_HOUR * hours, shown_Pas, NOISE * shown_Pas, none, none, none,
        np.arange(1.0, len(hours) + 1.0), np.full(len(hours), np.nan), none, "simulated",
    )  # fmt: skip


def _interval(found: Estimate) -> tuple[float, float]:
    """Value and half width of its 95 % interval."""
    return found.value, found.scatter * coverage_factor(found.dof)


def _viscosity(time_s: float) -> tuple[OfLaw, OfReadings]:
    return lambda law: law.at(time_s), lambda direct: direct.viscosity(time_s)


def _doubling(fitted: Fitted, truth: Truth) -> tuple[int, int]:
    """Whether a doubling time was given where there is one, and whether it holds."""
    start = SECONDS_PER_HOUR * float(HOURS[0])
    fine = np.linspace(HOURS[0], HOURS[-1], _FINE)
    curve = truth(fine)
    if curve[-1] < 2.0 * curve[0]:
        return 0, 0
    try:
        found = fitted.answer(
            lambda law: law.time_of(2.0, start), lambda direct: direct.time_of(2.0, start)
        )
    except FitRefused:
        return 0, 0
    value, half = _interval(found)
    true_s = SECONDS_PER_HOUR * float(np.interp(2.0 * curve[0], curve, fine))
    return 1, int(abs(value - true_s) <= half)


def _some(task: tuple[str, int, int, int]) -> Cell:
    truth, count, first, runs = task
    return reduce(add, (one(truth, count, first + i) for i in range(runs)))


def study(runs: int, workers: int, truths: Sequence[str], counts: Sequence[int]) -> list[Cell]:
    """Run the study: a cell for every truth and number of readings, printed as it comes."""
    tasks = [
        (truth, count, FIRST_SEED + first, min(_TASK, runs - first))
        for truth in truths
        for count in counts
        for first in range(0, runs, _TASK)
    ]
    cells: dict[tuple[str, int], Cell] = {}
    with ProcessPoolExecutor(workers) as pool:
        for part in pool.map(_some, tasks):
            place = part.truth, part.readings
            cells[place] = cells[place] + part if place in cells else part
            if cells[place].runs == runs:
                print(table([cells[place]])[-1], flush=True)
    return list(cells.values())


def table(cells: Sequence[Cell]) -> list[str]:
    """Coverage at each hour in percent, a row for each cell."""
    hours = " | ".join(f"{hour:g} h" for hour in HOURS)
    lines = [f"| truth | readings | {hours} | doubling | law | half width at 6 h, % |"]
    lines.append("|---" * (len(HOURS) + 5) + "|")
    for cell in cells:
        each = " | ".join(f"{100.0 * held / cell.runs:.1f}" for held in cell.held.tolist())
        twice = f"{100.0 * cell.doubled / cell.asked:.1f}" if cell.asked else ""
        law = 100.0 * float(cell.law_held.mean()) / cell.runs
        wide = 100.0 * float(cell.width[_MIDDLE]) / cell.runs
        lines.append(
            f"| {cell.truth} | {cell.readings} | {each} | {twice} | {law:.1f} | {wide:.1f} |"
        )
    return lines


def flag_table(cells: Sequence[Cell]) -> list[str]:
    """How often each flag was raised on these sound runs, by number of readings."""
    names = sorted({name for cell in cells for name in cell.flags})
    counts = sorted({cell.readings for cell in cells})
    lines = ["| flag | " + " | ".join(f"{count} readings" for count in counts) + " |"]
    lines.append("|---" * (len(counts) + 1) + "|")
    for name in names:
        raised = []
        for count in counts:
            mine = [cell for cell in cells if cell.readings == count]
            total = sum(cell.runs for cell in mine)
            raised.append(f"{100.0 * sum(cell.flags[name] for cell in mine) / total:.2f}")
        lines.append(f"| {name} | " + " | ".join(raised) + " |")
    return lines


def page(cells: Sequence[Cell]) -> str:
    """Write the page."""
    held = np.concatenate([cell.held / cell.runs for cell in cells])
    runs = cells[0].runs
    se = 100.0 * float(np.sqrt(0.95 * 0.05 / runs))
    return "\n".join(
        [
            "# How often intervals of viscosity hold after a law was chosen",
            _INTRODUCTION.format(
                runs=runs, se=se, mean=100 * held.mean(), low=100 * held.min(),
                high=100 * held.max(),
            ),
            "",
            *table(cells),
            "",
            _FLAGS,
            "",
            *flag_table(cells),
            "",
        ]
    )  # fmt: skip


_INTRODUCTION = """\
{runs} SYNTHETIC runs of each kind, read from 1 h to 12 h with errors of 3 % of reading; how many
95 % intervals hold the truth, in percent: those of the answer at each hour, of the doubling time,
and of the published law at all hours together. The standard error of one number is {se:.1f} %.
All answers at an hour together: {mean:.1f} %, the least {low:.1f} % and the most {high:.1f} %.
The seeds are fresh: nothing was chosen on them. Calibration, which only widens intervals, is left
out. Made by `python -m benchmarks.choice_coverage --docs`; how it is done:
[selection.md](selection.md)."""

_FLAGS = """\
## Flags on these runs
All of them are sound; runs with a flag, in percent."""


def main() -> None:
    """Run the study and print its tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=1000, help="of each truth and number")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--docs", action="store_true", help="write the page")
    options = parser.parse_args()
    cells = study(options.runs, options.workers, list(TRUTHS), COUNTS)
    print("\n".join(flag_table(cells)))
    if options.docs:
        PAGE.write_text(page(cells), "utf-8")


if __name__ == "__main__":
    main()
