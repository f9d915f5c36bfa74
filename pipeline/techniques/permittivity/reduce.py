"""One film: its sweep to permittivity and loss at the frequency of the card."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Condition, Detail, Flag, MeasuredValue, Measurement
from deamat.core.technique import Context
from deamat.estimators.dielectric.sweep import (
    Position,
    position,
    series_resistance,
    slope_per_decade,
)
from deamat.techniques.permittivity.card_point import CardPoint, card_point
from deamat.techniques.permittivity.cell import says_nothing, stated_cell
from deamat.techniques.permittivity.config import LOSS, PERMITTIVITY, PermittivityConfig
from deamat.techniques.permittivity.faults import conduction_flags
from deamat.techniques.permittivity.film import Film, film_flags, film_of
from deamat.techniques.permittivity.result import Dependence, FilmSpectrum
from deamat.techniques.permittivity.spectrum import Spectrum, permittivity_of, spectrum_of
from deamat.techniques.shared.outcome import nothing_measured, recorded, refusal, relative_lines

_LIMIT_TO_SIGMA = math.sqrt(3.0)  # a limit without further knowledge: rectangular, GUM 4.3.7
_RESISTANCE_TOLD = 3.0  # standard errors from which a series resistance is told from noise


@dataclass(frozen=True, slots=True)
class Reading:
    """A film's spectrum, read at the frequency of the card.

    Parameters
    ----------
    point : the card's frequency in the spectrum, and what the sweep's faults do there
    permittivity, loss : of the film at every point of the spectrum, shape (n,) each `[1]`
    resistance : in series with the film, with its standard error `[ohm]`, where there are points
    """

    film: Film
    point: CardPoint
    permittivity: FloatArray
    loss: FloatArray
    resistance: tuple[float, float] | None
    context: Context[PermittivityConfig]

    @property
    def config(self) -> PermittivityConfig:
        """Settings of the room."""
        return self.context.config

    def meter(self, u: float) -> Contribution:
        """Return the error of the meter's impedance."""
        return self.context.machine.shared_error("LCR meter", "impedance", u)

    def meter_of_loss(self, u: float) -> Contribution:
        """Return the error of the meter's phase: it is another one."""
        line = self.meter(u)
        calibrated = None if line.calibration is None else "loss"
        return replace(line, source=f"{line.source}, phase", calibrated=calibrated)

    @property
    def spectrum(self) -> Spectrum:
        """The sound points."""
        return self.point.spectrum

    @property
    def where(self) -> Position:
        """The card's frequency in the spectrum."""
        return self.point.where

    @property
    def conditions(self) -> dict[str, Condition]:
        """What the technique itself fixes."""
        return {"frequency_Hz": self.point.frequency_Hz}

    @property
    def lines(self) -> tuple[int, int]:
        """First and last line of the file that the card's value rests on."""
        lines = self.spectrum.lines[self.where.indices]
        return int(lines.min()), int(lines.max())

    @property
    def how(self) -> str:
        """How the card's frequency was reached, in words."""
        way = "interpolated in log f to" if self.where.interpolated else "measured at"
        if self.where.extrapolated:
            way = "continued in log f from its neighbours to"
        return f"{way} {self.point.frequency_Hz:g} Hz, from {self.spectrum.mode}"

    @property
    def impedance_ohm(self) -> float:
        """Modulus of the impedance at the card's frequency."""
        return self.where.of(self.spectrum.impedance_ohm)

    def edge_fraction(self, edge_field: str) -> float:
        """Part of the capacitance that is edge field, by one of the corrections `[1]`."""
        bare, _ = permittivity_of(self.spectrum.capacitance_F, self.film, "none")
        corrected, _ = permittivity_of(self.spectrum.capacitance_F, self.film, edge_field)
        return 1.0 - self.where.of(corrected) / self.where.of(bare)


def reduce(
    specimen: Specimen, recording: Recording | None, context: Context[PermittivityConfig]
) -> Measurement[FilmSpectrum]:
    r"""Reduce one film to permittivity and loss; the whole sweep is kept as its curve.

    $\epsilon_r = C_p d / (\epsilon_0 A)$ and $\tan\delta$ at the card's frequency, measured there
    or interpolated in log f; see `card_point` for sweeps with faults. The meter's limit
    of error $A_e(|Z|, f)$ counts as rectangular, $u = A_e / \sqrt 3$, shared by all films: the
    same meter errs alike.

    Parameters
    ----------
    specimen : see `film_of` for the numbers
    recording : frequency and one pair of `PAIRS` (what a meter shows) or `MATERIAL_PAIRS` (what a
        spectrometer computed, with the cell that its file states, else with the register's)
    context : with the compressive modulus among its needs

    Source: ASTM D150; LCR-6000 manual, 13.1 for the limits of C and D.
    """
    config = context.config
    try:
        file = recorded(recording)
        film, empty_F = _film(specimen, file, context)
        spectrum = spectrum_of(file, empty_F, context.machine.impedance, config)
    except FitRefused as error:
        return nothing_measured(specimen, (PERMITTIVITY, LOSS), error, recording)
    at: dict[str, Condition] = {"frequency_Hz": config.card_frequency_Hz}
    try:
        point = card_point(spectrum, config)
        curve = _curve(point.spectrum, film, config)
        reading = _read(film, point, curve, context)
        dependence = _dependence(reading)
    except FitRefused as error:
        refusals = tuple(refusal(specimen, key, error, at) for key in (PERMITTIVITY, LOSS))
        return Measurement(specimen, (), refusals, _curve(spectrum, film, config), file.source)
    flags = file.flags + _flags(reading, "level_V" in file.metadata)
    values: tuple[MeasuredValue, ...] = (_permittivity(reading, dependence, flags),)
    refused = {key: point.not_at for key in (PERMITTIVITY, LOSS) if point.not_at}
    try:
        values += (_loss(reading, flags),)
    except FitRefused as error:
        refused[LOSS] = error.reason
    return Measurement(
        specimen,
        values,
        tuple(refusal(specimen, key, FitRefused(why), at) for key, why in refused.items()),
        replace(curve, dependence=dependence),
        file.source,
    )


