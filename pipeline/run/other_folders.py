"""Folders of a campaign that no technique is called after, and which one may be meant."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from itertools import pairwise

_OF_TESTING_MACHINES = ("compression", "tension")
_TESTING_MACHINES = ("instron", "zwick", "mts", "shimadzu", "utm")
# What laboratories call a folder after: the instrument, or the test in other words.
_ALSO = {
    "compression": ("compressive", "compress", "druck", "druckversuch"),
    "tension": ("tensile", "zug", "zugversuch", "stretch", "uniaxial"),
    "nanoindentation": ("indentation", "indenter", "hysitron", "nano", "piuma", "chiaro"),
    "permittivity": ("dielectric", "lcr", "impedance", "capacitance", "novocontrol"),
    "breakdown": ("dielectric-strength", "high-voltage", "hv", "ramp", "scope"),
    "viscosity": ("rheology", "rheometer", "viscometer", "brookfield", "flow"),
    "handling": ("pot-life", "printing", "printability"),
}  # fmt: skip
_PICTURES = (
    *(".png", ".jpg", ".jpeg", ".tif", ".tiff", ".heic", ".svg", ".mp4", ".mov", ".avi"),
    *(".doc", ".docx", ".odt", ".ppt", ".pptx", ".html"),
)


def no_technique(folder: str, techniques: Iterable[str]) -> str:
    """Say that no technique is called after a folder, and which one may be meant."""
    there = sorted(techniques)
    meant = nearest_techniques(folder, there)
    if meant:
        hint = f"did you mean {' or '.join(map(repr, meant))}?"
    else:
        hint = f"a folder is called after its technique: {', '.join(there)}"
    return f"no technique is called {folder!r}; {hint}"


def nearest_techniques(folder: str, techniques: Iterable[str]) -> list[str]:
    """Name the techniques that a folder may be meant for, by its spelling or its instrument."""
    there = sorted(techniques)
    name = folder.casefold().replace("_", "-").replace(" ", "-")
    near = difflib.get_close_matches(name, there, n=1)
    if near:
        return near
    machines = [k for k in _OF_TESTING_MACHINES if set(name.split("-")) & set(_TESTING_MACHINES)]
    return techniques_said(name, there) or machines


def techniques_said(text: str, techniques: Iterable[str]) -> list[str]:
    """Name the techniques that the words of a text say, by their names or other usual ones."""
    words = re.split(r"[\W_]+", text.casefold())
    parts = {*words, *map("-".join, pairwise(words))}
    return [key for key in techniques if key in parts or parts & set(_ALSO.get(key, ()))]


def is_picture(path: str) -> bool:
    """Say whether a file is a picture or a text for people by its ending: never data."""
    return path.lower().endswith(_PICTURES)
