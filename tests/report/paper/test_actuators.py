"""Tables 1 and 5 come out to the digits at which they were recomputed before, right and wrong."""

from __future__ import annotations

import pytest

from deamat.report.paper import printed
from deamat.report.paper.actuators import electrode_for, table1, table5, totals
from deamat.report.paper.claims import figures, strip
from deamat.report.paper.entry import Entry


@pytest.fixture(scope="module")
def found() -> dict[str, Entry]:
    return {e.id: e for e in (*table1(), *table5(), *totals(), *figures())}


@pytest.mark.parametrize(
    ("path", "digits"),
    [
        ("table5.design_1.fom_single_layer_per_m", "8.713"),
        ("table5.design_1.fom_optimum_per_m", "8.776"),
        ("table1.haghiashtiani_2018.analytical", "39.68"),
        ("table1.haghiashtiani_2018.t_p_opt", "179.2"),
        ("table1.haghiashtiani_2018.optimum", "41.42"),
        ("table1.sikulskyi_2020.analytical", "11.76"),
        ("table1.sikulskyi_2020.t_p_opt", "2.48"),
        ("table1.sikulskyi_2020.optimum", "39.36"),
        ("table1.sikulskyi_2022.analytical", "8.037"),
        ("table1.sikulskyi_2022.t_p_opt", "236.6"),
        ("table1.sikulskyi_2022.optimum", "8.57"),
        ("table1.araromi_2012.analytical", "0.881"),
        ("table1.kadooka_2016.analytical", "4.169"),
        ("table1.kadooka_2016.t_p_opt", "46.06"),
        ("table1.kadooka_2016.optimum", "4.23"),
        ("table1.duduta_2016.analytical", "77.32"),
        ("table1.duduta_2016.t_p_opt", "9.32"),
        ("table1.duduta_2016.optimum", "77.52"),
        ("table1.kadooka_2016.analytical.corrected", "4.202"),
        ("table1.duduta_2016.analytical.corrected", "95.83"),
        ("table5.design_2.fom_single_layer_per_m", "13.11"),
        ("table5.design_2.fom_optimum_per_m", "13.23"),
        ("table1.araromi_2012.t_p_opt", "0.40"),
        ("table1.araromi_2012.optimum", "146"),
        ("table5.design_1.field_V_per_um", "22.2"),
        ("table5.design_2.field_V_per_um", "12.8"),
        ("text.total_of_design_1_um", "770"),
        ("figure6.loss_by_electrodes_percent", "19.6"),
    ],
)
def test_recomputed(found: dict[str, Entry], path: str, digits: str) -> None:
    decimals = len(digits.partition(".")[2])
    assert f"{found[path].recomputed:.{decimals}f}" == digits


def test_only_rows_that_used_equation_4_are_corrected(found: dict[str, Entry]) -> None:
    rows = {path.split(".")[1] for path in found if path.endswith(".corrected")}
    assert rows == {"kadooka_2016", "duduta_2016"}


def test_design_2_is_called_underivable_and_design_1_is_not(found: dict[str, Entry]) -> None:
    for name in ("fom_single_layer_per_m", "fom_optimum_per_m"):
        assert "NOT derivable" in found[f"table5.design_2.{name}"].note
        assert "NOT derivable" not in found[f"table5.design_1.{name}"].note


def test_the_electrode_that_would_save_design_2_spoils_its_optimum() -> None:
    for which, value in (("electrode_modulus_Pa", 0.99e6), ("electrode_thickness_m", 2.9e-6)):
        found, bent = electrode_for(25.1, which)
        assert found == pytest.approx(value, rel=0.01)
        assert bent.curvature_per_m == pytest.approx(25.1, abs=1e-3)
        assert bent.best_passive_m < 0.6 * 234e-6


def test_claims_that_are_exact_come_out_exactly(found: dict[str, Entry]) -> None:
    assert found["figure4.spread_of_optima_percent"].recomputed == 0.0
    assert found["figure5.eq19_off_percent"].recomputed == 0.0


def test_without_field_the_two_shapes_of_figure_3_nearly_agree() -> None:
    assert abs(strip(0.0).off) < 0.01
    assert abs(strip(printed.si("figure3.high_field_V_per_um")).off) > 0.05
