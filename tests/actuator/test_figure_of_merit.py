from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deamat.actuator.beam import bend
from deamat.actuator.figure_of_merit import (
    Unimorph,
    dea_strain,
    multilayer,
    no_electrodes,
    planar,
    single_layer,
)
from deamat.actuator.strain import drive, paper_eq4, pull_in_field, thickness_strain
from deamat.core.errors import OutOfRange

from .paper import ARAROMI_2012, DESIGN_1, DESIGN_2, POISSON_RATIO, SIKULSKYI_2020
from .stacks import random_unimorphs, stacked


@pytest.mark.parametrize("n", [1, 2, 5, 12])
def test_the_closed_form_is_the_general_beam(n: int) -> None:
    designs = random_unimorphs(1000, n, seed=n)
    strains = [0.0, *([0.0, 0.006] * n), 0.0]
    by_layers = np.asarray(bend(stacked(designs), strains).curvature_per_m)
    assert np.max(np.abs(multilayer(designs, 0.006) / by_layers - 1)) < 1e-12


def test_the_figures_of_merit_are_each_others_limits() -> None:
    designs = random_unimorphs(1000, 1, seed=0)
    assert np.allclose(single_layer(designs, 0.01), multilayer(designs, 0.01), rtol=1e-13)
    bare = replace(designs, electrode_thickness_m=0.0, electrode_modulus_Pa=0.0)
    assert np.allclose(no_electrodes(bare, 0.01), single_layer(bare, 0.01), rtol=1e-13)
    one = replace(bare, active_thickness_m=np.asarray(bare.active_thickness_m) / 8, n_active=8)
    assert np.allclose(multilayer(one, 0.01), single_layer(bare, 0.01), rtol=1e-12)


def test_properties_of_the_curvature() -> None:
    designs = random_unimorphs(200, 4, seed=1)
    kappa = np.asarray(multilayer(designs, 0.01))
    u = designs
    thicker = replace(
        u,
        passive_thickness_m=3.0 * u.passive_thickness_m,
        active_thickness_m=3.0 * u.active_thickness_m,
        electrode_thickness_m=3.0 * u.electrode_thickness_m,
    )
    stiffer = replace(
        u,
        passive_modulus_Pa=3.0 * u.passive_modulus_Pa,
        active_modulus_Pa=3.0 * u.active_modulus_Pa,
        electrode_modulus_Pa=3.0 * u.electrode_modulus_Pa,
    )
    assert np.allclose(multilayer(thicker, 0.01), kappa / 3, rtol=1e-13)
    assert np.allclose(multilayer(stiffer, 0.01), kappa, rtol=1e-13)
    assert np.allclose(multilayer(designs, -0.02), -2 * kappa, rtol=1e-14)


def test_any_other_active_material_goes_in_by_its_own_strain() -> None:
    """A bimetal without electrodes is Timoshenko's: equal layers give 3 e / (4 t)."""
    equal = Unimorph(1e-3, 2e11, 1e-3, 2e11, 0.0, 0.0)
    assert no_electrodes(equal, 1e-3) == pytest.approx(0.75e-3 / 1e-3, rel=1e-15)


def test_planar_ranks_and_dea_strain_reaches() -> None:
    assert planar(2.58, 22.2e6, 0.957e6) == pytest.approx(0.0117642, rel=1e-6)
    assert dea_strain(2.58, 22.2e6, 0.957e6, 0.49) == pytest.approx(0.49 * 0.0117642, rel=1e-6)
    # At its breakdown field the soft 30:1 film would be past pull-in: it ranks, but is not reached
    assert planar(2.63, 48.4e6, 0.095e6) == pytest.approx(0.574, abs=1e-3)
    limit = float(pull_in_field(0.095e6, 2.63))
    with pytest.raises(OutOfRange) as raised:
        dea_strain(2.63, 48.4e6, 0.095e6, 0.49)
    assert str(raised.value) == (
        f"field_V_m is 4.84e+07 V/m; allowed is 0 to {limit:g} V/m; above the pull-in field the "
        "film has no equilibrium: lower the field"
    )


def test_electrodes_cost_design_1_a_fifth_and_ten_films_a_thirteenth() -> None:
    """Sikulskyi et al. 2022 read 'about 19 %' off Figure 6A and 'about 7.5 %' off Figure 7."""
    designed = replace(DESIGN_1.unimorph, passive_thickness_m=341e-6, active_thickness_m=500e-6)
    kept = float(single_layer(designed, 0.01)) / float(no_electrodes(designed, 0.01))
    assert kept == pytest.approx(0.81, abs=0.01)
    films = Unimorph(165e-6, 1e6, 30e-6, 1e6, 3e-6, 1e4, 10)  # R_Y = R_t = 0.01, t = 0.55
    kept = float(multilayer(films, 0.01)) / float(no_electrodes(films, 0.01))
    assert kept == pytest.approx(0.925, abs=0.003)


def test_thinning_raises_a_multilayer_and_the_printed_sign_lowers_it() -> None:
    row = ARAROMI_2012
    s0 = drive(row.relative_permittivity, row.field_V_m, row.unimorph.active_modulus_Pa)
    linear = multilayer(row.unimorph, POISSON_RATIO * s0)
    assert multilayer(row.unimorph, POISSON_RATIO * np.asarray(thickness_strain(s0))) > linear
    assert multilayer(row.unimorph, POISSON_RATIO * np.asarray(paper_eq4(s0))) < linear


def test_a_batch_is_its_designs() -> None:
    film = np.linspace(200e-6, 600e-6, 5)
    batch = np.asarray(single_layer(replace(DESIGN_2.unimorph, active_thickness_m=film), 0.01))
    for t, kappa in zip(film, batch, strict=True):
        alone = single_layer(replace(DESIGN_2.unimorph, active_thickness_m=float(t)), 0.01)
        assert alone == pytest.approx(float(kappa), rel=1e-15)


def test_bad_input_is_refused() -> None:
    base = SIKULSKYI_2020.unimorph
    with pytest.raises(
        OutOfRange, match=r"^thickness_m of the passive layer is 25\.4 m; allowed is"
    ):
        replace(base, passive_thickness_m=25.4)
    with pytest.raises(
        OutOfRange, match=r"^thickness_m of the electrode is -1e-06 m; allowed is 0 "
    ):
        replace(base, electrode_thickness_m=-1e-6)
    with pytest.raises(
        OutOfRange, match=r"^modulus_Pa of the active layer is nan Pa; allowed is 100"
    ):
        replace(base, active_modulus_Pa=float("nan"))
    with pytest.raises(
        OutOfRange, match=r"^n_active is 0; allowed is 1 to 10000; give the number of"
    ):
        replace(base, n_active=0)
    with pytest.raises(
        OutOfRange, match=r"^strain of the active layer is 2; allowed is -0\.5 to 0\.5"
    ):
        multilayer(base, 2.0)
    with pytest.raises(OutOfRange, match=r"holds for n_active = 1, not 4; use multilayer$"):
        single_layer(ARAROMI_2012.unimorph, 0.01)
