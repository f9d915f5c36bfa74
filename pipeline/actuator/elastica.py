"""The strip as it really hangs: planar elastica under its own weight, curled by its films.

The tangent turns by `theta` along the strip, `t` from the clamp (0) to the free tip (1):

    theta'' = -g (1 - t) sin(a - theta),  theta(0) = 0,  theta'(1) = k,
    g = w L^3 / B,  k = kappa L,

`a` being the angle of gravity. Written as `theta = k t + g G[(1 - t) sin(a - theta)]`, with `G` the
double integral `Grid.sag`, it is solved by Newton at Gauss-Legendre points, many strips at once.

A heavy or strongly curled strip may rest in several shapes. The one given is that of the
experiment: weight first, then voltage, each raised slowly. Where that path ends in a buckle or a
snap there is no one answer, and none is given.

Source: Euler's elastica with a distributed load (Bickley 1934; Wang 1986); Sikulskyi et al. 2022,
section 2.1.1 for why small deflections do not do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from deamat.actuator.beam import Beam, weight
from deamat.actuator.collocation import evaluate, grid, integral, on_grid
from deamat.actuator.equilibrium import Strips, rest, tips
from deamat.actuator.ranges import Reals, check, within
from deamat.actuator.stack import Orientation
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange

MAX_LOAD = 1e4  # g: a strip 21 times its elasto-gravity length
MAX_TURN_rad = 4.0 * np.pi  # k: two full coils, already through itself
_FEWEST = 24
_BLOCK = 256  # strips at a time, so that their matrices stay in the cache


@dataclass(frozen=True, slots=True, eq=False)
class Elastica:
    """Shapes of strips at rest; `...` is the shape of the designs.

    Parameters
    ----------
    length_m : along the elongated strip, shape (...) `[m]`
    series : Legendre coefficients of the tangent angle over 0..1, shape (..., N) `[rad]`
    tip_x_m, tip_y_m : tip along the clamped root's axis, and towards the first layer `[m]`
    tip_angle_rad : tangent at the tip `[rad]`
    error : estimated numerical error of the tip, as a fraction of the length `[1]`
    settled : False where the strip buckles, snaps or is not resolved; its numbers are then NaN, and
        `error` is infinite
    """

    length_m: FloatArray
    series: FloatArray
    tip_x_m: FloatArray
    tip_y_m: FloatArray
    tip_angle_rad: FloatArray
    error: FloatArray
    settled: NDArray[np.bool_]

    def shape(self, positions: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return `x`, `y` `[m]` and the tangent angle `[rad]`, each `(..., points)`.

        Parameters
        ----------
        positions : along the strip as fractions of its length, shape (points,)

        Raises
        ------
        OutOfRange : a position off the strip
        """
        within("position", positions, 0.0, 1.0, hint="give fractions of the length")
        # Twice the points of the angle: its cosine has finer features
        g = grid(2 * self.series.shape[-1])
        angle = on_grid(self.series, g.points.size)
        x, y = (
            self.length_m[..., None] * evaluate(integral(f(angle) @ g.to_series.T), positions)
            for f in (np.cos, np.sin)
        )
        return x, y, evaluate(self.series, positions)


def deflect(
    beam: Beam,
    length_m: Reals,
    orientation: Orientation,
    tolerance: float = 1e-9,
    unsettled: Literal["raise", "nan"] = "raise",
) -> Elastica:
    """Return the shape of a cantilever strip under its own weight and the curvature of its films.

    The strip bends and does not stretch under weight; its length, stiffness and curvature are those
    of the beam under voltage.

    Parameters
    ----------
    beam : from `beam.actuate` or `beam.bend`
    length_m : as made `[m]`
    orientation : which way gravity pulls
    tolerance : of the tip, as a fraction of the length `[1]`
    unsettled : what to do about strips that buckle or snap

    Raises
    ------
    OutOfRange : a length outside `ranges.RANGES`, a load or a turn beyond what is solved
    FitRefused : a strip that buckles or snaps, unless `unsettled` is `"nan"`
    """
    check("length_m", length_m)
    check("bending_stiffness_N_m2", beam.bending_stiffness_N_m2)
    length = length_m * (1.0 + beam.elongation)
    load = weight(beam, orientation) * length**3 / beam.bending_stiffness_N_m2
    turn = beam.curvature_per_m * length
    return solve(load, turn, orientation.angle_rad, length, tolerance, unsettled)


