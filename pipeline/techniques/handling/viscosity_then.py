"""The viscosity that a silicone has when its handling time ends, and what that does not mean."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution
from deamat.core.records import Condition, Flag, Law, PropertyRecord, Refusal
from deamat.core.units import from_si
from deamat.techniques.handling.config import VISCOSITY, VISCOSITY_THEN

CAVEAT = Flag(
    "not-one-viscosity",
    "no handling time follows from a viscosity: Sikulskyi et al. 2022, section 2.2.1, found longer "
    "handling at higher viscosity; among the reasons are other strain rates while printing (about "
    "95 1/s, where a viscometer has 0.3 1/s) and viscous heating",
)


def viscosity_then(
    handling: PropertyRecord, laws: Mapping[str, Law], tolerance_K: float
) -> PropertyRecord | Refusal:
    """Evaluate the law of viscosity where lines were last clean and first defective.

    Parameters
    ----------
    handling : record of the handling time, a limit `[s]`
    laws : key to law of the same material and campaign
    tolerance_K : by which bed and viscometer may differ in temperature

    Returns
    -------
    a record that reaches from the viscosity at the last clean line to that at the first defective
    one, each its outer 95 % limit, at the middle of the shear rates of the law `[Pa.s]`; or why
    there is none
    """
    try:
        law = _law(handling, laws, tolerance_K)
        return _record(handling, law)
    except FitRefused as error:
        return Refusal(
            VISCOSITY_THEN, error.reason, handling.material, handling.campaign,
            conditions=handling.conditions, diagnostics=error.diagnostics,
        )  # fmt: skip


def _law(handling: PropertyRecord, laws: Mapping[str, Law], tolerance_K: float) -> Law:
    if VISCOSITY not in laws:
        raise FitRefused(
            "no law of viscosity is known of this material in this campaign, or more than one; "
            "measure its viscosity over time"
        )
    law = laws[VISCOSITY]
    bed = handling.conditions.get("temperature_K")
    liquid = law.temperature_K
    if not isinstance(bed, float) or liquid is None:
        return law
    if abs(bed - liquid) > tolerance_K:
        raise FitRefused(
            f"the bed had {from_si(bed, 'C'):.3g} C and the law of viscosity is of "
            f"{from_si(liquid, 'C'):.3g} C; measure viscosity at the temperature of the bed"
        )
    return law


def _record(handling: PropertyRecord, law: Law) -> PropertyRecord:
    first, last = handling.ci95
    low, high = law.valid
    if not low <= first <= high:
        raise FitRefused(
            f"the handling time, {from_si(first, 'h'):.4g} h, lies outside the law of viscosity, "
            f"{from_si(low, 'h'):.4g} h to {from_si(high, 'h'):.4g} h; measure viscosity as long"
        )
    rate = law.usual_rate
    then = law(first, rate)
    start = law.ci95(first, rate)[0]
    flags = [CAVEAT]
    end = math.inf
    if last <= high:
        end = max(law.ci95(last, rate)[1], start)
    elif math.isfinite(last):
        flags.append(
            Flag(
                "law-ends",
                f"the first defective line, at {from_si(last, 'h'):.4g} h, lies beyond the law of "
                f"viscosity, which ends at {from_si(high, 'h'):.4g} h",
            )
        )
    conditions: dict[str, Condition] = {**handling.conditions, "time_s": first}
    if rate is not None:
        conditions["rate_per_s"] = rate
    where = "" if rate is None else f" at the nominal shear rate {rate:.3g} 1/s"
    return PropertyRecord(
        key=VISCOSITY_THEN,
        material=handling.material,
        campaign=handling.campaign,
        quantity=replace(then, value=start),
        n=handling.n,
        sd=None,
        ci95=(start, end),
        conditions=conditions,
        method=f"law of viscosity ({law.kind}){where}, from the last clean line "
        "to the first defective one, 95 % limits"
        + ("" if math.isfinite(end) else ", which was not seen within the law"),
        budget=(Contribution("law of viscosity", then.standard_uncertainty, shared=False),),
        origins=law.origins,
        flags=(*flags, *(f for f in law.flags if f.name != "falls")),
        bound="interval" if math.isfinite(end) else "lower",
    )
