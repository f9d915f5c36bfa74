"""From cards to a design: what is taken, what is refused in which words, and what is marked."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deamat.actuator import case, model
from deamat.actuator.card_values import MixedConditions
from deamat.actuator.compositions import compare, pareto
from deamat.actuator.declared import load_designs
from deamat.actuator.design import design
from deamat.actuator.present import (
    compositions_text,
    design_document,
    design_text,
    pareto_document,
    pareto_text,
)
from deamat.actuator.request import Request
from deamat.core.errors import ConfigError, MissingProperty, OutOfRange
from deamat.core.records import Condition
from deamat.materials.card import MaterialCard

from .cards import ROOT, STATE, card, cards, declared, record

REQUEST = Request("soft", "stiff", "pedot-triton", 500e-6)
AT_4_KV = replace(REQUEST, voltage_V=4000.0)


def test_without_a_voltage_the_film_goes_as_far_as_it_may() -> None:
    found = design(cards(), declared(), REQUEST)
    assert found.bound == "breakdown"
    assert found.failure_probability == pytest.approx(0.01, rel=1e-9)
    low, high = found.failure_interval95 or (0.0, 0.0)
    assert low < 0.01 < high
    assert found.strip.passive_thickness_m == found.drive.best_passive_thickness_m
    assert found.prediction.value == pytest.approx(found.points[-1].curvature_per_m, rel=1e-12)
    assert [p.voltage_V for p in found.points][-1] == found.voltage_V
    assert np.all(np.diff([p.curvature_per_m for p in found.points]) > 0)
    inputs = {x.name for x in found.inputs}
    assert {"breakdown_strength of soft", "weibull_shape of soft"} <= inputs
    # 500 mm2 of strip, 100 mm2 tested
    assert found.case.values.area_ratio == pytest.approx(5.0)
    assert found.notes[0] == ("breakdown scaled to an electrode 5 times as large as the tested one")


def test_a_given_voltage_leaves_the_breakdown_out_of_the_curvature() -> None:
    found = design(cards(), declared(), AT_4_KV)
    assert (found.bound, found.voltage_V) == ("given", 4000.0)
    assert not any("breakdown" in x.name for x in found.inputs)
    assert found.failure_probability is not None
    assert {t.test for t in found.next_tests} == {
        "compression of soft", "compression of stiff", "permittivity of soft"
    }  # fmt: skip


def test_cards_and_limits_are_looked_up_once(monkeypatch: pytest.MonkeyPatch) -> None:
    counts: Counter[str] = Counter()

    def counted(name: str) -> None:
        original: Callable[..., object] = getattr(case, name)

        def count(*arguments: object) -> object:
            counts[name] += 1
            return original(*arguments)

        monkeypatch.setattr(case, name, count)

    counted("gather")
    counted("voltage_limits")
    monkeypatch.setattr(model, "voltage_limits", None)  # a given voltage needs no limits of draws
    assert design(cards(), declared(), AT_4_KV).case.limits.breakdown_V is not None
    assert counts == {"gather": 1, "voltage_limits": 1}


def test_one_material_in_two_layers_is_one_input() -> None:
    found = design(cards(), declared(), replace(AT_4_KV, de="stiff"))
    names = [x.name for x in found.inputs]
    assert names.count("compressive_modulus of stiff") == 1
    assert found.inputs[0].drives == ("film_modulus_Pa", "passive_modulus_Pa")
    assert len(list(found.case.values.records())) == 4


def test_two_materials_of_one_campaign_share_its_calibration() -> None:
    found = design(cards(), declared(), AT_4_KV)
    soft, stiff = (x for x in found.inputs if "compressive" in x.name)
    common = {c.source for c in soft.budget} & {c.source for c in stiff.budget}
    assert common == {"calibration of compression in made-2026"}


def of_another_campaign(made: MaterialCard, calibration: str | None) -> MaterialCard:
    """Return a card whose values come of another campaign, by this calibration of the load cell."""
    records = []
    for one in made.records:
        budget = tuple(
            replace(c, calibration=calibration, calibrated="force") if c.shared else c
            for c in one.budget
        )
        records.append(replace(one, campaign=f"{made.material}-2026", budget=budget))
    return replace(made, records=tuple(records))


@pytest.mark.parametrize(
    ("calibrations", "shared"),
    [(("cell-7", "cell-7"), True), (("cell-7", "cell-8"), False), ((None, None), False)],
)
def test_two_campaigns_share_the_calibration_that_both_name(
    calibrations: tuple[str | None, str | None], shared: bool
) -> None:
    made = cards()
    for material, calibration in zip(("soft", "stiff"), calibrations, strict=True):
        made[material] = of_another_campaign(made[material], calibration)
    soft, stiff = (x for x in design(made, declared(), AT_4_KV).inputs if "compressive" in x.name)
    common = {c.source for c in soft.budget} & {c.source for c in stiff.budget}
    assert common == ({"force by cell-7"} if shared else set())


def test_the_article_comes_out_with_its_own_inputs() -> None:
    """Design 1 of Table 5 at its layers as measured: 8.71 1/m at 22.2 V/um on the thinned film."""
    made = {"sylgard": card("sylgard", 0.957e6, 2.58)}
    request = Request("sylgard", "sylgard", "pedot-triton", 446e-6, 304e-6, 9700.0)
    found = design(made, declared(), request)
    at_22 = next(p for p in found.points if p.true_field_V_m > 22.0e6)
    # the printed number takes the film as made; thinned by 1.2 % it bends 1 % more
    scaled = at_22.curvature_per_m * (22.2e6 / at_22.true_field_V_m) ** 2
    assert scaled == pytest.approx(8.713, rel=0.015)


def test_no_breakdown_means_no_range_of_voltage() -> None:
    with pytest.raises(MissingProperty) as refused:
        design(cards(breakdown=False), declared(), REQUEST)
    assert str(refused.value) == (
        "the breakdown limit of soft is unknown (soft has no breakdown_strength; there is "
        "compressive_modulus, relative_permittivity): no range of voltage can be given; "
        "test its breakdown, or give a voltage"
    )
    found = design(cards(breakdown=False), declared(), AT_4_KV)
    assert (found.case.limits.breakdown_V, found.failure_probability) == (None, None)
    assert found.notes[0].startswith("the breakdown limit is unknown: soft has no breakdown")


def test_a_strip_far_larger_than_the_tested_electrode_is_not_guessed_at() -> None:
    config = declared()
    wide = config.model_copy(
        update={"geometry": config.geometry.model_copy(update={"width_mm": 30.0})}
    )
    with pytest.raises(MissingProperty, match=r"differ by a factor 15; the declared limit is 10"):
        design(cards(), wide, REQUEST)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"de_thickness_m": 0.0}, "thickness_m of the de layer is 0 m; allowed is 1e-09 to 0.05 m"),
        ({"de_thickness_m": -1e-4}, "thickness_m of the de layer is -0.0001 m; allowed is"),
        ({"de_thickness_m": 500.0}, "was it given in micrometres or millimetres?"),
        ({"passive_thickness_m": 0.0}, "thickness_m of the passive layer is 0 m; allowed is"),
        ({"voltage_V": -1.0}, "voltage_V of the de layer is -1 V; allowed is 0 to 1e+06 V"),
        ({"voltage_V": 0.0}, "voltage_V is 0 V; allowed is 0.001 to 1e+06 V; a film without"),
        ({"voltage_V": 12_900.0}, "above the pull-in voltage the film has no equilibrium"),
        ({"breakdown_probability": 1.0}, "breakdown_probability is 1; allowed is 1e-09 to 1"),
    ],
)
def test_a_number_outside_its_range_is_named(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(OutOfRange, match=re.escape(said)):
        design(cards(), declared(), replace(REQUEST, **changes))


def test_a_voltage_above_the_allowed_probability_is_refused() -> None:
    with pytest.raises(
        OutOfRange,
        match=r"voltage_V of the de layer is 12000 V; allowed is 0 to 11\d\d\d\.?\d* V; above it "
        r"more than 1 % of the films break down: lower the voltage, or allow another probability",
    ):
        design(cards(), declared(), replace(REQUEST, voltage_V=12_000.0))
    risky = replace(REQUEST, voltage_V=12_000.0, breakdown_probability=0.5)
    chance = design(cards(), declared(), risky).failure_probability
    assert chance is not None
    assert 0.01 < chance < 0.5


def without(made: MaterialCard, key: str) -> MaterialCard:
    return replace(made, records=tuple(r for r in made.records if r.key != key))


@pytest.mark.parametrize("key", ["compressive_modulus", "relative_permittivity"])
def test_a_missing_property_is_named(key: str) -> None:
    made = cards()
    made["soft"] = without(made["soft"], key)
    with pytest.raises(MissingProperty, match=f"soft has no {key}; there is"):
        design(made, declared(), AT_4_KV)


@pytest.mark.parametrize(
    ("condition", "said"),
    [
        ({"cure": "4 h at 60 C"}, "of stiff '4 h at 60 C': a design takes all its values from one"),
        ({"age": "2 months"}, "of stiff '2 months': a design takes all its values from one state"),
    ],
)
def test_two_cures_are_never_mixed(condition: dict[str, Condition], said: str) -> None:
    made = cards() | {"stiff": card("stiff", 1e6, conditions=condition)}
    with pytest.raises(MixedConditions, match=re.escape(said)):
        design(made, declared(), AT_4_KV)


def test_a_cure_that_is_not_stated_is_not_taken_for_the_same() -> None:
    bare = record("stiff", "compressive_modulus", 1e6, "Pa")
    bare = replace(bare, conditions={"age": STATE["age"]})
    made = cards() | {"stiff": replace(cards()["stiff"], records=(bare,))}
    with pytest.raises(MixedConditions, match=r"of soft is '2 h at 90 C', of .* stiff not stated"):
        design(made, declared(), AT_4_KV)


def test_another_age_can_be_asked_for_and_must_be_known_throughout() -> None:
    aged = record("soft", "compressive_modulus", 1.2e5, "Pa", conditions={"age": "2 months"})
    made = cards()
    made["soft"] = replace(made["soft"], records=(*made["soft"].records, aged))
    with pytest.raises(MissingProperty, match="no relative_permittivity of soft with age="):
        design(made, declared(), replace(AT_4_KV, where={"age": "2 months"}))


@pytest.mark.parametrize("synthetic", [True, False])
def test_simulated_cards_are_named_in_text_and_json(synthetic: bool) -> None:
    made = cards() | {"soft": card("soft", 1e5, strength_V_m=50e6, synthetic=synthetic)}
    found = design(made, declared(), REQUEST)
    document = json.loads(json.dumps(design_document(found), allow_nan=False))
    assert document["synthetic"] is synthetic
    assert document["synthetic_materials"] == (["soft"] if synthetic else [])
    banner = "SYNTHETIC: simulated data, not measurements"
    assert document["banner"] == (banner if synthetic else None)
    assert (f"{banner} (soft)" in design_text(found)) is synthetic
    compared = compare(made, declared(), REQUEST)
    assert (banner in compositions_text(*compared)) is synthetic
    front = pareto(made, declared(), REQUEST)
    assert pareto_document(front, synthetic)["synthetic"] is synthetic
    assert (banner in pareto_text(front, synthetic)) is synthetic


def test_all_compositions_and_why_some_are_refused() -> None:
    answered, refused = compare(cards(), declared(), REQUEST)
    assert {(c.de, c.passive) for c in answered} == {
        ("stiff", "stiff"), ("soft", "soft"), ("soft", "stiff")
    }  # fmt: skip
    assert {x.de for x in refused} == {"gel"}
    assert all("the breakdown limit of gel is unknown" in x.reason for x in refused)
    for c in answered:
        assert c.best_curvature_per_m >= c.curvature_per_m.max()
        assert c.without_electrodes_per_m > c.best_curvature_per_m
        alone = design(cards(), declared(), replace(REQUEST, de=c.de, passive=c.passive))
        assert c.best_curvature_per_m == pytest.approx(alone.prediction.value, rel=1e-9)


def test_nothing_beats_the_pareto_front() -> None:
    front = pareto(cards(), declared(), REQUEST)
    merits = np.array([(-t.voltage_V, t.curvature_per_m, t.blocked_force_N) for t in front])
    for i, merit in enumerate(merits):
        beaten = (merits >= merit).all(axis=1) & (merits > merit).any(axis=1)
        assert not beaten.any(), front[i]
    assert merits[:, 1].max() == pytest.approx(
        max(c.best_curvature_per_m for c in compare(cards(), declared(), REQUEST)[0]), rel=0.02
    )


def test_an_undeclared_electrode_names_the_declared_ones() -> None:
    with pytest.raises(
        ConfigError, match=r"designs.toml declares no electrode 'pedot'; nearest: pedot-triton"
    ):
        design(cards(), declared(), replace(REQUEST, electrode="pedot"))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("thickness_um = 10", "thickness = 10", "unknown key 'electrodes.pedot-triton.thickness'"),
        ("youngs_modulus_MPa = 3.5", "youngs_modulus_MPa = -3.5", "greater than 0"),
        ("poisson_ratio = 0.49", "poisson_ratio = 49", "less than or equal to 0.5"),
        ("[model]", "[model", "designs.toml: "),
    ],
)
def test_a_slip_in_the_declared_facts_is_named(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    text = (ROOT / "config" / "designs.toml").read_text()
    assert old in text
    (tmp_path / "designs.toml").write_text(text.replace(old, new, 1))
    with pytest.raises(ConfigError, match=re.escape(said)):
        load_designs(tmp_path)


def test_a_folder_without_declared_facts_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"no .*designs\.toml: a design needs its electrode"):
        load_designs(tmp_path)
