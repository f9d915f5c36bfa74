"""Conditions as laboratories have them: cylinders that were not tested in one state."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from numpy.random import Generator

from deamat.core.records import Condition
from deamat.twin.situations.cylinders import (
    MODULUS,
    SPECIMENS,
    MODULUS_Pa,
    cylinder,
    log,
    made,
    naive_modulus,
    row,
)
from deamat.twin.situations.situation import Made, Situation

_OTHERS = 2  # of the cylinders, the last ones
_USUAL = {"temperature_C": "22", "humidity_percent": "50"}


def _two_states(
    elsewhere: Mapping[str, str], asked: Mapping[str, Condition], rng: Generator, softer: float
) -> Made:
    """Two of five cylinders are softer, and were tested as `elsewhere` says."""
    cylinders, rows = [], []
    for i in range(1, SPECIMENS + 1):
        other = softer > 0.0 and i > SPECIMENS - _OTHERS
        one = cylinder(rng, MODULUS_Pa * (1.0 - softer if other else 1.0))
        cylinders.append(one)
        rows.append({**row(one, i), **_USUAL, **(elsewhere if other else {})})
    files = {f"{i}.csv": log(one) for i, one in enumerate(cylinders, start=1)}
    naive = [naive_modulus(one, cells) for one, cells in zip(cylinders, rows, strict=True)]
    handed = made(cylinders, rows, files, naive)
    usual = cylinders if softer == 0.0 else cylinders[: SPECIMENS - _OTHERS]
    return replace(handed, truth=_mean([one.modulus_Pa for one in usual]), conditions=asked)


def _mean(values: Sequence[float]) -> float:
    return math.fsum(values) / len(values)


def _situation(
    name: str,
    told: str,
    answer: str,
    causes: tuple[str, ...],
    severities: tuple[float, ...],
    make: Callable[[Generator, float], Made],
) -> Situation:
    unit = "softer in the other state, fraction"
    return Situation(name, "compression", MODULUS, told, answer, causes, unit, severities, make)


_SEVERITIES = (0.075, 0.25, 0.75)

SITUATIONS = (
    _situation(
        "conditions-warm",
        "Two of five cylinders were tested at 90 C, the others at 22 C.",
        "Never pooled: a value at each temperature.", (), _SEVERITIES,
        partial(_two_states, {"temperature_C": "90"}, {"temperature_K": 295.15}),
    ),
    _situation(
        "conditions-humid",
        "Two of five cylinders were tested at a humidity of 95 %, the others at 50 %.",
        "Never pooled: a value at each humidity.", (), _SEVERITIES,
        partial(_two_states, {"humidity_percent": "95"}, {"humidity": 0.5}),
    ),
    _situation(
        "conditions-unrecorded",
        "The rows of two of five cylinders do not say how warm they were.",
        "Pooled with the others, and flagged.", ("not-recorded",), _SEVERITIES,
        partial(_two_states, {"temperature_C": ""}, {"temperature_K": 295.15}),
    ),
)  # fmt: skip
