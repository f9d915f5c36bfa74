"""Runs of a viscometer for the tests of the room of viscosity, made in memory."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.records import Measurement
from deamat.core.technique import Context
from deamat.core.viscometer import full_scale_Pas
from deamat.techniques import viscosity
from deamat.techniques.viscosity.config import ViscosityConfig
from deamat.techniques.viscosity.result import Run

HOUR = 3600.0
MACHINE = Machine(u_torque_calibration=0.0025, torque_noise=0.003)
CONTEXT = Context(ViscosityConfig(), MACHINE, {})


def specimen(number: int = 1, **notes: str) -> Specimen:
    return Specimen(
        f"v-{number}", "silicone", "c", "viscosity", "x", None, {}, {}, notes, "r.csv", number + 1
    )


def recording(columns: Mapping[str, FloatArray], metadata: Mapping[str, str] = {}) -> Recording:
    rows = len(next(iter(columns.values())))
    return Recording(columns, metadata, {}, Source("x", "0" * 64, 2, rows + 1, "utf-8", "test"))


def newtonian(
    viscosity_Pas: FloatArray,
    time_s: FloatArray,
    rotor: int = 3,
    speed_rpm: float = 12.0,
    seed: int | None = 1,
) -> dict[str, FloatArray]:
    """Columns of a run at one speed, with the noise of the instrument (None: without)."""
    full = full_scale_Pas(rotor, speed_rpm)
    rng = np.random.default_rng(seed)
    noise = 0.0 if seed is None else rng.normal(0.0, MACHINE.torque_noise, len(time_s))
    shown = viscosity_Pas + full * noise
    n = len(time_s)
    return {
        "time_s": time_s,
        "rotor": np.full(n, float(rotor)),
        "speed_rpm": np.full(n, speed_rpm),
        "viscosity_Pas": shown,
        "torque": np.round(shown / full, 3),
        "line": np.arange(2.0, n + 2.0),
    }


def reduce(
    columns: Mapping[str, FloatArray],
    context: Context[ViscosityConfig] = CONTEXT,
    number: int = 1,
    **notes: str,
) -> Measurement[Run]:
    return viscosity.TECHNIQUE.reduce(specimen(number, **notes), recording(columns), context)
