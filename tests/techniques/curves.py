"""Recordings and registers for the tests of the mechanical rooms."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.records import Condition, Measurement
from deamat.core.technique import C, Context, R, Technique

EXACT = Machine(u_force_calibration=0.0, u_displacement_calibration=0.0)


def source(rows: int, first_line: int = 9) -> Source:
    return Source("c/t/a.csv", "0" * 64, first_line, first_line + rows - 1, "utf-8", "test")


def recording(**columns: FloatArray) -> Recording:
    rows = len(next(iter(columns.values()))) if columns else 0
    return Recording(columns, {}, {}, source(rows))


def lengths(**metres: float | Quantity) -> dict[str, Quantity]:
    return {k: v if isinstance(v, Quantity) else Quantity(v, "m") for k, v in metres.items()}


CYLINDER = lengths(diameter_m=0.05, height_m=0.03)
STRIP = lengths(width_m=6e-3, thickness_m=3e-3, gauge_length_m=33e-3)


def specimen(
    technique: str,
    numbers: Mapping[str, Quantity],
    name: str = "a",
    line: int = 2,
    conditions: Mapping[str, Condition] | None = None,
) -> Specimen:
    return Specimen(
        name, "m", "c", technique, "a.csv", None, numbers, conditions or {}, {}, "c/t/s.csv", line
    )


def context(technique: Technique[C, R], machine: Machine = EXACT, **config: object) -> Context[C]:
    return Context(technique.config.model_validate(config), machine, {})


def reduce(
    technique: Technique[C, R],
    numbers: Mapping[str, Quantity],
    columns: Mapping[str, FloatArray],
    machine: Machine = EXACT,
) -> Measurement[R]:
    return technique.reduce(
        specimen(technique.key, numbers), recording(**columns), context(technique, machine)
    )


def phantom(path: Path, own_only: bool = False) -> Recording:
    """Read one file of ecoflex-phantom-2026: 7 header lines, names, then stress in kPa."""
    table = np.loadtxt(path, delimiter=",", skiprows=8)
    columns = {"nominal_strain": table[:, 3], "nominal_stress_Pa": 1e3 * table[:, 4]}
    if not own_only:
        columns |= {"displacement_m": 1e-3 * table[:, 1], "force_N": table[:, 2].copy()}
    return Recording(columns, {}, {}, source(len(table)))


def soro(path: Path) -> Recording:
    """Read one file of soro-2019: 18 header lines, engineering columns in 1 and MPa."""
    table = np.loadtxt(path, delimiter=";", skiprows=18, encoding="latin-1")
    return Recording(
        {
            "time_s": table[:, 0],
            "nominal_strain": table[:, 3],
            "nominal_stress_Pa": 1e6 * table[:, 4],
        },
        {},
        {},
        source(len(table), first_line=19),
    )


def expected(shared: Path) -> list[dict[str, str]]:
    with (shared / "real" / "expected_mechanics.csv").open(newline="") as file:
        return list(csv.DictReader(file))
