"""Simulated (synthetic) sweeps of films for the tests of their room, and what is asked of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.records import Flag, Measurement
from deamat.core.technique import Context
from deamat.estimators.dielectric.impedance import PAIRS, ComplexArray, shown
from deamat.techniques.permittivity import TECHNIQUE
from deamat.techniques.permittivity.config import PermittivityConfig
from deamat.techniques.permittivity.result import FilmSpectrum

EPS0 = 8.8541878188e-12
FREQUENCY = np.logspace(1, 4, 31)
LEVEL = {"level_V": "1.0"}
NO_FORCE = Quantity(0.0, "N")
MODULUS = Quantity(1e6, "Pa", 1e4, 5e3)
NUMBERS = {
    "thickness_m": Quantity(300e-6, "m", 1e-6, 1e-6),
    "plate_length_m": Quantity(45e-3, "m", 1e-5, 1e-5),
    "plate_width_m": Quantity(45e-3, "m", 1e-5, 1e-5),
    "micrometer_force_N": Quantity(5.0, "N"),
    "anvil_diameter_m": Quantity(30e-3, "m", 1e-5, 1e-5),
}
# p = 5 N / (pi/4 (30 mm)^2) over 1 MPa
RATIO = 5.0 / (math.pi / 4 * 30e-3**2) / 1e6


def capacitor(eps_r: float, tan: float = 0.003, thickness_m: float = 300e-6) -> ComplexArray:
    """A film of the same permittivity at all frequencies, between plates of 45 mm."""
    c: ComplexArray = np.full(31, EPS0 * 45e-3**2 / thickness_m * eps_r * (1 - 1j * tan))
    return c


def recording(
    capacitance_F: ComplexArray,
    mode: str = "Cp-D",
    frequency_Hz: FloatArray = FREQUENCY,
    over_range: tuple[int, ...] = (),
    metadata: Mapping[str, str] = LEVEL,
    flags: tuple[Flag, ...] = (),
) -> Recording:
    primary, secondary = (values.copy() for values in shown(mode, frequency_Hz, capacitance_F))
    over = np.zeros(frequency_Hz.size)
    for i in over_range:
        over[i], primary[i], secondary[i] = 1.0, 9.9e37, 9.9e37
    columns = {
        "frequency_Hz": frequency_Hz,
        PAIRS[mode].primary: primary,
        PAIRS[mode].secondary: secondary,
        "over_range": over,
    }
    source = Source("c/permittivity/x.log", "0" * 64, 6, 5 + frequency_Hz.size, "utf-8", "lcr6000")
    return Recording(columns, metadata, {}, source, flags)


def specimen(**numbers: Quantity | None) -> Specimen:
    mine = {k: v for k, v in {**NUMBERS, **numbers}.items() if v is not None}
    return Specimen(
        "p1", "m", "c", "permittivity", "c/permittivity/x.log", None, mine, {"age": "after cure"},
        {}, "c/permittivity/specimens.csv", 2,
    )  # fmt: skip


def context(
    modulus: Quantity | None = MODULUS, machine: Machine | None = None, **config: Any
) -> Context[PermittivityConfig]:
    needs = {} if modulus is None else {"compressive_modulus": modulus}
    return Context(PermittivityConfig(**config), machine or Machine(), needs)


def reduce(
    record: Recording | None,
    ctx: Context[PermittivityConfig] | None = None,
    **numbers: Quantity | None,
) -> Measurement[FilmSpectrum]:
    return TECHNIQUE.reduce(specimen(**numbers), record, ctx or context())


def card(measurement: Measurement[FilmSpectrum]) -> tuple[float, float]:
    eps, loss = measurement.values
    assert (eps.key, loss.key) == ("relative_permittivity", "loss_tangent")
    return eps.quantity.value, loss.quantity.value


def refused(measurement: Measurement[FilmSpectrum]) -> str:
    assert measurement.values == ()
    assert [r.key for r in measurement.refusals] == ["relative_permittivity", "loss_tangent"]
    assert len({r.reason for r in measurement.refusals}) == 1
    return measurement.refusals[0].reason


def flag(measurement: Measurement[FilmSpectrum], name: str, value: int = 0) -> str:
    (found,) = (f.detail for f in measurement.values[value].flags if f.name == name)
    return found


def names(measurement: Measurement[FilmSpectrum], value: int = 0) -> list[str]:
    return [f.name for f in measurement.values[value].flags]
