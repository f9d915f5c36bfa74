from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deamat.actuator.figure_of_merit import multilayer, no_electrodes
from deamat.actuator.optimum import (
    best_passive_modulus,
    best_passive_thickness,
    best_split,
    modulus_ratio_at_fixed_active,
    thickness_ratio_at_fixed_active,
    thickness_ratio_at_fixed_total,
)
from deamat.core.errors import OutOfRange

from .stacks import random_unimorphs

BARE = replace(
    random_unimorphs(200, 1, seed=2), electrode_thickness_m=0.0, electrode_modulus_Pa=0.0
)
RATIO = np.asarray(BARE.passive_modulus_Pa) / np.asarray(BARE.active_modulus_Pa)


def test_equation_19_and_its_inverse() -> None:
    ratios = np.logspace(-9, 9, 400)
    back = modulus_ratio_at_fixed_active(thickness_ratio_at_fixed_active(ratios))
    assert np.allclose(back, ratios, rtol=1e-14)


def test_without_electrodes_the_numerical_optima_are_equations_18_and_19() -> None:
    on_film = np.asarray(best_passive_thickness(BARE)) / np.asarray(BARE.active_thickness_m)
    assert np.allclose(on_film, thickness_ratio_at_fixed_active(RATIO), rtol=2e-6)
    passive = np.asarray(best_split(BARE))
    shared = passive / (np.asarray(BARE.total_thickness_m) - passive)
    assert np.allclose(shared, thickness_ratio_at_fixed_total(RATIO), rtol=2e-6)
    stiffest = np.asarray(best_passive_modulus(BARE)) / np.asarray(BARE.active_modulus_Pa)
    t = np.asarray(BARE.passive_thickness_m) / np.asarray(BARE.active_thickness_m)
    assert np.allclose(stiffest, 1 / t**2, rtol=1e-13)


def test_at_fixed_total_every_pair_of_materials_bends_alike() -> None:
    """Figure 4B: the optimum curvature times thickness is 3/2 of the strain for any moduli."""
    passive = np.asarray(best_split(BARE))
    total = np.asarray(BARE.total_thickness_m)
    best = replace(BARE, passive_thickness_m=passive, active_thickness_m=total - passive)
    assert np.allclose(no_electrodes(best, 0.01) * total, 0.015, rtol=1e-10)


@pytest.mark.parametrize("n", [1, 6])
def test_with_electrodes_no_other_passive_layer_bends_more(n: int) -> None:
    designs = random_unimorphs(50, n, seed=7)
    t, y = best_passive_thickness(designs), best_passive_modulus(designs)
    top = np.asarray(multilayer(replace(designs, passive_thickness_m=t), 0.01))
    for other in np.geomspace(1.1e-9, 0.049, 300):
        assert np.all(
            multilayer(replace(designs, passive_thickness_m=other), 0.01) <= top * (1 + 1e-14)
        )
    y = np.clip(np.asarray(y), 1e2, 1e13)
    top = np.asarray(multilayer(replace(designs, passive_modulus_Pa=y), 0.01))
    for other in np.geomspace(1.1e2, 9e12, 300):
        assert np.all(
            multilayer(replace(designs, passive_modulus_Pa=other), 0.01) <= top * (1 + 1e-14)
        )


def test_electrodes_ask_for_a_thicker_passive_layer() -> None:
    """Section 2.1.4: designs with thicker electrodes need thicker passive layers and bend less."""
    film = replace(BARE, passive_modulus_Pa=1e6, active_thickness_m=300e-6, active_modulus_Pa=1e6)
    coated = replace(
        film, electrode_thickness_m=np.linspace(0, 60e-6, 7), electrode_modulus_Pa=3.5e6
    )
    t = best_passive_thickness(coated)
    assert np.all(np.diff(np.asarray(t)) > 0)
    assert np.all(np.diff(np.asarray(multilayer(replace(coated, passive_thickness_m=t), 0.01))) < 0)


def test_a_ratio_that_cannot_be_is_refused() -> None:
    for ratio in (
        thickness_ratio_at_fixed_active,
        thickness_ratio_at_fixed_total,
    ):
        with pytest.raises(OutOfRange, match=r"^modulus_ratio is -1; allowed is 1e-09 to 1e\+09$"):
            ratio(-1.0)
    with pytest.raises(OutOfRange, match=r"^thickness_ratio is 0; allowed is 1e-09 to 1e\+09$"):
        modulus_ratio_at_fixed_active(0.0)
