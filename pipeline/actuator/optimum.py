"""How thick and how stiff the passive layer should be, without and with electrodes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from deamat.actuator.figure_of_merit import Unimorph, active_part, multilayer
from deamat.actuator.ranges import RANGES, Reals, within

_RATIO = (1e-9, 1e9)
_GOLDEN = 0.6180339887498949
_STEPS = 50  # of golden section: the bracket shrinks to 4e-11 of its width


def thickness_ratio_at_fixed_total(modulus_ratio: Reals) -> Reals:
    """Return the best `t_p / t_a` when the total thickness is fixed, `1 / sqrt(Y_p / Y_a)`.

    Parameters
    ----------
    modulus_ratio : `Y_p / Y_a`, no electrodes `[1]`

    Raises
    ------
    OutOfRange : a ratio outside 1e-9 to 1e9

    Source: Sikulskyi et al. 2022, Eq. 18; Wang and Cross 1998.
    """
    within("modulus_ratio", modulus_ratio, *_RATIO)
    return 1.0 / np.sqrt(modulus_ratio)


def modulus_ratio_at_fixed_active(thickness_ratio: Reals) -> Reals:
    """Return the `Y_p / Y_a` for which `t_p / t_a` is the best passive thickness on a given film.

    `Y = 1 / (t^2 (2 t + 3))`, no electrodes.

    Parameters
    ----------
    thickness_ratio : `t_p / t_a` `[1]`

    Raises
    ------
    OutOfRange : a ratio outside 1e-9 to 1e9

    Source: Sikulskyi et al. 2022, Eq. 19.
    """
    within("thickness_ratio", thickness_ratio, *_RATIO)
    return 1.0 / (thickness_ratio * thickness_ratio * (2.0 * thickness_ratio + 3.0))


def thickness_ratio_at_fixed_active(modulus_ratio: Reals) -> Reals:
    """Return the best `t_p / t_a` on a film of given thickness: Eq. 19 solved for `t`.

    The one positive root of `2 t^3 + 3 t^2 = 1 / Y`. With `t = x - 1/2` it is
    `4 x^3 - 3 x = 2 / Y - 1`, a triple-angle formula: hyperbolic for `Y < 1`, trigonometric above.

    Parameters
    ----------
    modulus_ratio : `Y_p / Y_a`, no electrodes `[1]`

    Raises
    ------
    OutOfRange : a ratio outside 1e-9 to 1e9

    Source: Sikulskyi et al. 2022, Eq. 19.
    """
    within("modulus_ratio", modulus_ratio, *_RATIO)
    y = np.asarray(modulus_ratio, float)
    soft = np.cosh(np.arccosh(2.0 / np.minimum(y, 1.0) - 1.0) / 3.0) - 0.5
    # cos(a/3) - 1/2 as a product, which keeps its digits for a stiff, thin layer
    sixth = np.arcsin(1.0 / np.sqrt(np.maximum(y, 1.0))) / 3.0
    stiff = 2.0 * np.sin(np.pi / 3.0 - sixth) * np.sin(sixth)
    return np.asarray(np.where(y < 1.0, soft, stiff), np.float64)


def best_passive_modulus(unimorph: Unimorph) -> Reals:
    """Return the passive modulus that bends most at the given thicknesses, with electrodes `[Pa]`.

    The curvature is `a Y / (alpha Y^2 + beta Y + gamma)` in the passive modulus, greatest at
    `sqrt(gamma / alpha) = sqrt(12 A D) / t_p^2`, `A` and `D` being the stiffness and the bending
    stiffness of everything above; without electrodes that is Eq. 18.

    Parameters
    ----------
    unimorph : its `passive_modulus_Pa` is ignored
    """
    pull, bending, _ = active_part(unimorph)
    tp = unimorph.passive_thickness_m
    return np.sqrt(12.0 * pull * bending) / (tp * tp)


def best_passive_thickness(unimorph: Unimorph) -> Reals:
    """Return the passive thickness that bends most on the given film, with electrodes `[m]`.

    Parameters
    ----------
    unimorph : its `passive_thickness_m` is ignored

    Returns
    -------
    thickness to a relative 1e-6, which is as far as floats resolve a flat maximum `[m]`

    Source: maximum of `figure_of_merit.multilayer`; Sikulskyi et al. 2022, Table 1, Table 5.
    """

    def curvature(log_thickness: Reals) -> Reals:
        return multilayer(replace(unimorph, passive_thickness_m=np.exp(log_thickness)), 1e-3)

    allowed = RANGES["thickness_m"]
    # Just inside the limits, so that rounding in exp never leaves them
    low, high = np.log(1.0000001 * allowed.low), np.log(0.9999999 * allowed.high)
    return np.exp(_maximise(curvature, low, high, np.shape(curvature(low))))


def best_split(unimorph: Unimorph) -> Reals:
    """Return the passive thickness that bends most at the same total thickness, with electrodes.

    Total and electrode thicknesses stay; what the passive layer gains the active layers lose.

    Parameters
    ----------
    unimorph : fixes the total and the electrodes

    Returns
    -------
    passive thickness `[m]`

    Source: Sikulskyi et al. 2022, Eq. 18 and section 2.1.4.
    """
    n = unimorph.n_active
    layers = unimorph.passive_thickness_m + n * unimorph.active_thickness_m

    def curvature(share: Reals) -> Reals:
        return multilayer(
            replace(
                unimorph,
                passive_thickness_m=layers * share,
                active_thickness_m=layers * (1.0 - share) / n,
            ),
            1e-3,
        )

    low = RANGES["thickness_m"].low * 1.001 * n / np.min(layers)
    return layers * _maximise(curvature, low, 1.0 - low, np.shape(curvature(0.5)))


def _maximise(
    f: Callable[[Reals], Reals], low: float, high: float, shape: tuple[int, ...]
) -> Reals:
    """Find the single maximum of each design by golden section, all designs at once."""
    a = np.full(shape, low)
    b = np.full(shape, high)
    for _ in range(_STEPS):
        c = b - _GOLDEN * (b - a)
        d = a + _GOLDEN * (b - a)
        left = f(c) > f(d)
        b = np.where(left, d, b)
        a = np.where(left, a, c)
    return np.asarray(0.5 * (a + b))
