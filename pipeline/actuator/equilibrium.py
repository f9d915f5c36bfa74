"""Newton and path following for the dimensionless elastica, many strips at once.

A strip is three numbers: load `g = w L^3 / B`, turn `k = kappa L` and angle `a` of gravity. Its
tangent angle solves `theta = k t + g G[(1 - t) sin(a - theta)]` (see `elastica`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deamat.actuator.collocation import Grid, grid, on_grid
from deamat.core.arrays import FloatArray

# Load at which an upright strip buckles: (9/4) j^2, j the first zero of the Bessel function J(-1/3)
# (Greenhill 1881). Below it the energy is convex whatever the curl, so there is one shape only.
SELF_BUCKLING_LOAD = 7.837347438943

LEVELS = (16, 24, 36, 54, 81, 122, 183)
_COARSE, _HEAVY = 0, 2  # levels to begin with; the finer one where the coarse may find no shape
_HEAVY_LOAD, _HEAVY_TURN_rad = 100.0, 3.0

_FIRST_LOAD = 8.0
_FIRST_TURN_rad = 1.0
_LARGEST_STEP_rad = 1.2  # a tangent that turns further in one step has jumped to another shape
_SMALLEST_STEP = 1e-3
_ENERGY_POINTS = 61


@dataclass(frozen=True, slots=True, eq=False)
class Strips:
    """Loads, turns and angles of gravity, each of shape (strips,)."""

    load: FloatArray
    turn: FloatArray
    angle: FloatArray

    def __getitem__(self, which: NDArray[np.intp] | NDArray[np.bool_]) -> Strips:
        return Strips(self.load[which], self.turn[which], self.angle[which])


def rest(strips: Strips, tolerance: float) -> tuple[FloatArray, FloatArray]:
    """Find how strips come to rest: weight first, then curl, each raised slowly.

    Parameters
    ----------
    strips : any number of them; similar ones cost the same, so blocks of a few hundred are best
    tolerance : of the tip, as a fraction of the length

    Returns
    -------
    Legendre series of the tangent angle, shape (strips, LEVELS[-1]), and the estimated error of
    the tip, shape (strips,): what the last refinement moved it by, the last Newton step and
    rounding; infinite where the strip buckles or snaps on the way, or no grid resolves it
    """
    series = np.zeros((strips.load.size, LEVELS[-1]))
    error = np.full(strips.load.size, np.inf)
    heavy = (strips.load > _HEAVY_LOAD) | (np.abs(strips.turn) > _HEAVY_TURN_rad)
    for level, mask in ((_COARSE, ~heavy), (_HEAVY, heavy)):
        who = np.flatnonzero(mask)
        if not who.size:
            continue
        theta, found = _follow(strips[who], grid(LEVELS[level]))
        who = who[found]
        series[who], error[who] = _refine(strips[who], theta[found], level, tolerance)
    rested = np.flatnonzero(np.isfinite(error))
    fine = grid(_ENERGY_POINTS)
    error[rested[~_stable(strips[rested], on_grid(series[rested], _ENERGY_POINTS), fine)]] = np.inf
    return series, error


def tips(theta: FloatArray, on: Grid) -> FloatArray:
    """Return tip positions for tangent angles `(strips, N)`, in lengths, as `(strips, 2)`."""
    return np.stack([np.cos(theta) @ on.weights, np.sin(theta) @ on.weights], axis=-1)


def _follow(strips: Strips, on: Grid) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Raise the weight (path 0 to 1), then the curl (1 to 2); say who arrived."""
    light = strips.load < SELF_BUCKLING_LOAD
    path = np.where(light, 1.0, 0.0)
    first_load = np.log1p(_FIRST_LOAD) / np.log1p(np.maximum(strips.load, _FIRST_LOAD))
    first_turn = _FIRST_TURN_rad / np.maximum(np.abs(strips.turn), _FIRST_TURN_rad)
    step = np.where(light, 1.0, first_load)
    theta = np.where(light, strips.turn, 0.0)[:, None] * on.points
    active = np.arange(path.size)
    while active.size:
        case, here = strips[active], path[active]
        there = np.minimum(here + step[active], np.where(here < 1.0, 1.0, 2.0))
        waypoint = Strips(
            np.expm1(np.minimum(there, 1.0) * np.log1p(case.load)),
            np.maximum(there - 1.0, 0.0) * case.turn,
            case.angle,
        )
        trial, last = _newton(waypoint, theta[active], on, tolerance=1e-6, iterations=10)
        jump = np.abs(trial - theta[active]).max(axis=1)
        ok = (last < 1e-6) & ((jump <= _LARGEST_STEP_rad) | light[active])
        # Past a buckle Newton still finds the shape that no strip keeps; a smaller step may not
        ok &= _stable(waypoint, trial, on)
        theta[active[ok]] = trial[ok]
        path[active[ok]] = there[ok]
        step[active] = np.where(ok, 2.0, 0.25) * step[active]
        loaded = active[ok & (there == 1.0)]
        step[loaded] = first_turn[loaded]
        active = active[(path[active] < 2.0) & (step[active] >= _SMALLEST_STEP)]
    return theta, path >= 2.0


