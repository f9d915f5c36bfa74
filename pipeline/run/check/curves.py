"""Which curve of a recording a technique looks at, and what it shows without any dimension."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.instruments import LcrAccuracy
from deamat.core.recording import Recording
from deamat.core.units import from_si, si_factor
from deamat.estimators.curves.slope import fit_line
from deamat.estimators.curves.stress_strain import loading_branch, reloads
from deamat.estimators.dielectric.repeats import sweep_numbers
from deamat.run.check.found import Axis, Curve, Value
from deamat.techniques.permittivity.config import PermittivityConfig
from deamat.techniques.permittivity.spectrum import Spectrum, spectrum_of

_LOW, _HIGH = 0.05, 0.25  # of the travel: past the contact, before the curve bends
_FEWEST = 4  # samples of a slope


@dataclass(frozen=True, slots=True)
class Pair:
    """Two columns of a recording, and how people read them."""

    x: str
    y: str
    x_axis: Axis
    y_axis: Axis


_TRAVEL, _FORCE, _TIME = Axis("displacement", "mm"), Axis("force", "N"), Axis("time", "s")
_VISCOSITY = Axis("viscosity", "Pa.s", log=True)
_CURVES = (
    Pair("displacement_m", "force_N", _TRAVEL, _FORCE),
    Pair("nominal_strain", "nominal_stress_Pa", Axis("strain", "%"), Axis("stress", "kPa")),
)
PAIRS: Mapping[str, Sequence[Pair]] = {
    "compression": _CURVES,
    "tension": _CURVES,
    "nanoindentation": (Pair("depth_m", "force_N", Axis("depth", "um"), Axis("force", "uN")),),
    "breakdown": (Pair("time_s", "voltage_V", _TIME, Axis("voltage", "kV")),),
    "viscosity": (
        Pair("shear_rate_per_s", "viscosity_Pas", Axis("shear rate", "1/s", log=True), _VISCOSITY),
        Pair("time_s", "viscosity_Pas", Axis("time", "h"), _VISCOSITY),
    ),
}


def pair_of(technique: str, recording: Recording) -> Pair | None:
    """Find the first pair of columns that a recording has."""
    columns = recording.columns
    return next((p for p in PAIRS.get(technique, ()) if p.x in columns and p.y in columns), None)


def curve_of(technique: str, recording: Recording) -> Curve | None:
    """Return the curve that a technique looks at; None where it has nothing to look at.

    Raises
    ------
    FitRefused : a sweep that is no capacitance
    """
    if technique == "permittivity":
        return _spectrum_curve(recording)
    pair = pair_of(technique, recording)
    if pair is None:
        return None
    x, y = recording.columns[pair.x], recording.columns[pair.y]
    good = np.isfinite(x) & np.isfinite(y)
    for axis, values in ((pair.x_axis, x), (pair.y_axis, y)):
        good &= (values > 0.0) | (not axis.log)
    return Curve(
        pair.x_axis, pair.y_axis, _in(pair.x_axis.unit, x[good]), _in(pair.y_axis.unit, y[good])
    )


def _in(unit: str, values: FloatArray) -> tuple[float, ...]:
    scaled: list[float] = (from_si(1.0, unit) * values).tolist()
    return tuple(scaled)


def bare_values(technique: str, recording: Recording) -> tuple[Value, ...]:
    """Return what a recording says without any dimension of its specimen.

    Raises
    ------
    FitRefused : a sweep that is no capacitance
    """
    if technique == "permittivity":
        return _of_sweep(recording)
    pair = pair_of(technique, recording)
    if pair is None:
        return ()
    x, y = recording.columns[pair.x], recording.columns[pair.y]
    found = [_greatest(pair.y_axis, y), _greatest(pair.x_axis, x)]
    if pair.y == "force_N" and pair.x == "displacement_m":
        stiffness = _stiffness(x, y)
        return (*([stiffness] if stiffness else []), *found)
    return tuple(found)


def runs_of(technique: str, recording: Recording) -> str:
    """Say how many runs a recording holds; empty for one."""
    columns = recording.columns
    if technique == "permittivity" and "frequency_Hz" in columns:
        sweeps = int(sweep_numbers(columns["frequency_Hz"]).max()) + 1
        return f"{sweeps} sweeps" if sweeps > 1 else ""
    if "samples" in recording.metadata:
        return f"samples {recording.metadata['samples']}"
    pair = pair_of(technique, recording)
    if pair is None or pair not in _CURVES:
        return ""
    moved = _positive(columns[pair.x] - columns[pair.x][0])
    if not moved.max() > 0.0 or not reloads(moved, loading_branch(moved)):
        return ""
    return "loaded more than once; only the first loading is used"


def _greatest(axis: Axis, values: FloatArray) -> Value:
    greatest = float(np.nanmax(np.abs(values)))
    said = f"{from_si(greatest, axis.unit):.4g}" + (f" {axis.unit}" if axis.unit != "1" else "")
    name = f"greatest {axis.name}"
    return Value(name, greatest, None, si_factor(axis.unit)[0], said, "largest absolute value")


def _stiffness(travel: FloatArray, force: FloatArray) -> Value | None:
    """Slope of force over travel between 5 and 25 % of the travel of the first loading `[N/m]`."""
    moved, loaded = _positive(travel - travel[0]), _positive(force - force[0])
    branch = loading_branch(moved)
    moved, loaded = moved[:branch], loaded[:branch]
    inside = (moved >= _LOW * moved.max()) & (moved <= _HIGH * moved.max())
    if np.count_nonzero(inside) < _FEWEST or not np.ptp(moved[inside]) > 0.0:
        return None
    line = fit_line(moved[inside], loaded[inside])
    span = f"{_LOW:.0%} to {_HIGH:.0%} of the travel".replace("%", " %")
    return Value(
        "stiffness", line.slope, line.standard_error, "N/m", f"{line.slope:.4g} N/m",
        f"slope of force over displacement, {span} of the first loading",
    )  # fmt: skip


def _positive(values: FloatArray) -> FloatArray:
    return values if abs(values.max()) >= abs(values.min()) else -values


def _sweep(recording: Recording) -> tuple[Spectrum, bool]:
    """Return the sweep as capacitance, or as permittivity (True) where the file computed it."""
    spectrum = spectrum_of(recording, 1.0, LcrAccuracy(), PermittivityConfig())
    computed = {"relative_permittivity", "electric_modulus"} & set(recording.columns)
    return spectrum, bool(computed)


def _spectrum_curve(recording: Recording) -> Curve:
    spectrum, computed = _sweep(recording)
    y_axis = Axis("relative permittivity", "1") if computed else Axis("capacitance", "pF")
    return Curve(
        Axis("frequency", "Hz", log=True), y_axis, _in("Hz", spectrum.frequency_Hz),
        _in(y_axis.unit, spectrum.capacitance_F.real),
    )  # fmt: skip


def _of_sweep(recording: Recording) -> tuple[Value, ...]:
    spectrum, computed = _sweep(recording)
    target = PermittivityConfig().card_frequency_Hz
    at = int(np.abs(np.log(spectrum.frequency_Hz / target)).argmin())
    c, loss = float(spectrum.capacitance_F.real[at]), float(spectrum.loss[at])
    where = f"at {spectrum.frequency_Hz[at]:.6g} Hz"
    how = f"from {spectrum.mode}, the point nearest to {target:g} Hz"
    name, unit, said = "capacitance", "F", f"{from_si(c, 'pF'):.4g} pF {where}"
    if computed:
        name, unit, said = "relative permittivity", "1", f"{c:.4g} {where}"
    return (
        Value(name, c, None, unit, said, how),
        Value("loss tangent", loss, None, "1", f"{loss:.4g} {where}", how),
    )
