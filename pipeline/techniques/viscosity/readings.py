"""The readings of a run that can be trusted, each with the errors of the instrument."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.core.instruments import Machine
from deamat.core.recording import Recording
from deamat.core.records import Flag
from deamat.core.viscometer import full_scale_Pas
from deamat.formats.viscometer import lines_text
from deamat.techniques.viscosity.config import ViscosityConfig

ZERO_C_K = 273.15
# Torque is printed to 0.1 % and viscosity to 1 mPa.s: half of each, and as much again for an
# instrument that cuts where it should round.
_TORQUE_STEP = 0.001
_VISCOSITY_STEP_PAS = 0.001
# A display at its end repeats its greatest number although the liquid was rising until then.
_STUCK_READINGS = 3
_RISING_STEPS = 6.0  # of what the file resolves, over as many readings before


@dataclass(frozen=True, slots=True)
class Readings:
    """Viscosity against time since mixing.

    Parameters
    ----------
    time_s, viscosity_Pas : shape (n,)
    noise_Pas : standard deviation of a single reading, shape (n,)
    calibration_Pas : what one standard uncertainty of the calibration adds to each reading, all of
        them together, shape (n,)
    speed_rpm, rotor : shape (n,); zeros where the file does not say
    line : of the file, shape (n,)
    temperature_K : by the probe, shape (n,); NaN where there is none
    thermal_Pas : what one standard uncertainty of the activation energy adds to each reading that
        was corrected to one temperature, shape (n,); zeros where none was
    errors : the error model in words
    """

    time_s: FloatArray
    viscosity_Pas: FloatArray
    noise_Pas: FloatArray
    calibration_Pas: FloatArray
    speed_rpm: FloatArray
    rotor: FloatArray
    line: FloatArray
    temperature_K: FloatArray
    thermal_Pas: FloatArray
    errors: str
    flags: tuple[Flag, ...] = ()

    def __len__(self) -> int:
        return len(self.time_s)

    @property
    def of_full_scale(self) -> bool:
        """Whether rotor and speed are known, and with them the full scale."""
        return bool(np.all(self.rotor > 0))

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Every column by name."""
        return {name: getattr(self, name) for name in _COLUMNS}

    def where(self, chosen: NDArray[np.bool_] | NDArray[np.intp] | slice) -> Readings:
        """Keep the chosen readings (a mask, an index array or a slice)."""
        kept = {name: column[chosen] for name, column in self.columns.items()}
        return _of(kept, self)


_COLUMNS = (
    "time_s",
    "viscosity_Pas",
    "noise_Pas",
    "calibration_Pas",
    "speed_rpm",
    "rotor",
    "line",
    "temperature_K",
    "thermal_Pas",
)


def joined(runs: Sequence[Readings]) -> Readings:
    """Put the readings of several runs behind each other."""
    if len(runs) == 1:
        return runs[0]
    columns = [run.columns for run in runs]
    whole = {name: np.concatenate([c[name] for c in columns]) for name in _COLUMNS}
    return _of(whole, runs[0])


def _of(columns: Mapping[str, FloatArray], like: Readings) -> Readings:
    time, viscosity, noise, calibration, speed, rotor, line, kelvin, thermal = (
        columns[name] for name in _COLUMNS
    )
    return Readings(
        time, viscosity, noise, calibration, speed, rotor, line, kelvin, thermal, like.errors,
        like.flags,
    )  # fmt: skip


def tenth_of_degree(kelvin: float) -> float:
    """Round to a tenth of a degree Celsius, as probes show it `[K]`."""
    return round(kelvin - ZERO_C_K, 1) + ZERO_C_K


def speeds_alternate(readings: Readings) -> bool:
    """Whether speeds are swept: changed at more than every fourth reading."""
    changes = np.count_nonzero(np.diff(readings.speed_rpm))
    return bool(changes > 0.25 * len(readings))


