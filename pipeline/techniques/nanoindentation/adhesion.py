"""A tip that sticks: how hard it was held back, and the modulus without that."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.records import Flag
from deamat.estimators.curves.adhesion import Adhesive, fit_adhesive
from deamat.estimators.curves.contact import Contact
from deamat.techniques.nanoindentation.approach import Approach, Tip, in_uN, noise_of
from deamat.techniques.nanoindentation.config import NanoindentationConfig

_AVERAGED = 5  # samples, against their noise
_TOLD = 5.0  # standard errors of such an average
_TURN = 0.005  # of the depth: nearer to the deepest point the tip has not turned back
_BIAS = 1.5  # of Hertz' law on the loading of a sphere that sticks, in pull-off over peak load


@dataclass(frozen=True, slots=True)
class Pull:
    """How hard the tip was held back on its way out.

    Parameters
    ----------
    net_N : load without that of air, shape (n,)
    force_N : largest pull
    peak_N : peak load
    noise_N : of a sample
    sticks : told from the noise, and large enough to matter
    unseen : relative bias of a modulus by a pull that the noise would hide `[1]`
    """

    net_N: FloatArray
    force_N: float
    peak_N: float
    noise_N: float
    sticks: bool
    unseen: float


def pull(made: Approach, contact: Contact, config: NanoindentationConfig) -> Pull:
    """Measure the pull on the way out, against the load in air."""
    noise = noise_of(made.force_N)
    net = made.force_N - contact.air(made.depth_m)
    # a tip that sticks jumps into contact: no law of a loading tells where air ends
    if contact.per_tilt == 0.0 and _lowest(net[made.end :]) < -_TOLD * noise:
        net = made.force_N - _air(made, contact, noise)
    peak = float(net[: made.end].max())
    after = net[made.end :]
    least = _TOLD * noise / math.sqrt(_AVERAGED)
    lowest = _lowest(after)
    sticks = -lowest > max(config.least_pull * peak, least)
    unseen = _BIAS * least / peak if least > config.least_pull * peak else 0.0
    # the largest of noisy samples is too large by about their noise
    force = max(-float(after.min(initial=0.0)) - noise, -lowest, 0.0)
    return Pull(net, force, peak, noise, sticks, unseen)


def _lowest(load: FloatArray) -> float:
    """Return the lowest of the running means of a load `[N]`."""
    if load.size < _AVERAGED:
        return 0.0
    return float(np.convolve(load, np.full(_AVERAGED, 1.0 / _AVERAGED), "valid").min())


def _air(made: Approach, contact: Contact, noise_N: float) -> FloatArray:
    """Line through the first half of the approach and what lies beyond the pull-off, shape (n,)."""
    depth, force = made.depth_m, made.force_N
    half = max(contact.in_air // 2, 2)
    level = float(np.median(force[:half]))
    off = made.end + int(force[made.end :].argmin()) + _AVERAGED
    free = off + np.flatnonzero(np.abs(force[off:] - level) < _TOLD * noise_N)
    air = np.concatenate([np.arange(half), free])
    x, y = depth[air] - depth[air].mean(), force[air]
    slope = float(x @ y) / float(x @ x) if x.any() else 0.0
    line: FloatArray = y.mean() + slope * (depth - depth[air].mean())
    return line


def adhesion_flags(tip: Tip, held: Pull) -> tuple[Flag, ...]:
    """Flag adhesion where it is not corrected for: under a flat punch or a pyramid."""
    if not held.sticks:
        return ()
    told = (
        f"the tip was held back by {in_uN(held.force_N)} on its way out, "
        f"{100 * held.force_N / held.peak_N:.2g} % of the peak load; "
    )
    if tip.shape == "flat":
        return (
            Flag(
                "adhesion",
                f"{told}a flat punch keeps its area, and its stiffness does not depend on it",
            ),
        )
    return (
        Flag(
            "adhesion",
            f"{told}a law without adhesion takes the contact for smaller than it was and the "
            "modulus for larger",
        ),
    )


def without_adhesion(
    made: Approach,
    contact: Contact,
    radius_m: float,
    hertz_Pa: float,
    held: Pull,
    config: NanoindentationConfig,
) -> tuple[Adhesive, int]:
    """Fit the way out of a sphere that sticks, and hold it against the loading.

    Parameters
    ----------
    hertz_Pa : reduced modulus of the loading by Hertz' law, which adhesion makes too large by up
        to 1.5 times the pull-off over the peak load

    Returns
    -------
    the fit, and the sample of the approach where its curve begins

    Raises
    ------
    FitRefused : see `fit_adhesive`; or loading and unloading contradict each other
    """
    if contact.per_tilt > 0.0:
        raise FitRefused(
            f"the tip sticks ({in_uN(held.force_N)}), and the record starts in contact: the load "
            "in air, from which the pull-off counts, is not known; start in air"
        )
    # after a hold at constant depth or load, whichever it was
    deepest = float(made.depth_m.max())
    nearly = deepest - _TURN * (deepest - contact.depth0)
    top = int(np.flatnonzero(made.depth_m >= nearly)[-1])
    found = fit_adhesive(
        made.depth_m[top:],
        held.net_N[top:],
        held.force_N,
        radius_m,
        config.unloading[1],
        config.reach_of_adhesion_m,
        config.min_contact_samples,
    )
    if found.u_scatter > config.max_relative_uncertainty:
        raise FitRefused(
            f"the tip sticks ({in_uN(held.force_N)}), and its way out follows {found.model} within "
            f"{100 * found.u_scatter:.2g} % of the modulus only "
            f"({100 * config.max_relative_uncertainty:g} % is allowed); use a tip that sticks less",
            {"relative_uncertainty": found.u_scatter},
        )
    ratio = hertz_Pa / found.reduced_modulus
    most = 1.0 + _BIAS * held.force_N / held.peak_N
    allowed = config.max_disagreement + 2.0 * found.u_scatter
    if not 1.0 - allowed < ratio < (1.0 + allowed) * most:
        raise FitRefused(
            f"the tip sticks ({in_uN(held.force_N)}), and its way out by {found.model} says "
            f"{found.reduced_modulus:.3g} Pa where its loading by Hertz says {hertz_Pa:.3g} Pa, "
            f"{100 * (ratio - 1.0):+.2g} %: adhesion explains 0 to {100 * (most - 1.0):.2g} %. "
            "Creep or a deep contact does the rest; unload faster, or use a tip that sticks less",
            {"hertz_Pa": hertz_Pa, "adhesive_Pa": found.reduced_modulus},
        )
    return found, top


def corrected_flag(found: Adhesive, held: Pull, hertz_Pa: float) -> Flag:
    """Say that adhesion was corrected for, by which law, and what Hertz' law would have said."""
    return Flag(
        "adhesion",
        f"the tip was held back by {in_uN(found.pull_off)} on its way out, "
        f"{100 * found.pull_off / held.peak_N:.2g} % of the peak load: the modulus is that of the "
        f"way out by {found.model} (Tabor's parameter {found.tabor:.2g}, work of adhesion "
        f"{1e3 * found.work:.3g} mJ/m2); Hertz' law on the loading says "
        f"{100 * (hertz_Pa / found.reduced_modulus - 1.0):+.2g} %",
    )
