"""Table 2: viscosity laws, coefficient by coefficient and as curves, and the exponent of D3."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.quantity import Quantity
from deamat.core.records import Law
from deamat.core.units import si_factor
from deamat.materials.card import MaterialCard
from deamat.materials.database import Database
from deamat.report.paper import printed
from deamat.report.paper.entry import Entry
from deamat.report.paper.lookup import ask, is_synthetic, missing, provenance

VISCOSITY, CONSISTENCY, INDEX = "viscosity", "flow_consistency", "flow_index"
POLYNOMIAL, FLUID = "polynomial", "power-law-fluid"
HOURS = (1.0, 12.0)
_STEP_h = 0.05

# How the printed exponent e may be meant, as the index n of a power-law fluid.
READINGS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "e = n": lambda e: e,
    "e = 1 - n": lambda e: 1.0 - e,
    "e = n - 1": lambda e: 1.0 + e,
}
FOOTNOTE = "e = n - 1"
PLAUSIBLE = "e = n"  # drawn where no data tell the readings apart


@dataclass(frozen=True, slots=True)
class Reading:
    """Which reading of the exponent a law of the flow index supports.

    Parameters
    ----------
    material : a composition of Sylgard 186
    name : key of `READINGS`
    off : reading to root mean square distance from the data's n over the hours they share
    index : the data's n at the lowest and highest of these hours
    synthetic : the data are simulated, so that this is the choice of the simulation
    """

    material: str
    name: str
    off: dict[str, float]
    index: tuple[float, float]
    synthetic: bool


def polynomial(coefficients: Sequence[float], hours: FloatArray) -> FloatArray:
    """Evaluate a polynomial, lowest order first."""
    return np.asarray(np.polynomial.polynomial.polyval(hours, np.asarray(coefficients)))


def is_fluid(material: str) -> bool:
    """Say whether Table 2 prints a power-law fluid."""
    return bool(printed.part(f"table2.{material}.law") == "power-law")


def printed_viscosity(
    material: str, hours: FloatArray, rate_per_s: FloatArray, reading: str
) -> FloatArray:
    """Evaluate a law of Table 2 `[Pa.s]`; the rate and the reading count for a power law alone."""
    row = printed.part(f"table2.{material}")
    if not is_fluid(material):
        return polynomial(row["coefficients_low_to_high"], hours)
    index = READINGS[reading](polynomial(row["printed_exponent_low_to_high"], hours))
    factor = polynomial(row["K_low_to_high"], hours)
    return np.asarray(factor * rate_per_s ** (index - 1.0))


def fitted(law: Law, hours: float, rate_per_s: float) -> Quantity:
    """Evaluate a law of the database at a time in hours; the rate where it has one."""
    at = hours * _per_hour(law)
    answer: Callable[..., Quantity] = law
    return answer(at, rate_per_s) if law.kind == FLUID else answer(at)


def hours_of(law: Law) -> tuple[float, float]:
    """Return the hours that a law and Table 2 share."""
    low, high = (end / _per_hour(law) for end in law.valid)
    return max(low, HOURS[0]), min(high, HOURS[1])


def rates_of(law: Law) -> tuple[float, float] | None:
    """Return the shear rates between which a power-law fluid is known `[1/s]`; else None."""
    return law.rates if law.kind == FLUID else None


def rate_for(law: Law | None) -> float:
    """The rate at which laws are compared: the article's, or the nearest that a law knows."""
    nominal = printed.si("text.nominal_shear_rate_per_s")
    known = None if law is None else rates_of(law)
    return nominal if known is None else min(max(nominal, known[0]), known[1])


def _per_hour(law: Law) -> float:
    return si_factor("h")[1] / si_factor(law.argument_unit)[1]


def in_hours(law: Law) -> tuple[FloatArray, FloatArray]:
    """Coefficients and their standard uncertainties of a polynomial law with time in hours."""
    powers = _per_hour(law) ** np.arange(len(law.coefficients))
    u = np.sqrt(np.maximum(np.diagonal(np.asarray(law.covariance)), 0.0))
    return np.asarray(law.coefficients) * powers, u * powers


def reading(database: Database, material: str) -> Reading | str:
    """Find the reading of the exponent that the data support, or say why none is."""

    def question(card: MaterialCard) -> Reading:
        law = card.law(INDEX)
        low, high = hours_of(law)
        hours = np.linspace(low, high, 45)
        n = np.array([fitted(law, float(t), 1.0).value for t in hours])
        e = polynomial(printed.part(f"table2.{material}.printed_exponent_low_to_high"), hours)
        off = {
            name: float(np.sqrt(np.mean(np.square(read(e) - n)))) for name, read in READINGS.items()
        }
        return Reading(
            material,
            min(off, key=off.__getitem__),
            off,
            (float(n[0]), float(n[-1])),
            is_synthetic(card, law.campaign),
        )

    return ask(database, material, question)


