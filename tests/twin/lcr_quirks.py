"""Faults that logs of LCR meters have, to be built into a simulated campaign on purpose."""

from __future__ import annotations

from collections.abc import Callable

from deamat.core.errors import ConfigError
from tests.twin.quirks import Quirk, altered

OVER_RANGE = "9.90000e+37"  # what SCPI instruments send for "over range"
MICRO_SIGN, GREEK_MU = "\u00b5", "\u03bc"


def over_range_point(path: str, frequency: str, status: str = "OVER") -> Quirk:
    """Put 9.9E37 and a status in the row of one frequency, as a meter out of its range does."""
    return _row_changed(
        path, frequency, lambda row: f"{row[0]},+{OVER_RANGE},+{OVER_RANGE},{status}"
    )


def marked_out(path: str, frequency: str) -> Quirk:
    """Mark a point `OUT ` (with its blank) while its numbers look well."""
    return _row_changed(path, frequency, lambda row: ",".join([*row[:-1], "OUT "]))


def sentinel_marked_ok(path: str, frequency: str) -> Quirk:
    """Put 9.9E37 in the secondary alone, with the status of a good point."""
    return _row_changed(path, frequency, lambda row: ",".join([*row[:2], f"+{OVER_RANGE}", row[3]]))


def without_function(path: str) -> Quirk:
    """Leave out what `FUNC?` replied, so that nobody can say what the numbers are."""
    return _lines_changed(
        path, lambda lines: [line for line in lines if not line.startswith("# FUNC?")]
    )


def in_microfarad(path: str, mu: str) -> Quirk:
    """Write the capacitance of a plain table in uF, with one or the other letter mu."""

    def change(lines: list[str]) -> list[str]:
        at = lines.index("frequency_Hz,Cp_F,D")
        rows = [line.split(",") for line in lines[at + 1 :]]
        scaled = [f"{f},{1e6 * float(c):.6e},{d}" for f, c, d in rows]
        return [*lines[:at], f"frequency_Hz,Cp_{mu}F,D", *scaled]

    return _lines_changed(path, change)


def with_units_row(path: str) -> Quirk:
    """Move the units of a plain table into a row of their own."""

    def change(lines: list[str]) -> list[str]:
        at = lines.index("frequency_Hz,Cp_F,D")
        return [*lines[:at], "frequency,Cp,D", "Hz,F,1", *lines[at + 1 :]]

    return _lines_changed(path, change)


def _row_changed(path: str, frequency: str, change: Callable[[list[str]], str]) -> Quirk:
    def changed(lines: list[str]) -> list[str]:
        if not any(line.startswith(f"{frequency},") for line in lines):
            raise ConfigError(f"a quirk names {frequency!r}, which {path!r} does not hold")
        return [
            change(line.split(",")) if line.startswith(f"{frequency},") else line for line in lines
        ]

    return _lines_changed(path, changed)


def _lines_changed(path: str, change: Callable[[list[str]], list[str]]) -> Quirk:
    return altered(
        path,
        lambda data: "".join(f"{line}\n" for line in change(data.decode().splitlines())).encode(),
    )
