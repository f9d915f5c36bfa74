"""What the uncertainties of cards and layers do to a prediction: first order and Monte Carlo.

Source: JCGM 100:2008 and JCGM 101:2008.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deamat.actuator.inputs import Input
from deamat.actuator.model import Response
from deamat.actuator.ranges import RANGES, within
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused

_STEP = 1e-5  # relative; central differences are then good to about 1e-9
_FAR = 2.0  # standard uncertainties: where the linear answer is held against the model
_NO_VARIANCE = 2.0  # degrees of freedom up to which a t distribution has none
_FARTHEST = 50.0  # e-folds
_STRAIGHT = 0.15  # asymmetry there, up to which both methods were found to agree within 5 %


@dataclass(frozen=True, slots=True)
class FirstOrder:
    """A prediction with its uncertainty to first order.

    Parameters
    ----------
    value, u : prediction and standard uncertainty `[unit of the prediction]`
    gradient : by each input, in their order `[unit / unit of the input]`
    asymmetry : how unequal two standard uncertainties up and down are, 0 for a linear model `[1]`
    holds : the asymmetry is small enough for first order to be within 5 % of Monte Carlo
    """

    value: float
    u: float
    gradient: tuple[float, ...]
    asymmetry: float
    holds: bool


@dataclass(frozen=True, slots=True)
class MonteCarlo:
    """A prediction's distribution over draws of its inputs.

    Parameters
    ----------
    median : of the draws that have an equilibrium
    sd : their standard deviation; NaN where an input has the t distribution of three specimens or
        fewer, which has none
    interval95 : 2.5 and 97.5 % quantiles of those
    pull_in_probability : fraction of the draws whose film pulls in `[1]`
    draws : how many
    """

    median: float
    sd: float
    interval95: tuple[float, float]
    pull_in_probability: float
    draws: int


@dataclass(frozen=True, slots=True)
class Bar:
    """One bar of a tornado chart.

    Parameters
    ----------
    name : of the input
    low, high : prediction with the input one standard uncertainty down and up, NaN beyond pull-in
    u : standard uncertainty that it alone causes, to first order
    elasticity : relative change of the prediction over that of the input `[1]`
    declared : it has an uncertainty at all
    """

    name: str
    low: float
    high: float
    u: float
    elasticity: float
    declared: bool


def first_order(inputs: Sequence[Input], response: Response) -> FirstOrder:
    """Propagate uncertainties linearly, `u^2 = sum over sources of (sum_i df/dx_i u_i)^2`.

    Parameters
    ----------
    inputs : of the prediction
    response : the model

    Raises
    ------
    FitRefused : the film pulls in at the values themselves

    Source: JCGM 100:2008 (GUM), 5.1 and 5.2.
    """
    (only,) = first_orders(inputs, response, 1)
    return only


def first_orders(inputs: Sequence[Input], response: Response, points: int) -> list[FirstOrder]:
    """Propagate uncertainties as `first_order` does, at several points of a curve at once.

    Parameters
    ----------
    inputs : of every point
    response : the model, from values of shape (m,) or (points, m) to (points, m)
    points : how many

    Raises
    ------
    FitRefused : the film pulls in at the values themselves, at some point
    """
    values, gradients = _gradients(inputs, response, points)
    found = []
    us = [combined(inputs, gradient) for gradient in gradients]
    skewed = _asymmetries(inputs, gradients, us, values, response)
    for value, u, gradient, asymmetry in zip(
        values.tolist(), us, gradients.tolist(), skewed, strict=True
    ):
        found.append(FirstOrder(value, u, tuple(gradient), asymmetry, asymmetry <= _STRAIGHT))
    return found


def combined(inputs: Sequence[Input], gradient: FloatArray | Sequence[float]) -> float:
    """Combine the budgets of all inputs at a known gradient, each source once."""
    totals: dict[str, float] = {}
    for x, slope in zip(inputs, gradient, strict=True):
        for c in x.budget:
            totals[c.source] = totals.get(c.source, 0.0) + slope * c.signed_u
    return math.sqrt(math.fsum(total**2 for total in totals.values()))


def monte_carlo(
    inputs: Sequence[Input], response: Response, draws: int = 20_000, seed: int = 0
) -> MonteCarlo:
    """Draw the inputs from log-normal distributions and look at the distribution of the prediction.

    Log-normal keeps thicknesses and moduli above zero; each source is drawn once for all inputs
    that it enters, from Student's t distribution where its uncertainty was estimated from a few
    specimens: the mean of n has n - 1 degrees of freedom. Draws beyond `ranges.RANGES` count as
    their end.

    Parameters
    ----------
    inputs, response : as for `first_order`
    draws : 100 to 10 million
    seed : same seed, same answer

    Raises
    ------
    FitRefused : fewer than half of the draws have an equilibrium

    Source: JCGM 101:2008, 6.4.9 for the means of few specimens.
    """
    within("draws", draws, 100, 10_000_000)
    found = np.broadcast_to(response(_sample(inputs, draws, seed)), (draws,))
    good = found[np.isfinite(found)]
    lost = 1.0 - good.size / draws
    if lost > 0.5:
        raise FitRefused(
            f"{100 * lost:.0f} % of {draws} draws pull in: "
            "lower the voltage, or know the film better"
        )
    low, median, high = np.quantile(good, (0.025, 0.5, 0.975)).tolist()
    dof = [c.degrees_of_freedom for x in inputs for c in x.budget]
    has_sd = all(found is None or found > _NO_VARIANCE for found in dof)
    sd = float(good.std(ddof=1)) if has_sd else math.nan
    return MonteCarlo(median, sd, (low, high), lost, draws)


def tornado(inputs: Sequence[Input], prediction: FirstOrder, response: Response) -> tuple[Bar, ...]:
    """Move each input by its standard uncertainty alone; the widest bar first.

    Inputs without a declared uncertainty come last, by elasticity: their bars are not short, they
    are unknown.

    Parameters
    ----------
    inputs, prediction, response : from `first_order` of this response at these inputs
    """
    u = np.array([x.u for x in inputs])
    moved = response(_moved(inputs, np.concatenate([-np.diag(u), np.diag(u)])))
    low, high = np.reshape(np.broadcast_to(moved, (2 * len(inputs),)), (2, -1))
    bars = [
        Bar(
            x.name, float(low[i]), float(high[i]), abs(slope) * x.u,
            slope * x.value / prediction.value, x.u > 0,
        )
        for i, (x, slope) in enumerate(zip(inputs, prediction.gradient, strict=True))
    ]  # fmt: skip
    return tuple(sorted(bars, key=lambda b: (b.declared, b.u, abs(b.elasticity)), reverse=True))


def _sample(inputs: Sequence[Input], draws: int, seed: int) -> dict[str, FloatArray]:
    """Draw values by field of a strip, shape (draws,) each."""
    rng = np.random.default_rng(seed)
    drawn: dict[str, FloatArray] = {}
    values: dict[str, FloatArray] = {}
    for x in inputs:
        error = np.zeros(draws)
        for c in x.budget:
            if c.source not in drawn:
                drawn[c.source] = _standard_errors(rng, c.degrees_of_freedom, draws)
            error += c.signed_u * drawn[c.source]
        sigma = math.sqrt(math.log1p((x.u / x.value) ** 2))
        scale = sigma / x.u if x.u else 0.0
        exponent = np.clip(scale * error - 0.5 * sigma**2, -_FARTHEST, _FARTHEST)
        found = x.value * np.exp(exponent)
        values |= {field: _allowed(field, found) for field in x.drives}
    return values


def _standard_errors(
    rng: np.random.Generator, degrees_of_freedom: float | None, draws: int
) -> FloatArray:
    """Draw errors in units of their standard uncertainty, shape (draws,)."""
    if degrees_of_freedom is None:
        return rng.standard_normal(draws)
    return rng.standard_t(degrees_of_freedom, draws)


def _allowed(field: str, values: FloatArray) -> FloatArray:
    """Bring draws of a field of a strip back to the range of its kind."""
    for quantity, allowed in RANGES.items():
        if field.endswith(quantity):
            return np.clip(values, allowed.low, allowed.high)
    return values


def _gradients(
    inputs: Sequence[Input], response: Response, points: int
) -> tuple[FloatArray, FloatArray]:
    """Return values, shape (points,), and central differences, shape (points, inputs)."""
    steps = np.diag([_STEP * x.value for x in inputs])
    zero = np.zeros((1, len(inputs)))
    found = response(_moved(inputs, np.concatenate([zero, steps, -steps])))
    values = np.broadcast_to(found, (points, 2 * len(inputs) + 1))
    if not np.isfinite(values).all():
        raise FitRefused("the film is at pull-in: lower the voltage")
    up, down = np.split(values[:, 1:], 2, axis=1)
    return values[:, 0], (up - down) / (2.0 * np.diagonal(steps))


def _moved(inputs: Sequence[Input], steps: FloatArray) -> dict[str, FloatArray]:
    """Return values by field with steps added, whose last axis counts the inputs."""
    return {field: x.value + steps[..., i] for i, x in enumerate(inputs) for field in x.drives}


def _asymmetries(
    inputs: Sequence[Input],
    gradients: FloatArray,
    us: Sequence[float],
    values: FloatArray,
    response: Response,
) -> list[float]:
    # Along the direction in which the prediction is uncertain, not along each input alone
    own = np.array([x.u for x in inputs])
    directions = np.zeros_like(gradients)
    for i, (gradient, u) in enumerate(zip(gradients, us, strict=True)):
        if u:
            directions[i] = _FAR * gradient * own**2 / np.linalg.norm(gradient * own)
    both = np.stack([directions, -directions], axis=1)
    found = np.broadcast_to(response(_moved(inputs, both)), (len(us), 2))
    skewed = []
    for (up, down), u, value in zip(found, us, values, strict=True):
        if u == 0.0:
            skewed.append(0.0)
        elif np.isfinite(up) and np.isfinite(down):
            skewed.append(float(abs(up + down - 2.0 * value) / abs(up - down)))
        else:
            skewed.append(math.inf)
    return skewed
