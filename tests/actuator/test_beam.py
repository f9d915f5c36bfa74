from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from deamat.actuator.beam import (
    Beam,
    actuate,
    bend,
    curvature,
    deflection,
    displacement,
    neutral_axis,
    weight,
)
from deamat.actuator.figure_of_merit import single_layer
from deamat.actuator.stack import (
    FIRST_LAYER_DOWN,
    FIRST_LAYER_UP,
    HANGING,
    ON_EDGE,
    Layer,
    Orientation,
    Role,
    Stack,
)
from deamat.actuator.strain import film_drive, thickness_strain
from deamat.core.errors import MissingProperty, OutOfRange

from .stacks import layer, random_unimorphs, stacked, strip


def test_the_referee_strip() -> None:
    """An independent composite beam gives 9.0688 per metre for 0.6 % in the film."""
    assert f"{bend(strip(), [0, 0, 0.006, 0]).curvature_per_m:.4f}" == "9.0688"


def test_timoshenko_bimetal_to_machine_precision() -> None:
    """Two layers: kappa = 6 e (1 + m)^2 / (h (3 (1 + m)^2 + (1 + m n)(m^2 + 1 / (m n))))."""
    rng = np.random.default_rng(1)
    t1, t2 = (10.0 ** rng.uniform(-6, -3, 2000) for _ in "12")
    y1, y2 = (10.0 ** rng.uniform(5, 11, 2000) for _ in "12")
    m, n = t1 / t2, y1 / y2
    e = 1e-3
    exact = 6 * e * (1 + m) ** 2
    exact /= (t1 + t2) * (3 * (1 + m) ** 2 + (1 + m * n) * (m**2 + 1 / (m * n)))
    found = bend(Stack((layer("passive", t1, y1), layer("de", t2, y2))), [0.0, e]).curvature_per_m
    assert np.max(np.abs(found / exact - 1)) < 4e-15


def test_equation_16_is_the_general_beam_over_ten_thousand_designs() -> None:
    designs = random_unimorphs(10_000, 1, seed=16)
    beam = bend(stacked(designs), [0.0, 0.0, 0.006, 0.0])
    assert np.max(np.abs(single_layer(designs, 0.006) / beam.curvature_per_m - 1)) < 1e-12


def _uneven(rng: np.random.Generator, count: int) -> tuple[Stack, list[float]]:
    """Seven layers with their own widths, thicknesses and moduli; three of them active."""
    roles: tuple[Role, ...] = ("passive", "electrode", "de", "electrode", "de", "insulation", "de")
    layers = tuple(
        layer(
            role,
            10.0 ** rng.uniform(-5.5, -3.5, count),
            10.0 ** rng.uniform(5, 7, count),
            rng.uniform(5e-3, 2e-2, count),
        )
        for role in roles
    )
    return Stack(layers), [0.0, 0.0, 0.01, 0.0, 0.02, 0.0, -0.01]


def test_force_and_moment_balance_as_a_plain_2x2_system() -> None:
    stack, strains = _uneven(np.random.default_rng(2), 300)
    beam = bend(stack, strains)
    bottom = np.zeros(300)
    matrix, right = np.zeros((300, 2, 2)), np.zeros((300, 2))
    for part, e in zip(stack.layers, strains, strict=True):
        by = part.width_m * part.modulus_Pa
        top = bottom + part.thickness_m
        s0, s1, s2 = (by * (top**p - bottom**p) / p for p in (1, 2, 3))
        matrix += np.moveaxis(np.array([[s0, s1], [s1, s2]]), 2, 0)
        right += np.array([s0 * e, s1 * e]).T
        bottom = top
    at_bottom, kappa = np.linalg.solve(matrix, right[..., None])[..., 0].T
    assert np.allclose(beam.curvature_per_m, kappa, rtol=1e-9)
    assert np.allclose(beam.elongation - kappa * beam.centroid_m, at_bottom, rtol=1e-9, atol=1e-12)


def test_equations_7_to_9_of_the_article_hold() -> None:
    stack, strains = _uneven(np.random.default_rng(3), 50)
    beam = bend(stack, strains)
    length = 0.02
    kappa = np.asarray(curvature(beam, 0.3 * length, length, FIRST_LAYER_DOWN))
    z = neutral_axis(beam, kappa)
    below = np.zeros(50)
    force, lever, second, first, pull, driven = (np.zeros(50) for _ in range(6))
    for part, e in zip(stack.layers, strains, strict=True):
        t = np.asarray(part.thickness_m)
        a = part.width_m * part.modulus_Pa * t
        middle = below + t / 2
        force += a * (middle - e / kappa)
        pull += a
        driven += a * e
        first += a * (middle - z)
        lever += a * e * (middle - z)
        second += a * (below**2 + t * below + t**2 / 3 + z**2 - z * (2 * below + t))
        below = below + t
    moment = weight(beam, FIRST_LAYER_DOWN) / 2 * (0.7 * length) ** 2
    assert np.allclose(z, force / pull, rtol=1e-9)  # Eq. 7
    assert np.allclose(kappa, driven / first, rtol=1e-7)  # Eq. 8
    assert np.allclose(kappa, (moment + lever) / second, rtol=1e-9)  # Eq. 9


