"""What a reduction ends in: a value with its lines and budget, or a refusal with its reason."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeVar

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.records import Condition, Measurement, Refusal, Result

R = TypeVar("R", bound=Result)


def recorded(recording: Recording | None) -> Recording:
    """Insist on a recording.

    Raises
    ------
    FitRefused : there is none
    """
    if recording is None:
        raise FitRefused("the register names no data file for this specimen; fill in `file`")
    return recording


def line_span(source: Source, rows: int, first: int, last: int) -> tuple[int, int]:
    """Return the lines of the file that hold samples `first` to `last`.

    Where data rows and lines do not run in step (blank lines between them), the whole span of the
    data is the only certain answer.
    """
    if source.last_line - source.first_line + 1 != rows:
        return source.first_line, source.last_line
    return source.first_line + first, source.first_line + last


def relative_lines(value: float, budget: Iterable[Contribution]) -> tuple[Contribution, ...]:
    """Turn relative lines of a budget into those of the value; lines of nothing are left out."""
    return tuple(c.scaled(value) for c in budget if c.u > 0.0)


def refusal(
    specimen: Specimen, key: str, error: FitRefused, conditions: Mapping[str, Condition]
) -> Refusal:
    """Turn an estimator's refusal into one of this specimen's property."""
    return Refusal(
        key,
        error.reason,
        specimen.material,
        specimen.campaign,
        specimen.id,
        {**specimen.conditions, **conditions},
        diagnostics=error.diagnostics,
        selective=error.selective,
    )


def nothing_measured(
    specimen: Specimen,
    keys: Iterable[str],
    error: FitRefused,
    recording: Recording | None,
    result: R | None = None,
) -> Measurement[R]:
    """Refuse every property of a specimen; a result is kept where it shows why."""
    return Measurement(
        specimen,
        (),
        tuple(refusal(specimen, key, error, {}) for key in keys),
        result,
        None if recording is None else recording.source,
    )
