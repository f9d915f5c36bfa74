"""Files against their rows, and against the other files of their register."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from deamat.consistency.labels import labels_against_rows
from deamat.consistency.statements import against_row
from deamat.consistency.swaps import swapped_files
from deamat.core.arrays import FloatArray
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.records import MeasuredValue, Measurement
from tests.consistency.test_rows_of_a_register import row

SPEED = 12e-3 / 60.0


def recording(columns: Mapping[str, FloatArray], metadata: Mapping[str, str] | None = None) -> Recording:  # fmt: skip
    return Recording(columns, metadata or {}, {}, Source("c/a.csv", "0" * 64, 1, 9, "utf-8", "x"))


def loaded(n: int = 200) -> dict[str, FloatArray]:
    time = 0.1 * np.arange(n, dtype=np.float64)
    return {"time_s": time, "displacement_m": SPEED * time}


def specimen(speed: float = SPEED, **notes: str) -> Specimen:
    made = row("s0", notes=notes, diameter_m=28.6e-3, height_m=12.5e-3)
    numbers = {**made.numbers, "speed_m_per_s": Quantity(speed, "m/s")}
    return Specimen(**{**{f: getattr(made, f) for f in made.__slots__}, "numbers": numbers})


def names(found: object) -> list[str]:
    assert isinstance(found, tuple)
    return [flag.name for flag in found]


def test_a_sound_file_passes() -> None:
    header = {"Cylinder Diameter": "28.6 mm", "Cylinder Height": "12.4mm", "timestamp": "1/18/2022  9:00 AM", "Speed (mm/min)": "12"}  # fmt: skip
    assert against_row(recording(loaded(), header), specimen(tested_on="2022-01-18")) == ()


@pytest.mark.parametrize("factor", [0.1, 1 / 60, 10.0, 0.7, 25.4])
def test_a_speed_that_travel_over_time_contradicts(factor: float) -> None:
    columns = loaded()
    columns["displacement_m"] = factor * columns["displacement_m"]
    (flag,) = against_row(recording(columns), specimen())
    assert flag.name == "speed-disagrees"
    assert f"{factor:.4g} times" in flag.detail


def test_swapped_columns_show_in_the_speed() -> None:
    columns = loaded()
    columns["displacement_m"] = np.sqrt(columns["time_s"])
    assert "speed-disagrees" in names(against_row(recording(columns), specimen()))


def test_a_hold_before_the_loading_changes_no_speed() -> None:
    columns = loaded()
    held = np.concatenate([np.zeros(150), columns["displacement_m"]])
    time = 0.1 * np.arange(350, dtype=np.float64)
    assert against_row(recording({"time_s": time, "displacement_m": held}), specimen()) == ()


@pytest.mark.parametrize("with_time", [True, False])
def test_dropped_rows_leave_a_hole(with_time: bool) -> None:
    columns = {k: np.delete(v, slice(60, 75)) for k, v in loaded().items()}
    if not with_time:
        del columns["time_s"]
    (flag,) = against_row(recording(columns), specimen())
    assert flag.name == "missing-rows"
    assert "about 15 rows are missing" in flag.detail


@pytest.mark.parametrize(
    ("header", "name"),
    [
        ({"Cylinder Diameter": "14.3 mm"}, "header-disagrees"),
        ({"Specimen Height [mm]": "28.6"}, "header-disagrees"),
        ({"timestamp": "2/18/2022  9:00 AM"}, "tested-on-disagrees"),
        ({"Date": "2021-01-18"}, "tested-on-disagrees"),
        ({"timestamp": "Mon Jan 10 09:00:00 2021"}, "tested-on-disagrees"),
    ],
)
def test_the_header_against_the_row(header: Mapping[str, str], name: str) -> None:
    assert names(against_row(recording({}, header), specimen(tested_on="2022-01-18"))) == [name]


def test_a_file_written_before_the_cure() -> None:
    found = against_row(recording({}, {"Date": "2022-01-01"}), specimen(cured_on="2022-01-10"))
    assert names(found) == ["dates-disagree"]


def test_a_file_that_names_another_row() -> None:
    rows = [row("gel-17"), row("gel-18"), row("gel-19")]
    told = {"gel-17": "Gel 18", "gel-18": "Gel_18", "gel-19": "3"}
    flags = labels_against_rows(rows, told)
    assert list(flags) == ["gel-17"]
    assert flags["gel-17"][0].name == "file-of-another-specimen"


def measured(name: str, material: str, value: float) -> Measurement:
    quantity = Quantity(value, "Pa")
    return Measurement(row(name, material), (MeasuredValue("tensile_modulus", quantity, (), ""),))


def test_files_swapped_between_materials() -> None:
    soft = [measured(f"a{i}", "soft", v) for i, v in enumerate((1.0e5, 1.04e5, 4.1e5))]
    hard = [measured(f"b{i}", "hard", v) for i, v in enumerate((4.0e5, 1.02e5, 4.2e5))]
    flags = swapped_files([*soft, *hard])
    assert sorted(flags) == ["a2", "b1"]
    assert flags["a2"][0].name == "swapped-files"
    assert "b1" in flags["a2"][0].detail


def test_scatter_is_no_swap() -> None:
    soft = [measured(f"a{i}", "soft", v) for i, v in enumerate((1.0e5, 1.3e5, 0.9e5))]
    hard = [measured(f"b{i}", "hard", v) for i, v in enumerate((1.4e5, 1.2e5, 1.6e5))]
    odd = [measured(f"c{i}", "odd", v) for i, v in enumerate((4.0e5, 4.1e5, 1.1e5))]
    assert swapped_files([*soft, *hard, *odd]) == {}
