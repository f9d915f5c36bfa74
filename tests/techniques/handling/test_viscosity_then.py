"""The viscosity at the handling time: from the law, within it, and never without its caveat."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from deamat.core.instruments import Machine
from deamat.core.records import Law, PropertyRecord, Refusal, Summary
from deamat.core.technique import Context
from deamat.run.measure import in_order
from deamat.techniques import TECHNIQUES
from deamat.techniques.handling import TECHNIQUE
from deamat.techniques.handling.config import VISCOSITY_THEN, HandlingConfig
from deamat.techniques.handling.viscosity_then import CAVEAT
from deamat.twin.campaign import SEED
from deamat.twin.handling import simulate_handling, true_handling_times
from deamat.twin.truth import true_viscosities
from tests.techniques.handling.test_summarise import measured, run

HOUR = 3600.0
LAW = Law(
    key="viscosity",
    material="m",
    campaign="c",
    kind="polynomial",
    unit="Pa.s",
    argument="time since mixing",
    argument_unit="s",
    coefficients=(4.0, 0.5 / HOUR),
    covariance=((0.01, 0.0), (0.0, 0.0)),
    valid=(HOUR, 12 * HOUR),
    conditions={},
    method="",
    temperature_K=295.15,
)
FLUID = replace(
    LAW, kind="power-law-fluid", coefficients=(100.0, 0.4),
    covariance=((1.0, 0.0), (0.0, 0.0)), parts=(1, 1), rates=(0.027, 0.108),
)  # fmt: skip


def summary(text: str, laws: Mapping[str, Law]) -> Summary:
    context = Context(HandlingConfig(), Machine(), {}, laws=laws)
    return TECHNIQUE.summarise(measured(text), context)


def then(text: str, law: Law = LAW) -> PropertyRecord:
    _, found = summary(text, {"viscosity": law}).records
    return found


def reason(text: str, laws: Mapping[str, Law]) -> str:
    found = summary(text, laws)
    assert [r.key for r in found.records] == ["handling_time"]
    (refusal,) = found.refusals
    assert isinstance(refusal, Refusal)
    assert refusal.key == VISCOSITY_THEN
    return refusal.reason


SIX_HOURS = run("a", (2.0, 4.0, 6.0), (7.0, "dripping", ""))


def test_it_reaches_from_the_last_clean_to_the_first_defective_line() -> None:
    found = then(SIX_HOURS)
    assert found.key == VISCOSITY_THEN
    assert found.quantity.value == found.ci95[0]
    assert found.quantity.standard_uncertainty == pytest.approx(0.1)
    assert found.ci95[0] == pytest.approx(4.0 + 0.5 * 6 - 1.96 * 0.1, rel=1e-4)
    assert found.ci95[1] == pytest.approx(7.5 + 1.96 * 0.1, rel=1e-4)
    assert (found.bound, found.n) == ("interval", 1)
    assert found.conditions == {"temperature_K": 295.15, "time_s": 6 * HOUR}
    assert found.flags == (CAVEAT,)


def test_a_lower_bound_of_the_time_is_one_of_the_viscosity() -> None:
    found = then(run("a", (2.0, 6.0), (6.5, "no flow", "equipment")))
    limit = LAW.ci95(6 * HOUR)[0]
    assert limit < 7.0
    assert (found.bound, found.quantity.value, found.ci95) == ("lower", limit, (limit, math.inf))


def test_a_fluid_is_told_at_the_middle_of_its_rates() -> None:
    found = then(SIX_HOURS, FLUID)
    assert found.conditions["rate_per_s"] == 0.054
    assert found.quantity.value == FLUID.ci95(6 * HOUR, 0.054)[0]
    assert "at the nominal shear rate 0.054 1/s" in found.method


def test_a_law_that_ends_before_the_first_defect_leaves_a_lower_bound() -> None:
    found = then(SIX_HOURS, replace(LAW, valid=(HOUR, 6.5 * HOUR)))
    assert found.bound == "lower"
    assert [flag.name for flag in found.flags] == ["not-one-viscosity", "law-ends"]


def test_without_a_law_for_that_time_and_temperature_there_is_no_viscosity() -> None:
    assert reason(SIX_HOURS, {}) == (
        "no law of viscosity is known of this material in this campaign, or more than one; "
        "measure its viscosity over time"
    )
    short = replace(LAW, valid=(HOUR, 5 * HOUR))
    assert reason(SIX_HOURS, {"viscosity": short}) == (
        "the handling time, 6 h, lies outside the law of viscosity, 1 h to 5 h; measure viscosity "
        "as long"
    )
    warm = replace(LAW, temperature_K=323.15)
    assert reason(SIX_HOURS, {"viscosity": warm}) == (
        "the bed had 22 C and the law of viscosity is of 50 C; measure viscosity at the "
        "temperature of the bed"
    )


def test_viscosity_is_measured_before_handling() -> None:
    order = [technique.key for technique in in_order(TECHNIQUES)]
    assert order.index("viscosity") < order.index("handling")


@pytest.mark.parametrize("name", [n for n in true_handling_times() if "bed" not in n])
def test_the_interval_holds_the_viscosity_at_which_defects_truly_began(name: str) -> None:
    printed = simulate_handling(SEED, name)
    truth = true_viscosities()[printed.material]
    rate = 0.04
    if truth.index:
        law = replace(
            FLUID, coefficients=(*_per_second(truth.consistency), *_per_second(truth.index)),
            covariance=_zeros(len(truth.consistency) + len(truth.index)),
            parts=(len(truth.consistency), len(truth.index)), rates=(rate, rate),
        )  # fmt: skip
    else:
        law = replace(
            LAW, coefficients=_per_second(truth.consistency),
            covariance=_zeros(len(truth.consistency)),
        )  # fmt: skip
    rows = zip(printed.time_h, printed.defect, printed.limit, strict=True)
    found = then(run(name, (), *rows), law)
    assert (found.bound == "lower") == (printed.onset_s is None)
    if printed.onset_s is not None:
        at_onset = float(truth(np.array([printed.onset_s]), np.array([rate]))[0])
        assert found.quantity.value <= at_onset <= found.ci95[1]


def _per_second(coefficients: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(c / HOUR**k for k, c in enumerate(coefficients))


def _zeros(n: int) -> tuple[tuple[float, ...], ...]:
    return tuple((0.0,) * n for _ in range(n))
