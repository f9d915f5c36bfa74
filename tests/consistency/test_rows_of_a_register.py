"""Rows against their siblings, their dates and other registers."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from deamat.consistency.rows import flags_of_row, materials_by_id
from deamat.consistency.siblings import siblings_of_rows
from deamat.core.quantity import Quantity
from deamat.core.recording import Specimen

UNITS = {"temperature_K": "K", "humidity": "1"}


def row(name: str, material: str = "gel", *, notes: Mapping[str, str] | None = None, age: str = "", technique: str = "compression", **numbers: float) -> Specimen:  # fmt: skip
    return Specimen(
        id=name, material=material, campaign="c", technique=technique, file=f"c/{name}.csv",
        format=None, numbers={k: Quantity(v, UNITS.get(k, "m")) for k, v in numbers.items()},
        conditions={"age": age} if age else {}, notes=notes or {},
        register=f"c/{technique}/specimens.csv", line=2,
    )  # fmt: skip


def cylinders(*diameters: float) -> list[Specimen]:
    return [row(f"s{i}", diameter_m=d, height_m=12.5e-3) for i, d in enumerate(diameters)]


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (14.2e-3, "half: the radius for the diameter?"),
        (57.0e-3, "twice: the diameter for the radius?"),
        (2.86e-3, "a tenth: a decimal point?"),
        (0.0286e-3, "a thousandth"),
        (28.6e-3 / 25.4, "1/25.4: inches for mm?"),
    ],
)
def test_a_slip_is_named(wrong: float, says: str) -> None:
    for others in ((28.4e-3, 28.9e-3), (28.4e-3, 28.9e-3, 28.1e-3, 28.6e-3)):
        flags = siblings_of_rows(cylinders(wrong, *others))
        assert list(flags) == ["s0"]
        assert flags["s0"][0].name == "register-slip"
        assert says in flags["s0"][0].detail


def test_swapped_columns_are_named() -> None:
    rows = [*cylinders(28.4e-3, 28.9e-3), row("s9", diameter_m=12.5e-3, height_m=28.6e-3)]
    (flag,) = siblings_of_rows(rows)["s9"]
    assert flag.name == "register-slip"
    assert "swapped" in flag.detail


def test_a_value_apart_without_a_slip_is_an_outlier() -> None:
    (flag,) = siblings_of_rows(cylinders(40e-3, 28.4e-3, 28.9e-3))["s0"]
    assert flag.name == "register-outlier"


def test_a_slip_in_a_small_group_shows_against_the_register() -> None:
    others = [row(f"o{i}", "other", diameter_m=28.5e-3, height_m=12.5e-3) for i in range(4)]
    flags = siblings_of_rows([row("s0", diameter_m=14.3e-3, height_m=12.5e-3), *others])
    assert list(flags) == ["s0"]


@pytest.mark.parametrize(
    "values",
    [(28.4e-3, 28.9e-3), (0.1e-3, 0.2e-3, 0.4e-3), (132e-6, 133e-6, 146e-6, 160e-6), (1e-3,) * 3],
)
def test_usual_scatter_and_planned_series_pass(values: tuple[float, ...]) -> None:
    assert siblings_of_rows(cylinders(*values)) == {}


@pytest.mark.parametrize(
    ("cured", "tested", "age", "says"),
    [
        ("2022-01-10", "2022-01-08", "", "2 days before it was cured"),
        ("2022-01-10", "2022-01-18", "2 months", "8 days lie between"),
        ("2022-01-10", "2023-01-18", "after cure", "373 days lie between"),
        ("2022-01-10", "2022-01-18", "after cure", ""),
        ("2022-01-10", "2022-03-15", "2 months", ""),
        ("2022-01-10", "2022-01-11", "24 h", ""),
    ],
)
def test_dates_and_age(cured: str, tested: str, age: str, says: str) -> None:
    flags = flags_of_row(row("s0", age=age, notes={"cured_on": cured, "tested_on": tested}), {})
    assert [f.name for f in flags] == ["dates-disagree"] * bool(says)
    assert all(says in f.detail for f in flags)


def test_numbers_that_no_laboratory_has() -> None:
    (flag,) = flags_of_row(row("s0", temperature_K=493.15, humidity=0.5), {})
    assert flag.name == "register-implausible"
    assert "temperature_K is 493.1" in flag.detail
    assert flags_of_row(row("s0", temperature_K=295.15, diameter_m=28e-3), {}) == ()


def test_an_id_of_two_materials_is_flagged_unless_it_is_a_counter() -> None:
    rows = [row("gel-17", "a"), row("gel-17", "b", technique="tension"), row("s1", "a"), row("s1", "b", technique="tension")]  # fmt: skip
    known = materials_by_id(rows)
    assert [[f.name for f in flags_of_row(r, known)] for r in rows] == [
        ["id-of-another-material"], ["id-of-another-material"], [], [],
    ]  # fmt: skip
