"""The truth is what the paper prints, and nothing stands in for what it does not print."""

from __future__ import annotations

import re
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest

from deamat.core.errors import MissingProperty
from deamat.core.properties import PROPERTIES
from deamat.twin.truth import AGED, materials, true_value, truth_table


@pytest.mark.shared
def test_the_truth_is_table_4_as_printed(shared: Path) -> None:
    facts = tomllib.loads((shared / "paper" / "facts.toml").read_text("utf-8"))
    truth = tomllib.loads((files("deamat.twin") / "truth.toml").read_text("utf-8"))
    assert truth["materials"] == facts["table4"]


def test_the_truth_is_in_si() -> None:
    assert true_value("compressive_modulus", "sylgard-182-10to1").value == 0.957e6
    assert true_value("compressive_modulus", "sylgard-182-40to1", AGED).value == 0.03e6
    assert true_value("elongation_at_break", "sylgard-186-10to1").value == pytest.approx(7.3)
    assert true_value("breakdown_strength", "sylgard-182-30to1").value == pytest.approx(48.4e6)
    assert all(entry.unit == PROPERTIES[entry.key].unit for entry in truth_table())
    assert len(materials()) == 6


def test_a_value_that_the_paper_does_not_print_is_missing() -> None:
    message = (
        "the twin knows no breakdown_strength of sylgard-184-10to1 (after cure); it knows that of: "
        "sylgard-182-10to1 (after cure), sylgard-182-20to1 (after cure), "
        "sylgard-182-30to1 (after cure), sylgard-182-40to1 (after cure)"
    )
    with pytest.raises(MissingProperty, match=f"^{re.escape(message)}$"):
        true_value("breakdown_strength", "sylgard-184-10to1")
