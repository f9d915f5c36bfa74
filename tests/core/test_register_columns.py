"""The header of a register: near misses of known columns are errors, genuine notes are notes."""

from __future__ import annotations

import pytest

from deamat.core.errors import RawFileError
from deamat.core.register_columns import Column, numeric_columns

_HEADER = ["specimen", "material", "diameter_mm"]


def _columns(*further: str) -> dict[str, Column]:
    return numeric_columns(
        [*_HEADER, *further],
        "c/t/specimens.csv",
        ("diameter_m",),
        tuple(_HEADER[:2]),
        ("mixed_at",),
    )


@pytest.mark.parametrize(
    ("label", "meant"),
    [
        ("Age", "age"),
        ("agee", "age"),
        ("CURE", "cure"),
        ("cuer", "cure"),
        ("Material", "material"),
        ("specemin", "specimen"),
        ("files", "file"),
        ("tested-on", "tested_on"),
        ("Mixed_at", "mixed_at"),
        ("instrumnet", "instrument"),
        ("age_days", "age with the unit in each cell"),
        ("Age (months)", "age with the unit in each cell"),
        ("cure_h", "cure with the unit in each cell"),
        ("bed_temperatureC", "bed_temperature_C"),
        ("temperature_c", "temperature_C"),
        ("temprature_C", "temperature_C"),
        ("temprature", "temperature_C"),
        ("THICKNESS_MM", "thickness_mm"),
        ("hieght_mm", "height_mm"),
        ("u_widht_mm", "u_width_mm"),
        ("U_diameter_mm", "u_diameter_mm"),
        ("rates_V_per_s", "rate_V_per_s"),
        ("Mass_g", "mass_g"),
    ],
)
def test_a_near_miss_names_the_column_that_was_meant(label: str, meant: str) -> None:
    with pytest.raises(RawFileError) as caught:
        _columns(label)
    assert (caught.value.line, caught.value.column, caught.value.value) == (1, 4, label)
    assert caught.value.reason == "not a known column, but nearly one"
    assert f"write {meant}" in str(caught.value)


@pytest.mark.parametrize(
    ("label", "message"),
    [
        ("temperature_F", "F is not a unit of temperature (found 'temperature_F'); write temperature_C"),
        ("width_m", "a specimen measured in metres (found 'width_m'); write width_mm"),
        ("u_diameter_m", "a specimen measured in metres (found 'u_diameter_m'); write u_diameter_mm"),
        ("Humidity", "a quantity without a known unit in its column name (found 'Humidity')"),
        ("material", "duplicate column: column 2 has the same name (found 'material')"),
        ("diameter_um", "duplicate column: column 3 is the same quantity (found 'diameter_um')"),
    ],
)  # fmt: skip
def test_a_column_that_cannot_be_meant(label: str, message: str) -> None:
    with pytest.raises(RawFileError) as caught:
        _columns(label)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    "label",
    [
        "operator_comment", "comment", "operator", "tested_by", "mixed_by", "film", "page", "date",
        "curve", "batch", "cup", "curing_temperature", "rotation_speed", "mass_flow", "notes",
    ],
)  # fmt: skip
def test_a_note_stays_a_note(label: str) -> None:
    assert set(_columns(label)) == {"diameter_m"}


@pytest.mark.parametrize(
    ("label", "name"),
    [
        ("room_temperature_C", "room_temperature_K"),
        ("height_cm", "height_m"),
        ("speed_rpm", "speed_rpm"),
        ("rate_per_s", "rate_1_per_s"),
        ("weight_g", "weight_kg"),
        ("depth_mm", "depth_m"),
        ("u_diameter_um", "u_diameter_m"),
    ],
)
def test_other_numbers_stay_numbers(label: str, name: str) -> None:
    assert set(_columns(label)) == {"diameter_m", name}


@pytest.mark.parametrize(
    ("label", "name", "factor"),
    [
        ("Diameter [mm]", "diameter_m", 1e-3),
        ("Gauge length (mm)", "gauge_length_m", 1e-3),
        ("thickness / um", "thickness_m", 1e-6),
        ("Speed [mm/min]", "speed_m_per_s", 1e-3 / 60),
        ("u_Diameter [mm]", "u_diameter_m", 1e-3),
        ("Electrode area [mm2]", "electrode_area_m2", 1e-6),
        ("Humidity (%)", "humidity", 0.01),
    ],
)
def test_a_unit_in_brackets_is_the_unit_of_its_column(label: str, name: str, factor: float) -> None:
    extra = ["diameter_mm"] if name == "u_diameter_m" else []
    header = ["specimen", "material", *extra, label]
    column = numeric_columns(header, "r.csv", (), ("specimen", "material"), ())[name]
    assert column.factor == pytest.approx(factor)
    assert column.header == label


@pytest.mark.parametrize(
    ("label", "reason"),
    [
        ("Diameter [N]", "N is not a unit of diameter"),
        ("Diameter [m]", "a specimen measured in metres"),
        ("Diameter [furlong]", "a quantity without a known unit in its column name"),
    ],
)
def test_a_wrong_unit_in_brackets_is_an_error(label: str, reason: str) -> None:
    with pytest.raises(RawFileError) as caught:
        numeric_columns(["specimen", "material", label], "r.csv", (), ("specimen",), ())
    assert caught.value.reason == reason


def test_brackets_behind_other_words_stay_a_note() -> None:
    header = ["specimen", "material", "Batch (B)", "Remark [free]"]
    assert numeric_columns(header, "r.csv", (), ("specimen",), ()) == {}