def _film(
    specimen: Specimen, file: Recording, context: Context[PermittivityConfig]
) -> tuple[Film, float]:
    """Take the film from its row, or from a file that states it, and the empty cell's F."""
    cell = stated_cell(file.metadata)
    if cell is None:
        film = film_of(specimen.numbers, context)
        return film, film.empty_F
    if says_nothing(specimen.numbers):
        return cell.film(context.config), cell.vacuum_F
    film = film_of(specimen.numbers, context)
    return replace(film, edge_corrected=cell.edge_corrected), cell.vacuum_F


def _read(
    film: Film, point: CardPoint, curve: FilmSpectrum, context: Context[PermittivityConfig]
) -> Reading:
    sound = point.spectrum
    resistance = series_resistance(sound.frequency_Hz, sound.series_capacitance_F, sound.loss)
    return Reading(
        film, point, curve.relative_permittivity, curve.loss_tangent, resistance, context
    )


def _curve(spectrum: Spectrum, film: Film, config: PermittivityConfig) -> FilmSpectrum:
    permittivity, loss = permittivity_of(spectrum.capacitance_F, film, _edge_field(film, config))
    return FilmSpectrum(spectrum.frequency_Hz, permittivity, loss)


def _edge_field(film: Film, config: PermittivityConfig) -> str:
    """Which correction is still to be made."""
    return "none" if film.edge_corrected else config.edge_field


def _permittivity(
    reading: Reading, dependence: Dependence, flags: tuple[Flag, ...]
) -> MeasuredValue:
    config, spectrum = reading.config, reading.spectrum
    value = reading.where.of(reading.permittivity) * reading.point.factor
    limit = reading.where.of(spectrum.limit * np.hypot(1.0, spectrum.loss))
    edge_field = _edge_field(reading.film, config)
    edge = config.u_edge_field * reading.edge_fraction(edge_field)
    budget = relative_lines(
        value,
        (
            *reading.film.budget,
            reading.meter(limit / _LIMIT_TO_SIGMA),
            Contribution("edge field", edge, shared=True),
            *reading.point.found.permittivity,
        ),
    )
    flags += film_flags(reading.film, config) + _edge_flags(reading)
    if limit > config.accuracy_flag:
        flags += (
            Flag(
                "meter-limit",
                f"at |Z| = {reading.impedance_ohm:.2g} ohm the meter promises no better than "
                f"+- {100 * limit:.2g} %; check it against a reference capacitor of that "
                "impedance and declare the result",
            ),
        )
    edge_words = "not corrected" if edge_field == "none" else f"of a {edge_field} film"
    if reading.film.edge_corrected:
        edge_words = "corrected by the spectrometer's software"
    return MeasuredValue(
        key=PERMITTIVITY,
        quantity=Quantity.from_budget(value, "1", budget),
        budget=budget,
        method=f"C d / (eps0 A) {reading.how}; {reading.film.correction}; edge field {edge_words}",
        conditions=reading.conditions,
        lines=reading.lines,
        diagnostics={
            **_film_diagnostics(reading, value),
            **_dependence_diagnostics(dependence),
            **_resistance_diagnostics(reading.resistance),
        },
        flags=flags,
    )


def _loss(reading: Reading, flags: tuple[Flag, ...]) -> MeasuredValue:
    spectrum = reading.spectrum
    if reading.point.no_loss:
        raise FitRefused(reading.point.no_loss)
    value = reading.where.of(reading.loss)
    u = reading.where.of(spectrum.limit * (1.0 + np.abs(spectrum.loss))) / _LIMIT_TO_SIGMA
    flags += conduction_flags(spectrum, reading.point.frequency_Hz, u)
    if abs(value) < 2.0 * u:
        flags += (
            Flag(
                "loss-unresolved",
                f"{value:.2g}, where the meter tells losses to +- {2 * u:.2g}: not told from zero",
            ),
        )
    budget = (reading.meter_of_loss(u), *reading.point.found.loss)
    return MeasuredValue(
        key=LOSS,
        quantity=Quantity.from_budget(value, "1", budget),
        budget=budget,
        method=f"G / (omega C) {reading.how}",
        conditions=reading.conditions,
        lines=reading.lines,
        diagnostics={"points": spectrum.frequency_Hz.size},
        flags=flags,
    )