def test_upside_down_bends_the_other_way() -> None:
    stack, strains = _uneven(np.random.default_rng(4), 20)
    up, down = bend(stack, strains), bend(Stack(stack.layers[::-1]), strains[::-1])
    assert np.allclose(up.curvature_per_m, -np.asarray(down.curvature_per_m), rtol=1e-10)
    assert np.allclose(up.elongation, down.elongation, rtol=1e-12)


def test_a_layer_cut_in_two_is_the_same_layer() -> None:
    whole = strip()
    half = layer("de", 223e-6, 0.957e6)
    cut = Stack((*whole.layers[:2], half, half, whole.layers[3]))
    one, two = bend(whole, [0, 0, 0.006, 0]), bend(cut, [0, 0, 0.006, 0.006, 0])
    for name in Beam.__dataclass_fields__:
        assert getattr(one, name) == pytest.approx(getattr(two, name), rel=1e-14)


def test_scaling_thickness_moduli_and_width() -> None:
    strains = [0.0, 0.0, 0.006, 0.0]
    base = bend(strip(), strains)

    def scaled(t: float, y: float, b: float) -> Beam:
        layers = strip().layers
        return bend(
            Stack(
                tuple(
                    layer(x.role, t * x.thickness_m, y * x.modulus_Pa, b * x.width_m)
                    for x in layers
                )
            ),
            strains,
        )

    kappa, bending = base.curvature_per_m, base.bending_stiffness_N_m2
    assert scaled(3, 1, 1).curvature_per_m == pytest.approx(kappa / 3, rel=1e-14)
    assert scaled(1, 7, 0.3).curvature_per_m == pytest.approx(kappa, rel=1e-14)
    assert scaled(2, 7, 0.3).bending_stiffness_N_m2 == pytest.approx(8 * 2.1 * bending, rel=1e-14)


def test_a_batch_gives_what_its_designs_give_one_by_one() -> None:
    designs = random_unimorphs(50, 3, seed=5)
    volts = 0.5 * np.sqrt(np.asarray(designs.active_modulus_Pa)) * designs.active_thickness_m * 1e5
    batch = actuate(stacked(designs), volts, "maxwell")
    for i in (0, 17, 49):
        layers = tuple(
            layer(x.role, float(np.asarray(x.thickness_m)[i]), float(np.asarray(x.modulus_Pa)[i]))
            for x in stacked(designs).layers
        )
        alone = actuate(Stack(layers), float(volts[i]), "maxwell")
        assert alone.curvature_per_m == pytest.approx(
            float(np.asarray(batch.curvature_per_m)[i]), rel=1e-14
        )


def test_voltage_thins_the_films_and_keeps_their_mass() -> None:
    s = float(thickness_strain(film_drive(9800.0, 446e-6, 0.957e6, 2.58)))
    driven = actuate(strip(), 9800.0, "poisson")
    by_hand = bend(strip(), [0, 0, 0.49 * s, 0], [0, 0, s, 0])
    assert driven.curvature_per_m == by_hand.curvature_per_m
    assert driven.mass_kg_m == pytest.approx(1030 * 0.01 * 770e-6, rel=1e-14)
    assert driven.bending_stiffness_N_m2 < bend(strip(), [0.0] * 4).bending_stiffness_N_m2
    small = actuate(strip(), 9800.0, "poisson", thinning=False)
    s0 = float(film_drive(9800.0, 446e-6, 0.957e6, 2.58))
    assert small.curvature_per_m == bend(strip(), [0, 0, 0.49 * s0, 0]).curvature_per_m


def test_the_deflection_is_the_twice_integrated_curvature() -> None:
    beam, length = actuate(strip(), 9800.0, "poisson"), 0.03
    x = np.linspace(0, length, 2001)
    kappa = np.asarray(curvature(beam, x, length, Orientation(1.0)))
    step = x[1]
    slope = np.concatenate([[0], np.cumsum((kappa[1:] + kappa[:-1]) / 2)]) * step
    sag = np.concatenate([[0], np.cumsum((slope[1:] + slope[:-1]) / 2)]) * step
    assert np.allclose(deflection(beam, x, length, Orientation(1.0)), sag, rtol=1e-6, atol=1e-10)
    assert np.allclose(displacement(beam, x, length), beam.elongation * x, rtol=1e-15)


