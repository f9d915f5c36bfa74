"""Runs cases: every good campaign in a folder of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Self

from benchmarks.fuzz.cases import Case
from benchmarks.fuzz.good import ROOT, Good, good_campaigns, of_twin
from benchmarks.fuzz.judge import BAD, Judged, Verdict, judge
from benchmarks.fuzz.runner import BUDGET_s, Files, Outcome, Runner
from deamat.core.config import load_config
from deamat.techniques import TECHNIQUES

# Property that a technique needs of its material, and the technique that gives it.
_NEEDED = {
    "permittivity": ("compression", "compressive_modulus"), "handling": ("viscosity", "viscosity"),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Result:
    """What became of a case.

    Parameters
    ----------
    alone, group : None where the good campaign gives no value, or nothing changed in it
    """

    case: Case
    alone: Judged | None
    group: Judged | None

    @property
    def bad(self) -> Judged | None:
        """What nobody may leave as it is: silence, a crash, a hang."""
        found = (j for j in (self.alone, self.group) if j is not None)
        return next((j for j in found if j.verdict in BAD), None)

    def verdicts(self) -> dict[str, Verdict]:
        """Both verdicts, as far as there are any."""
        both = {"alone": self.alone, "group": self.group}
        return {name: judged.verdict for name, judged in both.items() if judged is not None}


class Fuzzer:
    """The good campaigns, each with its runner, and what is said of them; a context manager.

    Parameters
    ----------
    place : an empty folder
    """

    def __init__(self, place: Path) -> None:
        self._place = place
        self._config = load_config(ROOT / "config", {t.key: t.config for t in TECHNIQUES.values()})
        self._runners: dict[str, Runner] = {}
        self._said: dict[str, tuple[Outcome, Outcome]] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for runner in self._runners.values():
            runner.close()

    @cached_property
    def goods(self) -> Mapping[str, Good]:
        """Every good campaign by its name."""
        return good_campaigns()

    def said(self, name: str) -> tuple[Outcome, Outcome]:
        """What is said of a good campaign: of its first specimen alone, and of all."""
        if name not in self._said:
            good = self.goods[name]
            self._said[name] = self._outcome(name, good.alone), self._outcome(name, good.group)
        return self._said[name]

    def _outcome(self, name: str, given: Files) -> Outcome:
        budget_s = BUDGET_s * max(1, len(given.files))
        return self.runner(name).outcome(given, budget_s)

    def runner(self, name: str) -> Runner:
        """The runner of a good campaign, in which what its technique needs is known."""
        if name not in self._runners:
            good = self.goods[name]
            found = Runner(self._place / str(len(self._runners)), self._config)
            self._runners[name] = found
            if good.technique in _NEEDED:
                technique, key = _NEEDED[good.technique]
                before = found.outcome(of_twin(technique, good.material).group, 10.0 * BUDGET_s)
                found.records[good.material] = [r for r in before.records if r.key == key]
                found.laws[good.material] = list(before.laws)
        return self._runners[name]

    def judge(self, case: Case, *, group: bool = True) -> Result:
        """Run a case alone and, if asked for, among its siblings.

        What gives no value alone (a breakdown strength), or has no file of its own (a register of
        observations), is run as it is.
        """
        good = self.goods[case.good]
        spoilt = case.spoil(good)
        if spoilt is None:
            return Result(case, None, None)
        alone, among = self.said(case.good)
        single = bool(alone.records) and bool(good.files)
        return Result(
            case,
            self._judged(case, alone, good.alone, spoilt[0]) if single else None,
            self._judged(case, among, good.group, spoilt[1]) if group or not single else None,
        )

    def _judged(self, case: Case, clean: Outcome, good: Files, spoilt: Files) -> Judged | None:
        return None if spoilt == good else judge(clean, self._outcome(case.good, spoilt))
