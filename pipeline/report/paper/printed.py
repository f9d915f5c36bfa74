"""The numbers that the article prints, by dotted path such as `table3.sylgard-184-10to1.hours`."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

from deamat.core.units import to_si

_TABLE1_UNITS = {
    **dict.fromkeys(("n_de", "eps_r"), "1"),
    **dict.fromkeys(("t_de", "t_p", "t_el", "t_p_opt"), "um"),
    **dict.fromkeys(("Y_de", "Y_p", "Y_el"), "MPa"),
    **dict.fromkeys(("measured", "analytical", "optimum"), "1/m"),
    "V": "V",
}
_SUFFIXES = {
    "_MPa": "MPa",
    "_V_per_um": "V/um",
    "_kV": "kV",
    "_um": "um",
    "_mm": "mm",
    "_per_m": "1/m",
    "_per_s": "1/s",
    "_min": "min",
    "_percent": "%",
    "hours": "h",
}


@lru_cache(maxsize=1)
def document() -> dict[str, Any]:
    """Read `printed.toml`."""
    return tomllib.loads((Path(__file__).parent / "printed.toml").read_text(encoding="utf-8"))


def numbers(path: str = "") -> Iterator[tuple[str, float]]:
    """List every number at or below a path with its own path, in the order of the file."""
    found = part(path) if path else document()
    if isinstance(found, bool | str):
        return
    if isinstance(found, int | float):
        yield path, float(found)
        return
    items = found.items() if isinstance(found, dict) else enumerate(found)
    for key, _ in items:
        yield from numbers(f"{path}.{key}" if path else str(key))


def part(path: str) -> Any:
    """Return what stands at a path; positions in a list count from 0.

    Raises
    ------
    KeyError : the article's numbers hold no such path
    """
    found: Any = document()
    for key in path.split("."):
        if isinstance(found, list):
            found = dict(enumerate(found))
        name = int(key) if key.isdecimal() else key
        if not isinstance(found, dict) or name not in found:
            raise KeyError(f"printed.toml has nothing at {path!r}: there is no {key!r}")
        found = found[name]
    return found


def value(path: str) -> float:
    """Return one printed number in its printed unit.

    Raises
    ------
    KeyError : no such path
    """
    return float(part(path))


def si(path: str) -> float:
    """Return one printed number in SI.

    Raises
    ------
    KeyError : no such path
    """
    written = unit(path)
    return value(path) if written == "1/m" else to_si(value(path), written)


def unit(path: str) -> str:
    """Say in which unit a number is printed; `1` for a pure number."""
    keys = path.split(".")
    if keys[0] == "table1":
        return _TABLE1_UNITS[keys[2]]
    if keys[0] == "table2":
        return _coefficient_unit(keys) if len(keys) > 2 else "Pa.s"
    for key in reversed(keys):
        for suffix in sorted(_SUFFIXES, key=len, reverse=True):
            if key.endswith(suffix):
                return _SUFFIXES[suffix]
    return "1"


def _coefficient_unit(keys: list[str]) -> str:
    power = int(keys[3])
    per = "" if power == 0 else "/h" if power == 1 else f"/h^{power}"
    if keys[2] == "printed_exponent_low_to_high":
        return f"1{per}"
    return ("Pa.s^n" if keys[2] == "K_low_to_high" else "Pa.s") + per
