from __future__ import annotations

from datetime import date
from pathlib import Path

import pytest

from deamat.core.config import load_config
from deamat.core.errors import ConfigError
from deamat.core.instruments import Instruments, Machine

CELLS = """
[machines.frame]
match = "frame"
calibration = ["cell-2024", "cell-2025", "travel"]
u_force_calibration = 0.01

[gauges.thickness]
calibration = "micrometer"

[calibrations.cell-2024]
date = 2024-03-01
valid_days = 365
covers = ["force"]
u_relative = 0.002
certificate = "D-K-1 2024-03"

[calibrations.cell-2025]
date = 2025-03-01
valid_until = 2026-02-28
covers = ["force"]
u_relative = 0.003
certificate = "D-K-1 2025-03"

[calibrations.travel]
date = 2024-01-01
valid_until = 2030-01-01
covers = ["displacement"]
certificate = "gauge blocks"

[calibrations.micrometer]
date = 2024-01-01
valid_until = 2030-01-01
covers = ["length"]
certificate = "gauge blocks"
"""


def instruments(folder: Path, text: str = CELLS) -> Instruments:
    (folder / "instruments.toml").write_text(text)
    return load_config(folder, {}).instruments


@pytest.mark.parametrize(
    ("day", "held", "u"),
    [
        (date(2024, 6, 1), "cell-2024", 0.002),
        (date(2025, 2, 28), "cell-2024", 0.002),
        (date(2025, 3, 1), "cell-2025", 0.003),
        (date(2028, 1, 1), "cell-2025", 0.003),
        (date(2020, 1, 1), "cell-2024", 0.002),
        (None, "cell-2025", 0.003),
    ],
)
def test_the_day_of_the_test_chooses_the_calibration(
    tmp_path: Path, day: date | None, held: str, u: float
) -> None:
    machine = instruments(tmp_path).machine("a frame", day)
    assert machine.held == {"force": held, "displacement": "travel"}
    assert machine.u_force_calibration == u
    assert machine.u_displacement_calibration == Machine().u_displacement_calibration
    line = machine.shared_error("load cell calibration", "force", u)
    assert (line.source, line.calibration, line.calibrated) == (
        "load cell calibration", held, "force",
    )  # fmt: skip
    assert machine.shared_error("voltage calibration", "voltage", u).calibration is None


def test_a_calibration_ends_on_its_last_day(tmp_path: Path) -> None:
    known = instruments(tmp_path).calibrations
    assert known["cell-2024"].validity == "2024-03-01 to 2025-03-01"
    assert known["cell-2025"].last_day == date(2026, 2, 28)


def test_a_machine_that_no_entry_matches_says_so_in_its_line(tmp_path: Path) -> None:
    machine = instruments(tmp_path).machine("another")
    line = machine.shared_error("load cell calibration", "force", 1.0)
    assert line.source == "load cell calibration, default limits"
    assert line.assumed
    assert machine.entry == ""


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"travel"]', '"traval"]', r"machines.frame: there is no \[calibrations.traval\]; nearest: 'travel'"),
        ('calibration = "micrometer"', 'calibration = "travel"', "gauges.thickness: the calibration 'travel' does not cover length"),
        ('"travel"]', '"micrometer"]', "machines.frame: the calibration 'micrometer' is of a length"),
        ("valid_days = 365", "", "either valid_until or valid_days"),
        ("valid_days = 365", "valid_days = 365\nvalid_until = 2025-01-01", "either valid_until or valid_days"),
        ("valid_until = 2026-02-28", "valid_until = 2025-02-28", "it ends on 2025-02-28, before its date, 2025-03-01"),
        ('covers = ["length"]', 'covers = ["length"]\nu_relative = 0.01', "u_calibration_m"),
        ('covers = ["displacement"]', 'covers = ["travel"]', "calibrations.travel.covers"),
        ("u_relative = 0.003", "u_rel = 0.003", "unknown key 'calibrations.cell-2025.u_rel'"),
        ("date = 2025-03-01", "date = 2025-02-30", "instruments.toml"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in CELLS
    with pytest.raises(ConfigError, match=said):
        instruments(tmp_path, CELLS.replace(old, new))