def test_gravity_helps_with_the_first_layer_down_and_works_against_it_up() -> None:
    beam, length = actuate(strip(), 9800.0, "poisson"), 0.02
    by_weight = weight(beam, FIRST_LAYER_DOWN) * length**4 / (8 * beam.bending_stiffness_N_m2)
    by_film = beam.curvature_per_m * length**2 / 2
    for orientation, sign in (
        (FIRST_LAYER_DOWN, 1),
        (FIRST_LAYER_UP, -1),
        (HANGING, 0),
        (ON_EDGE, 0),
    ):
        tip = deflection(beam, length, length, orientation)
        assert tip == pytest.approx(by_film + sign * by_weight, rel=1e-13)


def test_the_elasto_gravity_length_of_the_referee_strip_is_17_mm() -> None:
    beam = bend(strip(), [0.0] * 4)
    long = (beam.bending_stiffness_N_m2 / weight(beam, FIRST_LAYER_DOWN)) ** (1 / 3)
    assert f"{long * 1e3:.0f}" == "17"


def test_nothing_stretches_at_the_neutral_axis() -> None:
    beam = actuate(strip(), 9800.0, "poisson")
    z = float(np.asarray(neutral_axis(beam, beam.curvature_per_m)))
    assert beam.elongation + beam.curvature_per_m * (z - beam.centroid_m) == pytest.approx(
        0, abs=1e-18
    )
    rest = bend(strip(), [0.0] * 4)
    assert neutral_axis(rest, 0.0) == rest.centroid_m
    symmetric = bend(Stack((layer("de", 1e-4, 1e6),)), [0.01])
    assert math.isinf(float(np.asarray(neutral_axis(symmetric, symmetric.curvature_per_m))))


@pytest.mark.parametrize(
    ("thickness", "message"),
    [
        (446.0, "446 m; allowed is 1e-09 to 0.05 m; lengths are in metres: was it given in "),
        (0.0, "0 m; allowed is 1e-09 to 0.05 m; "),
        (-1e-4, "-0.0001 m; allowed is 1e-09 to 0.05 m; "),
        (1e-10, "1e-10 m; allowed is 1e-09 to 0.05 m; "),
        (math.nan, "nan m; allowed is 1e-09 to 0.05 m; "),
        (math.inf, "inf m; allowed is 1e-09 to 0.05 m; "),
        (np.array([1e-4, math.nan]), "nan m at design 1; allowed is 1e-09 to 0.05 m; "),
        (np.array([]), "an empty array; allowed is 1e-09 to 0.05 m"),
    ],
)
def test_a_thickness_that_cannot_be_is_refused(thickness: float, message: str) -> None:
    with pytest.raises(OutOfRange) as raised:
        layer("de", thickness, 1e6)
    assert str(raised.value).startswith(f"thickness_m of the de layer is {message}")


def test_other_bad_input_is_refused() -> None:
    unknown: Any = "film"
    with pytest.raises(OutOfRange, match=r"^the stack has 0 layers; a beam needs at least one$"):
        Stack(())
    with pytest.raises(
        OutOfRange, match=r"^role is 'film'; allowed are passive, electrode, de, ins"
    ):
        layer(unknown, 1e-4, 1e6)
    with pytest.raises(
        OutOfRange, match=r"^modulus_Pa of the passive layer is 0\.957 Pa; allowed "
    ):
        layer("passive", 1e-4, 0.957)
    with pytest.raises(
        OutOfRange, match=r"^width_m of the passive layer is 10 m; allowed is 1e-06"
    ):
        layer("passive", 1e-4, 1e6, 10.0)
    with pytest.raises(OutOfRange, match=r"^density_kg_m3 of the de layer is 0 kg/m3; "):
        Layer("de", 1e-4, 1e6, 0.01, 0.0)
    with pytest.raises(OutOfRange, match=r"^free_strains has 3 values; the stack has 4 layers$"):
        bend(strip(), [0, 0, 0.006])
    with pytest.raises(
        OutOfRange, match=r"^strain of layer 3 \(de\) is 0\.6; .*given in percent\?$"
    ):
        bend(strip(), [0, 0, 0.6, 0])
    with pytest.raises(
        OutOfRange, match=r"^voltage_V of layer 3 \(de\) is 40000 V; allowed is 0 to "
    ):
        actuate(strip(), 4e4, "poisson")
    with pytest.raises(
        OutOfRange, match=r"^the stack has 0 de layers; a voltage needs at least one"
    ):
        actuate(Stack((layer("passive", 1e-4, 1e6),)), 1.0, "poisson")
    with pytest.raises(
        MissingProperty, match=r"^a de layer under voltage needs its poisson_ratio; it"
    ):
        actuate(Stack((Layer("de", 1e-4, 1e6, 0.01, 1e3, 2.6),)), 1.0, "poisson")
    with pytest.raises(
        OutOfRange, match=r"^x_m over length_m is 2; allowed is 0 to 1; it is off the"
    ):
        deflection(bend(strip(), [0.0] * 4), 0.04, 0.02, HANGING)
    with pytest.raises(OutOfRange, match=r"^angle_rad is 90 rad; .*was it given in degrees\?$"):
        Orientation(90.0)
