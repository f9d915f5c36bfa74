r"""What the probe says of the liquid: steady, corrected to one temperature, or drifting.

$\mu(T) = \mu(T_\mathrm{ref}) \exp\!\big(\tfrac{E}{R}(\tfrac1T - \tfrac1{T_\mathrm{ref}})\big)$ with
the activation energy E of flow, declared or fitted beside a flexible polynomial in time. A drift
that goes along with time cannot be told from curing, and is not fitted.

Source: E. N. da C. Andrade, Philos. Mag. 17 (1934) 497.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.laws import GAS_CONSTANT_J_per_molK
from deamat.core.records import Flag, MeasuredValue, Measurement
from deamat.estimators.least_squares.linear import fit_linear
from deamat.techniques.viscosity.config import ViscosityConfig
from deamat.techniques.viscosity.readings import ZERO_C_K, Readings, tenth_of_degree
from deamat.techniques.viscosity.result import Run

_DEGREE = 5
_SMOOTHED = 5
# A fitted energy is used if what it corrects is known to this part of the viscosity, and if it is
# one that flow can have.
_KNOWN_TO = 0.02
_PLAUSIBLE_J_per_mol = 3e3, 2e5


@dataclass(frozen=True, slots=True)
class Probe:
    """Temperature of the liquid over a run.

    Parameters
    ----------
    mean_K : that the values hold for: of the readings where it is steady, else the reference
    drifts : it moved by more than the tolerance and nothing corrects it
    """

    mean_K: float
    drifts: bool = False


def at_one_temperature(
    readings: Readings, config: ViscosityConfig, stated_K: float | None
) -> tuple[Readings, Probe | None]:
    """Bring the readings to one temperature where the probe says that it moved.

    Parameters
    ----------
    stated_K : what the register states of the run, the reference; the median of the probe if None

    Returns
    -------
    readings, corrected and with the error that the correction leaves, or as they were; and the
    temperature, None where no probe was read
    """
    kelvin = readings.temperature_K
    if not len(kelvin) or np.isnan(kelvin).any():
        return readings, None
    spread = float(np.ptp(_smooth(kelvin)))
    if spread <= config.temperature_drift_K:
        return readings, Probe(tenth_of_degree(float(kelvin.mean())))
    reference = float(np.median(kelvin))
    if stated_K is not None and kelvin.min() <= stated_K <= kelvin.max():
        reference = stated_K
    moved = (
        f"the temperature moves by {spread:.3g} K within the run, from "
        f"{kelvin[0] - ZERO_C_K:.3g} to {kelvin[-1] - ZERO_C_K:.3g} C"
    )
    try:
        energy, u, whence = _energy(readings, reference, config)
    except FitRefused as error:
        flag = Flag(
            "temperature-drift",
            f"{moved}: each value is of the liquid at its own temperature, and no law is given; "
            f"{error}",
        )
        drifting = replace(readings, flags=(*readings.flags, flag))
        return drifting, Probe(reference, drifts=True)
    x = (1.0 / kelvin - 1.0 / reference) / GAS_CONSTANT_J_per_molK
    corrected = readings.viscosity_Pas * np.exp(-energy * x)
    flag = Flag(
        "temperature-corrected",
        f"{moved}: corrected to {reference - ZERO_C_K:.3g} C by up to "
        f"{np.abs(energy * x).max():.1%} with an activation energy of {energy / 1e3:.3g} -+ "
        f"{u / 1e3:.2g} kJ/mol, {whence}",
    )
    return replace(
        readings,
        viscosity_Pas=corrected,
        noise_Pas=readings.noise_Pas * np.exp(-energy * x),
        calibration_Pas=readings.calibration_Pas * np.exp(-energy * x),
        thermal_Pas=u * x * corrected,
        flags=(*readings.flags, flag),
    ), Probe(tenth_of_degree(reference))


def _smooth(kelvin: FloatArray) -> FloatArray:
    """Take the noise of the probe off: running medians of five."""
    if len(kelvin) < _SMOOTHED:
        return kelvin
    around = np.lib.stride_tricks.sliding_window_view(kelvin, _SMOOTHED)
    return np.asarray(np.median(around, axis=1))


def temperature_at_K(readings: Readings, time_s: float) -> float:
    """Temperature of the liquid at a time `[K]`, to a tenth."""
    return tenth_of_degree(float(np.interp(time_s, readings.time_s, readings.temperature_K)))


def alike(
    measurements: Sequence[Measurement[Run]], tolerance_K: float
) -> tuple[Measurement[Run], ...]:
    """Give values of runs at nearly one temperature their mean temperature as condition."""
    kelvin = sorted({k for m in measurements for v in m.values if (k := _of(v)) is not None})
    means: dict[float, float] = {}
    while kelvin:
        together = [k for k in kelvin if k <= kelvin[0] + tolerance_K]
        kelvin = kelvin[len(together) :]
        means |= dict.fromkeys(together, tenth_of_degree(math.fsum(together) / len(together)))
    return tuple(replace(m, values=tuple(_with(v, means) for v in m.values)) for m in measurements)


def _of(value: MeasuredValue) -> float | None:
    kelvin = value.conditions.get("temperature_K")
    return kelvin if isinstance(kelvin, float) else None


def _with(value: MeasuredValue, means: Mapping[float, float]) -> MeasuredValue:
    kelvin = _of(value)
    if kelvin is None:
        return value
    return replace(value, conditions={**value.conditions, "temperature_K": means[kelvin]})


def refuse_mixed_temperatures(probes: Mapping[str, Probe | None], tolerance_K: float) -> None:
    """Refuse one law to runs at several temperatures, or to one whose temperature drifts.

    Parameters
    ----------
    probes : specimen to the temperature of its liquid

    Raises
    ------
    FitRefused : so it is
    """
    drifting = [name for name, probe in probes.items() if probe is not None and probe.drifts]
    if drifting:
        raise FitRefused(
            f"the temperature drifts in {', '.join(drifting)}, and a law is of one temperature; "
            "measure in a bath, or declare [viscosity.activation_energy] with its source"
        )
    means = {name: probe.mean_K for name, probe in probes.items() if probe is not None}
    if means and max(means.values()) - min(means.values()) > tolerance_K:
        told = ", ".join(f"{name} {kelvin - ZERO_C_K:.3g} C" for name, kelvin in means.items())
        raise FitRefused(f"the runs were at several temperatures ({told}): no one law is theirs")


def _energy(
    readings: Readings, reference_K: float, config: ViscosityConfig
) -> tuple[float, float, str]:
    """Activation energy of flow and its standard uncertainty `[J/mol]`, and where it is from."""
    declared = config.activation_energy
    if declared is not None:
        return declared.J_per_mol, declared.u_J_per_mol, f"declared: {declared.source}"
    t = readings.time_s
    inverse = (1.0 / readings.temperature_K - 1.0 / reference_K) / GAS_CONSTANT_J_per_molK
    if len(t) < 2 * (_DEGREE + 2):
        raise FitRefused(_DECLARE.format("too few readings tell what the temperature does"))
    x = 2.0 * (t - t[0]) / (t[-1] - t[0]) - 1.0
    scale = float(np.abs(inverse).max())
    terms = np.polynomial.chebyshev.chebvander(x, _DEGREE)
    design = np.concatenate([terms, inverse[:, None] / scale], axis=1)
    y = np.log(readings.viscosity_Pas)
    try:
        fit = fit_linear(design, y, readings.noise_Pas / readings.viscosity_Pas)
    except FitRefused as error:
        raise FitRefused(_DECLARE.format("the temperature moves along with time")) from error
    energy, u = float(fit.parameters[-1]) / scale, float(fit.standard_errors[-1]) / scale
    low, high = _PLAUSIBLE_J_per_mol
    if u * scale > _KNOWN_TO or not low <= energy <= high:
        raise FitRefused(
            _DECLARE.format(
                f"the readings give an activation energy of {energy / 1e3:.3g} -+ {u / 1e3:.2g} "
                "kJ/mol, for the temperature moves along with time"
            )
        )
    return energy, u, "fitted beside the curing"


_DECLARE = "{}; measure in a bath, or declare [viscosity.activation_energy] with its source"