def table2(database: Database) -> list[Entry]:
    """Look every law of Table 2 up: one row for the curve, then one for each coefficient."""
    entries = []
    for material in printed.part("table2"):
        entries.append(_curve(database, material))
        if is_fluid(material):
            entries += _coefficients(database, material, "K_low_to_high", CONSISTENCY)
            entries += _exponents(database, material)
        else:
            entries += _coefficients(database, material, "coefficients_low_to_high", VISCOSITY)
    return entries


def _curve(database: Database, material: str) -> Entry:
    """Hold the curves against each other where they differ most."""
    path = f"table2.{material}"
    found_reading = reading(database, material) if is_fluid(material) else ""
    name = found_reading.name if isinstance(found_reading, Reading) else PLAUSIBLE

    def question(card: MaterialCard) -> Entry | str:
        law = card.law(VISCOSITY)
        low, high = hours_of(law)
        if low >= high:
            return f"the law holds outside {HOURS[0]:g} h to {HOURS[1]:g} h"
        rate = rate_for(law)
        hours = np.linspace(low, high, round((high - low) / _STEP_h) + 1)
        then = printed_viscosity(material, hours, np.full_like(hours, rate), name)
        now = [fitted(law, float(t), rate) for t in hours]
        off = np.array([q.value for q in now]) / then - 1.0
        at = int(np.argmax(np.abs(off)))
        how = f"read as {name}, at {rate:.3g} 1/s; " if is_fluid(material) else ""
        return Entry(
            path,
            float(then[at]),
            now[at].value,
            "Pa.s",
            now[at].standard_uncertainty or None,
            f"greatest relative difference of the curves from {low:.3g} h to {high:.3g} h: "
            f"{round(100 * off[at], 1) + 0.0:+.1f} %, at {hours[at]:.2f} h; {how}{law.kind} law; "
            f"{provenance(card, law)}",
            is_synthetic(card, law.campaign),
            law.campaign,
        )

    found = ask(database, material, question)
    return missing(path, found) if isinstance(found, str) else found


def _coefficients(database: Database, material: str, row: str, key: str) -> list[Entry]:
    def question(card: MaterialCard) -> list[Entry]:
        law = card.law(key)
        return _beside(f"table2.{material}.{row}", card, law, *in_hours(law))

    return _rows(database, material, row, question)


def _exponents(database: Database, material: str) -> list[Entry]:
    row = "printed_exponent_low_to_high"
    found = reading(database, material)

    def question(card: MaterialCard) -> list[Entry]:
        law = card.law(INDEX)
        n, u = in_hours(law)
        name = found.name if isinstance(found, Reading) else PLAUSIBLE
        constant = np.eye(1, len(n))[0]
        e = {"e = n": n, "e = 1 - n": constant - n, "e = n - 1": n - constant}[name]
        return _beside(f"table2.{material}.{row}", card, law, e, u, f"read as {name} (D3); ")

    return _rows(database, material, row, question)


def _rows(
    database: Database, material: str, row: str, question: Callable[[MaterialCard], list[Entry]]
) -> list[Entry]:
    found = ask(database, material, question)
    if isinstance(found, str):
        return [missing(path, found) for path, _ in printed.numbers(f"table2.{material}.{row}")]
    return found


def _beside(
    path: str, card: MaterialCard, law: Law, values: FloatArray, u: FloatArray, how: str = ""
) -> list[Entry]:
    entries = []
    degree = len(values) - 1
    if degree >= len(list(printed.numbers(path))):
        how += f"the data support degree {degree}; "
    for i, (place, number) in enumerate(printed.numbers(path)):
        if law.kind != POLYNOMIAL:
            entries.append(missing(place, f"the data support a law of another form: {law.kind}"))
        elif i >= len(values):
            entries.append(
                missing(place, f"the data support degree {degree}; see the row of the curve")
            )
        else:
            entries.append(
                Entry(
                    place, number, float(values[i]), printed.unit(place), float(u[i]) or None,
                    f"{how}{provenance(card, law)}; coefficients of a polynomial are correlated, "
                    "the row of the curve says how far the laws differ",
                    is_synthetic(card, law.campaign), law.campaign,
                )
            )  # fmt: skip
    return entries
