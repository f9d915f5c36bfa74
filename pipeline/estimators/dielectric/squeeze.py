r"""How much a soft film gives way under the anvils of a micrometer.

A film under the pressure p of a flat anvil is taken as a neo-Hookean solid of modulus Y that slips
freely on the anvils:

$$ \frac{p}{Y} = \frac{1}{3} \Big(\frac{1}{\lambda} - \lambda^2\Big), \qquad
\lambda = d_\mathrm{read} / d. $$

For small pressures $d = d_\mathrm{read} (1 + p/Y)$, and still $d = d_\mathrm{read} / (1 - p/Y)$ to
second order. A real film sticks to dry anvils, and being much wider than thick it then hardly gives
way at all: free slip is an UPPER bound of the correction, `sticking_modulus` gives the lower one.

Source: neo-Hookean solid under the true stress p (the anvil's area does not grow with the film);
A. N. Gent, P. B. Lindley, Proc. Inst. Mech. Eng. 173 (1959) 111 for the bonded disc.
"""

from __future__ import annotations

import math

from deamat.core.errors import FitRefused

_LINEAR = 1e-12  # below this p/Y the two forms agree to the last digit


def squeezed_stretch(pressure_ratio: float) -> float:
    r"""Return $\lambda$ at a pressure: the root of $\lambda^3 + 3 x \lambda - 1 = 0$ with x = p/Y.

    $\lambda = 2 \sqrt{x} \sinh\big(\tfrac13 \mathrm{arsinh}(\tfrac12 x^{-3/2})\big)$

    Parameters
    ----------
    pressure_ratio : x = p/Y, not negative `[1]`

    Raises
    ------
    FitRefused : a pressure ratio that is negative or not finite
    """
    x = pressure_ratio
    if not 0.0 <= x < math.inf:
        raise FitRefused(f"the pressure over the modulus must be finite and not negative, not {x}")
    if x < _LINEAR:
        return 1.0 - x
    return 2.0 * math.sqrt(x) * math.sinh(math.asinh(0.5 * x**-1.5) / 3.0)


def squeeze_sensitivity(pressure_ratio: float) -> float:
    r"""Relative change of d for a relative change of p/Y: $x / (\lambda^2 + x)$ `[1]`."""
    return pressure_ratio / (squeezed_stretch(pressure_ratio) ** 2 + pressure_ratio)


def sticking_modulus(modulus_Pa: float, thickness_m: float, anvil_diameter_m: float) -> float:
    r"""Apparent modulus of an incompressible film that sticks to a round anvil.

    $Y_a = Y (1 + 2 S^2)$ with the shape factor $S = a / (4 d)$ `[Pa]`
    """
    return modulus_Pa * (1.0 + 2.0 * (anvil_diameter_m / (4.0 * thickness_m)) ** 2)