def _newton(
    strips: Strips, theta: FloatArray, on: Grid, tolerance: float, iterations: int
) -> tuple[FloatArray, FloatArray]:
    """Improve tangent angles; return them with the size of each strip's last step."""
    theta = theta.copy()
    last = np.full(theta.shape[0], np.inf)
    identity = np.eye(on.points.size)
    active = np.arange(last.size)
    for _ in range(iterations):
        lag = strips.angle[active, None] - theta[active]
        pull = strips.load[active, None] * (1.0 - on.points)
        straight = strips.turn[active, None] * on.points
        residual = straight + (pull * np.sin(lag)) @ on.sag.T - theta[active]
        jacobian = identity + on.sag * (pull * np.cos(lag))[:, None, :]
        change = np.linalg.solve(jacobian, residual[..., None])[..., 0]
        size = np.abs(change).max(axis=1)
        change *= np.minimum(1.0, 1.0 / np.maximum(size, 1.0))[:, None]
        theta[active] += change
        last[active] = size
        active = active[size >= tolerance]
        if not active.size:
            break
    return theta, last


def _refine(
    strips: Strips, theta: FloatArray, level: int, tolerance: float
) -> tuple[FloatArray, FloatArray]:
    """Solve again with more points until the tips no longer move."""
    series = np.zeros((theta.shape[0], LEVELS[-1]))
    error = np.full(theta.shape[0], np.inf)
    coarse = grid(LEVELS[level])
    active = np.arange(theta.shape[0])
    for n in LEVELS[level + 1 :]:
        fine = grid(n)
        start = on_grid(theta @ coarse.to_series.T, n)
        better, last = _newton(strips[active], start, fine, 0.1 * tolerance, iterations=8)
        moved = np.hypot(*(tips(better, fine) - tips(theta, coarse)).T)
        estimate = moved + np.minimum(last, 1.0)
        series[active, :n] = better @ fine.to_series.T
        error[active] = estimate + (4.0 + strips.load[active]) * np.finfo(float).eps
        done = estimate <= tolerance
        theta, coarse, active = better[~done], fine, active[~done]
        if not active.size:
            break
    error[active] = np.inf
    return series, error


def _stable(strips: Strips, theta: FloatArray, on: Grid) -> NDArray[np.bool_]:
    """Say which shapes are minima of the energy `int eta'^2 + g (1 - t) cos(a - theta) eta^2`.

    Where the cosine is nowhere negative enough to buckle an upright strip the answer is yes; the
    eigenvalues are asked for the rest, with `eta'` as unknown so that `eta(0) = 0`.
    """
    cosine = np.cos(strips.angle[:, None] - theta)
    stable = np.asarray(-strips.load * cosine.min(axis=1, initial=1.0) < SELF_BUCKLING_LOAD)
    doubtful = np.flatnonzero(~stable)
    root = np.sqrt(on.weights)
    lever = on.from_root / root * root[:, None]
    pull = strips.load[doubtful, None] * (1.0 - on.points) * cosine[doubtful]
    energy = np.eye(root.size) + lever.T @ (pull[:, :, None] * lever)
    stable[doubtful] = np.linalg.eigvalsh(energy)[:, 0] > 0.0
    return stable
