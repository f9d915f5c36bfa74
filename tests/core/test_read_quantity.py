"""Lengths and voltages as people write them; a number without its unit is refused."""

from __future__ import annotations

import re

import pytest

from deamat.core.errors import ConfigError
from deamat.core.units import UnknownUnit, read_quantity


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("500um", "m", 500e-6),
        (" 0.5 mm ", "m", 500e-6),
        ("500µm", "m", 500e-6),
        ("5e-4m", "m", 5e-4),
        ("6.4kV", "V", 6400.0),
        ("1.5e1 in", "m", 0.381),
    ],
)
def test_a_number_with_its_unit(text: str, unit: str, value: float) -> None:
    assert read_quantity(text, unit, "--t-de") == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "500",
            "--t-de is '500': a bare number is ambiguous; give it with its unit (cm, in, inch, m, ",
        ),
        (
            "500MPa",
            "--t-de is '500MPa': MPa does not fit; give it in cm, in, inch, m, mil, mm, nm, um",
        ),
        ("um", "--t-de is 'um'; give a number with its unit (cm, in, inch, m, mil, mm, nm, um)"),
        ("", "--t-de is ''; give a number with its unit"),
        ("5,5um", "--t-de is '5,5um'"),
    ],
)
def test_anything_else_is_refused(text: str, said: str) -> None:
    with pytest.raises((ConfigError, UnknownUnit), match=re.escape(said)):
        read_quantity(text, "m", "--t-de")


def test_an_unknown_unit_names_its_neighbours() -> None:
    with pytest.raises(UnknownUnit, match="unknown unit 'umm'; known units near it: um"):
        read_quantity("500umm", "m", "--t-de")
