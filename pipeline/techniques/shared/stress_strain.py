"""From a machine's columns and the register's geometry to nominal stress and strain."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.instruments import Machine
from deamat.core.quantity import Contribution, Quantity
from deamat.core.recording import Recording
from deamat.core.records import Flag
from deamat.estimators.curves.lone import lone_readings, without
from deamat.estimators.curves.start import find_hold, zero_of_position
from deamat.estimators.curves.stress_strain import loading_branch
from deamat.techniques.shared.geometry import Section, inverted, scale_budget
from deamat.techniques.shared.outcome import line_span

IndexArray = NDArray[np.intp]

_SMALL_STRAIN = 0.05  # up to which the file's own stress is held against force over area
_FEWEST = 8  # samples for that at least
_CHANNELS = ("displacement_m", "force_N", "nominal_strain", "nominal_stress_Pa")
_MOST_LONE = 3  # wild readings in one channel


Own = tuple[FloatArray | None, FloatArray | None]


@dataclass(frozen=True, slots=True)
class StressStrain:
    """A nominal stress-strain curve, signed so that loading is positive.

    Parameters
    ----------
    nominal_strain : displacement over the initial length, shape (n,) `[1]`
    nominal_stress_Pa : force over the initial area, shape (n,) `[Pa]`
    strain_budget, stress_budget : relative standard uncertainties of their scales `[1]`
    stress_resolution_Pa : one step of the load cell over the area `[Pa]`
    basis : which columns and whose geometry, in words
    own : the file's own (strain, stress) where they stand beside force and displacement, None for
        one that does not
    extensometer : strain of an extensometer that stands beside the displacement, shape (n,)
    compliance_per_Pa, u_compliance_per_Pa : strain of the machine for a stress, which was
        subtracted, and its standard uncertainty; None where no compliance is declared
    first : index of the first sample of the test: the last one before the machine moves
    flags : what was found at the start (an absolute position, grips that closed), wild readings
    """

    nominal_strain: FloatArray
    nominal_stress_Pa: FloatArray
    strain_budget: tuple[Contribution, ...]
    stress_budget: tuple[Contribution, ...]
    stress_resolution_Pa: float
    basis: str
    own: Own | None
    extensometer: FloatArray | None = None
    compliance_per_Pa: float | None = None
    u_compliance_per_Pa: float = 0.0
    first: int = 0
    flags: tuple[Flag, ...] = ()


def stress_strain(
    recording: Recording,
    section: Section,
    length: Quantity,
    length_name: str,
    machine: Machine,
    own_stress_refused: float = math.inf,
) -> StressStrain:
    r"""Reduce a recording to nominal stress and strain, loading positive.

    $$ \varepsilon = \pm \Delta l / l_0, \qquad \sigma = \pm F / A_0 $$

    Force and displacement are preferred, with the register's geometry; the file's own columns
    then only serve as a check. A file with nothing but its own columns is used as it is: the
    geometry was its exporter's, and its uncertainty cannot enter. The signs are those of the
    greatest excursions from the first sample while loading, so exports of either sign agree. Where
    the machine's compliance C is declared, $C F$ is subtracted from the displacement.

    Parameters
    ----------
    recording : with `force_N` and `displacement_m`, or `nominal_strain` and `nominal_stress_Pa`
    section, length : initial area, and height or gauge length `[m]`
    length_name : what to call the length (`height`)
    machine : resolution and calibration of load cell and crosshead, and its compliance
    own_stress_refused : relative difference to the file's own stress from which nothing is taken

    Raises
    ------
    FitRefused : columns are missing, not finite, or never move; the file's own stress is another;
        or more than a few single readings of a channel stand off both of their neighbours
    """
    columns, wild = _without_lone_readings(recording)
    strain_budget: tuple[Contribution, ...] = (
        machine.shared_error(
            "displacement calibration", "displacement", machine.u_displacement_calibration
        ),
    )
    stress_budget: tuple[Contribution, ...] = (
        machine.shared_error("load cell calibration", "force", machine.u_force_calibration),
    )
    compliance: float | None = None
    u_compliance = 0.0
    own_strain, own_stress = columns.get("nominal_strain"), columns.get("nominal_stress_Pa")
    own: Own | None = None
    if "force_N" in columns and "displacement_m" in columns:
        strain, stress = _loading_positive(
            columns["displacement_m"], columns["force_N"], length.value, section.area_m2
        )
        strain_budget += inverted(scale_budget(length_name, length))
        stress_budget += inverted(section.budget)
        basis = f"force over the register's cross-section, displacement over its {length_name}"
        if own_stress is not None:
            _insist_on_own_stress(strain, stress, own_stress, own_stress_refused)
        own_strain, own_stress = _own(own_strain, own_stress, strain, stress)
        if machine.compliance_m_per_N is not None:
            per_Pa = section.area_m2 / length.value
            compliance = per_Pa * machine.compliance_m_per_N
            u_compliance = per_Pa * machine.u_compliance_m_per_N
            strain = strain - compliance * stress
            own_strain = None if own_strain is None else own_strain - compliance * stress
            basis += ", less the machine's compliance"
        if own_strain is not None or own_stress is not None:
            own = own_strain, own_stress
    elif own_strain is not None and own_stress is not None:
        strain, stress = _loading_positive(own_strain, own_stress)
        basis = (
            "the file's own stress and strain; the geometry behind them is the exporter's, could "
            "not be checked and is in no uncertainty"
        )
    else:
        raise FitRefused(
            "a stress-strain curve needs force_N and displacement_m, or nominal_strain and "
            f"nominal_stress_Pa; the file has {', '.join(sorted(columns)) or 'no columns'}"
        )
    return _from_its_start(
        StressStrain(
            strain,
            stress,
            strain_budget,
            stress_budget,
            machine.force_resolution_N / section.area_m2,
            basis,
            own,
            columns.get("extensometer_strain"),
            compliance,
            u_compliance,
            flags=wild,
        )
    )


def _without_lone_readings(
    recording: Recording,
) -> tuple[Mapping[str, FloatArray], tuple[Flag, ...]]:
    """Replace single readings off both of their neighbours, and say where they are.

    Raises
    ------
    FitRefused : there are many of them
    """
    columns, flags = dict(recording.columns), list[Flag]()
    for name in _CHANNELS:
        values = columns.get(name)
        if values is None or not (lone := lone_readings(values)).size:
            continue
        shown = [line_span(recording.source, values.size, i, i)[0] for i in lone[:_MOST_LONE]]
        lines = ", ".join(map(str, shown))
        told = f"{name} stands off both neighbours, which agree, in line {lines}"
        if lone.size > _MOST_LONE:
            raise FitRefused(
                f"{told} and {lone.size - _MOST_LONE} others: the channel is not to be trusted"
            )
        columns[name] = without(values, lone)
        flags.append(Flag("wild-reading", f"{told}: taken as the mean of both"))
    return columns, tuple(flags)


def _insist_on_own_stress(
    strain: FloatArray, stress_Pa: FloatArray, own_Pa: FloatArray, tolerance: float
) -> None:
    """Refuse a file whose own stress rises otherwise than force over the cross-section.

    Over the first strain, where true and nominal stress hardly differ.
    """
    end = max(int(np.searchsorted(np.maximum.accumulate(strain), _SMALL_STRAIN)), _FEWEST)
    ours, theirs = stress_Pa[:end] - stress_Pa[0], own_Pa[:end] - own_Pa[0]
    rise = float(ours @ ours)
    if rise == 0.0:
        return
    ratio = abs(float(theirs @ ours)) / rise
    if ratio > 1.0 + tolerance or ratio < 1.0 / (1.0 + tolerance):
        raise FitRefused(
            f"the file's own stress is {ratio:.4g} times force over the register's cross-section: "
            "the unit of one of the columns, or the register's geometry, is wrong; nothing says "
            "which (own_stress_refused is the difference from which this is refused)",
            {"own_stress_over_ours": ratio},
        )


def _from_its_start(curve: StressStrain) -> StressStrain:
    """Count strain from where the test began, if the first position is no strain."""
    hold = find_hold(curve.nominal_strain, curve.nominal_stress_Pa)
    strain = curve.nominal_strain
    flags = curve.flags
    if hold.gripping:
        flags += (
            Flag(
                "grips",
                f"the load changes by {100 * hold.load_change:.2g} % of its greatest value in the "
                f"first {hold.last + 1} samples, before the machine moves: grips or plates closing",
            ),
        )
    branch = hold.last + loading_branch(strain[hold.last :] - strain[hold.last])
    loading = slice(hold.last, branch)
    if zero_of_position(strain[loading], curve.nominal_stress_Pa[loading]) == "absolute":
        start = float(strain[hold.last])
        flags += (
            Flag(
                "displacement-zeroed",
                f"displacement starts at {100 * start:.4g} % of the length without the load of "
                "such a strain: it is the machine's position, and counts from the first sample",
            ),
        )
        strain = strain - start
    return replace(curve, nominal_strain=strain, first=hold.last, flags=flags)


def _loading_positive(
    path: FloatArray, load: FloatArray, length: float = 1.0, area: float = 1.0
) -> tuple[FloatArray, FloatArray]:
    """Divide by length and area, signed by where the loading takes the two columns."""
    if path.size == 0:
        raise FitRefused("the file has no samples")
    far, reach = _excursion(path)
    if not (math.isfinite(reach) and math.isfinite(np.add.reduce(load))):
        raise FitRefused("displacement, force, strain or stress holds values that are not finite")
    if reach == 0.0:
        raise FitRefused(
            f"displacement (or strain) is the same in all {path.size} samples: nothing was loaded"
        )
    _, rise = _excursion(load[: far + 1])
    return path / math.copysign(length, reach), load / math.copysign(area, rise)


def _own(
    own_strain: FloatArray | None,
    own_stress: FloatArray | None,
    strain: FloatArray,
    stress: FloatArray,
) -> Own:
    """Sign the file's own columns as loading; a missing one takes the sign of the other channel.

    A strain that never changes is of a channel that was not connected.
    """
    if own_strain is not None and not np.ptp(own_strain) > 0.0:
        own_strain = None
    if own_strain is None and own_stress is None:
        return None, None
    signed = _loading_positive(
        strain if own_strain is None else own_strain, stress if own_stress is None else own_stress
    )
    return (
        None if own_strain is None else signed[0],
        None if own_stress is None else signed[1],
    )


def _excursion(values: FloatArray) -> tuple[int, float]:
    """Find the first sample that is farthest from sample 0, and its signed distance."""
    up, down = int(values.argmax()), int(values.argmin())
    start = float(values[0])
    rise, fall = float(values[up]) - start, float(values[down]) - start
    if rise == -fall:
        return min((up, rise), (down, fall))
    return (up, rise) if rise > -fall else (down, fall)


def _rounding(values: FloatArray) -> float:
    """Half the step of a column that is coarser than its sampling, else zero."""
    steps = np.abs(np.diff(values))
    moved = steps[steps > 0.0]
    return 0.5 * float(moved.min()) if 0 < moved.size < steps.size else 0.0


def disagreement(curve: StressStrain, inside: IndexArray, tolerance: float) -> tuple[Flag, ...]:
    """Hold the file's own stress and strain against force, displacement and geometry.

    Parameters
    ----------
    inside : indices of the samples to compare
    tolerance : greatest difference, relative to the greatest value among them, to pass unnoticed
    """
    if curve.own is None:
        return ()
    flags = []
    pairs = (
        ("strain", curve.own[0], curve.nominal_strain),
        ("stress", curve.own[1], curve.nominal_stress_Pa),
    )
    for name, theirs, ours in pairs:
        if theirs is None:
            continue
        a, b = theirs[inside], ours[inside]
        size = float(np.abs(b).max())
        worst = float(np.abs(a - b).max())
        ratio = float(a.dot(b) / b.dot(b)) if size > 0.0 else 1.0
        if worst > tolerance * size + _rounding(a) and size > 0.0:
            flags.append(
                Flag(
                    "own-columns-disagree",
                    f"the file's own {name} is {ratio:.4f} times what force, "
                    "displacement and the register's geometry give; they differ by up to "
                    f"{100 * worst / size:.2g} % of the {name} there",
                )
            )
    return tuple(flags)
