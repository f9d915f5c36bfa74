"""TOML as everybody here reads it: whatever is wrong with the text is one kind of error."""

from __future__ import annotations

import tomllib
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
