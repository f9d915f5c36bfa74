"""Contact point and stiffness of an indentation, fitted together."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.search import lowest

_CANDIDATES = 64
_FARTHEST = 10.0  # contact point before the record, in spans of its depth
_AIR_TOLD = 12.0  # F of a line in air: one sound record in two thousand is taken for contact
_ROUNDING = 1e-16  # part of a sum of squares: the contact point is searched to 1e-9 of its grid


class StartsInContact(FitRefused):
    """A record without a line in air before the contact."""


@dataclass(frozen=True, slots=True)
class Contact:
    """A loading law fitted to approach and loading, and how well it is known.

    Parameters
    ----------
    stiffness : K `[N/m^exponent]`
    depth0 : contact point `[m]`
    offset, tilt : of the load in air, `offset + tilt * depth` `[N]`, `[N/m]`
    u_stiffness : standard error of K, contact point and air line unknown `[N/m^exponent]`
    u_stiffness_alone : the part of it that would be left, were the contact point known
    u_depth0 : standard error of the contact point `[m]`
    in_air, in_contact : samples before and after the contact point
    residual_sd : noise of the load `[N]`
    independent_samples : `n (1 - rho) / (1 + rho)` for residuals of autocorrelation rho
    per_tilt : relative change of K for each N/m of a tilt that no air shows; 0 with air `[m/N]`
    """

    exponent: float
    stiffness: float
    depth0: float
    offset: float
    tilt: float
    u_stiffness: float
    u_stiffness_alone: float
    u_depth0: float
    in_air: int
    in_contact: int
    residual_sd: float
    independent_samples: float
    per_tilt: float = 0.0

    def air(self, depth: FloatArray) -> FloatArray:
        """Load in air at these depths, shape (n,) `[N]`."""
        return self.offset + self.tilt * depth

    def load(self, depth: FloatArray) -> FloatArray:
        """Load of the contact alone at these depths, shape (n,) `[N]`."""
        above: FloatArray = np.maximum(depth - self.depth0, 0.0) ** self.exponent
        return self.stiffness * above


def fit_contact(
    depth: FloatArray, load: FloatArray, exponent: float, min_air: int, min_contact: int
) -> Contact:
    r"""Fit `P = p_0 + k h + K (h - h_0)_+^m` by least squares, m known.

    The line in air is what the transducer's springs leave uncompensated. At a given $h_0$ the rest
    is linear, so the sum of squares is searched over $h_0$ alone: on a grid of 64, then by golden
    section. Standard errors come from the Jacobian of all four parameters (`standard_errors`).

    Parameters
    ----------
    depth, load : of approach and loading, in the order of time, shape (n,) `[m]`, `[N]`
    exponent : m, 1 for a flat punch, 1.5 for a sphere, 2 for a pyramid
    min_air, min_contact : samples that must lie before and after the contact point

    Raises
    ------
    StartsInContact : the load rises from the first samples on
    FitRefused : too few samples, no place for a contact point, or a load that nowhere begins to
        rise

    Source: I. N. Sneddon, Int. J. Eng. Sci. 3 (1965) 47, for the exponents; G. H. Golub,
    V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413, for the separation of the linear parameters.
    """
    n = depth.size
    found: dict[str, float | int | str] = {"samples": n, "samples_needed": min_air + min_contact}
    if n < min_air + min_contact:
        raise FitRefused(
            f"{n} samples of approach and loading; {min_air} in air and {min_contact} in contact "
            "are needed: sample faster",
            found,
        )
    ordered = np.sort(depth)
    low, high = float(ordered[min_air - 1]), float(ordered[n - min_contact])
    if not low < high:
        raise FitRefused("the depth does not change during approach and loading", found)
    profile = _profile(depth, load, exponent)
    depth0, best = lowest(profile, np.linspace(low, high, _CANDIDATES))
    if math.isinf(profile(depth0)):
        raise FitRefused("the load nowhere begins to rise: the tip never touched", found)
    if best == 0:
        raise StartsInContact(
            "the record starts in contact, the load rises from the first sample on: fewer than "
            f"{min_air} samples lie in air before the contact point, so neither it nor the zero of "
            "the load is known; start the approach farther above the surface",
            found,
        )
    if best == _CANDIDATES - 1:
        raise FitRefused(
            f"the load does not rise before the last {min_contact} samples: the tip hardly touched",
            found,
        )
    return _described(depth, load, exponent, depth0)


def fit_in_contact(
    depth: FloatArray, load: FloatArray, exponent: float, min_air: int, min_contact: int
) -> Contact:
    r"""Fit `P = p_0 + K (h - h_0)_+^m` to a record that starts in contact.

    The contact point lies before the record, or among its first samples; the load there is as
    unknown as it is. A tilt of the load cannot be told from the contact itself and is zero:
    `per_tilt` is what one would change.

    Parameters
    ----------
    depth, load, exponent : as for `fit_contact`; a flat punch (m = 1) has no contact point to find
    min_air : the contact point is searched up to this sample
    min_contact : samples that must follow it

    Raises
    ------
    FitRefused : too few samples, or a load that keeps to a straight line: any contact point far
        enough before the record fits it
    """
    n = depth.size
    if n < min_air + min_contact or exponent <= 1.0:
        raise FitRefused(f"{n} samples do not tell where the contact began")
    ordered = np.sort(depth)
    first, span = float(ordered[0]), float(ordered[-1] - ordered[0])
    grid = np.concatenate(
        [
            first - span * np.geomspace(_FARTHEST, 1e-4, _CANDIDATES),
            np.linspace(first, float(ordered[min_air - 1]), _CANDIDATES // 4),
        ]
    )
    depth0, best = lowest(_profile(depth, load, exponent, tilted=False), grid)
    if best == 0:
        raise FitRefused(
            "the load keeps to a straight line from the first sample on: the contact may have "
            "begun anywhere before"
        )
    return _described(depth, load, exponent, depth0, tilted=False)


def has_air(with_air: Contact, without: Contact) -> bool:
    """Tell whether a line in air explains a record better than contact from its start on.

    Parameters
    ----------
    with_air, without : `fit_contact` and `fit_in_contact` of the same samples

    The former has one parameter more, and must leave less by more than its noise (F test).
    """
    n = with_air.in_air + with_air.in_contact
    squares = with_air.residual_sd**2 * (n - 4)
    more = without.residual_sd**2 * (n - 3) - squares
    told: bool = more * min(with_air.independent_samples, n) > _AIR_TOLD * squares
    return told


def has_kink(contact: Contact, load: FloatArray, depth: FloatArray) -> bool:
    """Tell a flat punch that comes from air into contact from one straight line (F test).

    Parameters
    ----------
    contact : `fit_contact` of these samples with m = 1
    load, depth : shape (n,) each
    """
    x, y = depth - depth.mean(), load - load.mean()
    rest = y - x * (float(x @ y) / float(x @ x))
    squares = contact.residual_sd**2 * (x.size - 4)
    told: float = (float(rest @ rest) - squares) * min(contact.independent_samples, x.size)
    return bool(told > 2.0 * _AIR_TOLD * squares)


def _profile(
    depth: FloatArray, load: FloatArray, exponent: float, *, tilted: bool = True
) -> Callable[[float], float]:
    """Sum of squares as a function of the contact point; infinite where K would not be positive."""
    columns = [np.ones_like(depth), depth - depth.mean()] if tilted else [np.ones_like(depth)]
    line, _ = np.linalg.qr(np.column_stack(columns))
    rest = load - line @ (line.T @ load)
    total = float(rest @ rest)

    def cost(depth0: float) -> float:
        rise = np.maximum(depth - depth0, 0.0) ** exponent
        rise -= line @ (line.T @ rise)
        along = float(rise @ rest)
        return total - along**2 / float(rise @ rise) if along > 0.0 else math.inf

    return cost


def _described(
    depth: FloatArray, load: FloatArray, exponent: float, depth0: float, *, tilted: bool = True
) -> Contact:
    """Return all parameters at the best contact point, with their standard errors."""
    touching = depth > depth0
    above = np.maximum(depth - depth0, 0.0)
    air = [np.ones_like(depth), depth] if tilted else [np.ones_like(depth)]
    columns = np.column_stack([*air, above**exponent])
    k = len(air)
    scales = np.abs(columns).max(axis=0)
    scaled, *_ = np.linalg.lstsq(columns / scales, load, rcond=None)
    found = (scaled / scales).tolist()
    stiffness = float(found[k])
    residual = load - columns @ (scaled / scales)
    shift = np.zeros_like(depth)
    shift[touching] = -stiffness * exponent * above[touching] ** (exponent - 1.0)
    jacobian = np.column_stack([columns, shift])
    parameters = k + 2
    total = float(np.square(load - load.mean()).sum())
    independent = independent_samples(residual, parameters, total)
    u_full = standard_errors(jacobian, residual, independent)
    # what not knowing the contact point adds is a matter of the depths alone
    even = np.ones_like(depth)
    widened = standard_errors(jacobian, even, even.size)[k]
    known = standard_errors(columns, even, even.size)[k] / widened
    return Contact(
        exponent=exponent,
        stiffness=stiffness,
        depth0=depth0,
        offset=float(found[0]),
        tilt=float(found[1]) if tilted else 0.0,
        u_stiffness=float(u_full[k]),
        u_stiffness_alone=float(known * u_full[k]),
        u_depth0=float(u_full[k + 1]),
        in_air=int(depth.size - touching.sum()),
        in_contact=int(touching.sum()),
        residual_sd=math.sqrt(float(residual @ residual) / (depth.size - parameters)),
        independent_samples=independent,
        per_tilt=0.0 if tilted else _per_tilt(jacobian, depth) / stiffness,
    )


def _per_tilt(jacobian: FloatArray, depth: FloatArray) -> float:
    """Change of K when a tilt of 1 N/m is in the load and not in the fit."""
    scales = np.abs(jacobian).max(axis=0)
    taken, *_ = np.linalg.lstsq(jacobian / scales, depth, rcond=None)
    return abs(float(taken[1] / scales[1]))


def independent_samples(residual: FloatArray, parameters: int, total: float) -> float:
    r"""Count samples as independent ones, $n (1 - \rho) / (1 + \rho)$.

    $\rho = (n r_1 + p) / (n - 2p - 1)$, the first autocorrelation freed to first order of what a
    fit of p parameters takes from it, within $[0, 1 - 1/n]$.

    Parameters
    ----------
    residual : shape (n,)
    parameters : p
    total : sum of squares before the fit; what arithmetic alone leaves of it has no correlation
    """
    n = residual.size
    squares = float(residual @ residual)
    if squares <= _ROUNDING * total:
        return float(n)
    lag_one = float(residual[1:] @ residual[:-1]) / squares
    rho = min(max((n * lag_one + parameters) / max(n - 2 * parameters - 1, 1), 0.0), 1.0 - 1.0 / n)
    return n * (1.0 - rho) / (1.0 + rho)


def standard_errors(jacobian: FloatArray, residual: FloatArray, independent: float) -> FloatArray:
    r"""Standard errors of least-squares parameters whose residuals need not be equally large.

    Each sample counts with its own residual, $J^+ \mathrm{diag}(e^2) J^{+T}$, enlarged by
    $n / (n - p)$ for the fit and by n over the independent samples for their correlation: in
    contact the noise of the depth adds to that of the load, in air it does not.

    Parameters
    ----------
    jacobian : shape (n, p)
    residual : shape (n,)
    independent : see `independent_samples`

    Raises
    ------
    FitRefused : the data do not tell the parameters apart

    Source: J. G. MacKinnon, H. White, J. Econometrics 29 (1985) 305 (HC1).
    """
    n, p = jacobian.shape
    scales = np.linalg.norm(jacobian, axis=0)
    if not scales.all():
        raise FitRefused("the samples leave a parameter of the fit undetermined")
    basis, triangle = np.linalg.qr(jacobian / scales)
    if np.abs(np.diag(triangle)).min() < 1e-10:
        raise FitRefused("the samples do not tell the parameters of the fit apart")
    weights = np.linalg.solve(triangle, basis.T) * residual
    enlarged = math.sqrt(n / (n - p) * n / independent)
    errors: FloatArray = enlarged * np.linalg.norm(weights, axis=1) / scales
    return errors
