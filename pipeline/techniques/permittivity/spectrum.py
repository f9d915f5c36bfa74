"""A recorded sweep as complex capacitance, and that as complex permittivity."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.instruments import LcrAccuracy
from deamat.core.recording import Recording
from deamat.core.units import from_si
from deamat.estimators.dielectric.edge_field import edge_terms, vacuum_capacitance
from deamat.estimators.dielectric.impedance import (
    PAIRS,
    ComplexArray,
    Pair,
    complex_capacitance,
    impedance,
    loss_tangent,
)
from deamat.estimators.dielectric.material_pairs import (
    MATERIAL_PAIRS,
    MaterialPair,
    complex_permittivity,
)
from deamat.estimators.dielectric.repeats import sweep_numbers
from deamat.techniques.permittivity.config import PermittivityConfig
from deamat.techniques.permittivity.film import Film

_FAST = "fast"


@dataclass(frozen=True, slots=True)
class Spectrum:
    """The usable points of a sweep in rising order of frequency.

    Parameters
    ----------
    frequency_Hz, capacitance_F : f and $C^* = C_p (1 - j D)$, shape (n,) each
    lines : of the file, counted from 1, shape (n,)
    limit : relative limit of error of the meter at each point, shape (n,)
    sweep : which of several sweeps in one file each point belongs to, from 0, shape (n,)
    mode : what the meter showed (`Cp-D`)
    lost_Hz : frequencies of the points that the meter called over-range, shape (m,)
    """

    frequency_Hz: FloatArray
    capacitance_F: ComplexArray
    lines: NDArray[np.intp]
    limit: FloatArray
    sweep: NDArray[np.intp]
    mode: str
    lost_Hz: FloatArray

    def of(self, kept: NDArray[np.bool_]) -> Spectrum:
        """Return the spectrum of some of its points."""
        return replace(
            self,
            frequency_Hz=self.frequency_Hz[kept],
            capacitance_F=self.capacitance_F[kept],
            lines=self.lines[kept],
            limit=self.limit[kept],
            sweep=self.sweep[kept],
        )

    @property
    def loss(self) -> FloatArray:
        """Loss tangent of what is between the plates, shape (n,) `[1]`."""
        return loss_tangent(self.capacitance_F)

    @property
    def series_capacitance_F(self) -> FloatArray:
        """Capacitance of the circuit in series, which a resistance there leaves alone, (n,)."""
        return self.capacitance_F.real * (1.0 + self.loss**2)

    @property
    def impedance_ohm(self) -> FloatArray:
        """Modulus of the impedance, shape (n,) `[ohm]`."""
        return np.abs(impedance(self.frequency_Hz, self.capacitance_F))


def spectrum_of(
    recording: Recording, empty_F: float, accuracy: LcrAccuracy, config: PermittivityConfig
) -> Spectrum:
    """Take the usable points of a recording as complex capacitance.

    Parameters
    ----------
    empty_F : capacitance of the empty plates, with which a spectrometer's software computed
        permittivities `[F]`

    Raises
    ------
    FitRefused : no pair that gives a capacitance, fewer points than declared, or points without a
        positive capacitance
    """
    columns = recording.columns
    shows: dict[str, Pair | MaterialPair] = {**PAIRS, **MATERIAL_PAIRS}
    modes = [m for m, p in shows.items() if p.primary in columns and p.secondary in columns]
    if "frequency_Hz" not in columns or len(modes) != 1:
        raise FitRefused(
            f"the file holds {', '.join(columns)}, where a frequency and one of "
            f"{', '.join(shows)} belong"
        )
    frequency = columns["frequency_Hz"]
    good = np.ones(frequency.size, dtype=np.bool_)
    if "over_range" in columns:
        good = columns["over_range"] == 0.0
    if np.count_nonzero(good) < config.min_points:
        raise FitRefused(
            f"{np.count_nonzero(good)} of {frequency.size} points are usable, "
            f"{config.min_points} are needed (min_points of [permittivity] in "
            "config/methods.toml): fewer do not show a point that is off, or a step; measure at "
            "more frequencies, in a range that the meter holds",
            {"points": int(np.count_nonzero(good)), "points_needed": config.min_points},
        )
    order = np.flatnonzero(good)[np.argsort(frequency[good], kind="stable")]
    sweep = sweep_numbers(frequency)[order]
    f = frequency[order]
    pair = shows[modes[0]]
    primary, secondary = columns[pair.primary][order], columns[pair.secondary][order]
    if modes[0] in PAIRS:
        capacitance = complex_capacitance(modes[0], f, primary, secondary)
    else:
        capacitance = empty_F * complex_permittivity(modes[0], f, primary, secondary)
    lines = recording.source.first_line + order
    _insist_on_capacitance(f, capacitance, lines)
    limit = accuracy.limit(
        f, np.abs(impedance(f, capacitance)), _level_V(recording, config), fast=_is_fast(recording)
    )
    return Spectrum(f, capacitance, lines, limit, sweep, modes[0], frequency[~good])


def _level_V(recording: Recording, config: PermittivityConfig) -> float:
    """Test level: what the file says, else what the laboratory declares."""
    said = recording.metadata
    return float(said["level_V"]) if "level_V" in said else config.level_V


def _is_fast(recording: Recording) -> bool:
    return "speed" in recording.metadata and recording.metadata["speed"] == _FAST


def _insist_on_capacitance(
    frequency_Hz: FloatArray, capacitance_F: ComplexArray, lines: NDArray[np.intp]
) -> None:
    wrong = np.flatnonzero(~(capacitance_F.real > 0.0))
    if wrong.size:
        at = int(wrong[0])
        raise FitRefused(
            f"{wrong.size} of {frequency_Hz.size} points have no positive capacitance, first "
            f"{from_si(float(capacitance_F.real[at]), 'pF'):.4g} pF at {frequency_Hz[at]:g} Hz "
            f"(line {lines[at]}): not a film between plates; check open and short trimming, the "
            "leads, and the function that the file names",
            {"points_without_capacitance": int(wrong.size)},
        )


def permittivity_of(
    capacitance_F: ComplexArray, film: Film, edge_field: str
) -> tuple[FloatArray, FloatArray]:
    r"""Relative permittivity and loss tangent of the film.

    $\epsilon_r^* = (C^* - a) / (C_v + b)$ with the empty plates' $C_v = \epsilon_0 A / d$ and the
    edge's $C_e^* = a + b\,\epsilon_r^*$; without an edge field a = b = 0.

    Parameters
    ----------
    capacitance_F : $C^*$, shape (n,)
    edge_field : `"none"`, `"flush"` or `"overhanging"`

    Returns
    -------
    permittivity and loss tangent, shape (n,) each `[1]`
    """
    a, b = 0.0, 0.0
    if edge_field != "none":
        a, b = edge_terms(edge_field, film.thickness_m, film.perimeter_m)
    vacuum = vacuum_capacitance(film.area_m2, film.thickness_m)
    permittivity = (capacitance_F - a) / (vacuum + b)
    return permittivity.real.copy(), loss_tangent(permittivity)
