"""Calibrations of machines and gauges: one error each, with a day on which it was found small."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping, Sequence
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from deamat.core.declared import Declared

Covered = Literal["force", "displacement", "voltage", "impedance", "torque", "length"]


class Calibration(Declared):
    """`[calibrations.ID]`: what a certificate says; whatever names it shares its error."""

    date: dt.date
    valid_until: dt.date | None = Field(default=None, description="last day on which it holds")
    valid_days: int | None = Field(default=None, gt=0, description="for so many days, instead")
    covers: tuple[Covered, ...] = Field(
        min_length=1, description="what of the machine; `length` for a gauge"
    )
    u_relative: float | None = Field(
        default=None,
        ge=0,
        description="standard, in place of what the machine declares; of torque, of full scale",
    )
    certificate: str = Field(min_length=3, description="number of the certificate, or the source")

    @model_validator(mode="after")
    def _ends_once(self) -> Self:
        if (self.valid_until is None) == (self.valid_days is None):
            raise ValueError("a calibration says either valid_until or valid_days")
        if self.last_day < self.date:
            raise ValueError(f"it ends on {self.last_day}, before its date, {self.date}")
        if "impedance" in self.covers and self.u_relative is not None:
            raise ValueError("what an LCR meter is good for stands in its [...impedance]")
        if "length" in self.covers and self.u_relative is not None:
            raise ValueError("what a gauge is good for stands in its u_calibration_m")
        return self

    @property
    def last_day(self) -> dt.date:
        """Last day on which it holds."""
        if self.valid_until is not None:
            return self.valid_until
        return self.date + dt.timedelta(days=self.valid_days or 0)

    @property
    def validity(self) -> str:
        """Its first and last day in words."""
        return f"{self.date} to {self.last_day}"


def _one_or_several(given: object) -> object:
    return (given,) if isinstance(given, str) else given


# One id, or several of which the day of the test chooses.
CalibrationIds = Annotated[tuple[str, ...], BeforeValidator(_one_or_several)]


def held_on(
    day: dt.date | None, ids: Sequence[str], calibrations: Mapping[str, Calibration]
) -> dict[Covered, str]:
    """Return the calibration that held on a day, for each quantity that these cover.

    The last one made until then; before the first, or without a day, the first or the last one:
    `consistency.calibrations` flags that.
    """
    held: dict[Covered, str] = {}
    for name in sorted(ids, key=lambda one: (calibrations[one].date, one)):
        for covered in calibrations[name].covers:
            if covered not in held or day is None or calibrations[name].date <= day:
                held[covered] = name
    return held
