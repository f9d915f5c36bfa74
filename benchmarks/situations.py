"""How often a situation that laboratories have ends in a wrong number that nothing warns of.

`python -m benchmarks.situations` makes every situation of the twin at every severity, reads its
files as a run would and judges what comes out: right (the interval holds the truth), a limit that
holds, flagged with a cause, refused or rejected, missed (outside the interval), or SILENT: off by
more than twice the half width of its 95 % interval, with no flag that names the cause. Severity 0
is the same laboratory without the fault, and counts false alarms. `--docs` writes
`docs/situations.md`.
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from statistics import fmean
from typing import Literal

import numpy as np

from benchmarks.in_memory import Campaign, summaries
from benchmarks.timing import write_results
from deamat.core.config import Config, load_config
from deamat.core.errors import RawFileError
from deamat.core.records import PropertyRecord
from deamat.techniques import TECHNIQUES
from deamat.twin.situations import SITUATIONS
from deamat.twin.situations.situation import Made, Situation

ROOT = Path(__file__).resolve().parents[1]
FIRST_SEED = 500_000

Verdict = Literal["right", "limit", "flagged", "refused", "missed", "SILENT"]


@dataclass(frozen=True, slots=True)
class Judged:
    """What came of one material in one situation.

    Parameters
    ----------
    off : how far the naive value is from the truth, relative
    alarm : a flag that names the cause, or a refusal
    """

    verdict: Verdict
    off: float
    alarm: bool


@cache
def _config() -> Config:
    return load_config(ROOT / "config", {t.key: t.config for t in TECHNIQUES.values()})


def judge(situation: Situation, severity: float, seed: int) -> Judged:
    """Make one material in a situation, read it and hold the answer against the truth."""
    rng = np.random.default_rng([seed, *situation.name.encode(), round(1e6 * severity)])
    made = situation.make(rng, severity)
    off = made.naive / made.truth - 1.0
    try:
        found = _records(situation, made)
    except RawFileError:
        found = []
    if not found:
        return Judged("refused", off, True)
    verdicts = [_verdict(record, made, situation.causes) for record in found]
    alarm = any(_names_cause(record, situation.causes) for record in found)
    return Judged(max(verdicts, key=_ORDER.index), off, alarm)


_ORDER: tuple[Verdict, ...] = ("right", "limit", "refused", "flagged", "missed", "SILENT")


def _records(situation: Situation, made: Made) -> list[PropertyRecord]:
    technique = TECHNIQUES[situation.technique]
    campaign = Campaign("simulated", {f"{technique.key}/{p}": d for p, d in made.files.items()})
    return [
        record
        for summary in summaries(technique, campaign, _config())
        for record in summary.records
        if record.key == situation.key
        and all(record.conditions.get(k) == v for k, v in made.conditions.items())
    ]


def _names_cause(record: PropertyRecord, causes: Sequence[str]) -> bool:
    return any(flag.name in causes for flag in record.flags)


def _verdict(record: PropertyRecord, made: Made, causes: Sequence[str]) -> Verdict:
    low, high = record.ci95
    slack = 1e-9 * abs(made.truth)
    if record.bound == "lower":
        if low <= made.truth + slack:
            return "limit"
        return "flagged" if _names_cause(record, causes) else "SILENT"
    if low - slack <= made.truth <= high + slack:
        return "right"
    if _names_cause(record, causes):
        return "flagged"
    half = 0.5 * (high - low)
    return "SILENT" if abs(record.quantity.value - made.truth) > 2.0 * half else "missed"


def cell(task: tuple[str, float, int, int]) -> list[Judged]:
    """Judge many materials of one situation and severity."""
    name, severity, first, count = task
    return [judge(SITUATIONS[name], severity, first + i) for i in range(count)]


def study(names: Sequence[str], count: int, workers: int) -> list[dict[str, str | float]]:
    """Run the study: a row for every situation and severity, severity 0 first."""
    tasks = [
        (name, severity, FIRST_SEED, count)
        for name in names
        for severity in (0.0, *SITUATIONS[name].severities)
    ]
    with ProcessPoolExecutor(workers) as pool:
        cells = list(pool.map(cell, tasks))
    return [_row(task, judged) for task, judged in zip(tasks, cells, strict=True)]


def _row(task: tuple[str, float, int, int], judged: Sequence[Judged]) -> dict[str, str | float]:
    name, severity, _, count = task
    counted = Counter(j.verdict for j in judged)
    shares: dict[str, str | float] = {v: round(100.0 * counted[v] / count, 2) for v in _ORDER}
    alarms = round(100.0 * sum(j.alarm for j in judged) / count, 2)
    off = fmean(j.off for j in judged)
    shown = "" if math.isnan(off) else f"{100.0 * off:+.1f}"
    return {
        "situation": name, "severity": severity, "naive off %": shown, **shares,
        "cause named %": alarms,
    }  # fmt: skip


def page(rows: Sequence[dict[str, str | float]], count: int) -> str:
    """Write the page: what each situation is, what is said of it, and how often it is silent."""
    lines = ["# What laboratories have, and what is said of it", _INTRODUCTION.format(count), ""]
    for name in dict.fromkeys(str(row["situation"]) for row in rows):
        situation = SITUATIONS[name]
        verdicts = " | ".join(f"{verdict} %" for verdict in _SHOWN)
        lines += [f"## {name}", f"{situation.told} Property: `{situation.key}`."]
        lines += [f"**On the card:** {situation.answer}", ""]
        lines += [f"| {situation.severity} | naive script off, % | {verdicts} | cause named % |"]
        lines += ["|---" * (len(_SHOWN) + 3) + "|"]
        for row in (r for r in rows if r["situation"] == name):
            severity = float(row["severity"])
            label = "no fault" if severity == 0.0 else f"{severity:g}"
            numbers = " | ".join(str(row[v]) for v in (*_SHOWN, "cause named %"))
            lines.append(f"| {label} | {row['naive off %']} | {numbers} |")
        lines += [
            f"\n{severity:g}: {reason}" for severity, reason in situation.undetectable.items()
        ]
        lines.append("")
    return "\n".join(lines)


_INTRODUCTION = """\
Each situation is made by the twin (SYNTHETIC; `pipeline/twin/situations/`) {} times at each
severity, read and judged as a run would, one material in one campaign alone. SILENT is a value
that is off by more than twice the half width of its 95 % interval with no flag that names the
cause. Made by `python -m benchmarks.situations --docs`."""
_SHOWN: tuple[Verdict, ...] = ("right", "limit", "flagged", "refused", "missed", "SILENT")


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="situations [default: all]")
    parser.add_argument("--count", type=int, default=300, help="materials in each cell")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--docs", action="store_true", help="write docs/situations.md")
    options = parser.parse_args()
    rows = study(options.names or list(SITUATIONS), options.count, options.workers)
    for row in rows:
        print("  ".join(f"{key} {value}" for key, value in row.items()))
    write_results("situations", rows, ("numpy", "scipy"))
    if options.docs:
        (ROOT / "docs" / "situations.md").write_text(page(rows, options.count), "utf-8")


if __name__ == "__main__":
    main()
