"""Which of several laws to use: the cheapest that the data support, or that answers well enough.

`choose` asks the data: the cheapest law that no costlier one clearly beats. `choose_for` asks a
question as well: of the laws up to that one, the cheapest whose expected error is tolerable.
`averaged` answers with all laws that the data do not tell apart: its interval holds although a law
was chosen.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.least_squares.fit import Fit

# A costlier law must lower AICc by more than this against a cheaper one: the data must support it
# exp(6 / 2) = 20 times better. Of straight lines of 8 to 720 points, with orders up to 5 on offer,
# 0.3 to 1.6 % are then given a higher order (1 to 10 % with the customary 2).
DECISIVE = 6.0
NORMAL = 1.959963984540054  # half width of a 95 % interval in standard deviations
_EPSILON = float(np.finfo(np.float64).eps)

AnyFit = TypeVar("AnyFit", bound=Fit)


@dataclass(frozen=True, slots=True)
class Tried:
    """One candidate and its scores.

    Parameters
    ----------
    name : as the caller gave it
    parameter_count, aicc, leave_one_out_sd : None where there is no fit or no score
    refusal : why not, else empty
    """

    name: str
    parameter_count: int | None
    aicc: float | None
    leave_one_out_sd: float | None
    refusal: str = ""


@dataclass(frozen=True, slots=True)
class Choice(Generic[AnyFit]):
    """The fit to use, everything that was tried, in the order given, and why.

    Parameters
    ----------
    name, fit : the candidate chosen
    tried : all candidates
    reason : one sentence with the numbers that decided
    scored : name and fit of every candidate that has a score, the cheapest first
    """

    name: str
    fit: AnyFit
    tried: tuple[Tried, ...]
    reason: str
    scored: tuple[tuple[str, AnyFit], ...] = ()


def aicc(fit: Fit) -> float:
    r"""Akaike's information criterion with its small-sample term, less what is common to all.

    For a known error scale $\chi^2 + 2 p$, which needs no correction; for an estimated one
    $n \ln(\chi^2 / n) + 2 K + 2 K (K + 1) / (n - K - 1)$ with K = p + 1 parameters, the error
    scale among them. Squares below the rounding of the data count as that rounding.

    Raises
    ------
    FitRefused : n - K - 1 is not positive

    Source: C. M. Hurvich, C.-L. Tsai, Biometrika 76 (1989) 297.
    """
    n, p = len(fit.y), fit.parameter_count
    squares = math.fsum(np.square(fit.weighted_residuals))
    if fit.error_scale == "known":
        return squares + 2.0 * p
    k = p + 1
    if n - k - 1 <= 0:
        raise FitRefused(
            f"AICc of {p} parameters and an error scale needs at least {p + 3} points, not {n}",
            {"points": n, "parameters": p},
        )
    rounding = math.fsum(np.square(_EPSILON * fit.y / fit.sigma))
    if max(squares, rounding) == 0:
        raise FitRefused("data that are all zero say nothing about a law")
    return n * math.log(max(squares, rounding) / n) + 2.0 * k + 2.0 * k * (k + 1) / (n - k - 1)


def leave_one_out_sd(fit: Fit) -> float:
    r"""Root mean square error of predicting each point from all the others.

    $\sqrt{\frac1n \sum_i (r_i / (\sigma_i (1 - h_i)))^2}$ with the leverages h: exact for linear
    models, by linearisation for nonlinear ones. `[unit of y]`, or `[1]` where sigma was given.

    Raises
    ------
    FitRefused : a point that alone determines a parameter (leverage 1)

    Source: D. M. Allen, Technometrics 16 (1974) 125.
    """
    free = 1.0 - fit.leverages
    if np.any(free < 1e-10):
        point = int(np.argmin(free))
        raise FitRefused(
            f"point {point} alone determines a parameter: the others cannot predict it",
            {"point": point, "leverage": float(fit.leverages[point])},
        )
    return math.sqrt(math.fsum(np.square(fit.weighted_residuals / free)) / len(free))


def choose(candidates: Sequence[tuple[str, Callable[[], AnyFit]]]) -> Choice[AnyFit]:
    """Fit all candidates and take the first whose AICc is within `DECISIVE` of the lowest.

    A candidate that refuses, or that has too few points for a score, is recorded and passed over.

    Parameters
    ----------
    candidates : name and fit of each law, the cheapest first

    Raises
    ------
    FitRefused : no candidate gave a score, or they differ in points, weights or error scale
    """
    fits: list[AnyFit | None] = []
    tried: list[Tried] = []
    for name, make in candidates:
        try:
            fit = make()
            score = aicc(fit)
        except FitRefused as refusal:
            fits.append(None)
            tried.append(Tried(name, None, None, None, refusal.reason))
            continue
        fits.append(fit)
        tried.append(Tried(name, fit.parameter_count, score, _predicted(fit)))
    scored = [
        (t.aicc, t.name, f)
        for t, f in zip(tried, fits, strict=True)
        if t.aicc is not None and f is not None
    ]
    if not scored:
        told = "; ".join(f"{t.name}: {t.refusal}" for t in tried) or "there are none"
        raise FitRefused(f"no candidate law could be fitted: {told}")
    _comparable([fit for _, _, fit in scored])
    lowest = min(score for score, _, _ in scored)
    index = next(i for i, (score, _, _) in enumerate(scored) if score <= lowest + DECISIVE)
    _, name, fit = scored[index]
    return Choice(
        name,
        fit,
        tuple(tried),
        _reason([(s, n) for s, n, _ in scored], index),
        tuple((n, f) for _, n, f in scored),
    )


def akaike_weights(fits: Sequence[Fit], handicaps: ArrayLike) -> FloatArray:
    r"""Say how well the data support each law, shape (k,); the sum is 1.

    $w_k \propto \exp(-(n \ln \chi_k^2 + 2 p_k + h_k) / 2)$. Without the small-sample term of
    `aicc`: that favours stiff laws, whose bias no interval of theirs shows.

    Parameters
    ----------
    fits : of the same data with the same errors and an estimated error scale
    handicaps : h, shape (k,): 0, or what a law must be better supported by

    Raises
    ------
    FitRefused : no fits, or of different data

    Source: K. P. Burnham, D. R. Anderson, Model Selection and Multimodel Inference (Springer
    2002), 2.9.
    """
    if not fits:
        raise FitRefused("there is no law to weigh")
    _comparable(fits)
    n = len(fits[0].y)
    rounding = math.fsum(np.square(_EPSILON * fits[0].y / fits[0].sigma))
    squares = [max(math.fsum(np.square(f.weighted_residuals)), rounding) for f in fits]
    if min(squares) == 0:
        raise FitRefused("data that are all zero say nothing about a law")
    counts = np.array([float(f.parameter_count) for f in fits])
    score = n * np.log(np.array(squares)) + 2.0 * counts + np.asarray(handicaps, dtype=np.float64)
    weights = np.exp(-0.5 * (score - score.min()))
    return np.asarray(weights / weights.sum())


def averaged(
    values: ArrayLike,
    u: ArrayLike,
    dof: ArrayLike,
    weights: ArrayLike,
    about: float | None = None,
) -> tuple[float, float]:
    r"""Average the answers of laws that the data do not tell apart.

    $$ v = \sum_k w_k v_k, \qquad u^2 = \sum_k w_k \left(u_k^2 \left(\frac{t_{0.975}(\nu_k)}
    {1.96}\right)^2 + (v_k - v)^2\right) $$

    so that $v \pm 1.96\,u$ holds in 95 %.

    Parameters
    ----------
    values, u, dof : answers, their standard uncertainties and degrees of freedom, shape (k,)
    weights : shape (k,); need not sum to 1
    about : an answer to give in place of v, with the uncertainty that it then has

    Returns
    -------
    v, u

    Source: K. P. Burnham, D. R. Anderson, Model Selection and Multimodel Inference (Springer
    2002), 4.3.2 and 6.12; D. Fletcher, Model Averaging (Springer 2018), 3.2.
    """
    v, own, freedom, w = (np.asarray(a, dtype=np.float64) for a in (values, u, dof, weights))
    w = w / w.sum()
    middle = float(w @ v) if about is None else about
    wide = own * stdtrit(np.minimum(freedom, 1e6), 0.975) / NORMAL
    return middle, math.sqrt(float(w @ (np.square(wide) + np.square(v - middle))))


def _predicted(fit: Fit) -> float | None:
    """Leave-one-out error, where every point can be predicted from the others."""
    try:
        return leave_one_out_sd(fit)
    except FitRefused:
        return None


def _comparable(fits: Sequence[Fit]) -> None:
    """Refuse to hold scores of different data against each other."""
    first = fits[0]
    for fit in fits[1:]:
        if (
            fit.error_scale != first.error_scale
            or not np.array_equal(fit.y, first.y)
            or not np.array_equal(fit.sigma, first.sigma)
        ):
            raise FitRefused("candidate laws must be fitted to the same data with the same errors")


def _reason(scored: Sequence[tuple[float, str]], index: int) -> str:
    """Say which scores decided."""
    score, name = scored[index]
    lowest, best = min(scored)
    if score == lowest:
        told = f"{name}: AICc {score:.1f} is the lowest"
    else:
        told = (
            f"{name}: AICc {score:.1f} is within {DECISIVE:g} of the lowest, {lowest:.1f} of {best}"
        )
    if index == 0:
        return f"{told}; nothing cheaper was fitted"
    runner_score, runner = min(scored[:index])
    return f"{told}; the best cheaper law, {runner}, has {runner_score:.1f}"


@dataclass(frozen=True, slots=True)
class Answered:
    """One candidate's answer to the question.

    Parameters
    ----------
    name, cost : as the caller gave them
    value : its answer; None where it has none
    error : root of expected squared error: its own uncertainty and its bias `[unit of value]`
    refusal : why there is no answer, else empty
    """

    name: str
    cost: float
    value: float | None
    error: float | None
    refusal: str = ""


@dataclass(frozen=True, slots=True)
class Enough(Generic[AnyFit]):
    """The cheapest law that is good enough for a question.

    Parameters
    ----------
    name, fit, value, error : the law chosen, its answer and expected error
    tried : all candidates, in the order given
    supported : what the data alone say, as `choose` gives it
    finer, change : the next law that answered, and by how much it answers higher; no law and 0
        where there is none
    reason : one sentence with the numbers that decided
    """

    name: str
    fit: AnyFit
    value: float
    error: float
    tried: tuple[Answered, ...]
    supported: Choice[AnyFit]
    finer: str
    change: float
    reason: str


def choose_for(
    candidates: Sequence[tuple[str, float, Callable[[], AnyFit]]],
    question: Callable[[AnyFit], tuple[float, float]],
    tolerance: float,
) -> Enough[AnyFit]:
    r"""Take the cheapest law whose expected error on the question is within the tolerance.

    With the answer $v_s \pm u_s$ of the law that the data support (`choose`), a cheaper one of
    answer $v \pm u$ has the expected squared error

    $$ u^2 + \max\big((v - v_s)^2 - \max(u_s^2 - u^2, 0),\ 0\big) : $$

    part of the difference between nested laws is the noise that only the richer one carries. Laws
    costlier than the supported one are recorded and never taken: the data do not ask for them.

    Parameters
    ----------
    candidates : name, cost (in any unit; parameters, or seconds) and fit, the cheapest first
    question : a fit to its answer and the standard uncertainty of that
    tolerance : largest expected error that will do `[unit of the answer]`

    Raises
    ------
    FitRefused : costs that fall, a tolerance that is not positive, as in `choose`, or no law
        within the tolerance
    """
    costs = [cost for _, cost, _ in candidates]
    if any(b < a for a, b in pairwise(costs)):
        raise FitRefused(f"candidate laws must come with the cheapest first, not at costs {costs}")
    if not tolerance > 0.0:
        raise FitRefused(f"a tolerance must be positive, not {tolerance:g}")
    fits = [(name, _once(make)) for name, _, make in candidates]
    supported = choose(fits)
    best = [name for name, _ in fits].index(supported.name)
    v_s, u_s = question(supported.fit)
    answered: list[tuple[Answered, AnyFit | None]] = []
    for (name, make), cost in zip(fits, costs, strict=True):
        try:
            fit = make()
            v, u = question(fit)
        except (FitRefused, OutOfRange) as refusal:
            answered.append((Answered(name, cost, None, None, str(refusal)), None))
            continue
        bias2 = max((v - v_s) ** 2 - max(u_s**2 - u**2, 0.0), 0.0)
        answered.append((Answered(name, cost, v, math.sqrt(u**2 + bias2)), fit))
    for i, (answer, fitted) in enumerate(answered[: best + 1]):
        v_i, error = answer.value, answer.error
        if fitted is None or v_i is None or error is None or not error <= tolerance:
            continue
        finer = next((a for a, _ in answered[i + 1 :] if a.value is not None), None)
        change = 0.0 if finer is None or finer.value is None else finer.value - v_i
        told = "no finer law" if finer is None else f"{finer.name} would change it by {change:.3g}"
        return Enough(
            answer.name,
            fitted,
            v_i,
            error,
            tuple(a for a, _ in answered),
            supported,
            "" if finer is None else finer.name,
            change,
            f"{answer.name}: expected error {error:.3g}, within {tolerance:.3g}; {told}",
        )
    least = min(a.error for a, _ in answered[: best + 1] if a.error is not None)
    raise FitRefused(
        f"no law that the data support answers within {tolerance:.3g}: the least expected error is "
        f"{least:.3g}; measure more points, or ask for less",
        {"least_error": least, "tolerance": tolerance},
    )


def _once(make: Callable[[], AnyFit]) -> Callable[[], AnyFit]:
    """Fit at most once, whoever asks; a refusal is not kept, for it is cheap."""
    kept: list[AnyFit] = []

    def fit() -> AnyFit:
        if not kept:
            kept.append(make())
        return kept[0]

    return fit
