"""Many cases, judged in processes of their own and kept one by one, so that a study can go on."""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import os
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.fuzz.cases import draw
from benchmarks.fuzz.fuzzer import Fuzzer
from benchmarks.fuzz.good import ROOT
from benchmarks.fuzz.judge import Verdict


@dataclass(frozen=True, slots=True)
class Entry:
    """One case as it is kept.

    Parameters
    ----------
    alone, group : verdicts, empty where there is none
    why : of the worse of the two, where it is bad
    """

    seed: int
    technique: str
    kind: str
    good: str
    mutation: str
    alone: Verdict | None
    group: Verdict | None
    why: str = ""

    @property
    def replay(self) -> str:
        """How to see it again."""
        return f"python -m benchmarks.fuzz --replay {self.good} {self.mutation} {self.seed}"


def study(seeds: Sequence[int], techniques: Sequence[str], workers: int, done: Path) -> list[Entry]:
    """Judge the cases of some seeds, as far as `done` does not hold them yet."""
    key = f"{_code()} {' '.join(techniques)}"
    kept = {entry.seed: entry for entry in _kept(done, key)}
    open_seeds = [seed for seed in seeds if seed not in kept]
    with tempfile.TemporaryDirectory(prefix="fuzz-") as place, done.open("a") as file:
        for entry in _judged(open_seeds, techniques, workers, Path(place)):
            file.write(json.dumps(asdict(entry)) + "\n")
            file.flush()
            kept[entry.seed] = entry
    return [kept[seed] for seed in seeds]


def _judged(
    seeds: Sequence[int], techniques: Sequence[str], workers: int, place: Path
) -> Iterator[Entry]:
    """Judge cases in their order; one worker works in this process."""
    if workers < 2:
        with Fuzzer(place) as fuzzer:
            yield from (_entry_of(fuzzer, seed, techniques) for seed in seeds)
        return
    fresh = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(workers, fresh, _begin, (place, techniques)) as pool:
        yield from pool.map(_entry, seeds, chunksize=20)


def _kept(done: Path, key: str) -> Iterator[Entry]:
    """Read what is done; another code, or other techniques, begin anew."""
    lines = done.read_text("utf-8").splitlines() if done.exists() else []
    if not lines or lines[0] != json.dumps(key):
        done.parent.mkdir(parents=True, exist_ok=True)
        done.write_text(json.dumps(key) + "\n", "utf-8")
        return
    whole = []
    for line in lines[1:]:
        try:
            whole.append(Entry(**json.loads(line)))
        except json.JSONDecodeError:  # the study was stopped while it wrote this line
            break
    text = "".join(json.dumps(asdict(entry)) + "\n" for entry in whole)
    done.write_text(json.dumps(key) + "\n" + text, "utf-8")
    yield from whole


def _code() -> str:
    """Hash what decides a verdict."""
    found = hashlib.sha256()
    for folder in ("pipeline", "benchmarks/fuzz", "config"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".py", ".toml"):
                found.update(path.read_bytes())
    return found.hexdigest()[:16]


_HERE: dict[str, Fuzzer] = {}
_ASKED: list[str] = []


def _begin(place: Path, techniques: Sequence[str]) -> None:
    _HERE["fuzzer"] = Fuzzer(place / str(os.getpid()))
    _ASKED.extend(techniques)


def _entry(seed: int) -> Entry:
    return _entry_of(_HERE["fuzzer"], seed, _ASKED)


def _entry_of(fuzzer: Fuzzer, seed: int, techniques: Sequence[str]) -> Entry:
    """Judge a case and return what is kept of it."""
    result = fuzzer.judge(draw(seed, fuzzer.goods, techniques))
    case, bad, verdicts = result.case, result.bad, result.verdicts()
    return Entry(
        seed, fuzzer.goods[case.good].technique, case.kind, case.good, case.mutation,
        verdicts.get("alone"), verdicts.get("group"), bad.why if bad else "",
    )  # fmt: skip
