r"""Contact of a sphere that sticks: the limits of Johnson, Kendall, Roberts and of Derjaguin et al.

With the pull-off force $P_a$ and $p = P / P_a$ the depth of a sphere of radius R is

$$ h - h_0 = \Big(\frac{3 P_a}{E^*}\Big)^{2/3} R^{-1/3} \, g(p), \qquad
g_\mathrm{JKR} = s^{4/3} - \tfrac23 s^{1/3}, \; s = \tfrac12 (1 + \sqrt{1 + p}), \qquad
g_\mathrm{DMT} = \Big(\frac{1 + p}{4}\Big)^{2/3}, $$

both of which go over into Hertz' law for $p \gg 1$. Which one holds is a matter of Tabor's
parameter $\mu = \big(R W^2 / (E^{*2} z_0^3)\big)^{1/3}$, the reach of the stretched neck over that
of the forces: JKR above 5, DMT below 0.1. The work of adhesion W follows from the pull-off force,
$P_a = \tfrac32 \pi W R$ (JKR) or $2 \pi W R$ (DMT).

Source: K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301; B. V. Derjaguin,
V. M. Muller, Yu. P. Toporov, J. Colloid Interface Sci. 53 (1975) 314; D. Tabor, J. Colloid
Interface Sci. 58 (1977) 2; D. M. Ebenstein, K. J. Wahl, J. Colloid Interface Sci. 298 (2006) 652
for the depth as an explicit function of the load; K. L. Johnson, J. A. Greenwood, J. Colloid
Interface Sci. 192 (1997) 326 for the bounds of mu. Recalled; the forms are held to each other, to
Hertz and to the contact radius of Johnson, Kendall and Roberts in the tests.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.contact import independent_samples, standard_errors

MODELS = ("JKR", "DMT")
_JKR_ABOVE, _DMT_BELOW = 5.0, 0.1
_LOWEST = -0.9  # of the pull-off force: below, the depth runs away
_PULL_OFF = {"JKR": 1.5, "DMT": 2.0}  # P_a over pi W R
_STEP = 1e-3


@dataclass(frozen=True, slots=True)
class Adhesive:
    """A sphere's unloading with its pull-off, fitted by one of the two limits.

    Parameters
    ----------
    model : `"JKR"` or `"DMT"`
    reduced_modulus : E* `[Pa]`
    u_scatter : its relative standard error from the scatter of the depth
    per_pull_off : relative change of E* for a relative change of the pull-off force
    pull_off : P_a `[N]`
    work : W `[J/m^2]`
    tabor : mu `[1]`
    depth0 : of the surface, undeformed `[m]`
    first, last : samples that were fitted, as indices into the whole curve
    """

    model: str
    reduced_modulus: float
    u_scatter: float
    per_pull_off: float
    pull_off: float
    work: float
    tabor: float
    depth0: float
    first: int
    last: int


def tabor_parameter(radius_m: float, work: float, reduced_modulus: float, reach_m: float) -> float:
    """Return Tabor's mu `[1]`.

    Parameters
    ----------
    radius_m : R of the sphere
    work : of adhesion, W `[J/m^2]`
    reduced_modulus : E* `[Pa]`
    reach_m : z_0, of the forces between the surfaces
    """
    return float((radius_m * work**2 / (reduced_modulus**2 * reach_m**3)) ** (1.0 / 3.0))


def fit_adhesive(
    depth: FloatArray,
    load: FloatArray,
    pull_off: float,
    radius_m: float,
    top: float,
    reach_m: float,
    min_samples: int,
) -> Adhesive:
    """Fit the way out of a sphere that sticks, from a part of its peak load down to its pull-off.

    Parameters
    ----------
    depth, load : of the way out, from the peak on, load zero in air, shape (n,)
    pull_off : P_a, as measured `[N]`
    radius_m : R
    top : part of the peak load below which it is fitted
    reach_m : z_0 of Tabor's parameter
    min_samples : fewest samples from there to the pull-off

    Raises
    ------
    FitRefused : too few samples, a depth that does not return, or a Tabor parameter between the
        two limits
    """
    at = int(load.argmin())
    chosen = np.flatnonzero((load[:at] < top * load.max()) & (load[:at] > _LOWEST * pull_off))
    if chosen.size < min_samples:
        raise FitRefused(
            f"{chosen.size} samples of the way out before the pull-off, {min_samples} are needed; "
            "sample it faster",
            {"samples": int(chosen.size), "samples_needed": min_samples},
        )
    x, y = load[chosen], depth[chosen]
    found = {}
    for model in MODELS:
        modulus, u, surface = _fit(model, x / pull_off, y, pull_off, radius_m)
        work = pull_off / (_PULL_OFF[model] * math.pi * radius_m)
        mu = tabor_parameter(radius_m, work, modulus, reach_m)
        found[model] = Adhesive(
            model, modulus, u, 0.0, pull_off, work, mu, surface, int(chosen[0]), int(chosen[-1]),
        )  # fmt: skip
    if found["JKR"].tabor > _JKR_ABOVE:
        best = found["JKR"]
    elif found["DMT"].tabor < _DMT_BELOW:
        best = found["DMT"]
    else:
        raise FitRefused(
            f"the tip sticks, and Tabor's parameter is {found['JKR'].tabor:.2g}, between the "
            f"limits of DMT ({_DMT_BELOW:g}) and JKR ({_JKR_ABOVE:g}): neither law holds; use a "
            "larger tip",
            {"tabor": found["JKR"].tabor},
        )
    more = (1.0 + _STEP) * pull_off
    moved, *_ = _fit(best.model, x / more, y, more, radius_m)
    change = abs(moved / best.reduced_modulus - 1.0) / _STEP
    return Adhesive(
        best.model, best.reduced_modulus, best.u_scatter, change, pull_off, best.work, best.tabor,
        best.depth0, best.first, best.last,
    )  # fmt: skip


def shape(model: str, p: FloatArray) -> FloatArray:
    """Return g of a load over the pull-off force, shape (n,) `[1]`."""
    whole = np.maximum(1.0 + p, 0.0)
    if model == "DMT":
        result: FloatArray = (0.25 * whole) ** (2.0 / 3.0)
        return result
    s = 0.5 * (1.0 + np.sqrt(whole))
    jkr: FloatArray = s ** (4.0 / 3.0) - 2.0 / 3.0 * s ** (1.0 / 3.0)
    return jkr


def _fit(
    model: str, p: FloatArray, depth: FloatArray, pull_off: float, radius_m: float
) -> tuple[float, float, float]:
    """E*, its relative standard error and the surface's depth."""
    x = shape(model, p)
    dx, dy = x - x.mean(), depth - depth.mean()
    scale = float(dx @ dy) / float(dx @ dx)
    if not scale > 0.0:
        raise FitRefused("the depth does not return on the way out")
    surface = float(depth.mean()) - scale * float(x.mean())
    residual = depth - surface - scale * x
    independent = independent_samples(residual, 2, float(dy @ dy))
    u = standard_errors(np.column_stack([np.ones_like(x), x]), residual, independent)[1] / scale
    modulus = 3.0 * pull_off / math.sqrt(radius_m) * scale**-1.5
    return modulus, 1.5 * float(u), surface
