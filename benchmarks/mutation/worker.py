"""Judge mutants in a copy of the project: one line of JSON in for each, one line out.

The libraries are imported once; each mutant is then judged in a fork of this process, which imports
the package and the tests anew. The time limit counts processor time, so that a busy machine makes
no mutant look like an endless loop.
"""

from __future__ import annotations

import contextlib
import importlib
import json
import os
import resource
import signal
import sys
import time
from pathlib import Path

import pytest

from benchmarks.mutation.plugin import Selected

LIBRARIES = (
    "click", "h5py", "jinja2", "numpy", "pydantic", "scipy.interpolate",
    "scipy.optimize", "scipy.special", "scipy.stats", "xarray",
)  # fmt: skip
AT_MOST_SLOWER = (
    20.0  # time by the clock, in processor times allowed: a test may also wait for ever
)
SURVIVED = {int(pytest.ExitCode.OK), int(pytest.ExitCode.NO_TESTS_COLLECTED)}


def main() -> None:
    """Answer until the input ends."""
    for name in LIBRARIES:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    answers = os.fdopen(os.dup(1), "w")
    silence = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silence, 1)
    os.dup2(silence, 2)
    for line in sys.stdin:
        task = json.loads(line)
        answers.write(json.dumps(judged(task)) + "\n")
        answers.flush()


def judged(task: dict[str, object]) -> dict[str, object]:
    """Who killed the mutant: a test, the time limit, or nobody."""
    path, source = Path(str(task["path"])), str(task["source"])
    original, times = path.read_bytes(), path.stat()
    path.write_text(source, encoding="utf-8")
    os.utime(path, (times.st_atime, times.st_mtime + 1000.0))  # its compiled form is out of date
    try:
        tests = [str(name) for name in _list(task["tests"])]
        first = [name for name in tests if name.split("::")[0] == tests[0].split("::")[0]]
        killer = None
        for some in (first, tests[len(first) :]):  # most mutants never meet the second half
            if some and killer is None:
                killer = _run(some, float(str(task["cpu_s"])))
    finally:
        path.write_bytes(original)
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    return {"killer": killer}


def _run(tests: list[str], cpu_s: float) -> str | None:
    reads, writes = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reads)
        _test(tests, cpu_s, writes)
    os.close(writes)
    deadline = time.monotonic() + AT_MOST_SLOWER * cpu_s
    while True:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended or time.monotonic() > deadline:
            break
        time.sleep(0.02)
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(child, signal.SIGKILL)
    if not ended:
        os.waitpid(child, 0)
    with os.fdopen(reads) as pipe:
        killer = pipe.read() if ended else ""
    if ended and os.WIFEXITED(status) and os.WEXITSTATUS(status) in SURVIVED:
        return None
    return killer or "time limit"


def _test(tests: list[str], cpu_s: float, pipe: int) -> None:
    os.setsid()
    whole = int(cpu_s) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (whole, whole))
    sys.dont_write_bytecode = True
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    chosen = Selected(tests)
    files = list(dict.fromkeys(name.split("::")[0] for name in tests))
    options = ["-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist"]
    status: int = 70
    with contextlib.suppress(BaseException):
        status = int(pytest.main([*options, *files], plugins=[chosen]))
    os.write(pipe, (chosen.killer or f"pytest ends with status {status}").encode())
    os._exit(status)


def _list(value: object) -> list[object]:
    return value if isinstance(value, list) else []


if __name__ == "__main__":
    main()
