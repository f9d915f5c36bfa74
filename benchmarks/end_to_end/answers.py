"""What each contender found, held against the truth."""

from __future__ import annotations

import json
import math
import sqlite3
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

_KEY = "compressive_modulus"
_NORMAL = 1.959964  # the script states standard errors alone


@dataclass(frozen=True, slots=True)
class Judged:
    """How right the means of the materials are.

    Parameters
    ----------
    materials : how many there are
    error : root mean square of the relative distance from the truth
    inside : fraction of the 95 % intervals that hold the truth
    """

    materials: int
    error: float
    inside: float


Found = Mapping[str, tuple[float, float, float]]  # material to value and interval [Pa]


def of_deamat(processed: Path) -> Found:
    """Read the cards of a run."""
    found = {}
    for path in sorted((processed / "cards").glob("*.json")):
        card = json.loads(path.read_text(encoding="utf-8"))
        (record,) = (one for one in card["properties"] if one["key"] == _KEY)
        low, high = record["ci95"]
        found[card["material"]] = (record["value"], low, high)
    return found


def of_script(out: Path) -> Found:
    """Read the database of the script."""
    with sqlite3.connect(out / "materials.sqlite") as database:
        rows = database.execute("SELECT material, mean, sem FROM materials").fetchall()
    return {
        material: (1e6 * mean, 1e6 * (mean - _NORMAL * sem), 1e6 * (mean + _NORMAL * sem))
        for material, mean, sem in rows
    }


def judged(found: Found, truth: Mapping[str, float]) -> Judged:
    """Hold what was found against the true moduli.

    Raises
    ------
    ValueError : a material is missing: the work was not done
    """
    if found.keys() != truth.keys():
        raise ValueError(f"{len(found)} of {len(truth)} materials were found")
    off = [found[name][0] / true - 1.0 for name, true in truth.items()]
    inside = [found[name][1] <= true <= found[name][2] for name, true in truth.items()]
    error = math.sqrt(math.fsum(x * x for x in off) / len(off))
    return Judged(len(off), error, sum(inside) / len(inside))