def audited(
    recording: Recording, time_s: FloatArray, machine: Machine, config: ViscosityConfig
) -> Readings:
    r"""Hold each reading against its full scale and leave out, by line, what cannot be trusted.

    With rotor and speed known, errors are constant parts of full scale; else of the reading.

    Raises
    ------
    FitRefused : no viscosity, a rotor or speed that does not exist, or too many readings whose
        viscosity, torque and speed contradict each other
    """
    columns = recording.columns
    if "viscosity_Pas" not in columns:
        raise FitRefused("the file has no viscosity")
    viscosity = columns["viscosity_Pas"]
    line = columns["line"] if "line" in columns else np.arange(1.0, len(viscosity) + 1)
    probe = columns.get("temperature_K", np.full(len(viscosity), np.nan))
    stuck = _stuck(viscosity)
    stuck_flags = _left_out(
        "at-its-limit", f"{viscosity[stuck].max():g} Pa.s again and again at the top of a rise, as "
        "a display at the end of its range shows it", line[stuck],
    ) if stuck.any() else []  # fmt: skip
    if "rotor" not in columns or "speed_rpm" not in columns:
        whole = _of_reading(time_s, viscosity, line, probe, config)
        readings = _positive(whole.where(~stuck))
        return replace(readings, flags=(*stuck_flags, *readings.flags))
    rotor, speed = columns["rotor"], columns["speed_rpm"]
    full = _full_scales(rotor, speed, line, machine.spring_torque)
    readings = Readings(
        time_s, viscosity, machine.torque_noise * full, machine.u_torque_calibration * full, speed,
        rotor, line, probe, np.zeros(len(viscosity)),
        f"errors a constant fraction of full scale ({machine.torque_noise:.2%} noise of a reading, "
        f"{machine.u_torque_calibration:.2%} calibration, shared)",
    )  # fmt: skip
    torque = viscosity / full
    keep = ~stuck
    flags: list[Flag] = [*stuck_flags]
    if "torque" in columns:
        slack = _TORQUE_STEP + _VISCOSITY_STEP_PAS / full
        wrong = np.abs(columns["torque"] - torque) > slack
        if np.mean(wrong) > config.max_contradicting:
            at = int(np.argmax(wrong))
            raise FitRefused(
                f"viscosity, torque and speed contradict each other in {int(wrong.sum())} of "
                f"{len(wrong)} readings, first in line {int(line[at])}: {viscosity[at]:g} Pa.s of "
                f"{full[at]:g} Pa.s full scale is {100 * torque[at]:.1f} %, not "
                f"{100 * columns['torque'][at]:.1f} %; check rotor, speed and unit",
                {"contradicting": int(wrong.sum()), "readings": len(wrong)},
            )
        keep &= ~wrong
        flags += _left_out("contradicting", "viscosity, torque and speed disagree", line[wrong])
    else:
        flags.append(Flag("torque-not-recorded", "viscosity could not be held against the torque"))
    low, high = config.torque_window
    outside = keep & ((torque < low) | (torque > high))
    detail = f"torque outside {100 * low:g}-{100 * high:g} %"
    flags += _left_out("outside-torque-window", detail, line[outside])
    good = readings.where(keep & ~outside)
    changes = _changes(good)
    return replace(good, flags=(*flags, *changes))


def _stuck(viscosity: FloatArray) -> NDArray[np.bool_]:
    """Find an over-range display that shows a plausible number: the greatest one, repeated.

    A liquid that rose by several steps of the display until then does not stop from one reading
    to the next; one that levels off, or is constant, is ignored.
    """
    none = np.zeros(len(viscosity), dtype=bool)
    top: NDArray[np.bool_] = viscosity == viscosity.max()
    first, count = int(np.argmax(top)), int(np.count_nonzero(top))
    last = first + count
    if count < _STUCK_READINGS or first < _STUCK_READINGS or not top[first:last].all():
        return none
    step = np.diff(np.unique(viscosity)).min()
    before = viscosity[first - _STUCK_READINGS : first]
    if np.any(np.diff(before) <= 0) or np.ptp(before) <= _RISING_STEPS * step:
        return none
    return top


def _of_reading(
    time_s: FloatArray,
    viscosity: FloatArray,
    line: FloatArray,
    probe: FloatArray,
    config: ViscosityConfig,
) -> Readings:
    zeros, size = np.zeros(len(viscosity)), np.abs(viscosity)
    return Readings(
        time_s, viscosity, config.reading_noise * size, config.reading_calibration * size, zeros,
        zeros, line, probe, zeros,
        "errors a constant fraction of the reading, as the file states no rotor and speed "
        f"({config.reading_calibration:.0%} calibration, shared)",
    )  # fmt: skip


def _positive(readings: Readings) -> Readings:
    good = readings.viscosity_Pas > 0
    flags = _left_out("not-positive", "a viscosity of zero or less", readings.line[~good])
    return replace(readings.where(good), flags=tuple(flags))


def _full_scales(
    rotor: FloatArray, speed: FloatArray, line: FloatArray, spring_torque: float
) -> FloatArray:
    known: dict[tuple[float, float], float] = {}
    for pair, at in zip(zip(rotor.tolist(), speed.tolist(), strict=True), line, strict=True):
        if pair not in known:
            try:
                if not float(pair[0]).is_integer():
                    raise OutOfRange(f"an NDJ-8S has rotors 1 to 4, not {pair[0]:g}")
                known[pair] = full_scale_Pas(int(pair[0]), pair[1], spring_torque)
            except OutOfRange as error:
                raise FitRefused(f"line {int(at)}: {error}") from error
    return np.array([known[pair] for pair in zip(rotor.tolist(), speed.tolist(), strict=True)])


def _left_out(name: str, why: str, lines: FloatArray) -> list[Flag]:
    if not lines.size:
        return []
    return [Flag(name, f"{why}: {lines.size} readings left out, lines {lines_text(lines)}")]


def _changes(readings: Readings) -> list[Flag]:
    """Say where rotor or speed was changed; of speeds that are swept all the time, the rotor."""
    settings = list(zip(readings.rotor.tolist(), readings.speed_rpm.tolist(), strict=True))
    changed = [i for i in range(1, len(settings)) if settings[i] != settings[i - 1]]
    if len(changed) > len(set(settings)) + 3:
        changed = [i for i in changed if settings[i][0] != settings[i - 1][0]]
    if not changed:
        return []
    said = "; ".join(
        f"{settings[i - 1][0]:g}#{settings[i - 1][1]:g} to {settings[i][0]:g}#{settings[i][1]:g} "
        f"rpm at line {int(readings.line[i])}"
        for i in changed
    )
    return [Flag("setting-changed", f"{said}; each reading has the errors of its own full scale")]
