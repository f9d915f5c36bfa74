"""What runs under each stage of a run: a change of code or library redoes what uses it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deamat.core.fingerprint import Fingerprint, Sources
from deamat.core.technique import AnyTechnique
from deamat.run.build_cache import digest, key_of
from deamat.run.environment import installed
from deamat.run.state import State

_PACKAGE = Path(__file__).resolve().parents[1]
_NAME = __name__.partition(".")[0]

# Left out of the stages behind them: what these give stands in the key of whatever is made of it.
_ROOMS = f"{_NAME}.techniques"  # the list of all rooms; each stage names what it runs of one
_WORK = f"{_NAME}.run.work"
_MEASURE = f"{_NAME}.run.measure"
_DRAW = f"{_NAME}.run.draw"


@dataclass(frozen=True, slots=True)
class Stages:
    """The fingerprint of every stage by its name: `measurement compression`, `card`."""

    fingerprints: Mapping[str, Fingerprint]

    def parts(self, stage: str) -> dict[str, str]:
        """Return the components that the code of a stage adds to a key."""
        found = self.fingerprints[stage]
        return {
            "code": found.code,
            "Python": f"{sys.implementation.cache_tag} on {sys.platform}",
            **{f"library {name}": version for name, version in found.libraries},
        }

    def libraries(self) -> dict[str, str]:
        """Return the version of every library that some stage computes with."""
        return dict(sorted({lib for one in self.fingerprints.values() for lib in one.libraries}))


def find_stages(
    techniques: Mapping[str, AnyTechnique], hashes: Mapping[str, str], state: State
) -> Stages:
    """Take the fingerprint of every stage, or the one of the run before if no source changed.

    Parameters
    ----------
    techniques : by their keys; the room of each is the module of that name under `techniques/`
    hashes : every input to its sha256; those of the package begin with `code/`
    """
    code = {path[5:]: sha for path, sha in hashes.items() if path.startswith("code/")}
    table = _table(techniques)
    key = key_of({**code, "installed": installed(), "table": digest(table)})
    kept = json.loads(state.read_note("stages") or "[null, {}]")
    if kept[0] == key:
        return Stages({
            name: Fingerprint(digest, tuple(map(tuple, libraries)))
            for name, (digest, libraries) in kept[1].items()
        })  # fmt: skip
    sources = Sources(_NAME, _PACKAGE, code)
    found = {
        stage: sources.fingerprint(starts, without) for stage, (starts, without) in table.items()
    }
    told = {stage: [one.code, one.libraries] for stage, one in found.items()}
    state.note("stages", json.dumps([key, told]))
    return Stages(found)


def _table(
    techniques: Mapping[str, AnyTechnique],
) -> dict[str, tuple[tuple[str, ...], tuple[str, ...]]]:
    """Say for each stage which modules run it, and which of those they import are left out."""
    table: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {}
    for key, technique in techniques.items():
        room = f"{_ROOMS}.{key}"
        reduces, summarises, draws = (
            _home(run, room) for run in (technique.reduce, technique.summarise, technique.figure)
        )
        table[f"measurement {key}"] = (reduces, _WORK), (_ROOMS,)
        table[f"summary {key}"] = (summarises, _MEASURE), (_ROOMS,)
        table[f"figure {key}"] = (draws, _DRAW), (_ROOMS, _MEASURE, _WORK)
    table["figure"] = (_DRAW,), (_ROOMS, _MEASURE, _WORK)
    for output in ("card", "database", "curves", "audit"):
        table[output] = (f"{_NAME}.run.publish",), (_ROOMS, _MEASURE, _WORK, _DRAW)
    return table


def _home(run: Callable[..., Any] | None, room: str) -> str:
    """Name the module of its room that a function stands in; the whole room where that is unclear.

    The bytes of the room's `__init__`, which declares the technique, count in any case.
    """
    module = str(getattr(run, "__module__", room))
    return module if module.startswith(f"{room}.") else room
