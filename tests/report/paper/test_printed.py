"""The transcription holds the article's numbers, and nothing else is called theirs."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from deamat.core.units import si_factor
from deamat.report.paper import printed

TABLES = ("table1", "table2", "table3", "table4", "table4_manufacturer", "table5", "electrode")


@pytest.mark.shared
def test_it_is_what_the_shared_facts_say(shared: Path) -> None:
    facts = tomllib.loads((shared / "paper" / "facts.toml").read_text(encoding="utf-8"))
    assert {table: printed.part(table) for table in TABLES} == facts


def test_every_number_is_found_by_its_own_path() -> None:
    paths = dict(printed.numbers())
    assert len(paths) > 200
    assert all(printed.value(path) == number for path, number in paths.items())


def test_a_position_in_a_list_and_a_missing_path() -> None:
    assert printed.value("table1.haghiashtiani_2018.t_el.1") == 458
    with pytest.raises(KeyError, match="there is no 'hour'"):
        printed.part("table3.sylgard-184-10to1.hour")


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("table1.duduta_2016.t_p_opt", "um"),
        ("table1.duduta_2016.n_de", "1"),
        ("table2.sylgard-184-10to1.coefficients_low_to_high.3", "Pa.s/h^3"),
        ("table2.sylgard-186-10to1.K_low_to_high.0", "Pa.s^n"),
        ("table2.sylgard-186-10to1.printed_exponent_low_to_high.1", "1/h"),
        ("table3.sylgard-182-10to1-bed50C.hours", "h"),
        ("table4.sylgard-182-10to1.breakdown_strength_V_per_um", "V/um"),
        ("table4.sylgard-182-10to1.relative_permittivity_10Hz", "1"),
        ("table4.sylgard-182-10to1.elongation_percent", "%"),
        ("table4_manufacturer.sylgard-184-10to1.cure_min", "min"),
        ("table5.design_1.measured_um.de_sd", "um"),
        ("table5.design_1.field_over_breakdown", "1"),
        ("table5.design_1.fom_optimum_per_m", "1/m"),
        ("text.nominal_shear_rate_per_s", "1/s"),
    ],
)
def test_units_stand_in_the_keys(path: str, unit: str) -> None:
    assert printed.unit(path) == unit


def test_every_unit_but_those_of_laws_and_curvature_is_in_the_closed_table() -> None:
    for path, _ in printed.numbers():
        unit = printed.unit(path)
        if not path.startswith("table2.") and unit != "1/m":
            assert si_factor(unit)
