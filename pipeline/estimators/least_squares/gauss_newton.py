"""Search for, finish and check a minimum of weighted nonlinear least squares."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.checks import scaled_condition

# Of the weighted Jacobian with its columns scaled to equal length: float arithmetic then still
# leaves 6 digits in the parameters.
CONDITION_LIMIT = 1e10
GRADIENT_LIMIT = 1e-6
_JACOBIAN_LIMIT = 0.01
_TOLERANCE = 1e-15
_MOST_STEPS = 30
# Plain steps, or these parts of them, must lower the squares by this fraction of what the tangent
# promises; where the gradient is this fraction of the residuals, Newton steps take over.
_KEPT = 0.5
_PARTS = (1.0, 0.5, 0.25, 0.125, 0.0625)
_NEAR = 1e-7
_PLAIN_STEPS = 12
_EPSILON = float(np.finfo(np.float64).eps)


@dataclass(frozen=True, slots=True)
class Problem:
    """A model with its exact Jacobian, data and bounds; shapes as in `fit_nonlinear`.

    A search may try parameters where the model overflows: the caller mutes numpy's warnings.
    """

    model: Callable[[FloatArray], FloatArray]
    jacobian: Callable[[FloatArray], FloatArray]
    y: FloatArray
    sigma: FloatArray
    lower: FloatArray
    upper: FloatArray

    def residuals(self, b: FloatArray) -> FloatArray:
        """Weighted residuals (y - f(b)) / sigma, shape (n,); infinite where f has no value."""
        predicted = np.asarray(self.model(b), dtype=np.float64)
        if predicted.shape != self.y.shape:
            raise FitRefused(f"the model gives shape {predicted.shape} for {len(self.y)} points")
        return (self.y - predicted) / self.sigma

    def weighted_jacobian(self, b: FloatArray) -> FloatArray:
        """J / sigma, shape (n, p), finite."""
        weighted = self.any_jacobian(b)
        if not np.isfinite(weighted).all():
            raise FitRefused(f"the Jacobian is not finite at {_told(b)}")
        return weighted

    def any_jacobian(self, b: FloatArray) -> FloatArray:
        """J / sigma, shape (n, p), finite or not."""
        derivatives = np.asarray(self.jacobian(b), dtype=np.float64)
        if derivatives.shape != (len(self.y), len(b)):
            raise FitRefused(
                f"the Jacobian has shape {derivatives.shape}, not ({len(self.y)}, {len(b)})"
            )
        return derivatives / self.sigma[:, None]

    def holds(self, b: FloatArray) -> bool:
        """Whether a point lies between the bounds."""
        return bool((self.lower < b).all() and (b < self.upper).all())

    def inside(self, b: FloatArray) -> FloatArray:
        """Bring a point into the bounds, a little off them, as a search must start."""
        width = self.upper - self.lower
        room = np.where(np.isfinite(width), 1e-3 * width, 1e-3 * (1e-3 + np.abs(b)))
        return np.clip(b, self.lower + room, self.upper - room)


@dataclass(frozen=True, slots=True)
class Minimum:
    """A checked minimum: weighted residuals, J = Q R there, and what was measured."""

    parameters: FloatArray
    residuals: FloatArray
    q: FloatArray
    r: FloatArray
    r_inverse: FloatArray
    condition_number: float
    gradient: float
    curvature: float
    rounding: float

    @property
    def cost(self) -> float:
        """Half the weighted sum of squares."""
        return 0.5 * float(self.residuals @ self.residuals)


def descend(problem: Problem, start: FloatArray, evaluations: int) -> FloatArray:
    """Search by trust-region reflective steps, scaled by the Jacobian; shape (p,).

    Raises
    ------
    FitRefused : a start outside the bounds or without finite values, no convergence, or a minimum
        on a bound
    """
    from scipy.optimize import least_squares

    if not problem.holds(start):
        raise FitRefused(f"the start {_told(start)} does not lie inside the bounds")
    if not np.isfinite(problem.residuals(start)).all():
        raise FitRefused(f"the model is not finite at the start {_told(start)}")

    def excess(b: FloatArray) -> FloatArray:
        return -problem.residuals(b)

    found = least_squares(
        excess,
        start,
        problem.weighted_jacobian,
        bounds=(problem.lower, problem.upper),
        method="trf",
        x_scale="jac",
        ftol=_TOLERANCE,
        xtol=_TOLERANCE,
        gtol=_TOLERANCE,
        max_nfev=evaluations,
    )
    if found.status <= 0:
        raise FitRefused(
            f"the search from {_told(start)} did not converge in {evaluations} evaluations"
        )
    if np.any(found.active_mask != 0):
        which = int(np.flatnonzero(found.active_mask)[0])
        raise FitRefused(
            f"parameter {which} ended on its bound {found.x[which]:g}, where no standard error "
            "holds; widen the bound or take a model without this parameter",
            {"parameter": which, "bound": float(found.x[which])},
        )
    return np.asarray(found.x, dtype=np.float64)


def walk(
    problem: Problem, start: FloatArray, arrived: Callable[[FloatArray], bool] = lambda _: False
) -> tuple[FloatArray, FloatArray] | None:
    """Go by Gauss-Newton steps where the model is near its tangent.

    Normal equations will do for a search: they are a tenth of the time of `descend`. Where halved
    steps do not keep what the tangent promises, or leave the bounds, it gives None.

    Parameters
    ----------
    arrived : residuals to whether there is no need to go on, shape (n,) to bool

    Returns
    -------
    parameters, shape (p,), and residuals there, shape (n,)
    """
    b, residuals = start, problem.residuals(start)
    if not (problem.holds(start) and np.isfinite(residuals).all()):
        return None
    floor = (_EPSILON * float(np.linalg.norm(problem.y / problem.sigma))) ** 2
    for _ in range(_PLAIN_STEPS):
        if arrived(residuals):
            return b, residuals
        try:
            step, promised = _tangent_step(problem.any_jacobian(b), residuals)
        except np.linalg.LinAlgError:
            return None
        if not promised >= 0.0:
            return None
        if promised <= _NEAR**2 * float(residuals @ residuals) + floor:
            return b, residuals
        moved = _kept_step(problem, b, residuals, step, promised)
        if moved is None:
            return None
        b, residuals = moved
    return None


def _tangent_step(jacobian: FloatArray, residuals: FloatArray) -> tuple[FloatArray, float]:
    """Return the step to the lowest point of the tangent, and the fall of the squares there."""
    normal = jacobian.T @ jacobian
    lengths = np.sqrt(normal.diagonal())
    scaled = normal / lengths / lengths[:, None]
    if not np.isfinite(scaled).all():
        raise np.linalg.LinAlgError("columns of no length, or of too much")
    gradient = jacobian.T @ residuals / lengths
    step = np.linalg.solve(scaled, gradient)
    return step / lengths, float(gradient @ step)


def _kept_step(
    problem: Problem, b: FloatArray, residuals: FloatArray, step: FloatArray, promised: float
) -> tuple[FloatArray, FloatArray] | None:
    """Take the longest of the halved steps that keeps its promise, with the residuals there."""
    squares = float(residuals @ residuals)
    for part in _PARTS:
        moved = b + part * step
        if not problem.holds(moved):
            continue
        beyond = problem.residuals(moved)
        fall = squares - float(beyond @ beyond)
        if fall >= _KEPT * part * (2.0 - part) * promised:
            return moved, beyond
    return None


def polish(problem: Problem, b: FloatArray) -> Minimum:
    """Finish by Newton steps in the metric of the Jacobian, and check what stands there.

    With J = Q R and the Hessian R^T H R, the step is R^-1 H^-1 Q^T r.

    Raises
    ------
    FitRefused : rank-deficient Jacobian, a gradient that does not vanish, or no minimum
    """
    q, r = np.linalg.qr(problem.weighted_jacobian(b))
    _condition(b, r)
    hessian = _hessian(problem, b, r)
    curvature = float(np.linalg.eigvalsh(hessian)[0])
    if not curvature > 0:
        raise FitRefused(
            f"the point {_told(b)} is no minimum: curvature {curvature:.2g} in one direction",
            {"curvature": curvature},
        )
    residuals = problem.residuals(b)
    slope = q.T @ residuals
    # A residual is not known better than the floats that it is the difference of.
    floor = _EPSILON * float(np.linalg.norm(problem.y / problem.sigma))
    for _ in range(_MOST_STEPS):
        if float(np.linalg.norm(slope)) <= floor:
            break
        moved = b + np.linalg.solve(r, np.linalg.solve(hessian, slope))
        if not problem.holds(moved):
            break
        try:
            moved_q, moved_r = np.linalg.qr(problem.weighted_jacobian(moved))
        except FitRefused:
            break
        moved_residuals = problem.residuals(moved)
        moved_slope = moved_q.T @ moved_residuals
        if not np.linalg.norm(moved_slope) < np.linalg.norm(slope):
            break
        b, q, r = moved, moved_q, moved_r
        residuals, slope = moved_residuals, moved_slope
    rounding = 64.0 * floor
    size = float(np.linalg.norm(residuals))
    steepness = float(np.linalg.norm(slope))
    if steepness > GRADIENT_LIMIT * size + rounding:
        raise FitRefused(
            f"the search ended where the gradient does not vanish: {steepness / size:.1e} of the "
            f"residuals, at most {GRADIENT_LIMIT:.0e} is accepted",
            {"gradient": steepness / size},
        )
    return Minimum(
        parameters=b,
        residuals=residuals,
        q=q,
        r=r,
        r_inverse=np.asarray(np.linalg.solve(r, np.eye(len(b)))),
        condition_number=_condition(b, r),
        gradient=steepness / size if size > 0 else 0.0,
        curvature=curvature,
        rounding=rounding,
    )


def _condition(b: FloatArray, r: FloatArray) -> float:
    """Scaled condition number of the weighted Jacobian at b, refused beyond the limit."""
    lengths = np.square(r).sum(axis=0)
    if not np.all(lengths > 0):
        which = int(np.flatnonzero(~(lengths > 0))[0])
        raise FitRefused(f"the model does not depend on parameter {which} at {_told(b)}")
    condition = scaled_condition(r)
    if condition > CONDITION_LIMIT:
        raise FitRefused(
            f"the Jacobian is rank-deficient at {_told(b)}: condition number {condition:.1e}, at "
            f"most {CONDITION_LIMIT:.0e} is accepted; the data do not determine all parameters",
            {"condition_number": condition, "limit": CONDITION_LIMIT},
        )
    return condition


def _hessian(problem: Problem, b: FloatArray, r: FloatArray) -> FloatArray:
    r"""Hessian of half the squares in the metric of J^T J, by differences of the exact Jacobian.

    $1 - R^{-T} (\sum_i r_i \nabla^2 f_i) R^{-1}$. The steps change the prediction by a thousandth
    of the noise, or enough to rise above rounding, and show as well whether the Jacobian is the
    model's derivative.
    """
    n, p = len(problem.y), len(b)
    residuals, derivatives = problem.residuals(b), problem.weighted_jacobian(b)
    noise = float(np.linalg.norm(residuals)) / np.sqrt(n)
    size = float(np.linalg.norm(problem.y / problem.sigma)) / np.sqrt(n)
    length = max(1e-3 * noise, 1e-8 * size) or 1e-8
    bounded = bool(np.isfinite(problem.lower).any() or np.isfinite(problem.upper).any())
    bends = np.empty((p, p))
    for k, direction in enumerate(np.linalg.solve(r, length * np.eye(p)).T):
        part = _room(problem, b, direction) if bounded else 1.0
        moved = b + part * direction
        beyond = problem.residuals(moved)
        if not np.isfinite(beyond).all():
            raise FitRefused(f"the model is not finite at {_told(moved)}, beside the minimum")
        slopes = problem.weighted_jacobian(moved)
        expected = 0.5 * ((derivatives + slopes) @ (moved - b))
        wrong = float(np.linalg.norm(residuals - beyond - expected)) / (part * length)
        if not wrong <= _JACOBIAN_LIMIT:
            raise FitRefused(
                f"the Jacobian is not the derivative of the model at {_told(b)}: they differ by "
                f"{100 * wrong:.2g} %, at most {100 * _JACOBIAN_LIMIT:g} % is accepted",
                {"difference": wrong},
            )
        bends[:, k] = (slopes - derivatives).T @ residuals / (part * length)
    hessian = np.eye(p) - np.linalg.solve(r.T, bends)
    return np.asarray(0.5 * (hessian + hessian.T))


def _room(problem: Problem, b: FloatArray, direction: FloatArray) -> float:
    """Largest part of a step, at most all, that stays within half the way to every bound."""
    nearest = np.minimum(problem.upper - b, b - problem.lower)
    moving = direction != 0
    return float(min(1.0, np.min(0.5 * nearest[moving] / np.abs(direction[moving]), initial=1.0)))


def _told(b: FloatArray) -> str:
    """Parameters as a reader wants them."""
    return "(" + ", ".join(f"{v:.6g}" for v in b) + ")"
