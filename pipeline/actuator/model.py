"""The model that a design is computed with: a strip under voltage, in equilibrium.

This is the one place where a design asks a model: the film thins as a free one (`strain`), the
section bends as `beam.actuate` has it, in closed form and without weight, so that thousands of
draws and designs cost one pass over arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np

from deamat.actuator.declared import Geometry
from deamat.actuator.figure_of_merit import Unimorph, active_part, multilayer
from deamat.actuator.limits import Allowed, failure_probability, voltage_limits
from deamat.actuator.optimum import best_passive_thickness
from deamat.actuator.ranges import Reals, check
from deamat.actuator.strain import PULL_IN_DRIVE, drive, in_plane_strain, thickness_strain
from deamat.actuator.strip import Strip
from deamat.core.arrays import FloatArray

# From values by field of a `strip.Strip` (arrays of one shape) to the prediction, NaN where there
# is none because the film pulls in.
Response: TypeAlias = Callable[[Mapping[str, FloatArray]], Reals]


@dataclass(frozen=True, slots=True, eq=False)
class ActuatedStrip:
    """A strip under voltage; each number a scalar or an array over designs.

    Parameters
    ----------
    strip : as made
    thinned : its layers under voltage
    true_field_V_m : on the thinned film; NaN where it pulls in `[V/m]`
    curvature_per_m : towards the passive layer, without weight; NaN where it pulls in `[1/m]`
    """

    strip: Strip
    thinned: Unimorph
    true_field_V_m: Reals
    curvature_per_m: Reals

    def failure_probability(self) -> Reals:
        """Return the fraction of such films that break down; 1 where they pull in `[1]`.

        Raises
        ------
        MissingProperty : the strip's breakdown is not known
        """
        return failure_probability(self.strip, self.true_field_V_m)


def actuate(strip: Strip, voltage_V: Reals) -> ActuatedStrip:
    """Put a strip under voltage; a film above pull-in has no equilibrium and is NaN.

    Parameters
    ----------
    strip, voltage_V : scalars or arrays that broadcast

    Raises
    ------
    OutOfRange : a number outside `ranges.RANGES`

    Source: `beam.actuate` with thinning; Sikulskyi et al. 2022, Eqs. 4-9.
    """
    field = voltage_V / strip.film_thickness_m
    nominal = drive(strip.relative_permittivity, field, strip.film_modulus_Pa)
    s = thickness_strain(np.minimum(nominal, PULL_IN_DRIVE))
    thinned = Unimorph(
        strip.passive_thickness_m,
        strip.passive_modulus_Pa,
        strip.film_thickness_m * (1.0 - s),
        strip.film_modulus_Pa,
        strip.electrode_thickness_m,
        strip.electrode_modulus_Pa,
    )
    bent = multilayer(thinned, in_plane_strain(s, strip.poisson_ratio, strip.in_plane))
    pulls_in = np.asarray(nominal > PULL_IN_DRIVE)
    return ActuatedStrip(
        strip,
        thinned,
        np.where(pulls_in, np.nan, field / (1.0 - s)),
        np.where(pulls_in, np.nan, bent),
    )


def blocked_force(actuated: ActuatedStrip, size: Geometry) -> Reals:
    """Return the force that holds the tip of a cantilever at its place, `3 B kappa / (2 L)` `[N]`.

    Parameters
    ----------
    actuated : from `actuate`; NaN where a design pulls in
    size : length and width of the strip

    Source: small deflections, `kappa L^2 / 2 = F L^3 / (3 B)`.
    """
    length_m, width_m = size.length_m, size.width_m
    check("length_m", length_m)
    check("width_m", width_m)
    tp = actuated.thinned.passive_thickness_m
    passive = actuated.thinned.passive_modulus_Pa * tp
    pull, bending, height = active_part(actuated.thinned)
    h = 0.5 * (tp + height)
    stiffness = passive * tp * tp / 12.0 + bending + h * h * passive * pull / (passive + pull)
    return 1.5 * width_m * stiffness * actuated.curvature_per_m / length_m


def best_passive(strip: Strip, voltage_V: Reals) -> Reals:
    """Return the passive thickness that bends most at a voltage, with the film thinned `[m]`."""
    return best_passive_thickness(actuate(strip, voltage_V).thinned)


def respond(strip: Strip, at: Reals | Allowed) -> Response:
    """Return the curvature as a function of the inputs.

    Parameters
    ----------
    strip : what the inputs do not set
    at : voltage of all, or what sets the highest allowed one, which then moves with the inputs

    Raises
    ------
    MissingProperty : when called, if the highest allowed voltage is asked for and the breakdown
        is not known
    """

    def response(values: Mapping[str, FloatArray]) -> Reals:
        moved = _moved(strip, values)
        voltage = voltage_limits(moved, at).highest_V if isinstance(at, Allowed) else at
        return actuate(moved, voltage).curvature_per_m

    return response


def respond_by_failing(strip: Strip, voltage_V: float) -> Response:
    """Return the probability of breakdown at a voltage as a function of the inputs."""
    return lambda values: actuate(_moved(strip, values), voltage_V).failure_probability()


def _moved(strip: Strip, values: Mapping[str, FloatArray]) -> Strip:
    fields: dict[str, Any] = dict(values)  # by names that only a run knows
    return replace(strip, **fields)
