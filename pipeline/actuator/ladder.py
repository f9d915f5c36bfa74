"""From the planar figure of merit to the elastica: the cheapest model that is good enough.

Each rung takes in one effect that the rung below leaves out. Errors are those against the top rung,
not against the laboratory: a wide clamped root, for one, adds 5 to 11 % to the tip on every rung.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from deamat.actuator.beam import Beam, actuate, deflection, displacement, weight
from deamat.actuator.collocation import grid
from deamat.actuator.elastica import deflect
from deamat.actuator.equilibrium import SELF_BUCKLING_LOAD, tips
from deamat.actuator.figure_of_merit import Unimorph, no_electrodes, single_layer
from deamat.actuator.ranges import check, within
from deamat.actuator.stack import ON_EDGE, Orientation, Stack
from deamat.actuator.strain import InPlane, film_drive, in_plane_strain
from deamat.core.errors import OutOfRange

Rung: TypeAlias = Literal[
    "planar", "no electrodes", "single layer", "multilayer", "thinning", "weight", "elastica"
]
Aim: TypeAlias = Literal["tip", "curvature"]

# Cheapest first, each with what it leaves out and the rung above takes in.
NEGLECTS: dict[Rung, str] = {
    "planar": "how the thickness is shared between passive and active layers",
    "no electrodes": "the electrodes",
    "single layer": "the elongation, electrodes between films, unequal electrodes and widths",
    "multilayer": "the thinning of the films",
    "thinning": "the weight",
    "weight": "large rotations",
    "elastica": "nothing that the ladder knows of",
}
_CLOSED_FORMS: tuple[Rung, ...] = ("planar", "no electrodes", "single layer")
_ELASTICA_TOLERANCE = 1e-9
_POINTS = 24


@dataclass(frozen=True, slots=True, eq=False)
class Actuator:
    """One cantilever strip under voltage.

    Parameters
    ----------
    stack : layers as made
    length_m : free length as made `[m]`
    voltage_V : across each film `[V]`
    in_plane : rule of `strain.in_plane_strain`
    orientation : which way gravity pulls

    Raises
    ------
    OutOfRange : a length or voltage outside `ranges.RANGES`
    """

    stack: Stack
    length_m: float
    voltage_V: float
    in_plane: InPlane
    orientation: Orientation

    def __post_init__(self) -> None:
        check("length_m", self.length_m)
        check("voltage_V", self.voltage_V)


@dataclass(frozen=True, slots=True)
class Answer:
    """What one rung says of a strip.

    Parameters
    ----------
    curvature_per_m : that the films cause, towards the first layer `[1/m]`
    tip_x_m, tip_y_m : tip along the root's axis, and towards the first layer `[m]`
    """

    curvature_per_m: float
    tip_x_m: float
    tip_y_m: float


@dataclass(frozen=True, slots=True)
class Choice:
    """The cheapest rung within a tolerance, and why.

    Parameters
    ----------
    rung, answer : what was chosen, and what it says
    error : its estimated error: of the tip in lengths, or of the curvature relative `[1]`
    errors : estimated errors of all rungs, cheapest first; infinite for one that does not apply
    why : in words
    """

    rung: Rung
    answer: Answer
    error: float
    errors: tuple[tuple[Rung, float], ...]
    why: str


def evaluate(actuator: Actuator, rung: Rung) -> Answer:
    """Ask one rung for the curvature and the tip.

    Up to `thinning` the strip is a weightless arc, drawn with small deflections:
    `y = kappa L^2 / 2`. `planar` takes the most that films and passive layer of this total
    thickness reach without electrodes, `3 e / (2 T)` (Eq. 17 with the ratio of Eq. 18).

    Parameters
    ----------
    actuator : one strip
    rung : which model

    Raises
    ------
    OutOfRange : an unknown rung, a stack that the rung does not describe, a voltage above pull-in
    FitRefused : a strip that buckles or snaps (`elastica`)
    """
    if rung not in NEGLECTS:
        raise OutOfRange(f"rung is {rung!r}; allowed are {', '.join(NEGLECTS)}")
    length = actuator.length_m
    if rung in _CLOSED_FORMS:
        kappa = _merit(actuator, rung)
        return Answer(kappa, length, 0.5 * kappa * length**2)
    beam = actuate(actuator.stack, actuator.voltage_V, actuator.in_plane, rung != "multilayer")
    if rung == "elastica":
        shape = deflect(beam, length, actuator.orientation, _ELASTICA_TOLERANCE)
        return Answer(float(beam.curvature_per_m), float(shape.tip_x_m), float(shape.tip_y_m))
    orientation = actuator.orientation if rung == "weight" else ON_EDGE
    return Answer(
        float(beam.curvature_per_m),
        length + float(displacement(beam, length, length)),
        float(deflection(beam, length, length, orientation)),
    )


def errors(actuator: Actuator, aim: Aim) -> dict[Rung, float]:
    """Estimate how far each rung is from the elastica, without solving the elastica.

    Rungs up to `weight` cost microseconds and are compared with `weight`; the large rotations that
    it leaves out are added to all of them (`rotation_error`).

    Parameters
    ----------
    actuator : one strip
    aim : `"tip"`, errors in lengths, or `"curvature"` (of the films alone), relative errors

    Returns
    -------
    error of each rung, cheapest first; infinite for a rung that does not describe the stack

    Raises
    ------
    OutOfRange : an unknown aim, a voltage above pull-in
    """
    if aim not in ("tip", "curvature"):
        raise OutOfRange(f"aim is {aim!r}; allowed are 'tip' and 'curvature'")
    skipped = () if _alternates(actuator.stack) else _CLOSED_FORMS
    answers = {
        rung: evaluate(actuator, rung)
        for rung in NEGLECTS
        if rung != "elastica" and rung not in skipped
    }
    best = answers["weight"]
    found: dict[Rung, float] = dict.fromkeys(NEGLECTS, math.inf)
    if aim == "curvature":
        for rung, answer in answers.items():
            off = abs(answer.curvature_per_m - best.curvature_per_m)
            found[rung] = off / abs(best.curvature_per_m) if off else 0.0
        found["elastica"] = 0.0
        return found
    beam = actuate(actuator.stack, actuator.voltage_V, actuator.in_plane)
    rotation = rotation_error(beam, actuator.length_m, actuator.orientation)
    for rung, answer in answers.items():
        off = math.hypot(answer.tip_x_m - best.tip_x_m, answer.tip_y_m - best.tip_y_m)
        found[rung] = off / actuator.length_m + rotation
    found["elastica"] = _ELASTICA_TOLERANCE
    return found


def rotation_error(beam: Beam, length_m: float, orientation: Orientation) -> float:
    """Estimate what small deflections with weight miss of the tip, as a fraction of the length.

    One step of the fixed-point map of the elastica, from the small-deflection angle `theta1`:
    `theta2 = k t + g G[(1 - t) sin(a - theta1)]`. The map contracts by `q = g / 7.84`, the load
    over that at which an upright strip buckles, so the steps to come add about `q / (1 - q)` of it.

    Parameters
    ----------
    beam : of one strip, under voltage
    length_m : as made `[m]`
    orientation : which way gravity pulls

    Returns
    -------
    error of `deflection` and `displacement` at the tip; infinite for a strip with `q >= 1` `[1]`
    """
    stretched = length_m * (1.0 + beam.elongation)
    load = float(weight(beam, orientation) * stretched**3 / beam.bending_stiffness_N_m2)
    contraction = load / SELF_BUCKLING_LOAD
    if contraction >= 1.0:
        return math.inf
    on = grid(_POINTS)
    straight = beam.curvature_per_m * stretched * on.points
    lever = load * (1.0 - on.points)
    small = straight + on.sag @ (lever * np.sin(orientation.angle_rad))
    turned = straight + on.sag @ (lever * np.sin(orientation.angle_rad - small))
    tip_x, tip_y = stretched * tips(turned[None], on)[0]
    missed_x = tip_x - length_m - displacement(beam, length_m, length_m)
    missed_y = tip_y - deflection(beam, length_m, length_m, orientation)
    to_come = np.sqrt((turned - small) ** 2 @ on.weights) * contraction / (1.0 - contraction)
    return float(np.hypot(missed_x, missed_y) / length_m + to_come)


def choose(actuator: Actuator, tolerance: float, aim: Aim = "tip") -> Choice:
    """Take the cheapest rung whose estimated error is within a tolerance, and say why.

    Parameters
    ----------
    actuator : one strip
    tolerance : of the tip in lengths, or of the curvature relative, 1e-9 to 1 `[1]`
    aim : which of the two matters

    Raises
    ------
    OutOfRange : a tolerance outside its range, a voltage above pull-in
    FitRefused : only the elastica will do, and the strip buckles or snaps
    """
    within("tolerance", tolerance, _ELASTICA_TOLERANCE, 1.0, hint="it is a fraction, not percent")
    estimated = errors(actuator, aim)
    rungs = list(estimated)
    rung = next(r for r in rungs if estimated[r] <= tolerance)
    of = "of the length" if aim == "tip" else "of the curvature"
    why = f"'{rung}' is off by about {estimated[rung]:.2g} {of}, within {tolerance:g}"
    below = rungs[rungs.index(rung) - 1]
    if rung == rungs[0]:
        why += "; there is no cheaper rung"
    elif below in _CLOSED_FORMS and math.isinf(estimated[below]):
        why += f"; '{below}' does not describe this stack"
    elif math.isinf(estimated[below]):
        why += f"; '{below}' leaves out {NEGLECTS[below]}, too large to bound"
    else:
        why += f"; '{below}' is off by {estimated[below]:.2g}: it leaves out {NEGLECTS[below]}"
    return Choice(rung, evaluate(actuator, rung), estimated[rung], tuple(estimated.items()), why)


def _alternates(stack: Stack) -> bool:
    roles = [layer.role for layer in stack.layers]
    return roles[0] == "passive" and "de" in roles and set(roles[1:]) <= {"electrode", "de"}


def _merit(actuator: Actuator, rung: Rung) -> float:
    """Return the curvature of a closed form: all films as one, all electrodes as their mean."""
    stack = actuator.stack
    if not _alternates(stack):
        roles = ", ".join(layer.role for layer in stack.layers)
        raise OutOfRange(
            f"'{rung}' describes one passive layer below electrodes and films; the stack is {roles}"
        )
    passive = stack.layers[0]
    films = [layer for layer in stack.layers if layer.role == "de"]
    electrodes = [layer for layer in stack.layers if layer.role == "electrode"]
    film = films[0]
    permittivity, poisson_ratio = film.dielectric()
    where = f"layer {stack.layers.index(film) + 1} (de)"
    s = film_drive(actuator.voltage_V, film.thickness_m, film.modulus_Pa, permittivity, where)
    strain = in_plane_strain(s, poisson_ratio, actuator.in_plane)
    if rung == "planar":
        total = math.fsum(layer.thickness_m for layer in (passive, *films))
        return float(1.5 * strain / total)
    count = max(len(electrodes), 1)
    unimorph = Unimorph(
        passive_thickness_m=passive.thickness_m,
        passive_modulus_Pa=passive.modulus_Pa,
        active_thickness_m=math.fsum(layer.thickness_m for layer in films),
        active_modulus_Pa=film.modulus_Pa,
        electrode_thickness_m=math.fsum(layer.thickness_m for layer in electrodes) / count,
        electrode_modulus_Pa=math.fsum(layer.modulus_Pa for layer in electrodes) / count,
    )
    merit = no_electrodes if rung == "no electrodes" else single_layer
    return float(merit(unimorph, strain))
