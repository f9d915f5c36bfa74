"""Tips that stick: JKR on the way out for a sphere, and what is said of flat punches."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.twin.situations import SITUATIONS
from deamat.twin.situations.nanoindentation import sticking
from tests.techniques.curves import lengths
from tests.techniques.nanoindentation.indents import (
    FLAT,
    FLAT_CURVE,
    SPHERE,
    SPHERE_CURVE,
    MODULUS_Pa,
    flags,
    noisy,
    reason,
    reduce,
)

SMALL = {"tip": "spherical"}, lengths(tip_radius_m=100e-6, height_m=5e-3)
REDUCED_Pa = MODULUS_Pa / (1 - 0.49**2)


def curve(pull: float, seed: int = 0) -> tuple[FloatArray, FloatArray]:
    return sticking(np.random.default_rng(seed), REDUCED_Pa, pull)


@pytest.mark.parametrize("pull", [0.02, 0.1, 0.5, 1.0])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_sphere_that_sticks_gives_its_modulus(pull: float, seed: int) -> None:
    """However much of its adhesion it feels on its way in (drawn by the seed)."""
    measured = reduce(SMALL, noisy(curve(pull, seed), 1e-7))
    quantity = measured.values[0].quantity
    assert quantity.value == pytest.approx(MODULUS_Pa, rel=0.02)
    assert abs(quantity.value - MODULUS_Pa) < 2.5 * quantity.standard_uncertainty
    said = measured.values[0].diagnostics
    assert float(said["tabor_parameter"]) > 100
    assert flags(measured)[0].startswith("adhesion: the tip was held back by")
    assert "by JKR (Tabor's parameter" in flags(measured)[0]


def test_hertz_on_the_loading_would_be_wrong_by_about_the_pull_off() -> None:
    deviations = []
    for seed in range(20):
        measured = reduce(SMALL, curve(0.1, seed)).values[0]
        hertz = float(measured.diagnostics["reduced_modulus_by_hertz_Pa"])
        deviations.append(hertz / REDUCED_Pa - 1)
    assert min(deviations) > -0.01
    assert 0.08 < max(deviations) < 0.15


def test_a_pull_that_no_law_of_adhesion_makes_is_refused() -> None:
    depth, force = (column.copy() for column in SPHERE_CURVE)
    force[540:560] -= 2e-5
    assert reason(reduce(SPHERE, (depth, force))) == (
        "the tip sticks (20 uN), and its way out follows JKR within 14 % of the modulus only (10 % is "
        "allowed); use a tip that sticks less"
    )


def test_loading_and_way_out_that_contradict_each_other_are_refused() -> None:
    depth, force = curve(0.1)
    top = int(depth.argmax())
    crept = depth.copy()
    crept[top + 30 :] += 0.3 * (depth[top] - depth[top + 30 :])  # recovers but 0.7 of its depth
    said = reason(reduce(SMALL, (crept, force)))
    assert "by JKR says" in said
    assert "adhesion explains 0 to" in said


def test_a_sphere_that_sticks_from_contact_on_is_refused() -> None:
    depth, force = curve(0.3)
    first = int(np.argmax(depth > 2e-7))
    assert "the record starts in contact" in reason(
        reduce(SMALL, noisy((depth[first:], force[first:] + 0.0), 1e-7))
    )


def test_a_flat_punch_that_sticks_keeps_its_stiffness() -> None:
    depth, force = (column.copy() for column in FLAT_CURVE)
    force[560:575] -= 2e-5
    measured = reduce(FLAT, (depth, force))
    assert measured.values[0].quantity.value == pytest.approx(MODULUS_Pa, rel=1e-6)
    (said,) = flags(measured)
    assert said.startswith("adhesion: the tip was held back by")
    assert said.endswith("a flat punch keeps its area, and its stiffness does not depend on it")


def test_what_noise_could_hide_is_in_the_budget() -> None:
    loud = reduce(SPHERE, noisy(SPHERE_CURVE, 2e-6)).values[0]
    (hidden,) = (c for c in loud.budget if c.source == "adhesion that noise hides")
    # 5 standard errors of a mean of 5 in the peak load, as a limit
    assert hidden.u / loud.quantity.value == pytest.approx(
        1.5 * 5**0.5 * 2e-6 / 162e-6 / 3**0.5, rel=0.15
    )
    assert "adhesion" not in " ".join(flags(reduce(SPHERE, noisy(SPHERE_CURVE, 1e-7))))


def test_the_situations_are_on_the_one_list() -> None:
    assert {"indentation-preload", "indentation-adhesion"} <= SITUATIONS.keys()
