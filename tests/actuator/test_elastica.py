from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_bvp, solve_ivp
from scipy.special import jv

from deamat.actuator.beam import actuate, deflection, displacement
from deamat.actuator.elastica import MAX_LOAD, deflect, solve
from deamat.actuator.equilibrium import SELF_BUCKLING_LOAD
from deamat.actuator.stack import FIRST_LAYER_DOWN, HANGING, ON_EDGE, STANDING, Orientation
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange

from .stacks import strip

DOWN, UP, UPRIGHT = math.pi / 2, -math.pi / 2, math.pi


@pytest.mark.parametrize("turn", [1e-6, -0.5, 2.0, -6.0, 12.0])
def test_without_weight_it_is_an_arc(turn: float) -> None:
    found = solve(0.0, turn, 0.3)
    assert found.tip_x_m == pytest.approx(math.sin(turn) / turn, abs=1e-13)
    assert found.tip_y_m == pytest.approx(math.sin(turn / 2) ** 2 * 2 / turn, abs=1e-13)
    assert found.tip_angle_rad == pytest.approx(turn, abs=1e-10)


@pytest.mark.parametrize(
    ("load", "turn", "angle"),
    [(25, 0.5, DOWN), (60, 1.5, UP), (400, 2, DOWN), (200, 1, 0.0), (6, 1, UPRIGHT), (3, -2, 1.0)],
)
def test_scipy_solve_bvp_comes_to_the_same_tip(load: float, turn: float, angle: float) -> None:
    found = solve(load, turn, angle)

    def slope(t: FloatArray, y: FloatArray) -> FloatArray:
        bend = -load * (1 - t) * np.sin(angle - y[0])
        return np.array([y[1], bend, np.cos(y[0]), np.sin(y[0])])

    def ends(root: FloatArray, tip: FloatArray) -> FloatArray:
        return np.array([root[0], tip[1] - turn, root[2], root[3]])

    mesh = np.linspace(0, 1, 101)
    guess = np.array([0.8 * float(found.tip_angle_rad) * mesh, 0 * mesh, mesh, 0 * mesh])
    other = solve_bvp(slope, ends, mesh, guess, tol=1e-9, max_nodes=20_000)
    assert other.success
    assert np.hypot(found.tip_x_m - other.y[2, -1], found.tip_y_m - other.y[3, -1]) < 1e-8


def _slope(t: float, y: FloatArray, load: float, angle: float) -> list[float]:
    bend = -load * (1 - t) * math.sin(angle - y[0])
    return [y[1], bend, math.cos(y[0]), math.sin(y[0])]


