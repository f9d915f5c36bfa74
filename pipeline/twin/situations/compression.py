"""Compression as laboratories have it: five cylinders between plates."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

from numpy.random import Generator

from deamat.twin.situations.cylinders import (
    MODULUS,
    SPECIMENS,
    Cylinder,
    cylinder,
    log,
    made,
    naive_modulus,
    row,
    table,
)
from deamat.twin.situations.situation import Made, Situation

_DIAMETER_m = 28.2e-3


def _pressed(
    distort: Callable[[Cylinder, float], Cylinder], rng: Generator, severity: float
) -> Made:
    cylinders = [distort(cylinder(rng), severity) for _ in range(SPECIMENS)]
    rows = [row(one, i) for i, one in enumerate(cylinders, start=1)]
    files = {f"{i}.csv": log(one) for i, one in enumerate(cylinders, start=1)}
    naive = [naive_modulus(one, cells) for one, cells in zip(cylinders, rows, strict=True)]
    return made(cylinders, rows, files, naive)


def _yields(one: Cylinder, compliance: float) -> Cylinder:
    """Frame, cell and plates yield as well: the travel is that of all of them."""
    stiffness = one.modulus_Pa * one.area_m2 / one.height_m
    extra = compliance * one.force_N / stiffness
    return replace(one, travel_m=one.travel_m + extra)


def _bonded(declared: str, rng: Generator, shape_factor: float) -> Made:
    """Plates that hold the ends of the cylinders: stiffer by 1 + 2 S^2, S = D / 4h."""
    height = _DIAMETER_m / (4.0 * shape_factor) if shape_factor else None
    cylinders, rows = [], []
    for i in range(1, SPECIMENS + 1):
        one = cylinder(rng, height_m=height)
        if shape_factor:
            own = one.diameter_m / (4.0 * one.height_m)
            one = replace(one, force_N=one.force_N * (1.0 + 2.0 * own**2))
        cylinders.append(one)
        rows.append({**row(one, i), "plates": declared if shape_factor else "lubricated"})
    files = {f"{i}.csv": log(one) for i, one in enumerate(cylinders, start=1)}
    naive = [naive_modulus(one, cells) for one, cells in zip(cylinders, rows, strict=True)]
    return made(cylinders, rows, files, naive)


def _own_stress(rng: Generator, off: float) -> Made:
    """The export computed its stress with another area than the register's."""
    cylinders = [cylinder(rng) for _ in range(SPECIMENS)]
    rows = [row(one, i) for i, one in enumerate(cylinders, start=1)]
    files = {f"{i}.csv": table(one, 1.0 + off, "N") for i, one in enumerate(cylinders, start=1)}
    naive = [
        (1.0 + off) * naive_modulus(one, cells)
        for one, cells in zip(cylinders, rows, strict=True)
    ]  # fmt: skip
    return made(cylinders, rows, files, naive)


def _kilonewtons(own_stress: bool, rng: Generator, slip: float) -> Made:
    """Newtons under a label of kilonewtons."""
    cylinders = [cylinder(rng) for _ in range(SPECIMENS)]
    rows = [row(one, i) for i, one in enumerate(cylinders, start=1)]
    unit = "kN" if slip else "N"
    files = {}
    for i, one in enumerate(cylinders, start=1):
        text = table(one, 1.0, unit)
        if not own_stress:
            lines = text.decode().splitlines()
            text = "".join(f"{line.rpartition(',')[0] or line}\n" for line in lines).encode()
        files[f"{i}.csv"] = text
    naive = [
        naive_modulus(one, cells) * (1e3 if slip else 1.0)
        for one, cells in zip(cylinders, rows, strict=True)
    ]  # fmt: skip
    return made(cylinders, rows, files, naive)


def _situation(
    name: str,
    told: str,
    answer: str,
    causes: tuple[str, ...],
    severity: str,
    severities: tuple[float, ...],
    make: Callable[[Generator, float], Made],
    undetectable: Mapping[float, str] | None = None,
) -> Situation:
    return Situation(
        name, "compression", MODULUS, told, answer, causes, severity, severities, make,
        undetectable or {},
    )  # fmt: skip


_IN_SERIES = (
    "a compliance in series with a cylinder makes the curve of a softer one; every modulus says "
    "`machine compliance not declared` in its method until `compliance_m_per_N` is declared"
)
_FRICTION = (
    "friction multiplies the whole curve; every modulus says `friction at the plates not declared "
    "(1 to ... times)` in its method until the register's `plates` says more"
)
_SHAPE_FACTORS = (0.12, 0.22, 0.39)
_COMPLIANCES = (0.031, 0.11, 0.43)

SITUATIONS = (
    _situation(
        "compression-compliance",
        "Frame, load cell and plates yield along with the cylinder, and nobody measured by how "
        "much.",
        "Said in the method of every modulus; corrected where a compliance is declared.",
        (), "compliance of the machine over that of the cylinder", _COMPLIANCES,
        partial(_pressed, _yields), dict.fromkeys(_COMPLIANCES, _IN_SERIES),
    ),
    _situation(
        "compression-bonded",
        "The plates hold the ends of the cylinder, and the register says so.",
        "Flagged with the factor 1 + 2 S^2; corrected on request.",
        ("plate-friction",), "shape factor S", _SHAPE_FACTORS, partial(_bonded, "bonded"),
    ),
    _situation(
        "compression-friction",
        "The plates hold the ends of the cylinder, and the register says nothing of it.",
        "Said in the method of every modulus, with the largest factor.",
        (), "shape factor S", _SHAPE_FACTORS, partial(_bonded, ""),
        dict.fromkeys(_SHAPE_FACTORS, _FRICTION),
    ),
    _situation(
        "compression-own-stress",
        "The export computed its stress with another area than the register's.",
        "Force over area of the register, flagged; refused beyond 20 %.",
        ("own-columns-disagree",), "stress over force by area, less 1", (0.03, 0.1, 0.3),
        _own_stress,
    ),
    _situation(
        "compression-kilonewton",
        "The label of the load says kN over numbers that are N; the file has a stress as well.",
        "Refused: stress and force over area disagree.",
        ("own-columns-disagree",), "1: the slip", (1.0,), partial(_kilonewtons, True),
    ),
    _situation(
        "compression-kilonewton-only",
        "The label of the load says kN over numbers that are N, and nothing else in the file.",
        "Flagged: no elastomer is so stiff.",
        ("implausible",), "1: the slip", (1.0,), partial(_kilonewtons, False),
    ),
)  # fmt: skip
