"""A run whose time is in another unit than its label says: by its siblings, by its header."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deamat.consistency.statements import against_row
from deamat.consistency.time_units import time_units
from deamat.core.arrays import FloatArray
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.records import Measurement

HOURS = np.arange(0.25, 12.51, 0.25)
RISES = 1.64 + 0.18 * HOURS


@dataclass(frozen=True)
class Curve:
    columns: dict[str, FloatArray]


def run(name: str, time_s: FloatArray, viscosity: FloatArray) -> Measurement[Curve]:
    specimen = Specimen(name, "m", "c", "viscosity", None, None, {}, {}, {}, "r", 2)
    return Measurement(specimen, (), (), Curve({"time_s": time_s, "viscosity_Pas": viscosity}))


def test_the_one_of_three_that_rises_sixty_times_as_fast_is_flagged() -> None:
    runs = [run("a", 60.0 * HOURS, RISES), *(run(n, 3600.0 * HOURS, 1.01 * RISES) for n in "bc")]
    found = time_units(runs)
    assert list(found) == ["a"]
    assert found["a"][0].name == "time-unit"
    assert found["a"][0].detail == (
        "its 735 s are 0.01667 times those of b, and viscosity rises as far: minutes for seconds, "
        "or hours for minutes?"
    )


def test_of_two_runs_both_are_flagged_and_others_none() -> None:
    two = [run("a", HOURS, RISES), run("b", 3600.0 * HOURS, RISES)]
    assert set(time_units(two)) == {"a", "b"}
    steady = np.full(len(HOURS), 2.0)
    assert time_units([run("a", HOURS, steady), run("b", 3600.0 * HOURS, steady)]) == {}
    assert time_units([run("a", HOURS, RISES), run("b", 3600.0 * HOURS, 3.0 * RISES)]) == {}
    assert time_units([run("a", 1200.0 * HOURS, RISES), run("b", 3600.0 * HOURS, RISES)]) == {}


def flags(metadata: dict[str, str], time_s: FloatArray) -> list[str]:
    columns = {"time_s": time_s, "viscosity_Pas": RISES}
    recording = Recording(columns, metadata, {}, Source("x", "0" * 64, 2, 51, "utf-8", "test"))
    row = Specimen("a", "m", "c", "viscosity", None, None, {}, {}, {}, "r", 2)
    return [f.detail for f in against_row(recording, row) if f.name == "time-unit"]


def test_a_header_that_says_how_long_the_run_took_is_believed() -> None:
    minutes, seconds = 60.0 * HOURS, 3600.0 * HOURS
    for metadata in ({"line 1": "Duration: 12.25 h"}, {"Run duration [h]": "12.25"},
                     {"total duration": "735 min"}):  # fmt: skip
        (told,) = flags(metadata, minutes)
        assert told.endswith("its column of time spans 735 s, 0.01667 times that: another unit of "
                             "time?")  # fmt: skip
        assert flags(metadata, seconds) == []
    assert flags({"line 1": "made on a Monday: 12 of them"}, minutes) == []