def test_an_integrator_started_at_the_tip_arrives_at_the_clamp() -> None:
    """Random strips in random orientations, by an eighth-order Runge-Kutta method."""
    rng = np.random.default_rng(8)
    for _ in range(12):
        load, turn, angle = 10 ** rng.uniform(-1, 1.8), rng.uniform(-4, 4), rng.uniform(-2.5, 2.5)
        found = solve(load, turn, angle)

        tip = [float(found.tip_angle_rad), turn, float(found.tip_x_m), float(found.tip_y_m)]
        slope = partial(_slope, load=load, angle=angle)
        clamp = solve_ivp(slope, (1, 0), tip, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        assert np.max(np.abs(clamp[[0, 2, 3]])) < 1e-7


def test_the_estimated_error_is_kept() -> None:
    rng = np.random.default_rng(9)
    load, turn = 10 ** rng.uniform(-3, 3, 150), rng.uniform(-5, 5, 150)
    angle = rng.uniform(-2.5, 2.5, 150)
    exact = solve(load, turn, angle, 1.0, 1e-11, "nan")  # a few of them snap
    assert np.count_nonzero(exact.settled) > 140
    for tolerance in (1e-3, 1e-6, 1e-9):
        found = solve(load, turn, angle, 1.0, tolerance, "nan")
        off = np.hypot(found.tip_x_m - exact.tip_x_m, found.tip_y_m - exact.tip_y_m)
        assert found.settled.tolist() == exact.settled.tolist()
        assert np.all(found.error[found.settled] <= 1.001 * tolerance)
        assert np.all((off <= found.error + exact.error)[found.settled])


def test_small_deflections_are_its_limit() -> None:
    """The error of the small-deflection shape falls with the square of the slope."""
    beam = actuate(strip(), 9800.0, "poisson")
    off = []
    for length in (4e-3, 2e-3, 1e-3):
        tip = deflect(beam, length, FIRST_LAYER_DOWN)
        w = float(deflection(beam, length, length, FIRST_LAYER_DOWN))
        u = float(displacement(beam, length, length))
        slope = 2 * w / length
        assert abs(tip.tip_y_m - w) < 0.02 * w
        off.append(abs(tip.tip_x_m - length - u) / length / slope**2)
    assert np.allclose(off, 1 / 6, rtol=0.02)  # an arc of slope a ends a^2/6 short


def test_a_long_strip_sags_by_most_of_its_length() -> None:
    beam = actuate(strip(), 0.0, "poisson")
    length = 0.05
    tip = deflect(beam, length, FIRST_LAYER_DOWN)
    assert 0.75 * length < tip.tip_y_m < length
    assert float(deflection(beam, length, length, FIRST_LAYER_DOWN)) > 2 * length


def test_a_very_heavy_strip_hangs_as_a_rope() -> None:
    rope = solve(MAX_LOAD, 1.0, DOWN)
    assert rope.tip_y_m == pytest.approx(1.0, abs=0.03)
    straight = solve(MAX_LOAD, 0.0, 0.0)
    assert straight.tip_x_m == pytest.approx(1.0)
    assert straight.tip_y_m == 0.0


def test_mirrored_gravity_and_curl_mirror_the_strip() -> None:
    one, other = solve(30.0, 1.5, 0.7), solve(30.0, -1.5, -0.7)
    assert one.tip_x_m == pytest.approx(float(other.tip_x_m), abs=1e-13)
    assert one.tip_y_m == pytest.approx(-float(other.tip_y_m), abs=1e-13)


def test_the_shape_is_a_strip_of_its_length_from_the_clamp_to_the_tip() -> None:
    found = solve(np.array([40.0, 3.0]), np.array([1.0, 5.0]), UP, np.array([0.05, 0.03]))
    x, y, angle = found.shape(np.linspace(0, 1, 4001))
    assert np.allclose([x[:, 0], y[:, 0], angle[:, 0]], 0, atol=1e-8)
    assert np.allclose(x[:, -1], found.tip_x_m, atol=1e-13)
    assert np.allclose(y[:, -1], found.tip_y_m, atol=1e-13)
    walked = np.hypot(np.diff(x), np.diff(y)).sum(axis=1)
    assert np.allclose(walked, [0.05, 0.03], rtol=1e-6)
    assert np.allclose(
        np.diff(y) / np.hypot(np.diff(x), np.diff(y)),
        np.sin((angle[:, 1:] + angle[:, :-1]) / 2),
        atol=1e-6,
    )


def test_a_batch_is_its_strips_and_its_order_does_not_matter() -> None:
    rng = np.random.default_rng(10)
    load, turn = rng.uniform(0, 150, 300), rng.uniform(-4, 4, 300)
    batch = solve(load, turn, DOWN)
    backwards = solve(load[::-1], turn[::-1], DOWN)
    assert np.allclose(batch.tip_y_m, backwards.tip_y_m[::-1], atol=1e-10, rtol=0)
    for i in (0, 150, 299):
        alone = solve(float(load[i]), float(turn[i]), DOWN)
        assert alone.tip_y_m == pytest.approx(batch.tip_y_m[i], abs=1e-10)
        assert alone.tip_x_m.shape == ()


def test_raising_the_voltage_moves_the_strip_without_jumps() -> None:
    """The shape given is the one the experiment comes to, not another that also balances."""
    rng = np.random.default_rng(11)
    steps = np.linspace(0, 1, 81)
    for _ in range(12):
        load, turn, angle = 10 ** rng.uniform(0.5, 2), rng.uniform(-5, 5), rng.uniform(-2.6, 2.6)
        way = solve(load, turn * steps, angle)
        moved = np.hypot(np.diff(way.tip_x_m), np.diff(way.tip_y_m))
        assert np.max(moved) < 0.12


def test_an_upright_strip_stands_until_it_buckles() -> None:
    # (9/4) j^2 with J(-1/3)(j) = 0, Greenhill 1881
    assert jv(-1 / 3, 2 / 3 * math.sqrt(SELF_BUCKLING_LOAD)) == pytest.approx(0.0, abs=1e-11)
    assert solve(7.83, 0.0, UPRIGHT).tip_x_m == 1.0
    with pytest.raises(FitRefused):
        solve(7.85, 0.0, UPRIGHT)
    tilted = solve(7.85, 0.0, UPRIGHT - 0.01)
    assert tilted.tip_y_m > 0.15  # a strip that leans knows where to fall


def test_a_strip_that_buckles_or_snaps_is_refused_by_name_or_marked() -> None:
    load, turn = np.array([1.0, 30.0, 2.0]), np.array([0.5, 0.5, 0.5])
    with pytest.raises(FitRefused) as raised:
        solve(load, turn, UPRIGHT)
    assert str(raised.value) == (
        "1 of 3 strips have no one shape at rest: raising the weight, then the voltage, the first "
        "of them (design 1: load w L^3 / B 30, turn kappa L 0.5 rad, gravity at 3.142 rad) "
        "buckles, snaps or is not resolved; shorten or stiffen it, or turn it round"
    )
    assert raised.value.diagnostics["design"] == 1
    marked = solve(load, turn, UPRIGHT, unsettled="nan")
    assert marked.settled.tolist() == [True, False, True]
    assert np.isnan(marked.tip_x_m).tolist() == [False, True, False]
    assert marked.error[1] == np.inf
    # It leans one way under its weight; enough curl the other way throws it over
    with pytest.raises(FitRefused):
        solve(30.0, -6.5, UPRIGHT - 0.05)


def test_the_strip_of_a_beam_is_elongated_and_as_heavy_as_before() -> None:
    beam = actuate(strip(), 9800.0, "poisson")
    length = 0.03
    hanging = deflect(beam, length, HANGING)
    stretched = length * (1 + beam.elongation)
    load = beam.mass_kg_m * 9.80665 * length * stretched**2 / beam.bending_stiffness_N_m2
    same = solve(load, beam.curvature_per_m * stretched, 0.0, stretched)
    assert hanging.length_m == pytest.approx(stretched, rel=1e-15)
    assert hanging.tip_y_m == pytest.approx(float(same.tip_y_m), rel=1e-12)
    arc = deflect(beam, length, ON_EDGE)
    turn = beam.curvature_per_m * stretched
    assert arc.tip_y_m == pytest.approx(stretched * (1 - math.cos(turn)) / turn, rel=1e-12)
    assert deflect(beam, 0.01, STANDING).settled


def test_bad_input_is_refused() -> None:
    with pytest.raises(
        OutOfRange, match=r"^load w L\^3 / B is nan; allowed is 0 to 10000; shorten"
    ):
        solve(math.nan, 0.0, 0.0)
    with pytest.raises(
        OutOfRange, match=r"^turn kappa L is 20 rad; allowed is -12\.5664 to 12\.5664"
    ):
        solve(1.0, 20.0, 0.0)
    with pytest.raises(
        OutOfRange, match=r"^tolerance is 0; allowed is 1e-11 to 0\.01; it is a frac"
    ):
        solve(1.0, 1.0, 0.0, tolerance=0.0)
    unknown: Any = "skip"
    with pytest.raises(OutOfRange, match=r"^unsettled is 'skip'; allowed are 'raise' and 'nan'$"):
        solve(1.0, 1.0, 0.0, unsettled=unknown)
    with pytest.raises(
        OutOfRange, match=r"^length_m is 50 m; allowed is 1e-06 to 10 m; lengths are"
    ):
        deflect(actuate(strip(), 1.0, "poisson"), 50.0, Orientation(0.0))
    with pytest.raises(
        OutOfRange, match=r"^position is 2 at design 1; allowed is 0 to 1; give fract"
    ):
        solve(1.0, 1.0, 0.0).shape(np.array([0.5, 2.0]))
