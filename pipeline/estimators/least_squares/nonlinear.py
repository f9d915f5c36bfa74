"""Bounded weighted nonlinear least squares that proves its minimum or refuses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.checks import (
    ErrorScale,
    degrees_of_freedom,
    error_sizes,
    finite_array,
    same_length,
)
from deamat.estimators.least_squares.fit import Fit, error_variance, weighted_residual_sd
from deamat.estimators.least_squares.gauss_newton import Minimum, Problem, descend, polish, walk

# A second start confirms the first if its curve lies within this fraction of the residuals: another
# minimum that near would give the same answer.
_SAME = 1e-2
_START_SHIFTS = (0.2, 0.5, 1.0, 0.05)
_MOST_RESTARTS = 5
_MOST_EVALUATIONS = 4000
_CONFIRMING_EVALUATIONS = 500


@dataclass(frozen=True, slots=True, kw_only=True)
class NonlinearFit(Fit):
    """Parameters b of y = f(b) at a proven local minimum reached from two starts.

    Parameters
    ----------
    parameters : b, shape (p,)
    covariance : by linearisation at b, from the QR of the weighted Jacobian, shape (p, p)
    gradient : length of the weighted residuals' projection on the tangent space over that of the
        residuals: 0 at a minimum
    curvature : smallest eigenvalue of the Hessian in the metric of J^T J: 1 for a linear model,
        0 where the minimum stops being one
    returned, elsewhere : further searches that ended on the same curve, and at another, higher
        minimum; with `elsewhere` above 0 the model has several, and only starting values that
        mean something make this the right one
    """

    parameters: FloatArray
    covariance: FloatArray
    gradient: float
    curvature: float
    returned: int
    elsewhere: int

    @property
    def standard_errors(self) -> FloatArray:
        """Square roots of the diagonal of the covariance, shape (p,)."""
        return np.sqrt(np.diag(self.covariance))


def fit_nonlinear(
    model: Callable[[FloatArray], FloatArray],
    jacobian: Callable[[FloatArray], FloatArray],
    start: ArrayLike,
    y: ArrayLike,
    sigma: ArrayLike | None = None,
    error_scale: ErrorScale = "estimated",
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
    second_start: ArrayLike | None = None,
    confirmations: int = len(_START_SHIFTS),
) -> NonlinearFit:
    r"""Minimise $\sum_i ((y_i - f_i(b)) / \sigma_i)^2$ over lower < b < upper.

    A trust-region search goes from the start to a minimum and Newton steps finish it; gradient,
    rank, curvature and the Jacobian itself are checked there. Then more searches start around it,
    each parameter up or down by factors from 1.05 to 2.7: one at least must come back, and a lower
    minimum takes its place and is confirmed in turn. That proves a local minimum and looks for a
    lower one around it; no search proves that there is none far away.

    Parameters
    ----------
    model : f, parameters of shape (p,) to predictions of shape (n,) `[unit of y]`
    jacobian : exact derivatives df/db, shape (p,) to shape (n, p)
    start : shape (p,), inside the bounds
    y, sigma, error_scale : as in `fit_linear`
    lower, upper : bounds, shape (p,) each; unbounded if not given
    second_start : a start of the caller's own for one more search, shape (p,)
    confirmations : searches that come back, with none that ends elsewhere, after which no more
        are made; all of them unless the model is known to have one minimum

    Raises
    ------
    FitRefused : a search that does not converge, a Jacobian that is not finite, rank-deficient
        (scaled condition above 1e10) or not the derivative of the model, a point that is no
        minimum, a minimum on a bound (standard errors by linearisation do not hold there), or one
        that no other start confirms

    Source: M. A. Branch et al., SIAM J. Sci. Comput. 21 (1999) 1 (search); D. M. Bates, D. G.
    Watts, Nonlinear Regression Analysis (Wiley 1988), 2.2.3 (relative offset) and 7.2 (curvature).
    """
    values, first = finite_array("y", y), finite_array("start", start)
    n, p = len(values), len(first)
    sizes = error_sizes(sigma, n, error_scale)
    dof = degrees_of_freedom(n, p, error_scale)
    problem = Problem(
        model, jacobian, values, sizes, _bound(lower, p, -np.inf), _bound(upper, p, np.inf)
    )
    other = None if second_start is None else finite_array("second_start", second_start)
    if other is not None:
        same_length("second_start", other, p, "parameters")
    with np.errstate(all="ignore"):  # a search tries what it then turns away from
        best = _first_minimum(problem, first)
        best, returned, elsewhere = _confirmed(problem, best, other, confirmations)
    residual_sd = weighted_residual_sd(best.residuals, dof)
    return NonlinearFit(
        parameters=best.parameters,
        covariance=error_variance(residual_sd, error_scale) * (best.r_inverse @ best.r_inverse.T),
        gradient=best.gradient,
        curvature=best.curvature,
        returned=returned,
        elsewhere=elsewhere,
        y=values,
        sigma=sizes,
        residuals=best.residuals * sizes,
        leverages=np.einsum("ij,ij->i", best.q, best.q),
        residual_sd=residual_sd,
        dof=dof,
        condition_number=best.condition_number,
        error_scale=error_scale,
    )


def _bound(bound: ArrayLike | None, p: int, default: float) -> FloatArray:
    """Take a bound of shape (p,), infinite where there is none."""
    if bound is None:
        return np.full(p, default)
    values = np.asarray(bound, dtype=np.float64)
    if np.isnan(values).any():
        raise FitRefused("a bound must be a number or infinite, not nan")
    same_length("a bound", values, p, "parameters")
    return values


def _first_minimum(problem: Problem, start: FloatArray) -> Minimum:
    """Go the short way where it leads to a minimum, else search."""
    near = walk(problem, start)
    if near is not None:
        try:
            return polish(problem, near[0])
        except FitRefused:
            pass  # the search says what is wrong, if it ends there too
    return polish(problem, descend(problem, start, _MOST_EVALUATIONS))


def _confirmed(
    problem: Problem, best: Minimum, second: FloatArray | None, enough: int
) -> tuple[Minimum, int, int]:
    """Search from all over, move to what is lower, and count what came back or went elsewhere."""
    given = [] if second is None else [second]
    for _ in range(_MOST_RESTARTS):
        held, returned, elsewhere = best, 0, 0
        for start in [*given, *_beside(problem, held)]:
            try:
                found = _other_minimum(problem, start, held)
            except FitRefused:
                continue  # where this start ends says nothing of the minimum in hand
            if found is None:
                returned += 1
                if returned >= enough and not elsewhere:
                    break
                continue
            elsewhere += 1
            if found.cost < best.cost:
                best = found
        if best is held:
            if returned:
                return best, returned, elsewhere
            break
    raise FitRefused(
        "no second start came back to the minimum found; give starting values nearer to it, or a "
        "model whose parameters the data determine",
        {"cost": best.cost, "gradient": best.gradient, "curvature": best.curvature},
    )


def _beside(problem: Problem, minimum: Minimum) -> list[FloatArray]:
    """Points around a minimum: each factor up for some parameters and down for the others."""
    index = np.arange(len(minimum.parameters))
    starts = []
    for k, shift in enumerate(_START_SHIFTS):
        up = np.where(((index >> k) + k) % 2 == 0, 1.0, -1.0)
        starts.append(problem.inside(minimum.parameters * np.exp(shift * up)))
    return starts


def _other_minimum(problem: Problem, start: FloatArray, held: Minimum) -> Minimum | None:
    """Search from a start: another minimum, or None if it comes back to the curve in hand."""

    def back(residuals: FloatArray) -> bool:
        return _same_curve(held, residuals)

    near = walk(problem, start, back)
    if near is None:
        end = descend(problem, start, _CONFIRMING_EVALUATIONS)
        near = end, problem.residuals(end)
    if back(near[1]):
        return None  # the minimum there is proved already
    found = polish(problem, near[0])
    return None if back(found.residuals) else found


def _same_curve(held: Minimum, residuals: FloatArray) -> bool:
    """Whether residuals are those of the minimum in hand, whatever the parameters are called."""
    noise = np.sqrt(min(2.0 * held.cost, float(residuals @ residuals)))
    return bool(np.linalg.norm(held.residuals - residuals) <= _SAME * noise + held.rounding)