def _film_diagnostics(reading: Reading, value: float) -> dict[str, Detail]:
    film, spectrum = reading.film, reading.spectrum
    return {
        "points": spectrum.frequency_Hz.size,
        "over_range_points": spectrum.lost_Hz.size,
        "thickness_m": film.thickness_m,
        "thickness_read_m": film.read_m,
        "squeeze": film.squeeze,
        "relative_permittivity_if_film_stuck": value * film.sticking_m / film.thickness_m,
        "aspect": film.aspect,
        "impedance_ohm": reading.impedance_ohm,
        "meter_limit": reading.where.of(spectrum.limit),
        "edge_field_flush": reading.edge_fraction("flush"),
        "edge_field_overhanging": reading.edge_fraction("overhanging"),
    }


def _dependence(reading: Reading) -> Dependence:
    """Permittivity at the stated frequencies, slope per decade, change to the top frequency."""
    config, spectrum, curve = reading.config, reading.spectrum, reading.permittivity
    f, limit = spectrum.frequency_Hz, spectrum.limit
    found: dict[float, float] = {}
    for stated in config.stated_frequencies_Hz:
        try:
            at = position(f, stated, config.frequency_tolerance, config.widest_gap_decades)
        except FitRefused:
            continue  # a sweep that does not reach so far says nothing there
        found[stated] = at.of(curve)
    slope, u_slope = slope_per_decade(f, curve, curve * limit)
    return Dependence(
        stated=found,
        slope_per_decade=slope,
        u_slope_per_decade=u_slope,
        top_frequency_Hz=float(f[-1]),
        change_to_top=float(curve[-1]) / reading.where.of(curve) - 1.0,
        u_change_by_meter=math.hypot(reading.where.of(limit), float(limit[-1])) / _LIMIT_TO_SIGMA,
    )


def _dependence_diagnostics(found: Dependence) -> dict[str, Detail]:
    return {
        **{f"relative_permittivity_{f:g}_Hz": value for f, value in found.stated.items()},
        "slope_per_decade": found.slope_per_decade,
        "u_slope_per_decade": found.u_slope_per_decade,
        "top_frequency_Hz": found.top_frequency_Hz,
        "change_to_top_frequency": found.change_to_top,
        "u_change_by_meter": found.u_change_by_meter,
    }


def _resistance_diagnostics(found: tuple[float, float] | None) -> dict[str, Detail]:
    if found is None:
        return {}
    return {"series_resistance_ohm": found[0], "u_series_resistance_ohm": found[1]}


def _flags(reading: Reading, level_said: bool) -> tuple[Flag, ...]:
    """Everything a reader of both values must know."""
    config, where = reading.config, reading.where
    flags = reading.point.found.flags + _resistance_flags(reading)
    if where.interpolated:
        low, high = reading.spectrum.frequency_Hz[where.indices[[0, -1]]]
        flags += (
            Flag(
                "interpolated",
                f"{reading.point.frequency_Hz:g} Hz lies between {low:g} and {high:g} Hz, which "
                "were measured",
            ),
        )
    if not level_said:
        flags += (
            Flag(
                "level-declared",
                f"the file does not say the test level; {config.level_V:g} V is declared",
            ),
        )
    return flags


def _edge_flags(reading: Reading) -> tuple[Flag, ...]:
    config = reading.config
    flush, overhanging = (reading.edge_fraction(edge) for edge in ("flush", "overhanging"))
    corrected = reading.film.edge_corrected or config.edge_field != "none"
    if corrected or flush <= config.edge_flag:
        return ()
    return (
        Flag(
            "edge-field",
            f"not corrected: by ASTM D150 eps_r is {100 * flush:.2g} % too high for a film "
            f"cut flush with the plates, {100 * overhanging:.2g} % for a larger one",
        ),
    )


def _resistance_flags(reading: Reading) -> tuple[Flag, ...]:
    """Flag a loss that rises in proportion to f at the top of the sweep while C_p falls."""
    config, spectrum = reading.config, reading.spectrum
    if reading.resistance is None:
        return ()
    resistance, u = reading.resistance
    top, series = float(spectrum.frequency_Hz[-1]), float(spectrum.series_capacitance_F[-1])
    added = 2.0 * math.pi * top * series * resistance
    if not (added > config.series_loss_flag and resistance > _RESISTANCE_TOLD * u):
        return ()
    drop = 1.0 - float(spectrum.capacitance_F.real[-1]) / series
    return (
        Flag(
            "series-resistance",
            f"loss rises in proportion to frequency up to {top:g} Hz, as {resistance:.3g} ohm "
            f"(+- {2 * u:.2g}) in series with the film do: there it adds {added:.2g} to the loss "
            f"and C_p is {100 * drop:.2g} % low; look at electrodes, leads and contacts",
        ),
    )