def solve(
    load: Reals,
    turn: Reals,
    angle_rad: Reals,
    length_m: Reals = 1.0,
    tolerance: float = 1e-9,
    unsettled: Literal["raise", "nan"] = "raise",
) -> Elastica:
    """Solve the elastica from its dimensionless numbers; as `deflect` otherwise.

    Parameters
    ----------
    load : `g = w L^3 / B`, 0 to `MAX_LOAD` `[1]`
    turn : `k = kappa L`, up to `MAX_TURN_rad` either way `[rad]`
    angle_rad : of gravity from the root's axis `[rad]`
    length_m : along the elongated strip `[m]`
    """
    within("load w L^3 / B", load, 0.0, MAX_LOAD, hint="shorten or stiffen the strip")
    within("turn kappa L", turn, -MAX_TURN_rad, MAX_TURN_rad, "rad", "beyond, it coils up")
    check("angle_rad", angle_rad)
    check("length_m", length_m)
    if unsettled not in ("raise", "nan"):
        raise OutOfRange(f"unsettled is {unsettled!r}; allowed are 'raise' and 'nan'")
    within("tolerance", tolerance, 1e-11, 1e-2, hint="it is a fraction of the length")
    given = np.broadcast_arrays(*(np.asarray(v, float) for v in (load, turn, angle_rad, length_m)))
    g, k, a, length = (np.ravel(v) for v in given)
    strips = Strips(g, k, a)
    blocks = [
        rest(strips[np.arange(i, min(i + _BLOCK, g.size))], tolerance)
        for i in range(0, g.size, _BLOCK)
    ]
    series = np.concatenate([s for s, _ in blocks])
    error = np.concatenate([e for _, e in blocks])
    settled = np.isfinite(error)
    if unsettled == "raise" and not settled.all():
        raise FitRefused(*_refusal(strips, settled))
    return _assemble(series, error, length, given[0].shape)


def _assemble(
    series: FloatArray,
    error: FloatArray,
    length: FloatArray,
    shape: tuple[int, ...],
) -> Elastica:
    settled = np.isfinite(error)
    series = np.where(settled[:, None], series, np.nan)
    # Trailing zeros go, but enough points stay to integrate the cosine of two coils
    used = np.flatnonzero(np.any(np.nan_to_num(series) != 0.0, axis=0))
    n = max(int(used[-1]) + 1 if used.size else 1, _FEWEST)
    series = series[:, :n]
    on = grid(2 * n)
    tip = length[:, None] * tips(on_grid(series, 2 * n), on)
    angle = evaluate(series, np.ones(1))[:, 0]
    return Elastica(
        length_m=length.reshape(shape),
        series=series.reshape(*shape, n),
        tip_x_m=tip[:, 0].reshape(shape),
        tip_y_m=tip[:, 1].reshape(shape),
        tip_angle_rad=angle.reshape(shape),
        error=error.reshape(shape),
        settled=settled.reshape(shape),
    )


def _refusal(
    strips: Strips, settled: NDArray[np.bool_]
) -> tuple[str, dict[str, float | int | str]]:
    first = int(np.flatnonzero(~settled)[0])
    numbers: dict[str, float | int | str] = {
        "load": float(strips.load[first]),
        "turn_rad": float(strips.turn[first]),
        "angle_rad": float(strips.angle[first]),
        "design": first,
    }
    reason = (
        f"{np.count_nonzero(~settled)} of {settled.size} strips have no one shape at rest: raising "
        f"the weight, then the voltage, the first of them (design {first}: load w L^3 / B "
        f"{numbers['load']:.4g}, turn kappa L {numbers['turn_rad']:.4g} rad, gravity at "
        f"{numbers['angle_rad']:.4g} rad) buckles, snaps or is not resolved; "
        "shorten or stiffen it, or turn it round"
    )
    return reason, numbers
