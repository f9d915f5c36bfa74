"""One case: a good campaign, one way to spoil it, and a seed."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from benchmarks.fuzz.damage import LOCALE, TEXT
from benchmarks.fuzz.good import Good
from benchmarks.fuzz.registers import REGISTER
from benchmarks.fuzz.runner import Files
from benchmarks.fuzz.sheet import Register, Sheet
from benchmarks.fuzz.tables import CELLS, STRUCTURE
from benchmarks.fuzz.wrong import WRONG
from deamat.techniques import TECHNIQUES

OfFile = Callable[[Sheet, Generator, Sheet], bytes]
OfRegister = Callable[[Register, Generator], Register]

OF_FILES: Mapping[str, Sequence[OfFile]] = {
    "text": TEXT, "locale": LOCALE, "structure": STRUCTURE, "cells": CELLS, "wrong": WRONG,
}  # fmt: skip
KINDS = (*OF_FILES, "register")
_FILE_MUTATIONS = {f.__name__: (kind, f) for kind, each in OF_FILES.items() for f in each}
_REGISTER_MUTATIONS: Mapping[str, OfRegister] = {f.__name__: f for f in REGISTER}
MUTATIONS: Mapping[str, Sequence[str]] = {
    **{kind: [f.__name__ for f in each] for kind, each in OF_FILES.items()},
    "register": list(_REGISTER_MUTATIONS),
}
_TRIES = 5


@dataclass(frozen=True, slots=True)
class Case:
    """What names a spoilt campaign for ever: reader and material, mutation, seed."""

    good: str
    mutation: str
    seed: int

    @property
    def kind(self) -> str:
        """Kind of the mutation."""
        return _FILE_MUTATIONS[self.mutation][0] if self.mutation in _FILE_MUTATIONS else "register"

    def spoil(self, good: Good) -> tuple[Files, Files] | None:
        """Spoil the first specimen, alone and among its siblings; None where nothing changed."""
        for attempt in range(_TRIES):
            draw = [self.seed, attempt, zlib.crc32(self.mutation.encode())]
            spoilt = self._spoilt(good, draw)
            if spoilt[1] != good.group:
                return spoilt
        return None

    def _spoilt(self, good: Good, draw: Sequence[int]) -> tuple[Files, Files]:
        alone, group = good.alone, good.group
        if self.kind == "register":
            change = _REGISTER_MUTATIONS[self.mutation]
            whole, single = good.register, Register.of(alone.register.decode())
            return (
                replace(alone, register=change(single, np.random.default_rng(draw)).data),
                replace(group, register=change(whole, np.random.default_rng(draw)).data),
            )
        path = str(good.file)
        mutate = _FILE_MUTATIONS[self.mutation][1]
        mine, sibling = good.sheets
        data = mutate(mine, np.random.default_rng(draw), sibling)
        return (
            replace(alone, files={**alone.files, path: data}),
            replace(group, files={**group.files, path: data}),
        )


def draw(
    seed: int, goods: Mapping[str, Good], techniques: Sequence[str] = tuple(TECHNIQUES)
) -> Case:
    """Draw technique, kind, good campaign and mutation of a case, each with equal chances."""
    rng = np.random.default_rng(seed)
    while True:
        technique, kind = str(rng.choice(techniques)), str(rng.choice(KINDS))
        names = [
            good.name for good in goods.values()
            if good.technique == technique and (kind == "register" or good.files)
        ]  # fmt: skip
        if not names:
            continue
        case = Case(str(rng.choice(names)), str(rng.choice(MUTATIONS[kind])), seed)
        if case.spoil(goods[case.good]) is not None:
            return case
