"""How far the voltage of a strip may go: pull-in and breakdown, computed once and handed on.

Every limit of the voltage is found here and nowhere else; what comes after reads `Limits`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deamat.actuator.ranges import Reals, within
from deamat.actuator.strain import PULL_IN_STRAIN, drive, pull_in_voltage
from deamat.actuator.strip import Strip
from deamat.core.errors import MissingProperty

_UNKNOWN = (
    "the breakdown limit is unknown: the card of the de layer has no breakdown_strength with its "
    "weibull_shape; test its breakdown, or give a voltage"
)


@dataclass(frozen=True, slots=True)
class Allowed:
    """How much risk and which margin a designer accepts.

    Parameters
    ----------
    breakdown_probability : fraction of the films that may break down, 0 to 1 `[1]`
    pull_in_fraction : highest voltage over that of pull-in, 0 to 1 `[1]`

    Raises
    ------
    OutOfRange : a fraction outside its range
    """

    breakdown_probability: float
    pull_in_fraction: float

    def __post_init__(self) -> None:
        hint = "it is a fraction: was it given in percent?"
        within("breakdown_probability", self.breakdown_probability, 1e-9, 1.0 - 1e-9, hint=hint)
        within("pull_in_fraction", self.pull_in_fraction, 1e-3, 1.0, hint=hint)


@dataclass(frozen=True, slots=True, eq=False)
class Limits:
    """Limits of the voltage of one strip, or of many.

    Parameters
    ----------
    allowed : what they were computed for
    pull_in_V : the allowed fraction of the pull-in voltage `[V]`
    breakdown_V : at which the allowed fraction of the films breaks down; infinite if the film
        pulls in before, None if its breakdown is not known `[V]`
    """

    allowed: Allowed
    pull_in_V: Reals
    breakdown_V: Reals | None

    @property
    def highest_V(self) -> Reals:
        """The voltage that breakdown and pull-in allow, whichever comes first `[V]`.

        Raises
        ------
        MissingProperty : the breakdown is not known
        """
        if self.breakdown_V is None:
            raise MissingProperty(_UNKNOWN)
        return np.minimum(self.breakdown_V, self.pull_in_V)


def voltage_limits(strip: Strip, allowed: Allowed) -> Limits:
    """Compute all limits of the voltage of a strip.

    At the true field `E` of breakdown the film has thinned by `s = eps0 eps_r E^2 / Y`, so it sees
    `V = E t0 (1 - s)` if `s` is below 1/3; otherwise it pulls in before.

    Parameters
    ----------
    strip : scalars or arrays that broadcast; its passive layer and electrodes do not enter
    allowed : accepted risk and margin
    """
    pull_in_V = allowed.pull_in_fraction * pull_in_voltage(
        strip.film_thickness_m, strip.film_modulus_Pa, strip.relative_permittivity
    )
    if strip.breakdown_strength_V_m is None or strip.weibull_shape is None:
        return Limits(allowed, pull_in_V, None)
    field = breakdown_field(strip, allowed)
    s = drive(strip.relative_permittivity, field, strip.film_modulus_Pa)
    breakdown_V = np.where(s < PULL_IN_STRAIN, field * strip.film_thickness_m * (1.0 - s), np.inf)
    return Limits(allowed, pull_in_V, breakdown_V)


def breakdown_field(strip: Strip, allowed: Allowed) -> Reals:
    """Return the field that the allowed fraction of the films does not survive `[V/m]`.

    `E = E_b (-ln(1 - q) / a)^(1 / beta)`, `a` being the area ratio.

    Raises
    ------
    MissingProperty : the strip's breakdown is not known
    """
    scale, shape = _weibull(strip)
    hazard = -np.log1p(-allowed.breakdown_probability) / strip.area_ratio
    field: Reals = scale * np.power(hazard, 1.0 / np.asarray(shape))
    return field


def failure_probability(strip: Strip, true_field_V_m: Reals) -> Reals:
    """Return the fraction of films that break down, `1 - exp(-a (E / E_b)^beta)`, `a` by area.

    Parameters
    ----------
    strip : scalars or arrays that broadcast
    true_field_V_m : `E`, on the thinned film; NaN where the film pulls in, which fails for sure

    Raises
    ------
    MissingProperty : the strip's breakdown is not known

    Source: IEC 62539; weakest link over the area.
    """
    scale, shape = _weibull(strip)
    hazard = strip.area_ratio * (true_field_V_m / scale) ** shape
    chance: Reals = np.where(np.isnan(hazard), 1.0, -np.expm1(-hazard))
    return chance


def _weibull(strip: Strip) -> tuple[Reals, Reals]:
    if strip.breakdown_strength_V_m is None or strip.weibull_shape is None:
        raise MissingProperty(_UNKNOWN)
    return strip.breakdown_strength_V_m, strip.weibull_shape
