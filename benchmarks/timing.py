"""Timing that survives a busy machine: one core, interleaved contenders, the least of rounds."""

from __future__ import annotations

import csv
import io
import json
import os
import platform
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import TypeVar

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.atomic import write_atomically

Item = TypeVar("Item")
Row = Mapping[str, str | float | int]

RESULTS = Path("processed/benchmarks")


def stay_on_one_core() -> None:
    """Bind this process and those that it starts to one core."""
    if sys.platform == "linux":
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


def interleaved(
    contenders: Mapping[str, Callable[[Item], object]],
    parts: Sequence[Sequence[Item]],
    rounds: int,
    clock: Callable[[], float] = time.process_time,
) -> dict[str, FloatArray]:
    """Let every contender do every item, part by part in turn: a drift of the machine cancels.

    Who begins moves on by one from part to part: what a contender leaves in the caches helps or
    harms all others alike. The clock counts the processor time of this process: other users of the
    machine lengthen the wall time more than this one.

    Returns
    -------
    seconds by contender, shape (rounds, items)
    """
    names = list(contenders)
    seconds: dict[str, list[list[float]]] = {name: [] for name in names}
    for turn in range(rounds):
        for times in seconds.values():
            times.append([])
        for number, part in enumerate(parts):
            first = (turn + number) % len(names)
            for name in names[first:] + names[:first]:
                work, round_s = contenders[name], seconds[name][-1]
                for item in part:
                    start = clock()
                    work(item)
                    round_s.append(clock() - start)
    return {name: np.array(times) for name, times in seconds.items()}


def undisturbed_s(seconds: FloatArray) -> float:
    """Add up the least that any round took for each item `[s]`.

    Who shares the core and its caches slows code by up to twice, and code that computes more than
    code that waits for memory; such times last longer than an item and come and go between rounds.

    Parameters
    ----------
    seconds : of `interleaved`, shape (rounds, items)
    """
    return float(seconds.min(axis=0).sum())


def wall_times_s(command: Sequence[str], times: int) -> list[float]:
    """Run a command several times and give the wall time of each whole process `[s]`.

    Raises
    ------
    subprocess.CalledProcessError : the command failed
    """
    found = []
    for _ in range(times):
        start = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        found.append(time.perf_counter() - start)
    return found


def own_peak_memory_MB() -> float:
    """Return the largest resident size that this process has had `[MB]`.

    Linux hands the peak of a parent on to the child that it starts, so a process that is measured
    must be started before its parent has grown.
    """
    unit = 1024 if sys.platform == "linux" else 1
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6


def table(rows: Sequence[Row]) -> str:
    """Set rows with the same keys as a table with aligned columns."""
    cells = [list(rows[0]), *([_cell(value) for value in row.values()] for row in rows)]
    widths = [max(len(line[i]) for line in cells) for i in range(len(cells[0]))]
    lines = ["  ".join(c.ljust(w) for c, w in zip(line, widths, strict=True)) for line in cells]
    return "\n".join(line.rstrip() for line in lines)


def write_results(name: str, rows: Sequence[Row], packages: Sequence[str]) -> None:
    """Write what was measured as NAME.csv and NAME.json, with the versions it holds for."""
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    versions = {package: metadata.version(package) for package in packages}
    versions["python"] = platform.python_version()
    result = {"benchmark": name, "machine": platform.machine(), "versions": versions, "rows": rows}
    write_atomically(RESULTS / f"{name}.csv", text.getvalue().encode())
    write_atomically(RESULTS / f"{name}.json", (json.dumps(result, indent=1) + "\n").encode())


def _cell(value: str | float) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
