"""Figures of designs: marked where simulated, with the words that a reader needs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from deamat.actuator.compositions import compare, pareto
from deamat.actuator.design import design
from deamat.actuator.request import Request
from deamat.core.errors import MissingProperty
from deamat.report.design import (
    compositions_figure,
    curvature_figure,
    pareto_figure,
    tornado_figure,
)
from tests.actuator.cards import cards, declared

REQUEST = Request("soft", "stiff", "pedot-triton", 500e-6)


def all_four(folder: Path, *, synthetic: bool) -> dict[str, str]:
    made, config = cards(synthetic=synthetic), declared()
    found = design(made, config, REQUEST)
    front = pareto(made, config, REQUEST)
    pictures = {
        "curvature": curvature_figure(folder, "curvature", found),
        "tornado": tornado_figure(folder, "tornado", found),
        "compositions": compositions_figure(
            folder, "compositions", "All compositions", compare(made, config, REQUEST)[0]
        ),
        "pareto": pareto_figure(folder, "pareto", "Pareto front", front, synthetic),
    }
    assert all(png.read_bytes().startswith(b"\x89PNG") for _, png in pictures.values())
    return {name: svg.read_text() for name, (svg, _) in pictures.items()}


@pytest.mark.parametrize("synthetic", [True, False])
def test_simulated_cards_mark_every_figure(tmp_path: Path, synthetic: bool) -> None:
    for text in all_four(tmp_path, synthetic=synthetic).values():
        assert ("SYNTHETIC DATA: simulated, not measured" in text) is synthetic


def test_they_say_what_they_show(tmp_path: Path) -> None:
    drawn = all_four(tmp_path, synthetic=False)
    assert "soft (500 um) on stiff" in drawn["curvature"]
    assert "films that break down [%]" in drawn["curvature"]
    assert "curvature [1/m]" in drawn["tornado"]
    assert "no uncertainty declared" in drawn["tornado"]
    assert "soft on itself" in drawn["compositions"]
    assert "blocked force [uN]" in drawn["pareto"]


def test_without_a_breakdown_no_probability_is_drawn(tmp_path: Path) -> None:
    made = cards(breakdown=False)
    found = design(made, declared(), replace(REQUEST, voltage_V=4000.0))
    svg, _ = curvature_figure(tmp_path, "curvature", found)
    assert "films that break down" not in svg.read_text()


def test_the_same_design_gives_the_same_bytes(tmp_path: Path) -> None:
    one, other = (all_four(tmp_path / name, synthetic=True) for name in ("a", "b"))
    assert one == other


def test_nothing_to_compare_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MissingProperty, match="no composition can be compared"):
        compositions_figure(tmp_path, "compositions", "none", ())
    with pytest.raises(MissingProperty, match="there is no Pareto front"):
        pareto_figure(tmp_path, "pareto", "none", (), synthetic=False)
