"""Faults and events that logs of high-voltage ramps have, to be built in on purpose."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from deamat.core.errors import ConfigError
from tests.twin.quirks import Quirk, altered

_LIMIT_V, _HELD_ROWS = 20e3, 4
_Table = list[list[float]]


def with_flashover(path: str, row: int, left: float = 0.7) -> Quirk:
    """Let a part of the voltage be lost in one row of a DAQ log, and come back in the next."""

    def change(table: _Table) -> _Table:
        if not 0 < row < len(table) - 10:
            raise ConfigError(f"a flashover in row {row} of {path!r} is not on its ramp")
        flashed = [t.copy() for t in table]
        flashed[row][1] *= left
        return flashed

    return _rows_changed(path, change)


def to_the_limit(path: str) -> Quirk:
    """Go on at the same rate of rise to the amplifier's 20 kV, without a breakdown."""

    def change(table: _Table) -> _Table:
        peak = max(range(len(table)), key=lambda i: table[i][1])
        whole = [t.copy() for t in table[: peak + 1]]
        step = [b - a for a, b in zip(whole[-11], whole[-1], strict=True)]
        monitor = _LIMIT_V / 2000.0
        while whole[-1][1] < monitor:
            time, voltage, current = whole[-1]
            whole.append([time + step[0] / 10, min(voltage + step[1] / 10, monitor), current])
        for _ in range(_HELD_ROWS):
            whole.append([whole[-1][0] + step[0] / 10, *whole[-1][1:]])
        return whole

    return _rows_changed(path, change)


def ended_early(path: str, rows: int) -> Quirk:
    """End a DAQ log between two rows, so that nothing but the missing collapse tells."""
    return _rows_changed(path, lambda table: table[:rows])


def without_spike(path: str) -> Quirk:
    """Let the voltage fall without a current, as when the amplifier is switched off."""
    return _rows_changed(path, lambda table: [[t, v, min(i, 0.001)] for t, v, i in table])


def without_current(path: str) -> Quirk:
    """Leave out the current monitor: its channel line and its column."""

    def change(lines: Sequence[str]) -> list[str]:
        kept = [line for line in lines if not line.startswith("# channel 2")]
        return [line if line.startswith("#") else line.rpartition(",")[0] for line in kept]

    return _lines_changed(path, change)


def in_volts(path: str) -> Quirk:
    """Write a plain table in V where the others of its material are in kV."""

    def change(lines: Sequence[str]) -> list[str]:
        changed = []
        for line in lines:
            cells = line.split(",")
            if line.startswith("time_s"):
                cells[1] = "voltage_V"
            elif not line.startswith("#"):
                cells[1] = f"{1e3 * float(cells[1]):.1f}"
            changed.append(",".join(cells))
        return changed

    return _lines_changed(path, change)


def mislabelled(path: str) -> Quirk:
    """Write volts under the label of kilovolts in a plain table."""
    volts, label = in_volts(path), altered(path, lambda d: d.replace(b"voltage_V", b"voltage_kV"))
    return lambda contents: label(volts(contents))


def _lines_changed(path: str, change: Callable[[Sequence[str]], list[str]]) -> Quirk:
    def of_bytes(data: bytes) -> bytes:
        return ("\n".join(change(data.decode().split("\n")[:-1])) + "\n").encode()

    return altered(path, of_bytes)


def _rows_changed(path: str, change: Callable[[_Table], _Table]) -> Quirk:
    """Change the numbers of a DAQ log: time, voltage monitor, current monitor."""

    def of_lines(lines: Sequence[str]) -> list[str]:
        first = next(i for i, line in enumerate(lines) if line.startswith("time_s")) + 1
        table = change([[float(cell) for cell in line.split(",")] for line in lines[first:]])
        return [*lines[:first], *(f"{t:.3f},{v:.4f},{i:.4f}" for t, v, i in table)]

    return _lines_changed(path, of_lines)
