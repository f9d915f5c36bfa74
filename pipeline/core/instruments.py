"""`config/instruments.toml`: what is declared of machines and gauges."""

from __future__ import annotations

import re
from collections.abc import Mapping
from datetime import date
from difflib import get_close_matches
from fnmatch import fnmatchcase
from typing import Annotated, Self

import numpy as np
from pydantic import AfterValidator, Field, PrivateAttr, model_validator

from deamat.core.arrays import FloatArray
from deamat.core.calibration import Calibration, CalibrationIds, Covered, held_on
from deamat.core.declared import Declared
from deamat.core.quantity import Contribution

_LOW_IMPEDANCE_ohm = 500.0  # where the makers' tables change from k_a to k_b
_LOW_FREQUENCY_Hz = 100.0


class Gauge(Declared):
    """Standard uncertainties of a length where its register has no `u_` column."""

    u_reading_m: float = Field(default=1e-5, ge=0, description="repeatability, one per specimen")
    u_calibration_m: float = Field(default=1e-5, ge=0, description="shared by all specimens")
    calibration: str | None = Field(default=None, description="id of its [calibrations.ID]")


class LcrAccuracy(Declared):
    r"""What an LCR meter promises: limits of error that grow with the impedance.

    $$ A_e = \big(A A_r + K + K_f + K_L\big) K_c, \qquad
    K = k_a \frac{1 + v_a/V}{|Z|} \text{ below } 500\ \Omega, \quad
    K = k_b(f) |Z| (1 + v_b/V) \text{ above}, $$

    all relative here (the makers print percent), K times sqrt(100 Hz / f) below 100 Hz, and A and
    K doubled at the fast speed. $A_e$ is the limit for |Z| and C, and in absolute terms for D.

    Source: the form, A and the limit for D from the GW Instek LCR-6000 manual, 13.1 and 13.2; its
    table of K was not found, so K is that of the B&K Precision 894 manual, Table 13 (a meter of
    the same form; UNI-T's LCR-1000, another one, promises a limit four times as wide at 10 Hz).
    """

    basic: float = Field(default=5e-4, gt=0, description="A, at slow and medium speed")
    level_V: tuple[float, float] = Field(
        default=(0.4, 1.2), description="test levels at which A_r is 1"
    )
    other_level_factor: float = Field(default=2.5, ge=1, description="A_r at any other level")
    low_impedance_ohm: float = Field(default=1e-3, ge=0, description="k_a")
    low_impedance_V: float = Field(default=0.2, ge=0, description="v_a")
    high_impedance_per_ohm: tuple[tuple[float, float], ...] = Field(
        default=((1.2e3, 0.3e-9), (8e3, 1e-9), (150e3, 3e-9)),
        min_length=1,
        description="k_b: highest frequency in Hz, and the factor up to there; the last one holds "
        "beyond",
    )
    high_impedance_V: float = Field(default=0.07, ge=0, description="v_b")
    interpolation: float = Field(default=3e-4, ge=0, description="K_f, open and short trimming")
    leads: float = Field(default=0.0, ge=0, description="K_L, leads of no length")
    temperature: float = Field(default=1.0, ge=1, description="K_c, 18 to 28 C")
    source: str = "A: GW Instek LCR-6000 manual, 13.2; K: B&K Precision 894 manual, Table 13"

    def limit(
        self,
        frequency_Hz: FloatArray,
        impedance_ohm: FloatArray,
        level_V: float,
        *,
        fast: bool,
    ) -> FloatArray:
        """Return the relative limit of error, shape (n,).

        Parameters
        ----------
        frequency_Hz, impedance_ohm : f and |Z|, above zero, shape (n,) each
        level_V : test voltage, rms
        fast : at the fast speed
        """
        ends, factors = (
            np.array(column) for column in zip(*self.high_impedance_per_ohm, strict=True)
        )
        band = np.minimum(np.searchsorted(ends, frequency_Hz), ends.size - 1)
        k = np.where(
            impedance_ohm < _LOW_IMPEDANCE_ohm,
            self.low_impedance_ohm / impedance_ohm * (1.0 + self.low_impedance_V / level_V),
            factors[band] * impedance_ohm * (1.0 + self.high_impedance_V / level_V),
        ) * np.sqrt(np.maximum(1.0, _LOW_FREQUENCY_Hz / frequency_Hz))
        low, high = self.level_V
        basic = self.basic * (1.0 if low <= level_V <= high else self.other_level_factor)
        speed = 2.0 if fast else 1.0
        limit: FloatArray = self.temperature * (
            speed * (basic + k) + self.interpolation + self.leads
        )
        return limit


def _no_regular_expression(pattern: str) -> str:
    """Refuse what would silently match nothing; a regular expression can also take for ever."""
    found = re.search(r"\.[*+?]|[\\^$|]", pattern)
    if found:
        raise ValueError(f"{found[0]!r} is of a regular expression: write `*` for any text")
    return pattern


