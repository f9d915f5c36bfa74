"""The tables of a study: what becomes of spoilt files, by technique and kind of mutation."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from benchmarks.fuzz.cases import KINDS
from benchmarks.fuzz.judge import VERDICTS, Verdict
from benchmarks.fuzz.study import Entry
from benchmarks.timing import Row

DAMAGED = ("text", "locale", "structure", "cells")
_MANY = 25
_KINDS, _WHERE = ("damaged", "wrong", "register"), ("alone", "group")


def rows(entries: Sequence[Entry]) -> list[Row]:
    """Count verdicts by technique and kind, of specimens alone and among their siblings."""
    found: list[Row] = []
    for technique in dict.fromkeys(sorted(e.technique for e in entries)):
        for kind in KINDS:
            mine = [e for e in entries if (e.technique, e.kind) == (technique, kind)]
            if mine:
                found.append(_row(technique, kind, mine))
    return found


def _row(technique: str, kind: str, mine: Sequence[Entry]) -> Row:
    row: dict[str, str | float | int] = {"technique": technique, "kind": kind, "files": len(mine)}
    for name, verdicts in (
        ("alone", [e.alone for e in mine if e.alone]),
        ("group", [e.group for e in mine if e.group]),
    ):
        counted: Counter[Verdict] = Counter(verdicts)
        for verdict in VERDICTS:
            share = 100.0 * counted[verdict] / len(verdicts) if verdicts else 0.0
            row[f"{name} {verdict} %"] = round(share, 1) if verdicts else ""
    return row


def silent_per_10000(entries: Iterable[Entry], kinds: Sequence[str]) -> dict[str, dict[str, float]]:
    """Rate of silence by technique, of specimens alone and among their siblings."""
    chosen = [e for e in entries if e.kind in kinds]
    found: dict[str, dict[str, float]] = {}
    for technique in sorted({e.technique for e in chosen}):
        mine = [e for e in chosen if e.technique == technique]
        judged = {"alone": [e.alone for e in mine if e.alone],
                  "group": [e.group for e in mine if e.group]}  # fmt: skip
        found[technique] = {
            name: 1e4 * verdicts.count("SILENT") / len(verdicts)
            for name, verdicts in judged.items()
            if verdicts
        }
    return found


def page(entries: Sequence[Entry]) -> str:
    """Write the page of the study."""
    parts = [_INTRODUCTION.format(len(entries)), _rates(entries), _verdicts(entries)]
    return "\n".join([*parts, _named(entries), _mutations(entries), _READING])


def _rates(entries: Sequence[Entry]) -> str:
    lines = [
        f"| technique | {' | '.join(f'{kind}, {where}' for kind in _KINDS for where in _WHERE)} |",
        "|---" * 7 + "|",
    ]
    tables = [silent_per_10000(entries, kinds) for kinds in (DAMAGED, ("wrong",), ("register",))]
    for technique in sorted({t for table in tables for t in table}):
        cells = [_shown(table.get(technique, {}), name) for table in tables for name in _WHERE]
        lines.append(f"| {technique} | " + " | ".join(cells) + " |")
    return "\n".join(["## Silent, of 10 000 files", "", *lines, ""])


def _shown(rates: Mapping[str, float], name: str) -> str:
    return f"{rates[name]:.0f}" if name in rates else ""


def _verdicts(entries: Sequence[Entry]) -> str:
    names = [f"{where} {verdict} %" for where in ("alone", "group") for verdict in _SHOWN]
    lines = ["| technique | kind | files | " + " | ".join(names) + " |"]
    lines.append("|---" * (3 + len(names)) + "|")
    for row in rows(entries):
        cells = [str(row[name]) for name in ("technique", "kind", "files", *names)]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(["## All verdicts, in percent of the files", "", *lines, ""])


_SHOWN: tuple[Verdict, ...] = ("right", "rejected", "refused", "flagged", "gone", "SILENT")


def _named(entries: Sequence[Entry]) -> str:
    """Name every damaged file that is silent, to be seen again with `--replay`."""
    damaged = [e for e in entries if e.kind in DAMAGED]
    silent = [e for e in damaged if "SILENT" in (e.alone, e.group)]
    bad = [e for e in entries if {"crash", "hang"} & {e.alone, e.group}]
    together = len([e for e in damaged if e.group == "SILENT"])
    counts = f"Of {len(damaged)} damaged files {len(silent)} are silent, {together} among siblings"
    lines = [
        f"{counts}; of all files {len(bad)} crash or hang.",
        "",
        "| good | mutation | seed | alone | group | what became of it |",
        "|---|---|---|---|---|---|",
    ]
    for e in (*silent, *bad):
        why = e.why.replace("|", "/")
        lines.append(
            f"| {e.good} | {e.mutation} | {e.seed} | {e.alone or ''} | {e.group or ''} | {why} |"
        )
    return "\n".join(["## Damaged and silent, each by name", "", *lines, ""])


def _mutations(entries: Sequence[Entry]) -> str:
    tried = Counter((e.technique, e.mutation) for e in entries if e.alone)
    silent = Counter((e.technique, e.mutation) for e in entries if e.alone == "SILENT")
    lines = ["| technique | mutation | files alone | silent |", "|---|---|---|---|"]
    for (technique, mutation), count in silent.most_common(_MANY):
        lines.append(f"| {technique} | {mutation} | {tried[technique, mutation]} | {count} |")
    return "\n".join([f"## The {_MANY} ways that are silent most often", "", *lines, ""])


_INTRODUCTION = """\
# Spoilt files
{} good SYNTHETIC files or register rows, of every reader, were spoilt at random, one way each, and
run as `deamat all` does: alone, and among up to four good siblings. Made by `make fuzz` and
`python -m benchmarks.fuzz --docs`; the test suite does 3 000.

- text: bytes, lines and ends of files lost, doubled or overwritten. locale: decimal marks,
  separators, thousands, signs, encodings. structure: columns, rows, labels and units lost, doubled
  or exchanged. cells: blank, text, NaN, sentinels, sign, exponent, a wild number. These four are
  "damaged".
- wrong: the file reads well and does not say what was measured: units, gain, exchanged columns,
  clipping, offset, sign, a stuck channel, lost and doubled rows, two exports in one.
- register: cells, units, exchanged numbers and labels, doubled rows, other files, near names.

right: every value lies within twice the half width of its interval from that of the good file.
flagged: it does not, and bears a flag that the good one does not. refused, rejected: there is no
value, and a reason, or the file is rejected (the siblings' value stays). gone: there is no value
and no reason. SILENT: the value is off and nothing is said. Crashes (errors that are no
`PipelineError`, or warnings of a library) and hangs (more than 1 s of processor time per file): the
command ends with 1 if there is any.
"""
_READING = """\
How to read it: what a single file cannot show stays silent alone, such as a channel's gain, or a
number of the register that is wrong by less than any bound; siblings show it. A group is right with
one wrong specimen where the interval of its mean is as wide as that specimen makes it.
"""
