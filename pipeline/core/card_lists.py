"""What a card lists beside its values: exclusions, calibrations, and what errs together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, ClassVar

from deamat.core.kinds import (
    COEFFICIENT,
    CONDITIONS_KIND,
    ID,
    LINE,
    PROPERTY_KEY,
    SAID,
    UNCERTAINTY,
    Condition,
    array,
)
from deamat.core.schema import Entry, Mark

if TYPE_CHECKING:
    from deamat.core.records import PropertyRecord


@dataclass(frozen=True, slots=True)
class Excluded:
    """A specimen that was left out on purpose, and why."""

    ENTRY: ClassVar = Entry(
        "exclusion",
        "exclusions",
        "A specimen that was left out on purpose: it is in no value.",
        identity=("material", "campaign", "technique", "specimen"),
    )

    campaign: Annotated[str, ID]
    technique: Annotated[str, SAID]
    specimen: Annotated[str, ID]
    reason: Annotated[str, SAID, "As `config/exclusions.toml` says it."]
    material: Annotated[str, Mark.OF_THE_CARD]
    register: Annotated[str, SAID, "Register, relative to raw/."]
    register_line: Annotated[int, LINE]
    path: Annotated[str | None, "Raw file, relative to raw/; left out if it has none."] = None

    @property
    def place(self) -> str:
        """How exclusions and messages name it: `campaign/technique/specimen`."""
        return f"{self.campaign}/{self.technique}/{self.specimen}"


@dataclass(frozen=True, slots=True)
class CalibrationRecord:
    """A calibration that values of a card rest on, as `config/instruments.toml` declares it."""

    ENTRY: ClassVar = Entry(
        "calibration",
        "calibrations",
        "A calibration of a machine or a gauge: one error, shared by all values that name it.",
        identity=("material", "calibration"),
    )

    calibration: Annotated[str, ID]
    date: Annotated[str, SAID, "Day on which it was made, as YYYY-MM-DD."]
    valid_until: Annotated[str, SAID, "Last day on which it holds, as YYYY-MM-DD."]
    covers: Annotated[tuple[str, ...], array(SAID, 1), "What of the machine or gauge."]
    certificate: Annotated[str, SAID, "Number of the certificate, or the source."]
    u_relative: Annotated[
        float | None,
        UNCERTAINTY,
        "Relative standard uncertainty. Left out where the machine or gauge declares it.",
    ] = None


@dataclass(frozen=True, slots=True)
class JointFit:
    """Values that are estimates of one fit, and err together.

    Parameters
    ----------
    keys, campaign, conditions : which values
    correlations : of their independent errors, row by row in the order of the keys `[1]`
    why : what fit, in words
    """

    keys: tuple[str, ...]
    campaign: str
    conditions: Mapping[str, Condition]
    correlations: tuple[tuple[float, ...], ...]
    why: str

    def holds(self, record: PropertyRecord) -> bool:
        """Say whether a value is one of its estimates."""
        return (
            record.key in self.keys
            and record.campaign == self.campaign
            and record.conditions == self.conditions
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Correlation:
    """Two values of a card that do not err independently of each other."""

    ENTRY: ClassVar = Entry(
        "correlation",
        "correlations",
        "Two values that do not err independently: to be drawn jointly where both are used.",
    )

    key: Annotated[str, PROPERTY_KEY, Mark.IN_FRONT, "Property key of the one."]
    material: Annotated[str, Mark.OF_THE_CARD]
    campaign: Annotated[str, ID, "Campaign of the one."]
    conditions: Annotated[
        Mapping[str, Condition],
        CONDITIONS_KIND,
        "Conditions that tell the one from the others of its key and campaign.",
    ]
    other_key: Annotated[str, PROPERTY_KEY, Mark.IN_FRONT, "Property key of the other."]
    other_campaign: Annotated[str, ID]
    other_conditions: Annotated[Mapping[str, Condition], CONDITIONS_KIND]
    coefficient: Annotated[
        float,
        COEFFICIENT,
        "Correlation of their errors, shared ones included.",
    ]
    why: Annotated[str, SAID, "The fit, the specimens or the calibrations that both rest on."]
