"""What a whole process takes."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Spent:
    """What a process took.

    Parameters
    ----------
    cpu_s, wall_s : processor time of it and of the processes that it waited for; time on the clock
    peak_MB : largest resident size
    """

    cpu_s: float
    wall_s: float
    peak_MB: float


def spent(command: Sequence[str], environment: Mapping[str, str] | None = None) -> Spent:
    """Run a command to its end and say what it took.

    Raises
    ------
    RuntimeError : it failed
    """
    with tempfile.TemporaryFile() as errors:
        start = time.perf_counter()
        process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=errors,
            env={**os.environ, **(environment or {})},
        )  # fmt: skip
        _, status, usage = os.wait4(process.pid, 0)
        wall_s = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            errors.seek(0)
            said = errors.read().decode(errors="replace")[-2000:]
            raise RuntimeError(f"{' '.join(command[:4])} ended with {process.returncode}: {said}")
    unit = 1024 if sys.platform == "linux" else 1
    return Spent(usage.ru_utime + usage.ru_stime, wall_s, usage.ru_maxrss * unit / 1e6)
