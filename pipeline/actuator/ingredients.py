"""What a design takes from cards: records of one state of the materials, never of two."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from deamat.actuator.declared import Designs, Electrode
from deamat.actuator.strip import Strip
from deamat.actuator.uncertainty import Input
from deamat.core.errors import MissingProperty, OutOfRange, PipelineError
from deamat.core.quantity import Contribution
from deamat.core.records import Condition, PropertyRecord
from deamat.core.units import to_si
from deamat.estimators.weibull.area import area_ratio
from deamat.materials.card import MaterialCard

PERMITTIVITY, STRENGTH, SHAPE = "relative_permittivity", "breakdown_strength", "weibull_shape"

Where = Mapping[str, Condition | None]

# Conditions that concern one kind of test alone; any other one asks all of them.
_OWN = {
    "rate_per_s": "modulus",
    "window": "modulus",
    "frequency_Hz": PERMITTIVITY,
    "electrode_area_m2": STRENGTH,
    "rate_V_per_s": STRENGTH,
}
_STATE = ("cure", "age")

# Scale and shape of one Weibull fit err together. In large complete samples the correlation of
# ln(scale) and shape is 0.2570 / sqrt(1.1087 x 0.6079) = 0.313 (Lawless, chapter 5).
_JOINT = {STRENGTH: 1.0, SHAPE: 0.313}


class MixedConditions(PipelineError):
    """Values of materials in different states: they do not belong into one actuator."""


@dataclass(frozen=True, slots=True)
class Ingredients:
    """The records behind one strip.

    Parameters
    ----------
    film_modulus, permittivity, passive_modulus : records
    strength, shape : of the film's breakdown; None where they are not known, `unknown` says why
    area_ratio : electrode area of the strip over that of the breakdown tests `[1]`
    synthetic : materials whose card is simulated
    notes : what a reader must know
    """

    film_modulus: PropertyRecord
    permittivity: PropertyRecord
    passive_modulus: PropertyRecord
    strength: PropertyRecord | None
    shape: PropertyRecord | None
    area_ratio: float
    unknown: str
    synthetic: tuple[str, ...]
    notes: tuple[str, ...]

    def records(self) -> Iterator[PropertyRecord]:
        """Give each record that there is once, that of the passive layer last."""
        for record in (self.film_modulus, self.permittivity, self.strength, self.shape):
            if record is not None:
                yield record
        if self.passive_modulus.material != self.film_modulus.material:
            yield self.passive_modulus


def gather(
    film: MaterialCard, passive: MaterialCard, declared: Designs, where: Where
) -> Ingredients:
    """Take from two cards what a strip needs, all of it in one state of cure and age.

    Parameters
    ----------
    film, passive : cards of the film and of the passive layer; may be the same
    declared : which modulus enters, and how large the strip is
    where : conditions as for `MaterialCard.record`; those of one kind of test concern it alone

    Raises
    ------
    MissingProperty : a card lacks the modulus or the permittivity, or has several under `where`
    MixedConditions : two records differ in cure or age, or one does not state it
    """
    modulus = declared.model.modulus
    asked = {key: _for(key, where) for key in ("modulus", PERMITTIVITY, STRENGTH)}
    strength, shape, ratio, unknown = None, None, 1.0, ""
    notes: list[str] = []
    try:
        strength = film.record(STRENGTH, **asked[STRENGTH])
        shape = film.record(SHAPE, **asked[STRENGTH])
        ratio, said = _area_ratio(strength, declared)
        notes += said
    except (MissingProperty, OutOfRange) as error:
        strength = shape = None
        unknown = str(error)
    found = Ingredients(
        film.record(modulus, **asked["modulus"]),
        film.record(PERMITTIVITY, **asked[PERMITTIVITY]),
        passive.record(modulus, **asked["modulus"]),
        strength,
        shape,
        ratio,
        unknown,
        tuple(dict.fromkeys(c.material for c in (film, passive) if c.synthetic)),
        tuple(notes),
    )
    _one_state(found)
    return found


def strip_of(
    found: Ingredients,
    declared: Designs,
    electrode: Electrode,
    film_thickness_m: float,
    passive_thickness_m: float,
) -> Strip:
    """Put values of cards and declared facts together."""
    return Strip(
        film_modulus_Pa=found.film_modulus.quantity.value,
        relative_permittivity=found.permittivity.quantity.value,
        poisson_ratio=declared.elastomer.poisson_ratio,
        film_thickness_m=film_thickness_m,
        passive_modulus_Pa=found.passive_modulus.quantity.value,
        passive_thickness_m=passive_thickness_m,
        electrode_modulus_Pa=to_si(electrode.youngs_modulus_MPa, "MPa"),
        electrode_thickness_m=to_si(electrode.thickness_um, "um"),
        in_plane=declared.model.in_plane,
        breakdown_strength_V_m=found.strength.quantity.value if found.strength else None,
        weibull_shape=found.shape.quantity.value if found.shape else None,
    )


def inputs_of(
    found: Ingredients, strip: Strip, declared: Designs, electrode: Electrode, *, breakdown: bool
) -> tuple[Input, ...]:
    """List the uncertain numbers of a strip; one material in two layers is one input.

    Parameters
    ----------
    breakdown : the prediction depends on scale and shape of the breakdown, too
    """
    inputs = [_measured(found.film_modulus, "film_modulus_Pa")]
    if found.passive_modulus.material == found.film_modulus.material:
        inputs[0] = replace(inputs[0], drives=("film_modulus_Pa", "passive_modulus_Pa"))
    else:
        inputs.append(_measured(found.passive_modulus, "passive_modulus_Pa"))
    inputs.append(_measured(found.permittivity, "relative_permittivity"))
    if breakdown and found.strength and found.shape:
        inputs.append(_measured(found.strength, "breakdown_strength_V_m"))
        inputs.append(_measured(found.shape, "weibull_shape"))
    spread = declared.tolerances
    for layer, field, u_um in (
        ("de layer", "film_thickness_m", spread.u_de_thickness_um),
        ("passive layer", "passive_thickness_m", spread.u_passive_thickness_um),
        ("electrodes", "electrode_thickness_m", spread.u_electrode_thickness_um),
    ):
        inputs.append(_declared(f"thickness of the {layer}", field, strip, "m", to_si(u_um, "um")))
    u_MPa = electrode.u_youngs_modulus_MPa
    u = None if u_MPa is None else to_si(u_MPa, "MPa")
    inputs.append(_declared("modulus of the electrodes", "electrode_modulus_Pa", strip, "Pa", u))
    inputs.append(_declared("Poisson's ratio", "poisson_ratio", strip, "1", None))
    return tuple(inputs)


def _for(kind: str, where: Where) -> dict[str, Condition | None]:
    return {key: value for key, value in where.items() if key not in _OWN or _OWN[key] == kind}


def _measured(record: PropertyRecord, field: str) -> Input:
    technique = record.origins[0].technique.partition("@")[0] if record.origins else record.key
    name = f"{record.key} of {record.material}"
    test = f"{technique} of {record.material}"
    lines = record.budget or (
        Contribution("independent", record.quantity.u_independent, False),
        Contribution("shared", record.quantity.u_shared, True),
    )
    # One error of a campaign's technique, whichever materials it tested
    told = []
    for c in lines:
        if c.shared:
            told.append(replace(c, source=f"{c.source} of {technique} in {record.campaign}"))
        elif record.key in _JOINT:
            told += _joint(c, test, _JOINT[record.key])
        else:
            told.append(replace(c, source=f"{c.source} of {name}"))
    q = record.quantity
    return Input(name, (field,), q.value, q.unit, tuple(told), test, record.n)


def _joint(line: Contribution, test: str, correlation: float) -> list[Contribution]:
    """Split an error of a fit into the part that scale and shape share, and a rest of its own."""
    own = math.sqrt(1.0 - correlation**2) * line.u
    return [
        replace(line, source=f"fit of {test}", u=correlation * line.u),
        replace(line, source=f"fit of {test}, shape alone", u=own),
    ]


def _declared(name: str, field: str, strip: Strip, unit: str, u: float | None) -> Input:
    budget = () if u is None else (Contribution(f"declared {name}", u, True),)
    return Input(name, (field,), float(getattr(strip, field)), unit, budget)


def _area_ratio(strength: PropertyRecord, declared: Designs) -> tuple[float, list[str]]:
    size = declared.geometry
    area_m2 = to_si(size.length_mm, "mm") * to_si(size.width_mm, "mm")
    tested = strength.conditions.get("electrode_area_m2")
    if not isinstance(tested, float) or "area_ratio_limit" not in strength.diagnostics:
        return 1.0, ["the breakdown tests state no electrode area: not scaled to that of the strip"]
    limit = float(strength.diagnostics["area_ratio_limit"])
    ratio = area_ratio(tested, area_m2, limit)
    return ratio, [f"breakdown scaled to an electrode {ratio:.3g} times as large as the tested one"]


def _one_state(found: Ingredients) -> None:
    first, *others = found.records()
    for other in others:
        for key in _STATE:
            a, b = first.conditions.get(key), other.conditions.get(key)
            if a != b:
                raise MixedConditions(
                    f"{key} of {first.key} of {first.material} is {_said(a)}, of {other.key} of "
                    f"{other.material} {_said(b)}: a design takes all its values from one state; "
                    f"choose it with --where {key}=..., or test the missing one"
                )


def _said(value: Condition | None) -> str:
    return "not stated" if value is None else repr(value)
