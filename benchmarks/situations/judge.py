"""Makes a material in a situation, runs its campaign and holds the answer against the truth."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from benchmarks.fuzz.runner import CAMPAIGN, Runner
from deamat.core.config import load_config
from deamat.core.records import PropertyRecord
from deamat.techniques import TECHNIQUES
from deamat.twin.situations import SITUATIONS
from deamat.twin.situations.situation import MATERIAL, Made, Situation
from deamat.twin.situations.written import campaign_of, make_situation

ROOT = Path(__file__).resolve().parents[2]
_BUDGET_s = 20.0

# From the best to the worst.
Verdict = Literal["right", "limit", "refused", "flagged", "missed", "SILENT", "crash"]
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)


@dataclass(frozen=True, slots=True)
class Judged:
    """What came of one material in one situation.

    Parameters
    ----------
    off : how far the naive value is from the truth, relative
    alarm : a flag that names the cause, or a refusal
    flags : names of all flags on the cards that are more than information
    """

    verdict: Verdict
    off: float
    alarm: bool
    flags: frozenset[str]


def cell(task: tuple[str, float, int, int]) -> list[Judged]:
    """Judge many materials of one situation and severity: name, severity, first seed, count."""
    name, severity, first, count = task
    config = load_config(ROOT / "config", {t.key: t.config for t in TECHNIQUES.values()})
    with tempfile.TemporaryDirectory() as place:
        runner = Runner(Path(place), config)
        judged = [judge(SITUATIONS[name], severity, first + i, runner) for i in range(count)]
        runner.close()
    return judged


def judge(situation: Situation, severity: float, seed: int, runner: Runner) -> Judged:
    """Make one material in a situation, run it and hold the answer against the truth."""
    made = make_situation(situation, severity, seed)
    files = campaign_of(situation, severity, seed, made)
    outcome = runner.whole({f"{CAMPAIGN}/{p}": d for p, d in files.items()}, _BUDGET_s)
    off = made.naive / made.truth - 1.0
    flags = frozenset(f.name for r in outcome.records for f in r.flags if f.severity != "info")
    found = [r for r in outcome.records if _meant(r, situation, made)]
    telling = [r for r in outcome.records if r.key == situation.key] if made.misstated else found
    alarm = any(_names_cause(record, situation.causes) for record in telling)
    refused = any(key == situation.key for key, _ in outcome.refused) or bool(
        outcome.rejected or (outcome.refused and not outcome.records)  # specimens refused whole
    )
    if outcome.failures or outcome.hang:
        verdict: Verdict = "crash"
    elif not found:
        verdict = "refused" if refused else "SILENT"
    elif severity and made.misstated:
        verdict = "flagged" if alarm else "refused" if outcome.rejected else "SILENT"
    else:
        verdict = max((_verdict(r, made, situation.causes) for r in found), key=VERDICTS.index)
    return Judged(verdict, off, alarm or (not found and refused), flags)


def _meant(record: PropertyRecord, situation: Situation, made: Made) -> bool:
    return (
        record.key == situation.key
        and record.material == MATERIAL
        and all(_same(record.conditions.get(k), v) for k, v in made.conditions.items())
    )


def _same(one: object, other: object) -> bool:
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other)
    return one == other


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
