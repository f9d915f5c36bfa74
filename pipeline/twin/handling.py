"""Simulated printing of lines at intervals after mixing, until they show defects.

What is simulated: one mixture of each composition of Table 3 of Sikulskyi et al. 2022, and two
more on a heated bed; a line every half hour, or every hour where the table says 9 h or more; a
first defect that begins between the printed handling time and the next line; two more defective
lines after it. Where the table's value is a lower bound the printing ends without a defect: at
12 h, or with a line that the dispensing head can no longer push.
What is not: doubtful lines, several lines at one time, batches that differ.

The true value is the table's: the time of the last clean line.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from deamat.core.properties import property_key
from deamat.core.units import to_si
from deamat.twin.draws import Calibration, stream
from deamat.twin.part import SYNTHETIC, Part
from deamat.twin.truth import TrueValue, document
from deamat.twin.writers import register_csv

TECHNIQUE = "handling"
KEY = "handling_time"
AGE = "as mixed"
ROOM_C = 22.0

_HEATED = re.compile(r"(?P<material>.+)-bed(?P<bed_C>\d+)C")
_SLOW_FROM_H, _STEP_H, _SLOW_STEP_H = 9.0, 0.5, 1.0
_LIMIT = "equipment viscosity limit"
_DEFECTS = ("dripping", "dripping", "gap", "under-extrusion")  # most drip, as in the paper


@dataclass(frozen=True, slots=True)
class PrintedRun:
    """The lines of one mixture, in the order of time.

    Parameters
    ----------
    name : of the run, and of its batch
    bed_C : temperature of the bed `[degree Celsius]`
    time_h : since mixing `[h]`
    defect, limit : what was written down beside each line
    onset_s : when defects truly begin `[s]`; None where the run ends before
    """

    name: str
    material: str
    bed_C: float
    time_h: tuple[float, ...]
    defect: tuple[str, ...]
    limit: tuple[str, ...]
    onset_s: float | None


def true_handling_times() -> dict[str, TrueValue]:
    """Read Table 3: run to its true value."""
    return {name: _true_value(name, printed) for name, printed in document()["table3"].items()}


def _true_value(name: str, printed: Mapping[str, object]) -> TrueValue:
    material, bed_C = _where(name)
    return TrueValue(
        KEY,
        material,
        AGE,
        to_si(float(str(printed["hours"])), "h"),
        property_key(KEY).unit,
        temperature_K=to_si(bed_C, "C"),
        lower_bound="right_censored" in printed,
    )


def _where(name: str) -> tuple[str, float]:
    heated = _HEATED.fullmatch(name)
    return (heated["material"], float(heated["bed_C"])) if heated else (name, ROOM_C)


def simulate_handling(seed: int, name: str) -> PrintedRun:
    """Simulate the printed lines of one run in memory.

    Parameters
    ----------
    seed : of the campaign
    name : of the run, as Table 3 has it in `truth.toml`

    Raises
    ------
    KeyError : there is no such run
    ConfigError : the seed is negative
    """
    printed = document()["table3"][name]
    material, bed_C = _where(name)
    rng = stream(seed, TECHNIQUE, name)
    hours = float(printed["hours"])
    step = _SLOW_STEP_H if hours >= _SLOW_FROM_H else _STEP_H
    clean = [step * i for i in range(1, round(hours / step) + 1)]
    after = [hours + step * i for i in (1, 2, 3)]
    onset_s: float | None = to_si(hours + step * rng.uniform(), "h")
    defects = [_DEFECTS[int(i)] for i in rng.integers(len(_DEFECTS), size=len(after))]
    limits = [""] * len(after)
    if "right_censored" in printed:
        onset_s = None
        limited = "equipment" in printed["why"]
        after = after[: int(limited)]
        defects, limits = ["no flow"] * len(after), [_LIMIT] * len(after)
    return PrintedRun(
        name,
        material,
        bed_C,
        (*clean, *after),
        (*("none" for _ in clean), *defects),
        (*("" for _ in clean), *limits),
        onset_s,
    )


def handling_part(seed: int) -> Part:
    """Simulate the printing of all compositions as one register of observations."""
    rows: list[dict[str, str]] = []
    specimens = {}
    truth = true_handling_times()
    for name in truth:
        run = simulate_handling(seed, name)
        for number, (time_h, defect, limit) in enumerate(
            zip(run.time_h, run.defect, run.limit, strict=True), start=1
        ):
            rows.append(
                {
                    "material": run.material,
                    "batch": f"h-{name}",
                    "bed_temperature_C": f"{run.bed_C:g}",
                    "time_h": f"{time_h:.1f}",
                    "line": str(number),
                    "defect": defect,
                    "limit": limit,
                    "instrument": "simulated HYREL 30M, SDS-10",
                    "comment": SYNTHETIC,
                }
            )
        onset = {} if run.onset_s is None else {"onset_s": run.onset_s}
        specimens[f"h-{name}"] = {"lines": float(len(run.time_h)), **onset}
    return Part(
        TECHNIQUE,
        {f"{TECHNIQUE}/observations.csv": register_csv(rows)},
        tuple(truth.values()),
        Calibration(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        specimens,
    )