class Machine(Declared):
    """What the numbers of a testing machine are good for (relative ones are 1 sigma)."""

    match: Annotated[str, AfterValidator(_no_regular_expression)] = Field(
        default="",
        description="text that occurs in the register's instrument, in small letters or capitals; "
        "`*` stands for any text, `?` for any character",
    )
    force_resolution_N: float = Field(default=0.0, ge=0)
    u_force_calibration: float = Field(default=0.005, ge=0, description="relative, shared")
    u_displacement_calibration: float = Field(default=0.002, ge=0, description="relative, shared")
    u_voltage_calibration: float = Field(default=0.005, ge=0, description="relative, shared")
    impedance: LcrAccuracy = Field(default_factory=LcrAccuracy, description="of an LCR meter")
    u_torque_calibration: float = Field(
        default=0.01,
        ge=0,
        description="viscometer, fraction of full scale, shared: a limit of 2 % as two sigma",
    )
    spring_torque: float = Field(
        default=1.0,
        gt=0,
        description="viscometer, full torque over that of an NDJ-8S (LV type): its full scales are "
        "as many times higher. Brookfield's torque constants are LV 0.09373, RV 1, HA 2, HB 8",
    )
    torque_noise: float = Field(
        default=0.003, gt=0, description="viscometer, fraction of full scale, of a single reading"
    )
    compliance_m_per_N: float | None = Field(
        default=None,
        ge=0,
        description="of frame, load cell and grips: travel for a force without a specimen",
    )
    u_compliance_m_per_N: float = Field(default=0.0, ge=0, description="standard, shared")
    max_travel_m: float | None = Field(
        default=None, gt=0, description="reading at which the displacement ends, where it matters"
    )
    calibration: CalibrationIds = Field(
        default=(),
        description="id of its [calibrations.ID], or several of which the day of the test chooses",
    )
    source: str = "defaults: an ISO 7500-1 class 1 machine"

    def shared_error(self, source: str, covered: Covered, u: float) -> Contribution:
        """Return the line of a budget that is this machine's own error of a quantity.

        Parameters
        ----------
        source : what to call it
        u : standard uncertainty
        """
        del covered
        return Contribution(source, u, shared=True)


class Instrument(Machine):
    """The machine of one specimen: its entry, and the calibrations that held on that day.

    Parameters
    ----------
    entry : its name in the configuration; empty where no entry matches
    held : what is calibrated, to the id of the calibration
    """

    entry: str = ""
    held: Mapping[Covered, str] = Field(default_factory=dict)

    def shared_error(self, source: str, covered: Covered, u: float) -> Contribution:
        """Return the line of a budget, with its calibration; it says where limits are defaults."""
        if not self.entry:
            return Contribution(f"{source}, default limits", u, shared=True, assumed=True)
        if covered not in self.held:
            return Contribution(source, u, shared=True)
        return Contribution(
            source, u, shared=True, calibration=self.held[covered], calibrated=covered
        )


class Instruments(Declared):
    """`config/instruments.toml`: machines by name, gauges by register column, calibrations by id.

    Raises
    ------
    ValueError : a machine or gauge that names a calibration that is not there, or one of another
        kind
    """

    machines: Mapping[str, Machine] = Field(default_factory=dict)
    gauges: Mapping[str, Gauge] = Field(default_factory=dict)
    calibrations: Mapping[str, Calibration] = Field(default_factory=dict)
    _found: dict[tuple[str, date | None], Instrument] = PrivateAttr(default_factory=dict)

    @model_validator(mode="after")
    def _calibrated(self) -> Self:
        for name, machine in self.machines.items():
            for one in machine.calibration:
                if self._known(one, f"machines.{name}").covers == ("length",):
                    raise ValueError(f"machines.{name}: the calibration {one!r} is of a length")
        for name, gauge in self.gauges.items():
            if gauge.calibration is None:
                continue
            if "length" not in self._known(gauge.calibration, f"gauges.{name}").covers:
                raise ValueError(
                    f"gauges.{name}: the calibration {gauge.calibration!r} does not cover length"
                )
        return self

    def _known(self, calibration: str, where: str) -> Calibration:
        if calibration not in self.calibrations:
            near = get_close_matches(calibration, self.calibrations, n=1, cutoff=0.0)
            hint = f"; nearest: {near[0]!r}" if near else ""
            raise ValueError(f"{where}: there is no [calibrations.{calibration}]{hint}")
        return self.calibrations[calibration]

    def machine(self, instrument: str, tested_on: date | None = None) -> Instrument:
        """Find the machine that a register's `instrument` names; the class defaults otherwise.

        Parameters
        ----------
        tested_on : chooses among its calibrations, whose uncertainties take the place of its own
        """
        asked = instrument, tested_on  # the same for most rows of a register
        if asked not in self._found:
            self._found[asked] = self._matching(instrument, tested_on)
        return self._found[asked]

    def _matching(self, instrument: str, day: date | None) -> Instrument:
        for name, machine in self.machines.items():
            pattern = f"*{machine.match.casefold()}*"
            if machine.match and fnmatchcase(instrument.casefold(), pattern):
                return self._on(day, name, machine)
        return Instrument()

    def _on(self, day: date | None, name: str, machine: Machine) -> Instrument:
        held = held_on(day, machine.calibration, self.calibrations)
        found = {covered: self.calibrations[one].u_relative for covered, one in held.items()}
        changes = {f"u_{covered}_calibration": u for covered, u in found.items() if u is not None}
        return Instrument(**{**machine.model_dump(), **changes, "entry": name, "held": held})
