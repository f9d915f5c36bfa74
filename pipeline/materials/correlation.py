"""Values that err together: by a calibration, a test, a fit or specimens that both rest on."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations

from deamat.core.card_lists import Correlation, JointFit
from deamat.core.errors import MissingProperty
from deamat.core.quantity import Contribution
from deamat.core.records import Condition, PropertyRecord

_Side = tuple[str, str, Mapping[str, Condition]]

_LEAST = 0.01  # a weaker one is not listed
_FEWEST = 4  # specimens from which their scatter tells a correlation
_SIGNIFICANCE = 0.01
_SAME_STATE_K = 5.0
_STATE = ("age", "cure", "electrode", "electrode_area_m2", "rate_V_per_s")
_SAID = 3  # shared errors that a reason names


def technique_of(record: PropertyRecord) -> str:
    """Return the technique that measured a value."""
    return record.origins[0].technique if record.origins else record.key


def cause_of(line: Contribution, record: PropertyRecord) -> str:
    """Name the error behind a shared line: lines of one name are one error, in whichever values.

    That of a calibration is the same in all campaigns and techniques that name it; without one it
    is that of a technique's campaign, whichever materials it tested.
    """
    if line.calibration is not None:
        return f"{line.calibrated} by {line.calibration}"
    return f"{line.source} of {technique_of(record)} in {record.campaign}"


def shared_covariance(one: PropertyRecord, other: PropertyRecord) -> float:
    """Return the covariance of two values by the errors that they share, in their units."""
    return math.fsum(u for _, u in _shared(one, other))


def _shared(one: PropertyRecord, other: PropertyRecord) -> list[tuple[str, float]]:
    """Name each error that two values share, with its part of their covariance."""
    theirs: dict[str, float] = {}
    for line in other.budget:
        if line.shared:
            cause = cause_of(line, other)
            theirs[cause] = theirs.get(cause, 0.0) + line.signed_u
    return [
        (line.calibration or line.source, line.signed_u * theirs[cause])
        for line in one.budget
        if line.shared and (cause := cause_of(line, one)) in theirs
    ]


def correlation(
    one: PropertyRecord, other: PropertyRecord, fits: Iterable[JointFit] = ()
) -> tuple[float, str]:
    r"""Return the correlation of two values, and why they err together.

    $$ r = \frac{r_\mathrm{ind} u_\mathrm{ind} u'_\mathrm{ind} + \sum \pm u_i u'_i}{u u'} $$

    over the errors that they share, with the sign of the values' answer to each. The independent
    parts correlate by the fit that both come from, or as the values of the same specimens do, from
    four on, where that is told from zero at 1 %: five independent pairs often show 0.8.

    Parameters
    ----------
    one, other : values of one material or of several
    fits : estimates that come of one fit each

    Source: JCGM 100:2008 (GUM), 5.2.2 and F.1.2; JCGM 102:2011, 5.3.2.
    """
    independent, why = _independent(one, other, fits)
    shared = _shared(one, other)
    reasons = [why] if why else []
    strongest = sorted(shared, key=lambda named: -abs(named[1]))
    names = list(dict.fromkeys(name for name, part in strongest if part))[:_SAID]
    if names:
        reasons.append(f"both rest on {' and '.join(names)}")
    u = one.quantity.standard_uncertainty * other.quantity.standard_uncertainty
    if u == 0.0:
        return 0.0, ""
    own = independent * one.quantity.u_independent * other.quantity.u_independent
    found = (own + math.fsum(part for _, part in shared)) / u
    return max(-1.0, min(1.0, found)), "; ".join(reasons)


def _independent(
    one: PropertyRecord, other: PropertyRecord, fits: Iterable[JointFit]
) -> tuple[float, str]:
    """Correlate the independent parts of two values."""
    for fit in fits:
        if fit.holds(one) and fit.holds(other):
            places = fit.keys.index(one.key), fit.keys.index(other.key)
            return fit.correlations[places[0]][places[1]], fit.why
    if (one.campaign, technique_of(one)) != (other.campaign, technique_of(other)):
        return 0.0, ""
    theirs = {origin.specimen: origin.value for origin in other.origins}
    pairs = [(o.value, theirs[o.specimen]) for o in one.origins if o.specimen in theirs]
    counted = len(pairs) == len(one.origins) == len(other.origins) == one.n == other.n
    if not counted or len(pairs) < _FEWEST or any(len(r.budget) == 0 for r in (one, other)):
        return 0.0, ""
    r = _pearson(pairs)
    if not _told_from_zero(r, len(pairs)):
        return 0.0, ""
    return r, f"the values of the same {len(pairs)} specimens correlate by {r:.2f}"


def _told_from_zero(r: float, n: int) -> bool:
    """Hold a correlation of n pairs against what independent ones show: Student's t, 1 %."""
    from scipy.special import stdtrit  # whoever reads a card must not pay for it

    critical = float(stdtrit(n - 2, 1.0 - 0.5 * _SIGNIFICANCE))
    return r * r * (n - 2) > critical**2 * (1.0 - r * r)


def _pearson(pairs: Sequence[tuple[float, float]]) -> float:
    means = [math.fsum(column) / len(pairs) for column in zip(*pairs, strict=True)]
    apart = [(x - means[0], y - means[1]) for x, y in pairs]
    xx, yy, xy = (
        math.fsum(products)
        for products in zip(*((x * x, y * y, x * y) for x, y in apart), strict=True)
    )
    return xy / math.sqrt(xx * yy) if xx > 0.0 and yy > 0.0 else 0.0


def correlations_of(
    records: Sequence[PropertyRecord], fits: Sequence[JointFit]
) -> tuple[Correlation, ...]:
    """List the pairs of a card's values that err together, those of one state of the material.

    Values of one property under several conditions are not listed within one campaign, nor are
    coefficients below 0.01.
    """
    found = []
    for one, other in combinations(records, 2):
        if not _belong_together(one, other):
            continue
        coefficient, why = correlation(one, other, fits)
        if abs(coefficient) >= _LEAST:
            found.append(
                Correlation(
                    key=one.key,
                    material=one.material,
                    campaign=one.campaign,
                    conditions=_telling(one, records),
                    other_key=other.key,
                    other_campaign=other.campaign,
                    other_conditions=_telling(other, records),
                    coefficient=float(f"{coefficient:.4g}"),
                    why=why,
                )
            )
    return tuple(found)


def _belong_together(one: PropertyRecord, other: PropertyRecord) -> bool:
    if one.key == other.key and one.campaign == other.campaign:
        return False
    for name in _STATE:
        stated = [r.conditions[name] for r in (one, other) if name in r.conditions]
        if len(stated) == 2 and stated[0] != stated[1]:
            return False
    kelvin = [t for r in (one, other) if isinstance(t := r.conditions.get("temperature_K"), float)]
    return len(kelvin) < 2 or abs(kelvin[0] - kelvin[1]) <= _SAME_STATE_K


def _telling(record: PropertyRecord, records: Sequence[PropertyRecord]) -> dict[str, Condition]:
    """Return the conditions that tell a value from the others of its key and campaign."""
    alike = [r.conditions for r in records if (r.key, r.campaign) == (record.key, record.campaign)]
    return {
        name: value
        for name, value in record.conditions.items()
        if any(other.get(name) != value for other in alike)
    }


def coefficient_of(
    listed: Iterable[Correlation], one: PropertyRecord, other: PropertyRecord
) -> float:
    """Return the coefficient that a card lists for two of its values; 0 for a pair that it lacks.

    Raises
    ------
    MissingProperty : values of two materials, of which no card lists anything
    """
    if one.material != other.material:
        raise MissingProperty(f"{one.material} and {other.material} are two materials")
    for pair in listed:
        for first, second in _both_ways(pair):
            if _is(one, *first) and _is(other, *second):
                return pair.coefficient
    return 0.0


def partners(
    listed: Iterable[Correlation], record: PropertyRecord
) -> Iterator[tuple[str, Mapping[str, Condition], Correlation]]:
    """Yield key and telling conditions of each value that errs together with one, and the pair."""
    for pair in listed:
        for first, (key, _, conditions) in _both_ways(pair):
            if _is(record, *first):
                yield key, conditions, pair


def _both_ways(pair: Correlation) -> tuple[tuple[_Side, _Side], tuple[_Side, _Side]]:
    one = pair.key, pair.campaign, pair.conditions
    other = pair.other_key, pair.other_campaign, pair.other_conditions
    return (one, other), (other, one)


def _is(
    record: PropertyRecord, key: str, campaign: str, conditions: Mapping[str, Condition]
) -> bool:
    return (record.key, record.campaign) == (key, campaign) and all(
        record.conditions.get(name) == value for name, value in conditions.items()
    )


def independent_correlation(
    listed: Iterable[Correlation], one: PropertyRecord, other: PropertyRecord
) -> float:
    """Return what a card's coefficient leaves for the independent parts, without shared errors."""
    own = one.quantity.u_independent * other.quantity.u_independent
    u = one.quantity.standard_uncertainty * other.quantity.standard_uncertainty
    coefficient = coefficient_of(listed, one, other)
    if own == 0.0 or coefficient == 0.0:
        return 0.0
    return max(-1.0, min(1.0, (coefficient * u - shared_covariance(one, other)) / own))
