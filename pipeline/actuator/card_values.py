"""The values of cards behind a strip: records of one state of the materials, never of two."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deamat.actuator.declared import Designs
from deamat.actuator.request import Where
from deamat.core.errors import MissingProperty, OutOfRange, PipelineError
from deamat.core.records import Condition, PropertyRecord
from deamat.estimators.weibull.area import area_ratio
from deamat.materials.card import MaterialCard
from deamat.materials.correlation import independent_correlation

PERMITTIVITY, STRENGTH, SHAPE = "relative_permittivity", "breakdown_strength", "weibull_shape"

# Conditions that concern one kind of test alone; any other one asks all of them.
_OWN = {
    "rate_per_s": "modulus",
    "window": "modulus",
    "frequency_Hz": PERMITTIVITY,
    "electrode_area_m2": STRENGTH,
    "rate_V_per_s": STRENGTH,
}
_STATE = ("cure", "age")
_NOT_TOGETHER = (
    "the card lists no correlation of breakdown strength and shape: they are drawn independently"
)


class MixedConditions(PipelineError):
    """Values of materials in different states: they do not belong into one actuator."""


@dataclass(frozen=True, slots=True)
class CardValues:
    """The records of cards behind one strip.

    Parameters
    ----------
    film_modulus, permittivity, passive_modulus : records
    strength, shape : of the film's breakdown; None where they are not known, `unknown` says why
    fit_correlation : of their independent errors, as the film's card says it; 0 where it does not
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
    fit_correlation: float = 0.0

    def records(self) -> Iterator[PropertyRecord]:
        """Yield each record that there is once, that of the passive layer last."""
        for record in (self.film_modulus, self.permittivity, self.strength, self.shape):
            if record is not None:
                yield record
        if self.passive_modulus.material != self.film_modulus.material:
            yield self.passive_modulus


def gather(
    film: MaterialCard, passive: MaterialCard, declared: Designs, where: Where
) -> CardValues:
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
    strength, shape, ratio, unknown, together = None, None, 1.0, "", 0.0
    notes: list[str] = []
    try:
        strength = film.record(STRENGTH, **asked[STRENGTH])
        shape = film.record(SHAPE, **asked[STRENGTH])
        ratio, notes = _area_ratio(strength, declared)
        together = independent_correlation(film.correlations, strength, shape)
        if together == 0.0:
            notes.append(_NOT_TOGETHER)
    except (MissingProperty, OutOfRange) as error:
        strength = shape = None
        unknown = str(error)
    found = CardValues(
        film.record(modulus, **asked["modulus"]),
        film.record(PERMITTIVITY, **asked[PERMITTIVITY]),
        passive.record(modulus, **asked["modulus"]),
        strength,
        shape,
        ratio,
        unknown,
        tuple(dict.fromkeys(c.material for c in (film, passive) if c.synthetic)),
        tuple(notes),
        together,
    )
    _one_state(found)
    return found


def _for(kind: str, where: Where) -> dict[str, Condition | None]:
    return {key: value for key, value in where.items() if key not in _OWN or _OWN[key] == kind}


def _area_ratio(strength: PropertyRecord, declared: Designs) -> tuple[float, list[str]]:
    tested = strength.conditions.get("electrode_area_m2")
    limit = strength.area_ratio_limit
    if not isinstance(tested, float) or limit is None:
        return 1.0, ["the breakdown tests state no electrode area: not scaled to that of the strip"]
    ratio = area_ratio(tested, declared.geometry.area_m2, limit)
    return ratio, [f"breakdown scaled to an electrode {ratio:.3g} times as large as the tested one"]


def _one_state(found: CardValues) -> None:
    first, *others = found.records()
    for other in others:
        for key in _STATE:
            a, b = first.conditions.get(key), other.conditions.get(key)
            if a != b:
                raise MixedConditions(
                    f"{key} of {first.key} of {first.material} is {_stated(a)}, of {other.key} of "
                    f"{other.material} {_stated(b)}: a design takes all its values from one state; "
                    f"choose it with --where {key}=..., or test the missing one"
                )


def _stated(value: Condition | None) -> str:
    return "not stated" if value is None else repr(value)
