"""TOML as everybody here reads it: whatever is wrong with the text is one kind of error."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from typing import Any


def parse_toml(data: bytes) -> dict[str, Any]:
    """Parse a TOML file.

    Raises
    ------
    ValueError : not UTF-8, not TOML, a number of thousands of digits, tables nested without end
    """
    try:
        return tomllib.loads(data.decode("utf-8"))
    except RecursionError as error:
        raise ValueError("its values are nested too deeply") from error


def line_of(data: bytes, place: Sequence[str | int]) -> int | None:
    """Find the line of a key, or of the nearest table around it, counted from 1.

    Parameters
    ----------
    data : of a file that parses
    place : keys from the top, a number counts the tables of a list: `("ramp", "columns", 0)`
    """
    lines = data.decode("utf-8").split("\n")
    headers = [(at, *_header(line)) for at, line in enumerate(lines, 1) if _header(line)[0]]
    found, inside = None, 0
    for depth in range(len(place), 0, -1):
        keys = [key for key in place[:depth] if isinstance(key, str)]
        count = next((key for key in reversed(place[:depth]) if isinstance(key, int)), 0)
        same = [at for at, name, _ in headers if name == ".".join(keys)]
        if same:
            inside = found = same[min(count, len(same) - 1)]
            break
    for at, key in reversed(list(enumerate(place))):
        line = _line_of_key(lines, inside, key) if isinstance(key, str) else None
        if line is not None:
            index = place[at + 1] if at + 1 < len(place) else None
            listed = isinstance(index, int) and lines[line - 1].rstrip().endswith("[")
            return line + 1 + index if listed and isinstance(index, int) else line
    return found


def _line_of_key(lines: Sequence[str], first: int, key: str) -> int | None:
    """Find `key =` in a table, counted from 1; `first` is the line below its header, from 0."""
    for at in range(first, len(lines)):
        line = lines[at].strip()
        if line.startswith("[") and at > first - 1 and _header(line)[0]:
            return None
        if line.partition("=")[0].strip().strip("\"'") == key:
            return at + 1
    return None


def _header(line: str) -> tuple[str, bool]:
    """The name of a table's header, and whether it is one of a list."""
    text = line.partition("#")[0].strip()
    if not text.startswith("[") or not text.endswith("]"):
        return "", False
    listed = text.startswith("[[")
    name = text.strip("[]").strip()
    return ".".join(part.strip().strip("\"'") for part in name.split(".")), listed
