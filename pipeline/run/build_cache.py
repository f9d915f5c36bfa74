"""Stale or not: holds what a subject would be made from against what it was made from."""

from __future__ import annotations

import hashlib
import json
import pickle
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from deamat.run.state import DamagedState, State

# Results are kept as pickles, in this program's own cache alone: it carries checksums, is keyed on
# the code that wrote it and may be deleted at any time (ADR 4). Nothing published is a pickle.
STALE = "to be redone"


@dataclass(frozen=True, slots=True)
class Redo:
    """One thing that was or will be redone, and why."""

    stage: str
    subject: str
    why: str

    def __str__(self) -> str:
        return f"{self.stage} {self.subject}: {self.why}"


def digest(value: object) -> str:
    """Hash a frozen value by its repr (dataclasses, tuples, dicts in their written order)."""
    return hashlib.sha256(repr(value).encode()).hexdigest()[:16]


def key_of(components: Mapping[str, str]) -> str:
    """One key for a set of named components."""
    return hashlib.sha256(json.dumps(components, sort_keys=True).encode()).hexdigest()[:24]


@dataclass
class BuildCache:
    """The account of one run: asked for every subject of every stage, in their order."""

    state: State
    redone: list[Redo] = field(default_factory=list)
    _asked: dict[str, set[str]] = field(default_factory=dict)
    _made: dict[str, dict[str, tuple[str, dict[str, str]]]] = field(default_factory=dict)

    def _known(self, stage: str) -> dict[str, tuple[str, dict[str, str]]]:
        if stage not in self._made:
            self._made[stage] = self.state.made(stage)
        return self._made[stage]

    def fresh(self, stage: str, subject: str, components: Mapping[str, str]) -> bool:
        """Say whether the subject was made from exactly these components; note why if not."""
        self._asked.setdefault(stage, set()).add(subject)
        known = self._known(stage)
        if subject not in known:
            self.redone.append(Redo(stage, subject, "new"))
            return False
        before = known[subject][1]
        if before == dict(components):
            return True
        names = sorted(n for n in {*before, *components} if before.get(n) != components.get(n))
        why = ", ".join(
            f"{n} is new" if n not in before
            else f"{n} is gone" if n not in components
            else f"{n} is redone" if components[n] == STALE
            else f"{n} changed"
            for n in names
        )  # fmt: skip
        self.redone.append(Redo(stage, subject, why))
        return False

    def keep(self, stage: str, subject: str, components: Mapping[str, str], result: object) -> str:
        """Remember what was made; returns its key."""
        key = key_of(components)
        self.state.remember(stage, subject, key, components, pickle.dumps(result, protocol=5))
        return key

    def drop(self, stage: str, subject: str) -> None:
        """Forget what was made of a subject: its making failed, so the next run tries again."""
        self._asked.setdefault(stage, set()).add(subject)
        self.state.forget(stage, [subject])

    def result(self, stage: str, subject: str) -> Any:
        """Return what was made of a subject in an earlier run."""
        try:
            return pickle.loads(self.state.result(stage, subject))
        except (AttributeError, ImportError, TypeError, ValueError) as error:
            raise DamagedState(f"what is kept of {stage} {subject}: {error}") from error

    def earlier(self, stage: str, subject: str, components: Mapping[str, str]) -> Any:
        """Return what an earlier run made of a subject, None where nothing or by other code.

        What other code pickled may have fields that this code does not know.
        """
        known = self._known(stage)
        same = subject in known and known[subject][1].get("code") == components["code"]
        return self.result(stage, subject) if same else None

    def close(self) -> None:
        """Forget every subject that this run did not ask for, and note what went."""
        for stage in {*self._asked, *self.state.stages()}:
            asked = self._asked.get(stage, set())
            gone = sorted(set(self._known(stage)) - asked)
            self.redone += [Redo(stage, subject, "its source is gone") for subject in gone]
            self.state.forget(stage, gone)
