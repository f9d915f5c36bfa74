"""Put each mutant before its tests, several at a time; known verdicts are kept."""

from __future__ import annotations

import json
import math
import queue
import subprocess
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from benchmarks.mutation.copies import Copy, compile_tests, digest
from benchmarks.mutation.mutants import Mutant
from benchmarks.mutation.tests_of import Hits

LEAST_CPU_S, SLOWER = 30.0, 3.0  # a mutant may take this long, or its tests' time so many times


@dataclass(frozen=True)
class Verdict:
    """Who killed a mutant (None: nobody), and how many tests it had to face."""

    mutant: Mutant
    killer: str | None
    tests: int


def verdicts(
    copies: Sequence[Copy], project: Path, sample: Sequence[Mutant], hits: Hits, log: Path
) -> list[Verdict]:
    """Judge a sample; each verdict is written to `log` at once, so that a run can be resumed."""
    found: dict[str, Verdict] = {}
    waiting: queue.SimpleQueue[tuple[Mutant, str, list[str], str | None]] = queue.SimpleQueue()
    known = _known(log)
    for mutant in sample:
        source = (project / "pipeline" / mutant.file).read_text(encoding="utf-8")
        tests = hits.tests_for(mutant, source)
        told = known.get(mutant.name)
        if told is not None and told["state"] == _state(project, mutant, told["killer"], tests):
            found[mutant.name] = Verdict(mutant, told["killer"], len(tests))
        else:
            waiting.put((mutant, source, tests, told["killer"] if told else None))
    print(f"  {len(found)} known already, {len(sample) - len(found)} to judge", flush=True)
    log.parent.mkdir(parents=True, exist_ok=True)

    def work(copy: Copy) -> None:
        if waiting.empty():
            return
        compile_tests(copy)
        with log.open("a", encoding="utf-8") as lines, _worker(copy) as worker:
            checked = False
            while True:
                try:
                    mutant, source, tests, before = waiting.get_nowait()
                except queue.Empty:
                    break
                limit = LEAST_CPU_S + SLOWER * math.fsum(hits.seconds[name] for name in tests)
                if tests and not checked:
                    checked = True
                    killer = _ask(worker, copy, source, mutant.file, tests, limit)
                    if killer is not None:
                        raise RuntimeError(f"without a mutant the tests fail too: {killer}")
                slip, killer = mutant.applied_to(source), None
                if before in tests:  # who killed it before will most likely do so again
                    killer = _ask(worker, copy, slip, mutant.file, [before], limit)
                if killer is None:
                    killer = _ask(worker, copy, slip, mutant.file, tests, limit)
                found[mutant.name] = Verdict(mutant, killer, len(tests))
                state = _state(project, mutant, killer, tests)
                lines.write(json.dumps({"name": mutant.name, "killer": killer, "state": state}))
                lines.write("\n")
                lines.flush()
            if worker.stdin is not None:
                worker.stdin.close()

    with ThreadPoolExecutor(len(copies)) as pool:
        list(pool.map(work, copies))
    return [found[mutant.name] for mutant in sample]


def _worker(copy: Copy) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "benchmarks.mutation.worker"], cwd=copy.root,
        env=copy.environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip


def _ask(
    worker: subprocess.Popen[str],
    copy: Copy,
    source: str,
    file: str,
    tests: Sequence[str],
    cpu_s: float,
) -> str | None:
    if not tests or worker.stdin is None or worker.stdout is None:
        return None
    path = str(copy.root / "pipeline" / file)
    task = {"path": path, "source": source, "tests": list(tests), "cpu_s": cpu_s}
    worker.stdin.write(json.dumps(task) + "\n")
    worker.stdin.flush()
    killer: str | None = json.loads(worker.stdout.readline())["killer"]
    return killer


def _known(log: Path) -> Mapping[str, dict[str, str]]:
    lines = log.read_text(encoding="utf-8").splitlines() if log.is_file() else []
    return {told["name"]: told for told in map(json.loads, lines)}


def _state(project: Path, mutant: Mutant, killer: str | None, tests: Sequence[str]) -> str:
    """What the verdict rests on: the module, and the file of the killer or those of all tests."""
    witness = killer.split("::")[0] if killer else ""
    files = [witness] if witness.endswith(".py") else [name.split("::")[0] for name in tests]
    module = project / "pipeline" / mutant.file
    return digest([module, *(project / name for name in sorted(set(files)))])
