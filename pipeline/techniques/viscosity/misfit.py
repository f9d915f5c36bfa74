"""Whether a law misses its readings, and how much wider it is for that and for being chosen."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.records import Flag
from deamat.estimators.curves.noise import noise_sd
from deamat.estimators.least_squares.fit import Fit
from deamat.estimators.least_squares.lack_of_fit import outlying_points, residual_runs
from deamat.estimators.least_squares.monotone import NonDecreasingFit
from deamat.estimators.mean import coverage_factor
from deamat.estimators.selection import NORMAL
from deamat.formats.viscometer import lines_text
from deamat.techniques.viscosity.direct import Direct, direct_of, greatest_miss
from deamat.techniques.viscosity.fitted import Fitted
from deamat.techniques.viscosity.readings import Readings
from deamat.techniques.viscosity.time_law import TimeLaw, growth

# How often residuals of a law that is right seem to follow each other.
_FALSE_ALARMS = 0.002
# Weighted squares over their variance that holding to the shape may cost a law that does not fall:
# chi-squared of the highest degree, and more where few readings tell the variance.
_HELD, _HELD_OF_FEW = 20.0, 10.0
_HELD_A_LITTLE = 4.0  # enough to name the shape where the residuals follow each other anyway
_CHECKED_TIMES = 12
# Standard deviations of the noise of neighbouring readings, of many and of few: the noise of twelve
# is known to a third, and one in a thousand residuals then lies beyond eight of it.
_FAR, _FAR_OF_FEW = 6.0, 60.0


@dataclass(frozen=True, slots=True)
class Misfit:
    """A law that misses its readings.

    Parameters
    ----------
    direct : the readings, to be asked in its place
    greatest : how far readings nearby leave it at most, as a fraction of it
    flags : what was found
    """

    direct: Direct
    greatest: float
    flags: tuple[Flag, ...]


def held_by(found: NonDecreasingFit) -> float:
    """By how much a polynomial's shape raises its weighted squares, over their variance."""
    plain = found.unconstrained
    if plain.dof == 0 or plain.residual_sd == 0:
        return 0.0
    raised = _squares(found.fit) - _squares(plain)
    return raised / plain.residual_sd**2 / (1.0 + _HELD_OF_FEW / plain.dof)


def misfit_of(law: TimeLaw, fit: Fit, held: float, readings: Readings) -> Misfit | None:
    """Hold a law against its readings: residuals that follow each other, or a shape forced on them.

    Parameters
    ----------
    held : as `held_by` tells
    readings : in the order of `fit`

    Returns
    -------
    what was found, or None
    """
    runs = residual_runs(readings.time_s, fit, _FALSE_ALARMS)
    if not runs.found and held <= _HELD:
        return None
    direct = direct_of(law, readings)
    greatest, at_s = greatest_miss(direct)
    flags = []
    if held > (_HELD_A_LITTLE if runs.found else _HELD):
        flags.append(
            Flag(
                "held-to-shape",
                f"the readings fall where {law.name} may not: it misses them by up to "
                f"{greatest:.1%}, at {at_s / 3600:.3g} h after mixing",
            )
        )
    if runs.found:
        flags.append(
            Flag(
                "systematic-misfit",
                f"residuals of {law.name} follow each other (von Neumann ratio {runs.ratio:.2f} "
                f"where noise has 2): it misses the readings by up to {greatest:.1%}, at "
                f"{at_s / 3600:.3g} h after mixing; values are of the readings nearby, and the "
                "interval of the law is as wide as it misses them",
            )
        )
    return Misfit(direct, greatest, tuple(flags))


def outlying_flags(law: TimeLaw, fit: Fit, readings: Readings) -> tuple[Flag, ...]:
    """Name readings far off a law, which stay in its fit.

    Far from the majority; or outside the law's interval and by more than six standard deviations
    (of twelve readings eleven) of what neighbouring readings scatter: where a law misses several
    readings at its end, its majority lies off it too.

    Parameters
    ----------
    readings : in the order of `fit`
    """
    off = np.union1d(outlying_points(fit), _left_behind(law, fit, readings))
    if not off.size:
        return ()
    one = off.size == 1
    return (
        Flag(
            "outlying-readings",
            f"{off.size} of {len(readings)} readings "
            f"{'lies' if one else 'lie'} far off the law; {'it stays' if one else 'they stay'} in "
            f"the fit: {'line' if one else 'lines'} {lines_text(np.sort(readings.line[off]))}",
        ),
    )


def _left_behind(law: TimeLaw, fit: Fit, readings: Readings) -> NDArray[np.intp]:
    order = np.argsort(readings.time_s, kind="stable")
    noise = noise_sd(fit.weighted_residuals[order])
    far = np.flatnonzero(np.abs(fit.weighted_residuals) > (_FAR + _FAR_OF_FEW / order.size) * noise)
    if noise == 0.0:
        return far[:0]
    outside = []
    for at in far.tolist():
        value, slopes = law.at(float(readings.time_s[at]))
        found = law.estimate(value, slopes)
        u = math.hypot(found.scatter, found.calibration, found.thermal)
        miss = abs(float(readings.viscosity_Pas[at]) - value)
        outside.append(miss > coverage_factor(found.dof) * u)
    return far[np.array(outside, dtype=np.bool_)]


def widened_by_misfit(law: TimeLaw, missed: Misfit) -> TimeLaw:
    """Widen a law at all times by what its readings leave it by at most."""
    return replace(
        with_relative_u(law, missed.greatest / coverage_factor(law.dof)),
        flags=(*law.flags, *missed.flags),
        diagnostics={**law.diagnostics, "greatest_misfit": missed.greatest},
    )


def with_relative_u(law: TimeLaw, relative: float) -> TimeLaw:
    """Add a standard uncertainty that is a fraction of viscosity at all times and rates."""
    upwards = relative * growth(law)
    return replace(law, covariance=law.covariance + np.outer(upwards, upwards))


def widened_by_choice(fitted: Fitted) -> Fitted:
    """Widen the published law until its interval holds what all supported laws say.

    Its covariance is multiplied by one factor, the greatest that any time over its range asks for.
    """
    law = fitted.law
    factor = 1.0
    for time_s in np.linspace(*law.valid, _CHECKED_TIMES).tolist():
        value, slopes = law.at(time_s)
        own = law.estimate(value, slopes).scatter * coverage_factor(law.dof)
        everyone = replace(fitted, asked_for=True).answer(partial(_at, time_s=time_s))
        if own > 0:
            factor = max(factor, NORMAL * everyone.scatter / own)
    said = {**law.diagnostics, "widened_for_choice": factor}
    wider = replace(law, covariance=factor**2 * law.covariance, diagnostics=said)
    return replace(fitted, law=wider)


def _squares(fit: Fit) -> float:
    return math.fsum(np.square(fit.weighted_residuals))


def _at(law: TimeLaw, time_s: float) -> tuple[float, FloatArray]:
    return law.at(time_s)
