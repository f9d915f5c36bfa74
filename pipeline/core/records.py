"""The nouns of the pipeline, in the order in which data flow: from Recording to PropertyRecord."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import OutOfRange
from deamat.core.laws import evaluate
from deamat.core.quantity import Contribution, Quantity

if TYPE_CHECKING:
    import lmfit

Condition = str | float | tuple[float, float]
Detail = float | int | str

# What the value of a record is: an estimate, or only a limit of what was seen to hold.
Bound = Literal["exact", "interval", "lower"]


@dataclass(frozen=True, slots=True)
class Flag:
    """Something a reader of the value must know; it changes no number."""

    name: str
    detail: str

    def __str__(self) -> str:
        return f"{self.name}: {self.detail}"


@dataclass(frozen=True, slots=True)
class Source:
    """Where a recording came from, down to the lines that hold its data.

    Parameters
    ----------
    path : relative to `raw/`, with forward slashes
    sha256 : of the file's bytes
    first_line, last_line : the data rows, as lines counted from 1
    encoding : as found (`utf-8`, `utf-8-sig`, `utf-16`, `latin-1`)
    reader : name of the format that read it
    """

    path: str
    sha256: str
    first_line: int
    last_line: int
    encoding: str
    reader: str


@dataclass(frozen=True, slots=True)
class Recording:
    """Columns in SI as one instrument wrote them, with its metadata and source; no physics.

    Parameters
    ----------
    columns : name with its SI unit (`force_N`) to values, shape (n,) each
    metadata : what the file says about itself, as text
    column_units : label to unit as written over each column, to hold against other statements
    flags : what the reader noticed (contradictions, identical rows, odd endings)
    """

    columns: Mapping[str, FloatArray]
    metadata: Mapping[str, str]
    column_units: Mapping[str, str]
    source: Source
    flags: tuple[Flag, ...] = ()


@dataclass(frozen=True, slots=True)
class Specimen:
    """One row of a register.

    Parameters
    ----------
    id, material, campaign, technique : who it is
    file : data file relative to `raw/`, or None where the register holds the value itself
    format : name of a reader, or None to detect it
    numbers : geometry and settings in SI by name (`diameter_m`), each with its uncertainty
    conditions : what tells its record apart, keys of `core.properties.CONDITIONS`
    notes : every other column, kept as text
    register, line : the register's path relative to `raw/`, and the row's line
    """

    id: str
    material: str
    campaign: str
    technique: str
    file: str | None
    format: str | None
    numbers: Mapping[str, Quantity]
    conditions: Mapping[str, Condition]
    notes: Mapping[str, str]
    register: str
    line: int


@dataclass(frozen=True, slots=True)
class MeasuredValue:
    """One property of one specimen.

    Parameters
    ----------
    key : property key
    quantity : value with uncertainty; `budget` lists where that comes from
    method : estimator and window in words
    conditions : what the technique itself fixes (window, rate)
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


@dataclass(frozen=True, slots=True)
class Refusal:
    """A value that was asked for and not given, and why."""

    key: str
    reason: str
    material: str
    campaign: str
    specimen: str | None = None
    conditions: Mapping[str, Condition] = field(default_factory=dict)
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Measurement:
    """What one specimen gave: values, refusals, and the reduced curve behind them.

    Parameters
    ----------
    curve : reduced columns by name with unit (`nominal_strain`, `nominal_stress_Pa`), shape (n,)
    """

    specimen: Specimen
    values: tuple[MeasuredValue, ...]
    refusals: tuple[Refusal, ...] = ()
    curve: Mapping[str, FloatArray] = field(default_factory=dict)
    source: Source | None = None


@dataclass(frozen=True, slots=True)
class Origin:
    """One specimen's value behind a record, down to the bytes it rests on."""

    specimen: str
    value: float
    u_independent: float
    u_shared: float
    register: str
    register_line: int
    path: str | None
    sha256: str | None
    first_line: int | None
    last_line: int | None
    reader: str | None
    technique: str
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class PropertyRecord:
    """What one material has under one set of conditions, in one campaign.

    Parameters
    ----------
    sd : standard deviation between specimens `[unit]`; None for one specimen
    ci95 : 95 % confidence interval `[unit]`; where the value is a limit, the interval within which
        the truth was seen to lie
    budget : contributions to the standard uncertainty of `quantity`
    bound : "exact" for an estimate; "interval" where `quantity` is the lower end of `ci95`;
        "lower" where it is all that is known and the truth may be any larger (right-censored):
        such a value is written `>= 12 h`, never `12 h`

    Raises
    ------
    OutOfRange : a limit that is not the lower end of its interval, or an open interval that is not
        said to be a lower bound
    """

    key: str
    material: str
    campaign: str
    quantity: Quantity
    n: int
    sd: float | None
    ci95: tuple[float, float]
    conditions: Mapping[str, Condition]
    method: str
    budget: tuple[Contribution, ...]
    origins: tuple[Origin, ...]
    flags: tuple[Flag, ...] = ()
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)
    bound: Bound = "exact"

    def __post_init__(self) -> None:
        if self.bound == "exact":
            return
        low, high = self.ci95
        if low != self.quantity.value or (self.bound == "lower") != math.isinf(high):
            raise OutOfRange(
                f"{self.key} of {self.material}: {self.quantity.value:g} {self.quantity.unit} "
                f"cannot be its {self.bound} bound with the interval from {low:g} to {high:g}"
            )


@dataclass(frozen=True, slots=True)
class Law:
    r"""A fitted function of time (and shear rate) that answers with its uncertainty.

    Parameters
    ----------
    key : property key of y
    kind : name of its form in `core.laws.FORMS`
    argument, argument_unit : what x is
    coefficients : as the form takes them; a polynomial's lowest order first
    covariance : of the coefficients, shape (p, p)
    valid : range of x in which the law holds `[argument_unit]`
    parts : lengths of the polynomials in a form that has several, else empty
    rates : range of shear rates in which the law holds `[1/s]`; None for a form without a rate
    degrees_of_freedom : of the covariance; None where it counts as known

    Raises
    ------
    OutOfRange : asked for an x outside `valid`, or a rate outside `rates`
    """

    key: str
    material: str
    campaign: str
    kind: str
    unit: str
    argument: str
    argument_unit: str
    coefficients: tuple[float, ...]
    covariance: tuple[tuple[float, ...], ...]
    valid: tuple[float, float]
    conditions: Mapping[str, Condition]
    method: str
    origins: tuple[Origin, ...] = ()
    flags: tuple[Flag, ...] = ()
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)
    parts: tuple[int, ...] = ()
    rates: tuple[float, float] | None = None
    degrees_of_freedom: float | None = None

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
        """Give the 95 % confidence interval of the law at x `[unit]`: Student's t."""
        from scipy.special import stdtrit  # reading a card must not cost it

        found = self(x, rate_per_s)
        dof = 1e6 if self.degrees_of_freedom is None else min(self.degrees_of_freedom, 1e6)
        half = float(stdtrit(dof, 0.975)) * found.standard_uncertainty
        return found.value - half, found.value + half

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
    """What a technique says of one material in one campaign."""

    records: tuple[PropertyRecord, ...]
    laws: tuple[Law, ...] = ()
    refusals: tuple[Refusal, ...] = ()
