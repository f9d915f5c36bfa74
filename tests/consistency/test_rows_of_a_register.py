"""Rows against their siblings, their dates and other registers."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from deamat.consistency.names import near_names
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


@pytest.mark.parametrize(
    ("rare", "usual"),
    [
        ("simulatd", "simulated"),
        ("simualted", "simulated"),
        ("simullated", "simulated"),
        ("sylgard_182-10to1", "sylgard-182-10to1"),
        ("sylgard-182-10tol", "sylgard-182-10to1"),
        ("slygard-182-10to1", "sylgard-182-10to1"),
    ],
)
def test_of_two_names_one_letter_apart_the_rarer_is_flagged(rare: str, usual: str) -> None:
    flags = near_names([usual] * 4 + [rare], ())
    assert list(flags) == [rare]
    assert repr(usual) in flags[rare].detail


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("sylgard-182-10to1", "sylgard-184-10to1"),
        ("sylgard-182-10to1", "sylgard-182-20to1"),
        ("ef30-25t", "ef10-25t"),
        ("mix-a", "mix-b"),
        ("cable-insulation-i", "cable-insulation-ii"),
        ("resin-01", "resin-11"),
        ("ecoflex-00-10", "ecoflex-00-30"),
    ],
)
def test_names_that_differ_by_a_digit_or_in_a_short_word_are_two(one: str, other: str) -> None:
    assert near_names([one] * 4 + [other], ()) == {}


def test_two_declared_names_are_two_materials() -> None:
    assert near_names(["simulatd", "simulated"], ("simulatd", "simulated")) == {}


@pytest.mark.parametrize(
    ("height_m", "technique", "flagged"),
    [(28e-3, "compression", True), (28e-3, "tension", False), (17e-3, "compression", False)],
)
def test_a_slender_cylinder_is_flagged(height_m: float, technique: str, flagged: bool) -> None:
    specimen = row("c-1", technique=technique, height_m=height_m, diameter_m=12e-3)
    names = [flag.name for flag in flags_of_row(specimen, {})]
    assert names == (["register-implausible"] if flagged else [])
