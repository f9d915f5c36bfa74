"""Simulated viscosity against time: an NDJ-8S from 0.25 h to 13 h after mixing, three batches each.

What is simulated: batches whose viscosity differs by 0.6 % (one standard deviation); silicone that
is thinner than its law in the first 45 min, warm from the mixer; a reading every 15 min of
Sylgard 182 and 184 with rotor 3, at the fastest speed that shows no more than full torque, so that
a run goes over range (`EEEE`) and on at the next slower speed; a sweep from 0.3 rpm up to 6 rpm or
until the instrument is over range every 15 min of Sylgard 186 with rotor 4, and an end of the run
where even 0.3 rpm is too fast; torque shown to 0.1 % and viscosity to 1 mPa.s.

Sylgard 186 (10:1) is beyond an NDJ-8S: at 12 h its law takes 6.5 times the full scale of rotor 4 at
0.3 rpm, which it leaves before 6 h. Its batches are measured on a viscometer with the 10.7 times
stronger spring of an RV type, which logs the same lines: with rotor 3, and with rotor 4 from the
sweep on that would take 0.6 rpm over range. Register and configuration name it by its own name.

Errors of each instrument, in parts of full scale: one error of the zero of torque for the whole
campaign (standard deviation 0.25 %, what a check against a standard oil leaves) and noise of every
reading (0.3 %). A viscometer that has not been checked may be wrong by 2 % of full scale, which no
number of readings would remove.

Logs: batch 1 is stamped with date and time, batch 2 with the time of day alone, batch 3 with an
offset; all of them run past midnight. Sylgard 182 (40:1) is a plain CSV in hours and Pa.s.

What is not: viscous heating, a cup that is not wide, drift of temperature, thixotropy.

Source: rotors, times and laws from Sikulskyi et al. 2022, section 3.2 and Table 2; nominal shear
rate 0.27 1/s at 3 rpm from the same (which names rotor 4 of an NDJ-8S for Sylgard 186); torque
constants of the springs, RV 1 and LV 0.09373, from Brookfield (DV-I manual, M/92-021, appendix D).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import MissingProperty
from deamat.core.instruments import Machine
from deamat.core.viscometer import SPEEDS_RPM, full_scale_Pas
from deamat.twin.draws import Calibration, stream
from deamat.twin.part import SYNTHETIC, Part
from deamat.twin.truth import SECONDS_PER_HOUR, TrueValue, TrueViscosity, true_viscosities
from deamat.twin.writers import ndj8s_log, register_csv, viscometer_csv

TECHNIQUE = "viscosity"
BATCHES = 3
RATE_PER_RPM_PER_S = 0.09
VISCOMETER = Machine(u_torque_calibration=0.0025, torque_noise=0.003)
RV_TYPE = "RV-type viscometer, full scale 10.669 times that of an NDJ-8S"
STRONGER = VISCOMETER.model_copy(update={"spring_torque": 10.669})
ON_STRONGER_SPRING = "sylgard-186-10to1"
AS_CSV = "sylgard-182-40to1"

_BATCH_SD = 0.006
_FIRST_S, _LAST_S, _EVERY_S = 0.25 * SECONDS_PER_HOUR, 13.0 * SECONDS_PER_HOUR, 900.0
_NEXT_SPEED_S, _LATE_S = 40, 20
_WARM_S, _WARM_PART = 0.75 * SECONDS_PER_HOUR, 0.15
_SWEPT_RPM = tuple(speed for speed in SPEEDS_RPM if speed <= 6.0)
_MIXED_AT = datetime.fromisoformat("2022-03-01T18:30:00")  # the campaign's own clock
_THINNER_ROTORS = (3, 4)
_TORQUE = 4  # its place in what is shown
_PROBE_PERIOD = 5  # the probe is read at every reading but each fifth


@dataclass(frozen=True, slots=True)
class SimulatedRun:
    """One simulated run, as the instrument showed it.

    Parameters
    ----------
    batch : from 1
    time_s : since mixing, whole seconds, shape (n,)
    rotor, speed_rpm : shape (n,) each
    viscosity_Pas, torque : as shown, shape (n,); zero where it was over range
    over : whether a reading was over range, shape (n,)
    factor : of this batch's viscosity over the law
    """

    material: str
    batch: int
    time_s: FloatArray
    rotor: FloatArray
    speed_rpm: FloatArray
    viscosity_Pas: FloatArray
    torque: FloatArray
    over: NDArray[np.bool_]
    factor: float


def simulate_viscosity(seed: int, material: str, batch: int) -> SimulatedRun:
    """Simulate one run in memory.

    Raises
    ------
    MissingProperty : the truth table holds no viscosity of this material
    ConfigError : the seed is negative
    """
    laws = true_viscosities()
    if material not in laws:
        raise MissingProperty(
            f"the twin knows no viscosity of {material}; it knows that of: {', '.join(laws)}"
        )
    law = laws[material]
    rng = stream(seed, TECHNIQUE, material, str(batch))
    factor = 1.0 + rng.normal(0.0, _BATCH_SD)
    machine = machine_of(material)
    show = _Display(law, factor, machine, torque_error(seed, machine), rng)
    if machine is STRONGER:
        readings = list(_swept_on(show, rng))
    else:
        readings = list(_swept(show, rng) if law.index else _followed(show, rng))
    times, rotors, speeds, viscosities, torques = (
        np.array(column) for column in zip(*readings, strict=True)
    )
    over = torques > 1.0
    return SimulatedRun(
        material,
        batch,
        times,
        rotors,
        speeds,
        np.where(over, 0.0, viscosities),
        np.where(over, 0.0, torques),
        over,
        factor,
    )


def machine_of(material: str) -> Machine:
    """Return the viscometer that a material is measured on."""
    return STRONGER if material == ON_STRONGER_SPRING else VISCOMETER


def torque_error(seed: int, machine: Machine = VISCOMETER) -> float:
    """Draw the error of a viscometer's zero, common to the campaign, in parts of full scale."""
    name = "viscometer" if machine is VISCOMETER else "viscometer with a stronger spring"
    rng = stream(seed, "calibration", name)
    return rng.normal(0.0, machine.u_torque_calibration)


