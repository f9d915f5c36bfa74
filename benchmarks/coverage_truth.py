"""What every value on a card of the twin would be without any error."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import MissingProperty
from deamat.core.properties import REFERENCE_AGE
from deamat.core.records import Condition, PropertyRecord
from deamat.twin.part import Part
from deamat.twin.truth import SECONDS_PER_HOUR, TrueViscosity, true_viscosities

LIMIT_Pas = 3.5  # whose time is asked for: two of the liquids reach it between 1 h and 12 h

# Property keys that no card of the twin carries, and why.
NOT_ON_CARDS = {
    "breakdown_field": "of one specimen; the card of a material holds the Weibull distribution",
    "mass_density": "no technique measures it",
    "viscosity_against_temperature": "the liquids of the twin are measured at one temperature",
    "tensile_modulus_toe_compensated": "only of strips that hang loose; none of the twin does, and "
    "of the few that are taken to the truth is that of the plain modulus",
}
_SISTERS = {"tensile_modulus_toe_compensated": "tensile_modulus"}

_LAST_S, _EVERY_S = 24.0 * SECONDS_PER_HOUR, 1.0
_OF_LIQUIDS = frozenset(
    {
        "viscosity",
        "viscosity_at_printing_rate",
        "viscosity_doubling_time",
        "time_to_viscosity_limit",
        "flow_consistency",
        "flow_consistency_wide_cup",
        "flow_index",
    }
)

# key, material, age or None, temperature or None
Place = tuple[str, str, Condition | None, Condition | None]


def table_of(parts: Iterable[Part]) -> dict[Place, float]:
    """Index what the parts of a campaign say of their materials; liquids answer by their laws."""
    return {
        (v.key, v.material, None if v.temperature_K else v.age, v.temperature_K): v.value
        for part in parts
        for v in part.truth
        if v.key not in _OF_LIQUIDS
    }


def truth_of(record: PropertyRecord, table: Mapping[Place, float]) -> float:
    """Return the true value of a record.

    Raises
    ------
    MissingProperty : nobody has said what it is
    """
    if record.key == "viscosity_at_handling_time":
        return _when_handled(record, table)
    if record.key in _OF_LIQUIDS:
        return _of_liquid(true_viscosities()[record.material], record.key, record.conditions)
    bed = record.conditions.get("temperature_K")
    age = None if bed else record.conditions.get("age", REFERENCE_AGE)
    try:
        return table[_SISTERS.get(record.key, record.key), record.material, age, bed]
    except KeyError:
        raise MissingProperty(
            f"the twin tells no truth of {record.key} of {record.material} "
            f"({dict(record.conditions)}); let its part state one"
        ) from None


def _when_handled(record: PropertyRecord, table: Mapping[Place, float]) -> float:
    bed, rate = record.conditions["temperature_K"], record.conditions.get("rate_per_s", 1.0)
    time_s = table["handling_time", record.material, None, bed]
    return viscosity_at(true_viscosities()[record.material], time_s, float(str(rate)))


def _of_liquid(law: TrueViscosity, key: str, conditions: Mapping[str, Condition]) -> float:
    rate = float(str(conditions.get("rate_per_s", 1.0)))
    if key == "time_to_viscosity_limit":
        return _time_of(law, LIMIT_Pas, rate, 0.0)
    time_s = float(str(conditions["time_s"]))
    if key == "viscosity_doubling_time":
        return _time_of(law, 2.0 * viscosity_at(law, time_s, rate), rate, time_s)
    return liquid_at(law, key, time_s, rate)


def liquid_at(law: TrueViscosity, key: str, time_s: float, rate_per_s: float) -> float:
    """Return viscosity, K, n or K n^n of a liquid at a time.

    Raises
    ------
    MissingProperty : another key
    """
    hours = time_s / SECONDS_PER_HOUR
    if key in ("viscosity", "viscosity_at_printing_rate"):
        return viscosity_at(law, time_s, rate_per_s)
    k = float(np.polynomial.polynomial.polyval(hours, law.consistency))
    n = float(np.polynomial.polynomial.polyval(hours, law.index))
    flow: dict[str, float] = {
        "flow_consistency": k,
        "flow_index": n,
        "flow_consistency_wide_cup": k * n**n,
    }
    if key not in flow:
        raise MissingProperty(f"{key} is no property of a liquid at one time")
    return flow[key]


def viscosity_at(law: TrueViscosity, time_s: float, rate_per_s: float) -> float:
    """Return the viscosity at a time and a nominal shear rate `[Pa.s]`."""
    return float(law(np.array([time_s]), np.array([rate_per_s]))[0])


def _time_of(law: TrueViscosity, viscosity_Pas: float, rate_per_s: float, start_s: float) -> float:
    """First time at which the viscosity is reached `[s]`, between the points of a fine grid."""
    times = np.arange(start_s, _LAST_S, _EVERY_S)
    values: FloatArray = law(times, np.full(times.size, rate_per_s))
    at = int(np.argmax(values >= viscosity_Pas))
    if at == 0:
        raise MissingProperty(f"{law.material} does not rise to {viscosity_Pas:g} Pa.s in 24 h")
    part = (viscosity_Pas - values[at - 1]) / (values[at] - values[at - 1])
    return float(times[at - 1] + _EVERY_S * part)
