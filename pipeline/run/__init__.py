"""The driver: what is stale, in parallel, published whole or not at all.

`run_all` imports nothing heavy until it knows that there is something to do.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from deamat.core.errors import ConfigError
from deamat.run.environment import installed
from deamat.run.folders import Folders, Stat, look
from deamat.run.host import cpu_count
from deamat.run.published import intact
from deamat.run.state import STATE_FILE, DamagedState, State, set_state_aside

Hold = Callable[[dict[str, Stat]], dict[str, Stat]]


def run_all(
    folders: Folders,
    workers: int | None,
    progress: Callable[[str, int, int], None],
    verify: bool = False,
    hold: Hold = dict,
) -> dict[str, Any]:
    """Bring `processed/` up to date and give the document that `summary.text` prints.

    Parameters
    ----------
    workers : processes at most; None for one per core
    progress : told (stage, done, total) as the run goes on
    verify : hash every input again, whatever its time of change
    hold : given every input there is, returns them as the run may see them

    Raises
    ------
    ConfigError : a folder is not there, the configuration does not hold, another run is at work
    """
    for what, folder in (("--raw", folders.raw), ("--config", folders.config)):
        if not folder.is_dir():
            raise ConfigError(f"no folder {folder}; give one with {what}")
    try:
        return _run(folders, workers, progress, verify, hold)
    except DamagedState as error:
        aside = set_state_aside(folders.processed, error)
        document = _run(folders, workers, progress, verify, hold)
        return {**document, "warnings": [aside, *document["warnings"]]}


def _run(
    folders: Folders,
    workers: int | None,
    progress: Callable[[str, int, int], None],
    verify: bool,
    hold: Hold,
) -> dict[str, Any]:
    with State(folders.processed) as state:
        seen = hold(look(folders))
        document: dict[str, Any] = json.loads(state.read_note("document") or "{}")
        places = json.dumps([str(folders.raw.resolve()), str(folders.config.resolve())])
        if (
            not verify
            and not document.get("internal_errors")  # what failed is tried again
            and state.read_note("places") == places
            and state.read_note("installed") == installed()
            and state.unchanged(seen)
            and intact(folders.processed, state.read_note("published"))
        ):
            return {**document, "nothing_to_do": True}
        from deamat.run.process import process  # numpy, pydantic: only when there is work

        document = process(
            folders, state, seen, workers=workers or cpu_count(), progress=progress, verify=verify
        )
        state.note("places", places)
        state.note("installed", installed())
        state.note("document", json.dumps(document))
        warnings = [*state.aside, *document["warnings"]]  # told once, not kept
        return {**document, "warnings": warnings, "nothing_to_do": False}


def explain(folders: Folders) -> dict[str, Any]:
    """Say what a run would redo now and why, and what the last one redid; nothing is written.

    Raises
    ------
    DamagedState : nobody knows what the last run did
    """
    last, now = last_run(folders, verify=False)
    return {"now": now, "last": last["redone"]}


def last_run(folders: Folders, verify: bool = True) -> tuple[dict[str, Any], list[str]]:
    """Return the document of the last run and what one would redo now; nothing is written.

    Raises
    ------
    DamagedState : nobody knows what the last run did
    """
    try:
        with State(folders.processed, read_only=True) as state:
            from deamat.run.process import process

            seen = look(folders)
            now = process(
                folders, state, seen, workers=1, progress=_silent, verify=verify, dry=True
            )
            last = json.loads(state.read_note("document") or '{"redone": []}')
    except DamagedState as error:
        place = folders.processed / STATE_FILE
        said = f"{place}: {error}; the next run sets it aside and redoes everything"
        raise DamagedState(said) from error
    return last, now["redone"]


def _silent(stage: str, done: int, total: int) -> None:
    """Tell nobody."""
    del stage, done, total