_Shown = tuple[float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class _Display:
    """What the instrument shows of one batch at a time and speed."""

    law: TrueViscosity
    factor: float
    machine: Machine
    torque_error: float
    rng: Generator

    def __call__(self, time_s: float, speed_rpm: float, rotor: int | None = None) -> _Shown:
        """Time, rotor, speed, viscosity to 1 mPa.s and torque to 0.1 % (above 1: over range)."""
        rotor = rotor or self.law.rotor
        rate = np.array([RATE_PER_RPM_PER_S * speed_rpm])
        true = self.factor * float(self.law(np.array([time_s]), rate)[0])
        cold = max(0.0, 1.0 - time_s / _WARM_S)
        full = full_scale_Pas(rotor, speed_rpm, self.machine.spring_torque)
        torque = true * (1.0 - _WARM_PART * cold**2) / full + self.torque_error
        torque += self.rng.normal(0.0, VISCOMETER.torque_noise)
        return time_s, float(rotor), speed_rpm, round(torque * full, 3), round(torque, 3)


def _clock(rng: Generator) -> Iterator[float]:
    """Times of reading, every 15 min and some seconds late, in whole seconds."""
    for due in np.arange(_FIRST_S, _LAST_S + 1.0, _EVERY_S):
        yield float(due + rng.integers(0, _LATE_S))


def _followed(show: _Display, rng: Generator) -> Iterator[_Shown]:
    """One reading at a time; once over range, on at the next slower speed."""
    fastest = [s for s in SPEEDS_RPM if show(_FIRST_S, s)[_TORQUE] <= 1.0]
    speeds = iter(sorted(fastest, reverse=True))
    speed = next(speeds)
    for time_s in _clock(rng):
        shown = show(time_s, speed)
        yield shown
        while shown[_TORQUE] > 1.0:
            speed = next(speeds)
            shown = show(time_s + _NEXT_SPEED_S, speed)
            yield shown


def _swept(show: _Display, rng: Generator) -> Iterator[_Shown]:
    """From the slowest speed up to where it is over range; the end is where even that is."""
    for time_s in _clock(rng):
        for i, speed in enumerate(_SWEPT_RPM):
            shown = show(time_s + i * _NEXT_SPEED_S, speed)
            yield shown
            if shown[_TORQUE] > 1.0:
                break
        if shown[_TORQUE] > 1.0 and speed == _SWEPT_RPM[0]:
            return


def _swept_on(show: _Display, rng: Generator) -> Iterator[_Shown]:
    """As above, and on with the next thinner rotor where one speed alone would be left."""
    rotors = iter(_THINNER_ROTORS)
    rotor = next(rotors)
    for time_s in _clock(rng):
        for i, speed in enumerate(_SWEPT_RPM):
            shown = show(time_s + i * _NEXT_SPEED_S, speed, rotor)
            yield shown
            if shown[_TORQUE] > 1.0:
                break
        if speed <= _SWEPT_RPM[1] and shown[_TORQUE] > 1.0:
            rotor = next(rotors, rotor)


def viscosity_part(seed: int) -> Part:
    """Simulate the runs of all materials as files with a register."""
    contents: dict[str, bytes] = {}
    rows: list[dict[str, str]] = []
    specimens = {}
    mixed_at = _MIXED_AT
    for material in true_viscosities():
        for batch in range(1, BATCHES + 1):
            run = simulate_viscosity(seed, material, batch)
            ending = "csv" if material == AS_CSV else "log"
            file = f"{material}/synthetic-{batch}.{ending}"
            contents[f"{TECHNIQUE}/{file}"] = _file(run, mixed_at)
            mass_g = stream(seed, TECHNIQUE, material, str(batch), "mass").uniform(95.0, 105.0)
            row = _row(run, file, mixed_at, mass_g)
            rows.append(row)
            specimens[row["specimen"]] = {"batch_factor": run.factor}
            if material == ON_STRONGER_SPRING:
                specimens[row["specimen"]]["torque_error"] = torque_error(seed, STRONGER)
            mixed_at += timedelta(days=1, minutes=7)
    contents[f"{TECHNIQUE}/specimens.csv"] = register_csv(rows)
    # no cell, crosshead or gauge has a part in it
    calibration = Calibration(0.0, 0.0, 0.0, 0.0, 0.0, torque=torque_error(seed))
    return Part(TECHNIQUE, contents, _truth(), calibration, specimens)


def _truth() -> tuple[TrueValue, ...]:
    """Viscosity of the law at 1 h, and n where there is one."""
    hour, middle = np.array([SECONDS_PER_HOUR]), np.array([RATE_PER_RPM_PER_S * 3.0])
    said = "1 h after mixing, nominal shear rate 0.27 1/s"
    found = []
    for material, law in true_viscosities().items():
        value = float(law(hour, middle)[0])
        found.append(TrueValue("viscosity", material, said, value, "Pa.s"))
        if law.index:
            found.append(TrueValue("flow_index", material, said, sum(law.index), "1"))
    return tuple(found)


def _file(run: SimulatedRun, mixed_at: datetime) -> bytes:
    readings = [
        (int(r), s, None if over else v, t)
        for r, s, v, t, over in zip(
            run.rotor.tolist(),
            run.speed_rpm.tolist(),
            run.viscosity_Pas.tolist(),
            run.torque.tolist(),
            run.over.tolist(),
            strict=True,
        )
    ]
    probe = [None if i % _PROBE_PERIOD == 0 else 22.0 for i in range(len(readings))]
    name = RV_TYPE if run.material == ON_STRONGER_SPRING else "NDJ-8S"
    remarks = (SYNTHETIC, f"{name}, COM4 9600 8N1")
    if run.material == AS_CSV:
        return viscometer_csv(
            remarks[:1], (run.time_s / SECONDS_PER_HOUR).tolist(), readings, probe
        )
    clock = [mixed_at + timedelta(seconds=t) for t in run.time_s.tolist()]
    stamps = {
        1: [t.isoformat(timespec="seconds") for t in clock],
        2: [t.time().isoformat(timespec="seconds") for t in clock],
        3: [t.isoformat(timespec="seconds") + "+00:00" for t in clock],
    }
    return ndj8s_log(remarks, stamps[run.batch], readings, probe)


def _row(run: SimulatedRun, file: str, mixed_at: datetime, mass_g: float) -> dict[str, str]:
    return {
        "specimen": f"v-{run.material}-{run.batch}",
        "material": run.material,
        "file": file,
        "mixed_at": mixed_at.isoformat(timespec="seconds"),
        "mass_g": f"{mass_g:.1f}",
        "cup": "150 ml plastic",
        "temperature_C": "22",
        "humidity_percent": "52",
        "instrument": f"simulated {RV_TYPE}"
        if run.material == ON_STRONGER_SPRING
        else "simulated NDJ-8S",
        "comment": SYNTHETIC,
    }
