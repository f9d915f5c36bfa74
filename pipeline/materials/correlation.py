"""What two values err alike: errors that they share, by calibration or by test."""

from __future__ import annotations

import math

from deamat.core.quantity import Contribution
from deamat.core.records import PropertyRecord


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
    theirs: dict[str, float] = {}
    for line in other.budget:
        if line.shared:
            cause = cause_of(line, other)
            theirs[cause] = theirs.get(cause, 0.0) + line.signed_u
    return math.fsum(
        line.signed_u * theirs.get(cause_of(line, one), 0.0) for line in one.budget if line.shared
    )
