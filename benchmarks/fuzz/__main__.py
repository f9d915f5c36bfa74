"""`python -m benchmarks.fuzz`: spoil good files and registers, and judge what cards say of them.

Every case is named by its good campaign, its mutation and its seed. What is done is kept in
`processed/benchmarks/fuzz.jsonl`, and a study that was stopped goes on from there, unless the code
has changed since. Ends with 1 if there was a crash or a hang.
"""

from __future__ import annotations

import argparse
import difflib
import tempfile
from pathlib import Path

from benchmarks.fuzz.cases import Case
from benchmarks.fuzz.fuzzer import Fuzzer
from benchmarks.fuzz.good import ROOT
from benchmarks.fuzz.judge import BAD, answers
from benchmarks.fuzz.page import page, rows
from benchmarks.fuzz.study import study
from benchmarks.timing import RESULTS, table, write_results
from deamat.techniques import TECHNIQUES

DONE = RESULTS / "fuzz.jsonl"
_SHOWN = 40


def main() -> int:
    """Run a study, or show one case again."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fuzz", description=__doc__)
    parser.add_argument("--count", type=int, default=20_000, help="files (default: 20000)")
    parser.add_argument("--first", type=int, default=0, metavar="SEED", help="(default: 0)")
    parser.add_argument("--techniques", nargs="+", default=list(TECHNIQUES), metavar="TECHNIQUE")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--docs", action="store_true", help="write docs/fuzz.md")
    parser.add_argument(
        "--replay", nargs=3, metavar=("GOOD", "MUTATION", "SEED"), help="show one case again"
    )
    asked = parser.parse_args()
    if asked.replay:
        good, mutation, seed = asked.replay
        return replay(Case(good, mutation, int(seed)))
    seeds = range(asked.first, asked.first + asked.count)
    entries = study(seeds, asked.techniques, asked.workers, DONE)
    found = rows(entries)
    print(table(found))
    write_results("fuzz", found, ("numpy", "scipy"))
    bad = [e for e in entries if e.alone in BAD or e.group in BAD]
    for entry in sorted(bad, key=lambda e: "SILENT" in (e.alone, e.group))[:_SHOWN]:
        print(f"alone {entry.alone}, group {entry.group}: {entry.replay}\n  {entry.why}")
    print(f"{len(bad)} of {len(entries)} silent, crashed or hanging; all of them: {DONE}")
    if asked.docs:
        (ROOT / "docs" / "fuzz.md").write_text(page(entries), "utf-8")
    return int(any({e.alone, e.group} & {"crash", "hang"} for e in entries))


def replay(case: Case) -> int:
    """Show what a case changes, what is said of it, and where it crashes."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as place, Fuzzer(Path(place)) as fuzzer:
        good = fuzzer.goods[case.good]
        spoilt = case.spoil(good)
        if spoilt is None:
            print("this case changes nothing")
            return 1
        for before, after in ((good.alone, spoilt[0]), (good.group, spoilt[1])):
            given = {"register": before.register, **before.files}
            taken = {"register": after.register, **after.files}
            for name in given:
                _show_change(name, given[name], taken[name])
            outcome = fuzzer.runner(case.good).outcome(after)
            for answer in answers(outcome):
                print(f"  {answer.key}: {answer}")
            for key, reason in outcome.refused:
                print(f"  {key} refused: {reason}")
            for reason in outcome.rejected:
                print(f"  rejected: {reason}")
            for failure in outcome.failures:
                print(failure.traceback)
        result = fuzzer.judge(case)
        print(f"alone: {result.alone}\ngroup: {result.group}")
        return 0


def _show_change(name: str, before: bytes, after: bytes) -> None:
    if before == after:
        return
    lines = difflib.unified_diff(
        _shown_lines(before),
        _shown_lines(after),
        f"good {name}",
        f"spoilt {name}",
        lineterm="",
        n=1,
    )
    print("\n".join(list(lines)[:_SHOWN]))


def _shown_lines(data: bytes) -> list[str]:
    """Return lines of bytes with every odd byte shown."""
    return [repr(line)[2:-1] for line in data.split(b"\n")]


if __name__ == "__main__":
    raise SystemExit(main())
