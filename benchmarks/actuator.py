"""How fast and how accurate the actuator model is, each rival in the same run.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.actuator

Speeds are of the best of several repetitions, on designs drawn at random (synthetic); rivals are
plain loops over designs, and scipy's boundary-value solver for the elastica.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.integrate import solve_bvp

from deamat.actuator.beam import actuate
from deamat.actuator.elastica import solve
from deamat.actuator.figure_of_merit import Unimorph, multilayer, single_layer
from deamat.actuator.ladder import NEGLECTS, Actuator, choose, errors, evaluate
from deamat.actuator.ranges import Reals
from deamat.actuator.stack import FIRST_LAYER_DOWN, Layer, Role, Stack
from deamat.actuator.strain import VACUUM_PERMITTIVITY_F_m
from deamat.core.arrays import FloatArray

BLOCK, BLOCKS, ONE_BY_ONE, STRIPS = 10_000, 20, 2000, 2000
PERMITTIVITY, POISSON_RATIO, VOLTAGE_V = 2.58, 0.49, 3000.0
rng = np.random.default_rng(0)


def per_second(count: int, work: Callable[[], object], repeat: int = 5) -> float:
    best = math.inf
    for _ in range(repeat):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return count / best


def draw(count: int) -> Unimorph:
    def between(low: float, high: float) -> FloatArray:
        return rng.uniform(low, high, count)

    return Unimorph(
        between(100e-6, 400e-6),
        between(0.5e6, 2e6),
        between(300e-6, 500e-6),
        between(0.5e6, 2e6),
        between(5e-6, 20e-6),
        between(1e6, 5e6),
    )


def layers(unimorph: Unimorph) -> Stack:
    def one(role: Role, thickness_m: Reals, modulus_Pa: Reals) -> Layer:
        return Layer(role, thickness_m, modulus_Pa, 0.01, 1030.0, PERMITTIVITY, POISSON_RATIO)

    u = unimorph
    electrode = one("electrode", u.electrode_thickness_m, u.electrode_modulus_Pa)
    return Stack(
        (
            one("passive", u.passive_thickness_m, u.passive_modulus_Pa),
            electrode,
            one("de", u.active_thickness_m, u.active_modulus_Pa),
            electrode,
        )
    )


def rows(unimorph: Unimorph) -> list[list[float]]:
    columns = [
        unimorph.passive_thickness_m,
        unimorph.passive_modulus_Pa,
        unimorph.active_thickness_m,
        unimorph.active_modulus_Pa,
        unimorph.electrode_thickness_m,
        unimorph.electrode_modulus_Pa,
    ]
    values: list[list[float]] = np.array(columns).T.tolist()
    return values


def plain_merit(tp: float, yp: float, ta: float, ya: float, te: float, ye: float) -> float:
    t, y, r, q = tp / ta, yp / ya, te / ta, ye / ya
    below = 1 + y**2 * t**4 + q * r * (8 + 12 * r + 8 * r**2)
    below += y * t * (4 + 12 * r + 6 * t + 12 * r**2 + 12 * t * r + 4 * t**2)
    below += q**2 * r**2 * (12 + 24 * r + 16 * r**2)
    below += q * r * y * t * (12 + 36 * r + 12 * t + 32 * r**2 + 24 * t * r + 8 * t**2)
    return 6 * 0.006 * y * (t + t**2 + 2 * t * r) / (ta * below)


def plain_beam(tp: float, yp: float, ta: float, ya: float, te: float, ye: float) -> float:
    s0 = VACUUM_PERMITTIVITY_F_m * PERMITTIVITY * (VOLTAGE_V / ta) ** 2 / ya
    s = 4 / 3 * math.sin(math.asin(math.sqrt(6.75 * s0)) / 3) ** 2
    thick, stiff, free = (
        (tp, te, ta * (1 - s), te),
        (yp, ye, ya, ye),
        (0.0, 0.0, POISSON_RATIO * s, 0.0),
    )
    bottom = pull = first = 0.0
    for t, y in zip(thick, stiff, strict=True):
        pull += y * t
        first += y * t * (bottom + t / 2)
        bottom += t
    centre, bottom, moment, bending = first / pull, 0.0, 0.0, 0.0
    for t, y, e in zip(thick, stiff, free, strict=True):
        z = bottom + t / 2 - centre
        moment += y * t * e * z
        bending += y * t * (z * z + t * t / 12)
        bottom += t
    return moment / bending


def by_scipy(load: float, turn: float) -> tuple[float, float]:
    def slope(t: FloatArray, y: FloatArray) -> FloatArray:
        return np.array([y[1], -load * (1 - t) * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])])

    def ends(root: FloatArray, tip: FloatArray) -> FloatArray:
        return np.array([root[0], tip[1] - turn, root[2], root[3]])

    mesh = np.linspace(0, 1, 21)
    found = solve_bvp(slope, ends, mesh, np.array([mesh, 0 * mesh, mesh, mesh]), tol=1e-6)
    return float(found.y[2, -1]), float(found.y[3, -1])


def line(what: str, ours: float, theirs: float, rival: str, apart: float) -> None:
    ratio = ours / theirs
    print(f"{what:34}{ours:12,.0f} /s  {ratio:8,.0f} x {rival:22} differ by {apart:.1e}")


def merits() -> None:
    designs = draw(BLOCK)
    listed = rows(designs)[:ONE_BY_ONE]
    loop = per_second(ONE_BY_ONE, lambda: [plain_merit(*r) for r in listed])
    for name, merit in (("single layer (Eq. 16)", single_layer), ("multilayer, n = 1", multilayer)):

        def work(merit: Callable[[Unimorph, Reals], Reals] = merit) -> None:
            for _ in range(BLOCKS):
                merit(replace(designs), 0.006)  # a new Unimorph, so that checking is timed, too

        found = np.asarray(merit(designs, 0.006))[:ONE_BY_ONE]
        apart = np.max(np.abs(found / [plain_merit(*r) for r in listed] - 1))
        line(name, per_second(BLOCK * BLOCKS, work), loop, "a plain loop", float(apart))


def beams() -> None:
    designs = draw(BLOCK)
    listed = rows(designs)[:ONE_BY_ONE]
    loop = per_second(ONE_BY_ONE, lambda: [plain_beam(*r) for r in listed])

    def work() -> None:
        for _ in range(BLOCKS):
            actuate(layers(designs), VOLTAGE_V, "poisson")

    found = actuate(layers(designs), VOLTAGE_V, "poisson").curvature_per_m
    plain = [plain_beam(*r) for r in listed]
    apart = np.max(np.abs(np.asarray(found)[:ONE_BY_ONE] / plain - 1))
    line("4 layers, thinned", per_second(BLOCK * BLOCKS, work), loop, "a plain loop", float(apart))


def strips() -> None:
    load, turn = rng.uniform(0, 40, STRIPS), rng.uniform(0, 1.5, STRIPS)
    found = solve(load, turn, math.pi / 2)
    some = range(40)
    other = np.array([by_scipy(load[i], turn[i]) for i in some])
    apart = np.hypot(found.tip_x_m[:40] - other[:, 0], found.tip_y_m[:40] - other[:, 1]).max()
    theirs = per_second(40, lambda: [by_scipy(load[i], turn[i]) for i in some], 2)
    for tolerance in (1e-6, 1e-9):
        ours = per_second(STRIPS, partial(solve, load, turn, math.pi / 2, 1.0, tolerance), 3)
        line(f"elastica to {tolerance:.0e} L", ours, theirs, "scipy solve_bvp 1e-6", float(apart))


def _twenty_times(work: Callable[[], object]) -> None:
    for _ in range(20):
        work()


def ladder() -> None:
    stack = layers(Unimorph(304e-6, 0.957e6, 446e-6, 0.957e6, 10e-6, 3.5e6))
    lengths = (2e-3, 5e-3, 10e-3, 20e-3)
    ours = [Actuator(stack, x, 9800.0, "poisson", FIRST_LAYER_DOWN) for x in lengths]
    print("\none design at a time: cost, and estimated error of the tip for strips of a length")
    print(f"{'rung':16}{'us':>8}" + "".join(f"{x * 1e3:>8.0f} mm" for x in lengths))
    for rung in NEGLECTS:
        cost = 1e6 / per_second(20, partial(_twenty_times, partial(evaluate, ours[0], rung)))
        found = "".join(f"{errors(a, 'tip')[rung]:11.1e}" for a in ours)
        print(f"{rung:16}{cost:8.0f}{found}")
    cost = 1e6 / per_second(20, partial(_twenty_times, partial(choose, ours[1], 1e-3)))
    print(f"{'choose':16}{cost:8.0f}")


if __name__ == "__main__":
    merits()
    beams()
    strips()
    ladder()
