"""Table 2: coefficients in hours, curves at their widest distance, and the reading of an exponent."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from deamat.core.ledger import Provenance
from deamat.materials.card import MaterialCard
from deamat.materials.database import Database, open_database, write_database
from deamat.report.paper import laws, printed
from deamat.report.paper.entry import Entry
from deamat.report.paper.laws import READINGS, Reading, reading

from .samples import TWIN, database, law

FLUID = "sylgard-186-40to1"


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Entry]:
    with open_database(database(tmp_path_factory.mktemp("processed"))) as opened:
        return {e.id: e for e in laws.table2(opened)}


def test_coefficients_are_compared_in_hours(found: dict[str, Entry]) -> None:
    first, second = (
        found[f"table2.sylgard-182-10to1.coefficients_low_to_high.{k}"] for k in (0, 1)
    )
    assert first.recomputed == pytest.approx(1.64)
    assert first.standard_uncertainty == pytest.approx(0.0164)
    assert second.recomputed == pytest.approx(0.30)
    assert (second.printed, second.unit) == (0.267, "Pa.s/h")


def test_the_curves_are_held_together_where_they_differ_most(found: dict[str, Entry]) -> None:
    curve = found["table2.sylgard-182-10to1"]
    assert curve.printed == pytest.approx(1.64 + 0.267 * 12)
    assert curve.recomputed == pytest.approx(1.64 + 0.30 * 12)
    assert curve.standard_uncertainty == pytest.approx(0.0164)
    assert curve.note.startswith(
        "greatest relative difference of the curves from 1 h to 12 h: +8.2 %, at 12.00 h; "
        "polynomial law; SYNTHETIC"
    )


def test_a_law_of_another_form_and_no_law_say_so(found: dict[str, Entry]) -> None:
    other = found["table2.sylgard-184-10to1.coefficients_low_to_high.0"]
    assert other.recomputed is None
    assert other.missing
    assert other.note == "the data support a law of another form: exponential"
    none = found["table2.sylgard-184-40to1"]
    assert none.recomputed is None
    assert none.missing
    assert none.note == "the database has no material sylgard-184-40to1"


def fluid(tmp_path: Path, index: list[float]) -> Database:
    card = MaterialCard(
        FLUID, "Sylgard 186 (40:1)", True, records=(), campaigns=(TWIN,),
        laws=(law("viscosity", tuple(index), FLUID),),
    )  # fmt: skip
    write_database(tmp_path / "materials.sqlite", [card], (), Provenance("1", "c" * 24, (), (), ()))
    return open_database(tmp_path)


@pytest.mark.parametrize("name", READINGS)
def test_the_data_choose_the_reading(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr(laws, "INDEX", "viscosity")  # any polynomial law can play the index
    e = np.array(printed.part(f"table2.{FLUID}.printed_exponent_low_to_high"))
    sign, offset = {"e = n": (1, 0), "e = 1 - n": (-1, 1), "e = n - 1": (1, 1)}[name]
    n = sign * e + offset * np.eye(1, len(e))[0]
    with fluid(tmp_path, [float(c) for c in n]) as opened:
        found = reading(opened, FLUID)
        rows = {r.id: r for r in laws.table2(opened)}
    assert isinstance(found, Reading)
    assert (found.name, found.synthetic) == (name, True)
    assert found.off[name] == pytest.approx(0.0, abs=1e-12)
    for k in (0, 1):
        row = rows[f"table2.{FLUID}.printed_exponent_low_to_high.{k}"]
        assert row.recomputed == pytest.approx(row.printed)
        assert f"read as {name}" in row.note


def test_the_readings_agree_at_one_per_second_and_only_the_footnote_thickens() -> None:
    hours = np.array([2.0, 2.0])
    for name in READINGS:
        slow, one = laws.printed_viscosity(FLUID, hours, np.array([0.1, 1.0]), name)
        assert one == pytest.approx(108.6 + 2 * 3.293)
        assert (slow < one) == (name == laws.FOOTNOTE)
