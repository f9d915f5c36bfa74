"""The closed unit table, held against pint."""

from __future__ import annotations

import pint
import pytest

from deamat.core.units import UNITS, UnknownUnit, from_si, si_factor, to_si

_TO_PINT = {
    "%": "percent", "-": "dimensionless", "1": "dimensionless", "mm/mm": "dimensionless",
    "m2": "m**2", "cm2": "cm**2", "mm2": "mm**2", "N/mm2": "N/mm**2", "N/mm^2": "N/mm**2",
    "kg/m3": "kg/m**3", "mm_per_min": "mm/min", "mm_per_s": "mm/s", "per_s": "1/s",
    "V_per_um": "V/um",
    "S_per_m": "S/m", "kV_per_mm": "kV/mm", "V_per_s": "V/s", "kV_per_s": "kV/s",
    "Pas": "Pa*s", "mPas": "mPa*s", "Pa.s": "Pa*s", "mPa.s": "mPa*s", "C": "degC", "sec": "s",
    "N.m": "N*m", "Nm": "N*m", "mN.m": "mN*m", "uN.m": "uN*m", "mNm": "mN*m", "uNm": "uN*m", "Pa s": "Pa*s",
    "1/min": "rpm", "m/m": "dimensionless", "in/in": "dimensionless", "mil": "thou", "mPa s": "mPa*s", "s-1": "1/s",
    "N/m2": "N/m**2", "N/cm2": "N/cm**2", "kgf/cm2": "kgf/cm**2", "dyn/cm2": "dyn/cm**2", "g/cm3": "g/cm**3",
}  # fmt: skip


@pytest.fixture(scope="module")
def registry() -> pint.UnitRegistry[float]:
    return pint.UnitRegistry()


@pytest.mark.parametrize("unit", sorted(UNITS.keys() - {"Pa.s^n"}))  # its n is the fluid's own
def test_table_agrees_with_pint(unit: str, registry: pint.UnitRegistry[float]) -> None:
    spelt, si = (_TO_PINT.get(u, u) for u in (unit, UNITS[unit][0]))
    expected = registry.Quantity(3.7, spelt).to(si).magnitude
    assert to_si(3.7, unit) == pytest.approx(expected, rel=1e-14)
    assert from_si(to_si(3.7, unit), unit) == pytest.approx(3.7, rel=1e-13)


@pytest.mark.parametrize("spelling", ["\u00b5m", "\u03bcm", " um "])
def test_both_micro_signs(spelling: str) -> None:
    assert si_factor(spelling) == ("m", 1e-6, 0.0)


def test_unknown_unit_is_an_error_that_names_the_nearest() -> None:
    with pytest.raises(UnknownUnit, match=r"unknown unit 'MPas'; known units near it: .*mPas"):
        to_si(1.0, "MPas")
