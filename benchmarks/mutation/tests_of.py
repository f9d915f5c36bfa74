"""Which tests run which line: they run once, over a copy that notes its blocks."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue

from benchmarks.mutation.blocks import block_of, instrumented
from benchmarks.mutation.copies import Copy, digest
from benchmarks.mutation.mutants import Mutant

BUDGET_S = 60.0  # processor time of the tests that one mutant has to face at most


@dataclass
class Hits:
    """Blocks run by each test, or by the fixtures of each file of tests; times; imports."""

    tests: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    seconds: dict[str, float] = field(default_factory=dict)
    importers: dict[str, set[str]] = field(default_factory=dict)

    def tests_for(self, mutant: Mutant, source: str) -> list[str]:
        """The tests to face a mutant: its own file first, then from the cheapest file on."""
        block = block_of(source, mutant.file, mutant.line)
        if block is not None:
            return self._ordered(mutant, self.tests.get(block, set()))
        modules = {mutant.file} | self.importers.get(mutant.file, set())
        named = (one for block, tests in self.tests.items()
                 if block.rsplit(":", 1)[0] in modules for one in tests)  # fmt: skip
        return self._ordered(mutant, named)

    def _ordered(self, mutant: Mutant, names: Iterable[str]) -> list[str]:
        wanted = set(names)
        files: dict[str, list[str]] = defaultdict(list)
        for test in sorted(self.seconds):
            if test in wanted or test.split("::")[0] in wanted:
                files[test.split("::")[0]].append(test)
        own = f"tests/{Path(mutant.file).with_name('test_' + Path(mutant.file).name)}"
        cost = {name: sum(self.seconds[one] for one in tests) for name, tests in files.items()}
        chosen: list[str] = []
        spent = 0.0
        for name in sorted(files, key=lambda name: (name != own, round(cost[name], 1), name)):
            if not chosen or spent + cost[name] <= BUDGET_S:
                chosen += files[name]
                spent += cost[name]
        return chosen


def measured(
    copies: Sequence[Copy], folder: Path, package: str, tests: Sequence[str], cache: Path
) -> Hits:
    """Run the tests over an instrumented package, or take what is known of unchanged files."""
    hits = Hits(importers=importers_of(folder, package))
    code = digest(sorted((folder / package).rglob("*.py")))
    root = folder.parent
    told: list[Path] = []
    waiting: list[tuple[str, Path]] = []
    for path in sorted({path for one in tests for path in _test_files(root / one)}):
        name = str(path.relative_to(root))
        known = cache / code / f"{digest([path, root / 'tests/conftest.py'], name)}.json"
        told.append(known)
        if not known.is_file():
            waiting.append((name, known))
    if waiting:
        for copy in copies:
            copy.replace(package, lambda source, file: instrumented(source, file))
        shared: SimpleQueue[tuple[str, Path]] = SimpleQueue()
        for one in waiting:
            shared.put(one)
        with ThreadPoolExecutor(len(copies)) as pool:
            list(pool.map(partial(_note, shared), copies))
        for copy in copies:
            copy.restore(package)
    for known in told:
        noted = json.loads(known.read_text(encoding="utf-8"))
        hits.seconds |= noted["seconds"]
        for block, tests in noted["blocks"].items():
            hits.tests[block] |= set(tests)
    return hits


def _test_files(place: Path) -> list[Path]:
    return [place] if place.is_file() else list(place.rglob("test_*.py"))


def importers_of(folder: Path, package: str) -> dict[str, set[str]]:
    """For each module of the package, the modules of the package that import it."""
    found: dict[str, set[str]] = defaultdict(set)
    paths = {str(path.relative_to(folder)): path for path in (folder / package).rglob("*.py")}
    for name, path in paths.items():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                base = node.module.removeprefix("deamat.").replace(".", "/")
                options = [f"{base}.py", *(f"{base}/{alias.name}.py" for alias in node.names)]
                for option in options:
                    if option in paths:
                        found[option].add(name)
    return found


def _note(waiting: SimpleQueue[tuple[str, Path]], copy: Copy) -> None:
    """Run files of tests while there are any, each in a process of its own."""
    while True:
        try:
            name, known = waiting.get_nowait()
        except Empty:
            return
        with tempfile.TemporaryDirectory() as there:
            report, log = Path(there, "report.json"), Path(there, "hits")
            subprocess.run(
                [sys.executable, "-m", "benchmarks.mutation.plugin", str(report), name],
                cwd=copy.root, env=copy.environment | {"MUTATION_HITS": str(log)}, check=False,
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            )  # fmt: skip
            outcome = {"seconds": {}, "failed": [name]}  # of tests that took the process with them
            if report.is_file():
                outcome = json.loads(report.read_text(encoding="utf-8"))
            blocks: Mapping[str, set[str]] = defaultdict(set)
            for line in log.read_text(encoding="utf-8").splitlines() if log.is_file() else []:
                test, _, block = line.partition("\t")
                blocks[block].add(test)
        if outcome["failed"]:
            count = len(outcome["failed"])
            print(f"  {count} fail or are skipped without a mutant and count for nothing: {name}")
        noted = {"seconds": outcome["seconds"], "blocks": {b: sorted(t) for b, t in blocks.items()}}
        known.parent.mkdir(parents=True, exist_ok=True)
        partial = known.with_suffix(f".{os.getpid()}")
        partial.write_text(json.dumps(noted), encoding="utf-8")
        partial.replace(known)
