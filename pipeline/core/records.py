"""The nouns of the pipeline, in the order in which data flow: from Measurement to Summary."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, ClassVar, Generic, Literal, Protocol

import numpy as np
from typing_extensions import TypeVar  # with a default, which typing has from Python 3.13 on

from deamat.core.arrays import FloatArray
from deamat.core.card_lists import JointFit
from deamat.core.errors import OutOfRange
from deamat.core.flags import Flag as Flag  # one of the nouns, though declared there
from deamat.core.kinds import (
    COUNT,
    ID,
    INTERVAL,
    LINE,
    NUMBER,
    PROPERTY_KEY,
    SAID,
    SHA256,
    UNCERTAINTY,
    UNIT,
    array,
)
from deamat.core.kinds import Condition as Condition  # two of the nouns, though declared there
from deamat.core.kinds import Detail as Detail
from deamat.core.laws import evaluate
from deamat.core.properties import property_key
from deamat.core.quantity import Contribution, Quantity
from deamat.core.recording import Source, Specimen
from deamat.core.schema import After, Entry, Mark

if TYPE_CHECKING:
    import lmfit

# What the value of a record is: an estimate, or only a limit of what was seen to hold.
Bound = Literal["exact", "interval", "lower"]


@dataclass(frozen=True, slots=True)
class MeasuredValue:
    """One property of one specimen.

    Parameters
    ----------
    key : property key
    quantity : value with uncertainty; `budget` lists where that comes from
    method : estimator and window in words
    conditions : what the technique itself fixes (window, rate)
    bound : "lower" where the truth is only known to exceed the value
    degrees_of_freedom : of its independent uncertainty; infinite where that counts as known
    lines : first and last line of the file that the value rests on, None without a file
    diagnostics : numbers worth keeping (samples in the window, r, slope per bin)
    """

    key: str
    quantity: Quantity
    budget: tuple[Contribution, ...]
    method: str
    conditions: Mapping[str, Condition] = field(default_factory=dict)
    lines: tuple[int, int] | None = None
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)
    flags: tuple[Flag, ...] = ()
    bound: Literal["exact", "lower"] = "exact"
    degrees_of_freedom: float = math.inf


@dataclass(frozen=True, slots=True)
class Refusal:
    """A value that was asked for and not given, and why."""

    ENTRY: ClassVar = Entry("refusal", "refusals")

    key: Annotated[str, PROPERTY_KEY]
    reason: Annotated[str, SAID, "Why, and what would make the value acceptable."]
    material: Annotated[str, Mark.OF_THE_CARD]
    campaign: Annotated[str, ID]
    specimen: Annotated[str | None, Mark.ALWAYS, "Null if all specimens together were refused."] = (
        None
    )
    conditions: Mapping[str, Condition] = field(default_factory=dict)
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)
    selective: Annotated[
        bool,
        "Refused for its size (a slope within its noise), so that the mean of the specimens that "
        "were not is biased. Left out where it is false.",
    ] = False


class Result(Protocol):
    """What a technique makes of one specimen, in typed fields of its own."""

    @property
    def columns(self) -> Mapping[str, FloatArray]:
        """Reduced curve by name with unit (`nominal_stress_Pa`), shape (n,) each; {} for none."""


R_co = TypeVar("R_co", bound=Result, covariant=True, default=Result)


@dataclass(frozen=True, slots=True)
class Measurement(Generic[R_co]):
    """What one specimen gave: values, refusals, and the result behind them.

    Parameters
    ----------
    result : what `summarise` and `figure` of the same technique go by; None where nothing came of
        the specimen, and kept beside a refusal where it shows why
    """

    specimen: Specimen
    values: tuple[MeasuredValue, ...]
    refusals: tuple[Refusal, ...] = ()
    result: R_co | None = None
    source: Source | None = None

    @property
    def curve(self) -> Mapping[str, FloatArray]:
        """Columns of the result, as `curves.h5` keeps them."""
        return {} if self.result is None else self.result.columns


@dataclass(frozen=True, slots=True)
class Origin:
    """One specimen's value behind a record, down to the bytes it rests on."""

    ENTRY: ClassVar = Entry(
        "origin", "origins", "One specimen's value, down to the bytes that it rests on."
    )

    specimen: Annotated[str, ID]
    value: float
    u_independent: Annotated[float, UNCERTAINTY]
    u_shared: Annotated[float, UNCERTAINTY]
    register: Annotated[str, SAID, "Register, relative to raw/."]
    register_line: Annotated[int, LINE]
    path: Annotated[str | None, "Raw file, relative to raw/; null if the register holds the value."]
    sha256: Annotated[str | None, SHA256, "Of the raw file's bytes."]
    first_line: Annotated[
        int | None, LINE, "First line of the raw file that the value rests on, counted from 1."
    ]
    last_line: Annotated[int | None, LINE]
    reader: Annotated[str | None, "Format that read the file."]
    technique: Annotated[str, SAID, "Technique that measured it."]
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)
    instrument: Annotated[str | None, "Instrument, as the register says it."] = None
    operator: Annotated[str | None, "Who tested it, as the register says it."] = None
    tested_on: Annotated[str | None, "Day of the test, as YYYY-MM-DD."] = None
    temperature_K: Annotated[float | None, "Temperature of this specimen."] = None
    humidity: Annotated[float | None, "Relative humidity at its test, 0 to 1."] = None
    calibrations: Annotated[
        tuple[str, ...],
        array(ID),
        Mark.IF_ANY,
        "Ids of the calibrations of its machine and gauges. Left out where none is declared.",
    ] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class PropertyRecord:
    """What one material has under one set of conditions, in one campaign.

    A value that is a lower bound (right-censored) is written `>= 12 h`, never `12 h`.

    Raises
    ------
    OutOfRange : a limit that is not the lower end of its interval, or an open interval that is not
        said to be a lower bound
    """

    ENTRY: ClassVar = Entry("property", "properties")

    key: Annotated[str, PROPERTY_KEY, Mark.IN_FRONT]
    material: Annotated[str, Mark.OF_THE_CARD]
    quantity: Quantity
    sd: Annotated[
        float | None,
        UNCERTAINTY,
        "Standard deviation between specimens; null for one specimen.",
    ]
    ci95: Annotated[
        tuple[float, float],
        INTERVAL,
        "95 % confidence interval; null is a side without a bound.",
    ]
    bound: Annotated[
        Bound,
        Mark.ALWAYS,
        "What the value is: an estimate; the lower end of the interval within which the truth was "
        "seen to lie; or all that is known from below (right-censored: write `>= value`).",
    ] = "exact"
    n: Annotated[int, COUNT, "Specimens behind the value."]
    conditions: Mapping[str, Condition]
    area_ratio_limit: Annotated[
        float | None,
        "How many times as large, or as small, an electrode may be that a Weibull strength is "
        "scaled to: E2 = E1 (A1/A2)^(1/shape). Left out where it cannot be scaled.",
    ] = None
    campaign: Annotated[str, ID, Mark.IN_FRONT]
    method: Annotated[str, SAID, "Estimator and window in words."]
    budget: Annotated[
        tuple[Contribution, ...],
        "Contributions to the standard uncertainty, the largest first.",
    ]
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)
    flags: tuple[Flag, ...] = ()
    origins: tuple[Origin, ...]

    @property
    def symbol(self) -> Annotated[str, After("key"), Mark.NO_COLUMN]:
        """Symbol of the property in figures."""
        return property_key(self.key).symbol

    @property
    def standard(
        self,
    ) -> Annotated[
        str,
        After("method"),
        Mark.NO_COLUMN,
        "Test standard or article that defines the property.",
    ]:
        """Test standard or article that defines the property."""
        return property_key(self.key).standard

    def __post_init__(self) -> None:
        if self.bound == "exact":
            return
        low, high = self.ci95
        if low != self.quantity.value or (self.bound == "lower") != math.isinf(high):
            raise OutOfRange(
                f"{self.key} of {self.material}: {self.quantity.value:g} {self.quantity.unit} "
                f"cannot be its {self.bound} bound with the interval from {low:g} to {high:g}"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Law:
    r"""A fitted function of time (and shear rate) that answers with its uncertainty.

    Raises
    ------
    OutOfRange : asked for an x outside `valid`, or a rate outside `rates`
    """

    ENTRY: ClassVar = Entry(
        "law",
        "laws",
        "A function y(x) of a named form over its range of x; outside of it nothing is known.",
    )

    key: Annotated[str, PROPERTY_KEY, Mark.IN_FRONT, "Property key of y."]
    material: Annotated[str, Mark.OF_THE_CARD]
    kind: Annotated[str, SAID, "Form of the law, by its name in pipeline/core/laws.py."]
    unit: Annotated[str, UNIT, "SI unit of y."]
    argument: Annotated[str, SAID, "What x is."]
    argument_unit: Annotated[str, SAID, "SI unit of x."]
    coefficients: Annotated[
        tuple[float, ...],
        array(NUMBER, 1),
        "As the form takes them; a polynomial has its lowest order first.",
    ]
    covariance: Annotated[
        tuple[tuple[float, ...], ...],
        array(array(NUMBER, 1), 1),
        "Covariance matrix of the coefficients, row by row.",
    ]
    valid: Annotated[tuple[float, float], "Range of x in which the law holds."]
    parts: Annotated[
        tuple[int, ...],
        array(COUNT),
        "Lengths of the polynomials, in a form that has several; else empty.",
    ] = ()
    rates: Annotated[
        tuple[float, float] | None,
        Mark.ALWAYS,
        "Range of shear rates (1/s) in which the law holds; null for a form without a rate.",
    ] = None
    degrees_of_freedom: Annotated[
        float | None, Mark.ALWAYS, "Of the covariance; null where it counts as known."
    ] = None
    temperature_K: Annotated[
        float | None,
        "Mean temperature of the liquid in the runs that were fitted. Left out where the register "
        "does not state it of all of them.",
    ] = None
    rate_per_rpm_per_s: Annotated[
        float | None,
        "Nominal shear rate (1/s) over speed (rpm) of the viscometer. Left out for a form without "
        "a rate.",
    ] = None
    relative_scatter: Annotated[
        float | None,
        "Root mean square of residual over law, of the readings that it was fitted to. Left out "
        "where it was not kept.",
    ] = None
    conditions: Mapping[str, Condition]
    campaign: Annotated[str, ID, Mark.IN_FRONT]
    method: Annotated[str, SAID, "Estimator and range in words."]
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)
    flags: tuple[Flag, ...] = ()
    origins: tuple[Origin, ...] = ()

    @property
    def symbol(self) -> Annotated[str, After("key"), Mark.NO_COLUMN]:
        """Symbol of y in figures."""
        return property_key(self.key).symbol

    def __call__(self, x: float, rate_per_s: float | None = None) -> Quantity:
        """Evaluate the law at x `[argument_unit]` and, where it has one, a shear rate `[1/s]`."""
        self._inside(x, rate_per_s)
        coefficients = np.asarray(self.coefficients, dtype=np.float64)
        value, slopes = evaluate(self.kind, coefficients, self.parts, x, rate_per_s)
        variance = float(slopes @ np.asarray(self.covariance) @ slopes)
        return Quantity(value, self.unit, max(variance, 0.0) ** 0.5)

    def model(self) -> tuple[lmfit.Model, lmfit.Parameters]:
        """Return the law as an lmfit model of `x`, and of `rate_per_s` where it has a shear rate.

        Unlike the law itself, the model answers at any x.

        Returns
        -------
        the model, and its parameters under the names of `core.laws.coefficient_names`, with their
        standard uncertainties (`stderr`), correlations (`correl`) and bounds
        """
        from deamat.core.law_model import lmfit_model

        return lmfit_model(self)

    @property
    def usual_rate(self) -> float | None:
        """Geometric middle of `rates` `[1/s]`, to six digits; None for a form without a rate."""
        if self.rates is None:
            return None
        return float(f"{math.sqrt(self.rates[0] * self.rates[1]):.6g}")

    def ci95(self, x: float, rate_per_s: float | None = None) -> tuple[float, float]:
        """Return the 95 % confidence interval of the law at x `[unit]`: Student's t."""
        from scipy.special import stdtrit  # reading a card must not cost it

        found = self(x, rate_per_s)
        dof = 1e6 if self.degrees_of_freedom is None else min(self.degrees_of_freedom, 1e6)
        half = float(stdtrit(dof, 0.975)) * found.standard_uncertainty
        return found.value - half, found.value + half

    def prediction95(self, x: float, rate_per_s: float | None = None) -> tuple[float, float]:
        """Give the range that holds 95 % of single readings at x `[unit]`.

        Raises
        ------
        OutOfRange : as when the law is asked, or its scatter was not kept
        """
        if self.relative_scatter is None:
            raise OutOfRange(f"what readings scatter about {self.key} of {self.material} is lost")
        low, high = self.ci95(x, rate_per_s)
        middle = 0.5 * (low + high)
        half = math.hypot(0.5 * (high - low), 1.96 * self.relative_scatter * middle)
        return middle - half, middle + half

    def _inside(self, x: float, rate_per_s: float | None) -> None:
        low, high = self.valid
        if not low <= x <= high:
            raise OutOfRange(
                f"{self.key} of {self.material} is known for {self.argument} from {low:g} to "
                f"{high:g} {self.argument_unit}, not at {x:g}"
            )
        if self.rates is None:
            if rate_per_s is not None:
                raise OutOfRange(f"{self.key} of {self.material} is a law without a shear rate")
            return
        slow, fast = self.rates
        if rate_per_s is None or not slow <= rate_per_s <= fast:
            raise OutOfRange(
                f"{self.key} of {self.material} is known for shear rates from {slow:g} to "
                f"{fast:g} 1/s, not at {'no rate' if rate_per_s is None else f'{rate_per_s:g}'}"
            )


@dataclass(frozen=True, slots=True)
class Summary:
    """What a technique says of one material in one campaign.

    Parameters
    ----------
    fits : which of the records come of one fit
    """

    records: tuple[PropertyRecord, ...]
    laws: tuple[Law, ...] = ()
    refusals: tuple[Refusal, ...] = ()
    fits: tuple[JointFit, ...] = ()
