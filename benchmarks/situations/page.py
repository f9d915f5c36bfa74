"""Writes `docs/situations.md`: what each situation is, what is said of it, how often in silence."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence

from benchmarks.situations.judge import Judged, Verdict
from deamat.core.flags import SEVERITY_OF
from deamat.twin.situations import SITUATIONS

Cells = Mapping[tuple[str, float], Sequence[Judged]]

_SHOWN: tuple[Verdict, ...] = ("right", "limit", "flagged", "refused", "missed", "SILENT")
_ALLOWED_SILENT, _ALLOWED_MISSED = 1.0, 6.0  # % of a cell
_CHANCE = (
    "A 95 % interval misses in 5 % without any fault, and of 200 materials by chance in 2 to 8 % "
    "(of 50 in 0 to 12 %): what the same laboratory misses without the fault stands beside."
)
_INTRODUCTION = """\
Each situation is made by the twin (SYNTHETIC; `pipeline/twin/situations/`) at each severity as many
times as n says, and run as `deamat all` does, one campaign alone; `deamat simulate --situation NAME
--severity X --seed N --out DIR` writes one. Right: the interval holds the truth. Limit: a lower
limit that holds. Flagged: off, with a flag that names the cause. Refused: no value, and a reason.
Missed: outside the 95 % interval, without such a flag, by less than twice its half width. SILENT:
by more. Where the fault is in what a row says of its specimen (its speed, dates, name or
material), all that is neither flagged nor rejected is SILENT. Made by
`python -m benchmarks.situations --docs`."""


def row(task: tuple[str, float], judged: Sequence[Judged]) -> dict[str, str | float]:
    """Count the verdicts of one cell, in per cent."""
    name, severity = task
    count = len(judged)
    counted = Counter(j.verdict for j in judged)
    shares: dict[str, str | float] = {v: _percent(counted[v], count) for v in _SHOWN}
    off = math.fsum(j.off for j in judged) / count
    shown = "" if math.isnan(off) else f"{100.0 * off:+.1f}"
    return {
        "situation": name, "severity": severity, "n": count, "naive off %": shown, **shares,
        "crash": _percent(counted["crash"], count),
        "cause named %": _percent(sum(j.alarm for j in judged), count),
    }  # fmt: skip


def _percent(part: int, whole: int) -> float:
    return round(100.0 * part / whole, 2)


def page(cells: Cells) -> str:
    """Write the page."""
    rows = [row(task, judged) for task, judged in cells.items()]
    lines = ["# What laboratories have, and what is said of it", _INTRODUCTION, ""]
    lines += [*_worst(rows), *_false_alarms(cells)]
    for name in dict.fromkeys(task[0] for task in cells):
        lines += _of_situation(name, [r for r in rows if r["situation"] == name])
    return "\n".join(lines)


def _of_situation(name: str, rows: Sequence[dict[str, str | float]]) -> list[str]:
    situation = SITUATIONS[name]
    verdicts = " | ".join(f"{verdict} %" for verdict in _SHOWN)
    lines = [f"## {name}", f"{situation.told} Property: `{situation.key}`."]
    lines += [f"**On the card:** {situation.answer}", ""]
    lines += [f"| {situation.severity} | n | naive script off, % | {verdicts} | cause named % |"]
    lines += ["|---" * (len(_SHOWN) + 4) + "|"]
    for one in rows:
        severity = float(one["severity"])
        label = "no fault" if severity == 0.0 else f"{severity:g}"
        numbers = " | ".join(str(one[v]) for v in (*_SHOWN, "cause named %"))
        lines.append(f"| {label} | {one['n']} | {one['naive off %']} | {numbers} |")
    lines += [f"\n{severity:g}: {reason}" for severity, reason in situation.undetectable.items()]
    return [*lines, ""]


def _worst(rows: Sequence[dict[str, str | float]]) -> list[str]:
    """List the cells that the data cannot show, and those beyond what is allowed."""
    faulty = [r for r in rows if float(r["severity"]) != 0.0]
    sound = {r["situation"]: r for r in rows if float(r["severity"]) == 0.0}
    beyond = [
        r for r in faulty
        if float(r["SILENT"]) >= _ALLOWED_SILENT or float(r["missed"]) > _ALLOWED_MISSED
    ]  # fmt: skip
    said = f"{len(beyond)} of {len(faulty)} cells with a fault are silent in {_ALLOWED_SILENT:g} % "
    said += f"or more, or missed in more than {_ALLOWED_MISSED:g} %. {_CHANCE}"
    lines = ["## The worst cells", said, ""]
    if beyond:
        lines += [
            "| situation | severity | n | SILENT % | missed % | both without the fault % | why |",
            "|---|---|---|---|---|---|---|",
        ]
    for r in beyond:
        name, severity = str(r["situation"]), float(r["severity"])
        without = sound[name]
        chance = f"{float(without['SILENT']) + float(without['missed']):.3g}"
        why = SITUATIONS[name].undetectable.get(severity, "")
        told = (name, f"{severity:g}", r["n"], r["SILENT"], r["missed"], chance, why)
        lines.append(f"| {' | '.join(map(str, told))} |")
    return [*lines, ""]


def _false_alarms(cells: Cells) -> list[str]:
    """Count the flags on materials without a fault, by technique and by flag."""
    clean: dict[str, list[Judged]] = defaultdict(list)
    for (name, severity), judged in cells.items():
        if severity == 0.0 and SITUATIONS[name].sound:
            clean[SITUATIONS[name].technique] += judged
    lines = ["## False alarms on clean data"]
    lines += [
        "The same laboratories without the fault: flags of severity warning or serious. Some are",
        "tests whose level says how often they raise a false alarm: `outlier` (Grubbs) is one at",
        "1 % for each property, `poor-fit` and `low-outlier` are tests at 5 % (`goodness_level`,",
        "`low_outlier_level` of [breakdown]).",
        "",
        "| technique | materials | flag | severity | false alarms % |",
        "|---|---|---|---|---|",
    ]
    for technique, judged in clean.items():
        count = len(judged)
        raised = Counter(flag for j in judged for flag in j.flags)
        start = f"| {technique} | {count} "
        lines += [
            f"{start}| {flag} | {SEVERITY_OF.get(flag, 'warning')} | {_percent(times, count)} |"
            for flag, times in sorted(raised.items())
        ]
        refused = sum(j.verdict == "refused" for j in judged)
        lines.append(f"{start}| refused | | {_percent(refused, count)} |")
        any_ = sum(bool(j.flags) or j.verdict == "refused" for j in judged)
        lines.append(f"{start}| any of them | | {_percent(any_, count)} |")
    return [*lines, ""]
