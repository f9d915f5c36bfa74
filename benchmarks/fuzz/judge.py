"""Holds what a card says of a spoilt campaign against what it said of the good one.

Right: every value agrees with the good one, which lies within twice the half width of its interval.
Flagged: a value is off and bears a flag that its good sister does not. Refused: a value is gone and
a reason is stated. Rejected: a file, register or row is. SILENT: a value is off by more than twice
the half width and nothing is said; gone: a value is, and nothing is said. Crash: an error that is
no `PipelineError`, or a warning of a library. Hang: the budget of processor time is spent.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

from benchmarks.fuzz.runner import Outcome
from deamat.core.errors import OutOfRange
from deamat.core.kinds import Condition
from deamat.core.records import Law, PropertyRecord

Verdict = Literal["right", "rejected", "refused", "flagged", "gone", "SILENT", "hang", "crash"]
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)
BAD: tuple[Verdict, ...] = ("SILENT", "hang", "crash")
_SHARES_OF_LAW = (0.1, 0.5, 0.9)
_LAW = " (law)"


@dataclass(frozen=True, slots=True)
class Judged:
    """The verdict on one campaign, and the value or error that led to it."""

    verdict: Verdict
    why: str = ""


@dataclass(frozen=True, slots=True)
class Answer:
    """One value of a card, or of a law at one place."""

    key: str
    conditions: Mapping[str, Condition]
    value: float
    low: float
    high: float
    flags: Counter[str]

    @property
    def half(self) -> float:
        """Half the width of its interval."""
        return 0.5 * (self.high - self.low)

    def agrees_with(self, good: Answer) -> bool:
        """Say whether the good value is what this one may be taken for."""
        slack = 1e-9 * abs(good.value)
        if math.isinf(self.half):  # a lower bound
            return self.low <= good.value + slack
        if math.isinf(good.half):
            return self.high + self.half >= good.value - slack
        near = self.low - self.half - slack <= good.value <= self.high + self.half + slack
        return near or abs(self.value - good.value) <= 2.0 * self.half + slack

    def __str__(self) -> str:
        flags = ", ".join(sorted(self.flags))
        said = f"{self.value:.5g} [{self.low:.5g}, {self.high:.5g}]"
        return f"{said} ({flags})" if flags else said


def judge(good: Outcome, spoilt: Outcome) -> Judged:
    """Judge a spoilt campaign by the worst of its values."""
    if spoilt.hang:
        return Judged("hang")
    if spoilt.failures:
        return Judged("crash", str(spoilt.failures[0]))
    before, after = list(answers(good)), list(answers(spoilt, good.laws))
    verdicts = [_verdict(one, before, after, spoilt) for one in before]
    worst = max(verdicts, key=lambda j: VERDICTS.index(j.verdict), default=Judged("right"))
    news = sorted(set(spoilt.rejected) - set(good.rejected))
    if worst.verdict == "right" and news:
        return Judged("rejected", news[0])
    return worst


def answers(outcome: Outcome, asked: Sequence[Law] = ()) -> Iterator[Answer]:
    """List every value of an outcome, and its laws at three times.

    Parameters
    ----------
    asked : laws over whose range these are asked; their own by default
    """
    for r in outcome.records:
        flags = Counter(flag.name for flag in r.flags)
        yield Answer(r.key, _conditions(r), r.quantity.value, *r.ci95, flags)
    for law in outcome.laws:
        over = next((other for other in asked if other.key == law.key), law)
        yield from _along(law, over)


def _conditions(record: PropertyRecord) -> dict[str, Condition]:
    return dict(record.conditions)


def _along(law: Law, over: Law) -> Iterator[Answer]:
    low, high = over.valid
    rate = over.usual_rate
    for share in _SHARES_OF_LAW:
        x = low + share * (high - low)
        try:
            value, interval = law(x, rate).value, law.ci95(x, rate)
        except OutOfRange:
            continue
        flags = Counter(flag.name for flag in law.flags)
        yield Answer(law.key + _LAW, {"x": x}, value, *interval, flags)


def _verdict(
    good: Answer, before: Sequence[Answer], after: Sequence[Answer], spoilt: Outcome
) -> Judged:
    """Judge all that a spoilt campaign says of one value."""
    sisters = [one for one in before if one.key == good.key]
    telling = [k for k in good.conditions if len({repr(s.conditions.get(k)) for s in sisters}) > 1]
    found = [
        one for one in after
        if one.key == good.key
        and all(one.conditions.get(k) == good.conditions[k] for k in telling)
    ]  # fmt: skip
    if not found:
        return _absent(good, spoilt)
    judged = [_compared(good, one) for one in found]
    return max(judged, key=lambda j: VERDICTS.index(j.verdict))


def _absent(good: Answer, spoilt: Outcome) -> Judged:
    if good.key.endswith(_LAW):
        return Judged("right")  # a law that does not reach so far says so when it is asked
    for key, reason in spoilt.refused:
        if key == good.key:
            return Judged("refused", f"{key}: {reason}")
    if spoilt.rejected:
        return Judged("rejected", spoilt.rejected[0])
    if spoilt.refused and not spoilt.records:  # a specimen is refused whole, under its usual keys
        return Judged("refused", ": ".join(spoilt.refused[0]))
    return Judged("gone", f"{good.key}: {good}")


def _compared(good: Answer, one: Answer) -> Judged:
    if one.agrees_with(good):
        return Judged("right")
    why = f"{good.key}: {good} became {one}"
    return Judged("flagged" if one.flags - good.flags else "SILENT", why)
