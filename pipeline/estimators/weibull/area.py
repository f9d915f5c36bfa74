"""Breakdown strength on another electrode area: the weakest of many small films.

A film of area A survives when each of its parts does, so E2 = E1 (A1/A2)^(1/shape). That is a law
about flaws of one kind; a limit on the area ratio must be declared by whoever uses it.

Source: IEC 62539; Weibull, Ingeniorsvetenskapsakademiens Handlingar 151 (1939).
"""

from __future__ import annotations

import math

from deamat.core.errors import OutOfRange
from deamat.estimators.weibull.fit import check_parameters


def area_ratio(area_from: float, area_to: float, limit: float) -> float:
    """Return area_to / area_from, if it is within the declared limit.

    With it, `Inference.scale`, `.quantile` and `.failure_probability` give exact intervals on the
    other area, in which shape and scale are uncertain together.

    Parameters
    ----------
    area_from, area_to : area tested and area asked about, both in one unit
    limit : largest ratio allowed, up or down, at least 1

    Raises
    ------
    OutOfRange : an area that is not positive, a limit below 1, or a ratio beyond the limit
    """
    for name, value in (("area_from", area_from), ("area_to", area_to)):
        if not (value > 0 and math.isfinite(value)):
            raise OutOfRange(f"{name} must be above 0 and finite, not {value:g}")
    if not limit >= 1:
        raise OutOfRange(f"the limit on the area ratio must be at least 1, not {limit:g}")
    ratio = area_to / area_from
    if max(ratio, 1.0 / ratio) > limit:
        raise OutOfRange(
            f"areas {area_from:g} and {area_to:g} differ by a factor {max(ratio, 1 / ratio):.3g}; "
            f"the declared limit is {limit:g}: test specimens nearer in area"
        )
    return ratio


def scale_to_area(
    scale: float, shape: float, area_from: float, area_to: float, limit: float
) -> float:
    """Return the scale on another area: E2 = E1 (A1/A2)^(1/shape).

    Parameters
    ----------
    scale, shape : Weibull parameters found on `area_from`
    area_from, area_to, limit : as for `area_ratio`

    Raises
    ------
    OutOfRange : as `area_ratio`, or a scale or shape that is not positive
    """
    check_parameters(scale, shape)
    return scale * math.exp(-math.log(area_ratio(area_from, area_to, limit)) / shape)
