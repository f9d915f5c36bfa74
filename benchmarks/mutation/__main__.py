"""`python -m benchmarks.mutation PACKAGE...`: a seeded sample of slips against the tests.

Prints the score of each package and every survivor; ends with 1 when a score is too low or a
survivor has no reason in `survivors.toml`.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import tomllib
from collections.abc import Sequence
from pathlib import Path

from benchmarks.mutation.copies import copy_of
from benchmarks.mutation.judge import Verdict, verdicts
from benchmarks.mutation.mutants import Mutant, mutants_of, sample_of
from benchmarks.mutation.tests_of import measured

PROJECT = Path(__file__).resolve().parents[2]
STATE = PROJECT / ".mutants"  # what is known already; may be deleted at any time
REASONS = Path(__file__).with_name("survivors.toml")


def main() -> int:
    """Judge the samples and print what they show."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutation", description=__doc__)
    parser.add_argument("packages", nargs="+", metavar="PACKAGE", help="e.g. estimators")
    parser.add_argument("--sample", type=int, default=150, help="slips per package (default: 150)")
    parser.add_argument("--seed", type=int, default=1, help="of the sample (default: 1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="at a time")
    parser.add_argument("--at-least", type=float, default=85.0, help="percent killed, or exit 1")
    parser.add_argument(
        "--tests", nargs="+", metavar="PLACE", help="that judge (default: tests/PACKAGE alone)"
    )
    asked = parser.parse_args()
    reasons = reasons_in(REASONS.read_text(encoding="utf-8"))
    good = True
    with tempfile.TemporaryDirectory(prefix="mutants-") as there:
        now = copy_of(PROJECT, Path(there, "now"))  # the tree may be edited meanwhile
        copies = [copy_of(now.root, Path(there, str(job))) for job in range(asked.jobs)]
        for package in asked.packages:
            sample = _sample(now.root, package, asked.sample, asked.seed)
            tests = asked.tests or [f"tests/{package}"]
            hits = measured(copies, now.root / "pipeline", package, tests, STATE / "hits")
            judged = verdicts(copies, now.root, sample, hits, STATE / f"{package}.jsonl")
            lines, passed = report(judged, reasons, asked.at_least)
            print("\n".join(lines), flush=True)
            good = good and passed
    return 0 if good else 1


def reasons_in(text: str) -> dict[tuple[str, str, str, str], str]:
    """The reason for each survivor that is known: by file, function, before and after."""
    survivors = tomllib.loads(text).get("survivor", [])
    return {
        (one["file"], one["function"], one["before"], one["after"]): one["reason"]
        for one in survivors
    }


def report(
    judged: Sequence[Verdict], reasons: dict[tuple[str, str, str, str], str], at_least: float
) -> tuple[list[str], bool]:
    """The score and the survivors in words, and whether that is good enough."""
    survivors = [one for one in judged if one.killer is None]
    killed = len(judged) - len(survivors)
    slow = sum(one.killer == "time limit" for one in judged)
    score = 100.0 * killed / max(len(judged), 1)
    lines = [f"  killed {killed} of {len(judged)} = {score:.1f} % ({slow} by the time limit)"]
    explained = True
    for one in survivors:
        reason = reasons.get(_key(one.mutant))
        explained = explained and reason is not None
        lines += [
            f"  survived {one.tests} tests: {one.mutant.place}",
            f"    before: {one.mutant.before}",
            f"    after:  {one.mutant.after}",
            f"    reason: {reason or 'NONE in survivors.toml'}",
        ]
    return lines, explained and score >= at_least


def _key(mutant: Mutant) -> tuple[str, str, str, str]:
    return mutant.file, mutant.function, mutant.before, mutant.after


def _sample(project: Path, package: str, count: int, seed: int) -> list[Mutant]:
    everything = mutants_of(project / "pipeline", package)
    sample = sample_of(everything, count, seed)
    print(f"{package}: {len(sample)} of {len(everything)} mutants, seed {seed}", flush=True)
    return sample


if __name__ == "__main__":
    raise SystemExit(main())
