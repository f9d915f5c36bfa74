"""What the uncertainties of cards and layers do to a prediction: first order and Monte Carlo.

Inputs that rest on one calibration or one fit move together: contributions of the same source are
one error, whichever inputs it enters. What is shared by all specimens never averages away.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from deamat.actuator.ranges import Reals, within
from deamat.actuator.strip import Floats
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution

# From values by field of a `strip.Strip` (arrays of one shape) to the prediction, NaN where there
# is none because the film pulls in.
Response: TypeAlias = Callable[[Mapping[str, Floats]], Reals]

_STEP = 1e-5  # relative; central differences are then good to about 1e-9
_FAR = 2.0  # standard uncertainties: where the linear answer is held against the model
_STRAIGHT = 0.15  # asymmetry there, up to which both methods were found to agree within 5 %


@dataclass(frozen=True, slots=True)
class Input:
    """One uncertain number of a design.

    Parameters
    ----------
    name : `compressive_modulus of sylgard-182-30to1`
    drives : fields of a `strip.Strip` that it sets: the modulus of a material used twice sets two
    value, unit : in SI, above zero
    budget : standard uncertainties; one source is one error, in whichever inputs it stands;
        those that are not shared shrink with the number of specimens
    test : what measures it (`compression of sylgard-182-30to1`), None for a declared one
    n : specimens behind it, 0 for a declared one
    """

    name: str
    drives: tuple[str, ...]
    value: float
    unit: str
    budget: tuple[Contribution, ...]
    test: str | None = None
    n: int = 0

    @property
    def u(self) -> float:
        """Combined standard uncertainty `[unit]`."""
        return math.sqrt(sum(c.u**2 for c in self.budget))

    def after(self, further: int) -> Input:
        """Give the input as `further` specimens would leave it: independent parts shrink."""
        factor = math.sqrt(self.n / (self.n + further)) if self.n else 1.0
        budget = (c if c.shared else replace(c, u=c.u * factor) for c in self.budget)
        return replace(self, budget=tuple(budget), n=self.n + further if self.n else 0)


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
    mean, sd : over the draws that have an equilibrium
    interval95 : 2.5 and 97.5 % quantiles of those
    pull_in_probability : part of the draws whose film pulls in `[1]`
    draws : how many
    """

    mean: float
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
    u : part of the standard uncertainty that it brings alone, to first order
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
    value, gradient = _gradient(inputs, response)
    u = combined(inputs, gradient)
    asymmetry = _asymmetry(inputs, gradient, u, value, response)
    return FirstOrder(value, u, tuple(gradient.tolist()), asymmetry, asymmetry <= _STRAIGHT)


def combined(inputs: Sequence[Input], gradient: Floats | Sequence[float]) -> float:
    """Combine the budgets of all inputs at a known gradient, each source once."""
    totals: dict[str, float] = {}
    for x, slope in zip(inputs, gradient, strict=True):
        for c in x.budget:
            totals[c.source] = totals.get(c.source, 0.0) + slope * c.u
    return math.sqrt(sum(total**2 for total in totals.values()))


def monte_carlo(
    inputs: Sequence[Input], response: Response, draws: int = 20_000, seed: int = 0
) -> MonteCarlo:
    """Draw the inputs from log-normal distributions with their values and uncertainties.

    Log-normal keeps thicknesses and moduli above zero; each source is drawn once for all inputs
    that it enters.

    Parameters
    ----------
    inputs, response : as for `first_order`
    draws : 100 to 10 million
    seed : same seed, same answer

    Raises
    ------
    FitRefused : fewer than half of the draws have an equilibrium

    Source: JCGM 101:2008.
    """
    within("draws", draws, 100, 10_000_000)
    found = np.broadcast_to(response(sample(inputs, draws, seed)), (draws,))
    good = found[np.isfinite(found)]
    lost = 1.0 - good.size / draws
    if lost > 0.5:
        raise FitRefused(
            f"{100 * lost:.0f} % of {draws} draws pull in: "
            "lower the voltage, or know the film better"
        )
    low, high = np.quantile(good, (0.025, 0.975))
    return MonteCarlo(
        float(good.mean()), float(good.std(ddof=1)), (float(low), float(high)), lost, draws
    )


def sample(inputs: Sequence[Input], draws: int, seed: int) -> dict[str, Floats]:
    """Draw values by field of a strip, shape (draws,) each; see `monte_carlo`."""
    rng = np.random.default_rng(seed)
    drawn: dict[str, Floats] = {}
    values: dict[str, Floats] = {}
    for x in inputs:
        error = np.zeros(draws)
        for c in x.budget:
            if c.source not in drawn:
                drawn[c.source] = rng.standard_normal(draws)
            error += c.u * drawn[c.source]
        sigma = math.sqrt(math.log1p((x.u / x.value) ** 2))
        scale = sigma / x.u if x.u else 0.0
        values |= dict.fromkeys(x.drives, x.value * np.exp(scale * error - 0.5 * sigma**2))
    return values


def tornado(inputs: Sequence[Input], response: Response) -> tuple[Bar, ...]:
    """Move each input by its standard uncertainty alone; the widest bar first.

    Inputs without a declared uncertainty come last, by elasticity: their bars are not short, they
    are unknown.
    """
    value, gradient = _gradient(inputs, response)
    u = np.array([x.u for x in inputs])
    moved = response(_moved(inputs, np.concatenate([-np.diag(u), np.diag(u)])))
    low, high = np.reshape(np.broadcast_to(moved, (2 * len(inputs),)), (2, -1))
    bars = [
        Bar(
            x.name, float(low[i]), float(high[i]), abs(float(gradient[i])) * x.u,
            float(gradient[i]) * x.value / value, x.u > 0,
        )
        for i, x in enumerate(inputs)
    ]  # fmt: skip
    return tuple(sorted(bars, key=lambda b: (b.declared, b.u, abs(b.elasticity)), reverse=True))


def _gradient(inputs: Sequence[Input], response: Response) -> tuple[float, Floats]:
    steps = np.diag([_STEP * x.value for x in inputs])
    zero = np.zeros((1, len(inputs)))
    found = response(_moved(inputs, np.concatenate([zero, steps, -steps])))
    values = np.broadcast_to(found, (2 * len(inputs) + 1,))
    if not np.isfinite(values).all():
        raise FitRefused("the film is at pull-in: lower the voltage")
    up, down = values[1:].reshape(2, -1)
    return float(values[0]), (up - down) / (2.0 * np.diagonal(steps))


def _moved(inputs: Sequence[Input], steps: Floats) -> dict[str, Floats]:
    """Give values by field, with each row of `steps`, shape (m, inputs), added."""
    return {field: x.value + steps[:, i] for i, x in enumerate(inputs) for field in x.drives}


def _asymmetry(
    inputs: Sequence[Input], gradient: Floats, u: float, value: float, response: Response
) -> float:
    # Along the direction in which the prediction is uncertain, not along each input alone
    if u == 0.0:
        return 0.0
    own = np.array([x.u for x in inputs])
    direction = _FAR * gradient * own**2 / np.linalg.norm(gradient * own)
    up, down = np.broadcast_to(response(_moved(inputs, np.array([direction, -direction]))), (2,))
    if not (np.isfinite(up) and np.isfinite(down)):
        return math.inf
    return float(abs(up + down - 2.0 * value) / abs(up - down))
