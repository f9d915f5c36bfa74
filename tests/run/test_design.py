"""What the words of `deamat design` become."""

from __future__ import annotations

from typing import Any

import pytest

from deamat.actuator.declared import load_designs
from deamat.core.errors import ConfigError
from deamat.run.design import Asked, request_of
from tests.run.conftest import ROOT

DECLARED = load_designs(ROOT / "config")
NOTHING = dict.fromkeys(
    ("name", "de", "passive", "electrode", "t_de", "t_passive", "voltage", "probability")
)
FULL = {"de": "soft", "passive": "stiff", "electrode": "pedot-triton", "t_de": "500um"}


def asked(**words: Any) -> Asked:
    return Asked(**{**NOTHING, "where": {}, **words})


def test_a_design_in_words_becomes_si() -> None:
    request = request_of(
        asked(**FULL, t_passive="0.2 mm", voltage="4kV", probability=0.01, where={"age": "fresh"}),
        DECLARED,
    )
    assert (request.de, request.passive, request.electrode) == ("soft", "stiff", "pedot-triton")
    assert request.de_thickness_m == pytest.approx(500e-6)
    assert request.passive_thickness_m == pytest.approx(200e-6)
    assert request.voltage_V == pytest.approx(4000.0)
    assert request.breakdown_probability == 0.01
    assert request.where == {"age": "fresh"}
    bare = request_of(asked(**FULL), DECLARED)
    assert (bare.passive_thickness_m, bare.voltage_V, bare.breakdown_probability) == (None,) * 3


@pytest.mark.parametrize(
    ("given", "missing"),
    [
        ({}, "--de, --passive, --electrode, --t-de"),
        ({**FULL, "t_de": None}, "--t-de"),
        ({**FULL, "de": ""}, "--de"),
    ],
)
def test_what_a_design_lacks_is_named(given: dict[str, str | None], missing: str) -> None:
    with pytest.raises(ConfigError) as caught:
        request_of(asked(**given), DECLARED)
    assert str(caught.value).startswith(
        f"a design needs {missing}, or the name of a declared one ("
    )
    assert all(name in str(caught.value) for name in DECLARED.designs)


def test_words_change_a_declared_design() -> None:
    name, wanted = next(iter(DECLARED.designs.items()))
    plain = request_of(asked(name=name), DECLARED)
    assert (plain.de, plain.passive, plain.electrode) == (
        wanted.de, wanted.passive, wanted.electrode,
    )  # fmt: skip
    changed = request_of(asked(name=name, passive="other", t_de="300um"), DECLARED)
    assert (changed.de, changed.passive) == (wanted.de, "other")
    assert changed.electrode == wanted.electrode
    assert changed.de_thickness_m == pytest.approx(300e-6)


def test_a_length_needs_its_unit() -> None:
    with pytest.raises(ConfigError, match="--t-de"):
        request_of(asked(**{**FULL, "t_de": "500"}), DECLARED)
