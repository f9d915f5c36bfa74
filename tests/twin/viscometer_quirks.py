"""Faults that real viscometer logs have, to be built into a simulated campaign on purpose."""

from __future__ import annotations

import re
from collections.abc import Callable

from tests.twin.quirks import Quirk, altered

_LINE = re.compile(r"^([^\t#]+\t\d+#[\d.]+ RPM) +\S+ +\S+ +(\S+)$")


def over_range(path: str, line: int) -> Quirk:
    """Show `EEEE` in one line (counted from 1) of a log."""
    return _line_altered(path, line, lambda text: _LINE.sub(r"\1  EEEE", text))


def below_zero(path: str, line: int) -> Quirk:
    """Show `----` in one line (counted from 1) of a log."""
    return _line_altered(path, line, lambda text: _LINE.sub(r"\1  ---- ---- \2", text))


def contradicting(path: str, line: int) -> Quirk:
    """Show a torque in one line (counted from 1) that belongs to another reading."""
    return _line_altered(path, line, lambda text: re.sub(r" \d+\.\d( +\S+)$", r"  12.3\1", text))


def without_dates(path: str) -> Quirk:
    """Stamp with the time of day alone."""
    return altered(
        path, lambda data: re.sub(rb"(?m)^\d{4}-\d\d-\d\dT(\d\d:\d\d:\d\d)[^\t]*", rb"\1", data)
    )


def rotor_misnoted(path: str, noted: int) -> Quirk:
    """Name another rotor in every line than the one that turned."""
    return altered(path, lambda data: re.sub(rb"\t\d#", b"\t%d#" % noted, data))


def wrong_unit(path: str) -> Quirk:
    """Head a column of Pa.s with mPa.s."""
    return altered(path, lambda data: data.replace(b"viscosity_Pas", b"viscosity_mPas"))


def _line_altered(path: str, line: int, change: Callable[[str], str]) -> Quirk:
    def of_line(data: bytes) -> bytes:
        lines = data.decode().split("\n")
        lines[line - 1] = change(lines[line - 1])
        return "\n".join(lines).encode()

    return altered(path, of_line)
