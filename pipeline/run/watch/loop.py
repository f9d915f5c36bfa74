"""The loop of `deamat watch`: look, wait until files are complete, run, say what came of it."""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

from deamat.core.errors import ConfigError, PipelineError
from deamat.run import run_all, summary
from deamat.run.folders import Folders, Stat, look
from deamat.run.watch.arrivals import Arrivals, Patience
from deamat.run.watch.notices import Notices, noticing

_LOOK_s = 1.0  # between two looks at least, whatever the system notices
_TOGETHER_s = 0.05  # notices of one writer come in a row
_AGAIN_s = 5.0  # after a run that another one or the machine prevented
_MOST = 5  # lines about rejected files
_CODE = "code/"


@dataclass(frozen=True, slots=True)
class Watching:
    """How to watch.

    Parameters
    ----------
    poll : ask for the state of files instead of being told: for network drives
    workers : processes of a run at most; None for one per core
    """

    patience: Patience = field(default_factory=Patience)
    poll: bool = False
    workers: int | None = None


def follow(
    folders: Folders,
    watching: Watching,
    say: Callable[[str], None],
    stopped: Callable[[], bool] = lambda: False,
) -> None:
    """Run whenever a file is complete, until stopped.

    Parameters
    ----------
    say : told a line at a time
    stopped : asked between two looks

    Raises
    ------
    ConfigError : a folder is not there, the program itself was changed
    """
    for what, folder in (("--raw", folders.raw), ("--config", folders.config)):
        if not folder.is_dir():
            raise ConfigError(f"no folder {folder}; give one with {what}")
    roots = {folders.raw.resolve(): "raw", folders.config.resolve(): "config"}
    with noticing(roots, poll=watching.poll) as notices:
        loop = _Loop(folders, watching, say, Arrivals(watching.patience))
        loop.begin()
        say(f"watching   {folders.raw} (Ctrl-C ends it)")
        while not stopped():
            loop.look(notices)
            loop.wait(notices)


@dataclass
class _Loop:
    """What the loop remembers.

    Parameters
    ----------
    code : the program's own files as they were at the start
    again_s : when a run that could not be made is tried again; None for none
    failing : why the last one could not, empty where it could
    """

    folders: Folders
    watching: Watching
    say: Callable[[str], None]
    arrivals: Arrivals
    code: dict[str, Stat] = field(default_factory=dict)
    again_s: float | None = None
    failing: str = ""

    def begin(self) -> None:
        """Take what is there, run, and load what runs need, so that the next one is quick."""
        seen = look(self.folders)
        self.code = {path: stat for path, stat in seen.items() if path.startswith(_CODE)}
        files = _files(seen)
        now_s = time.time()
        age_s = {path: now_s - stat.mtime_ns / 1e9 for path, stat in files.items()}
        self.arrivals.begin(files, age_s, time.monotonic())
        import_module("deamat.run.process")
        self.run()

    def look(self, notices: Notices) -> None:
        """Look at the files, and run where one is complete."""
        for path, note in notices.take().items():
            self.arrivals.note(path, note)
        try:
            seen = look(self.folders)
        except OSError as error:  # a drive that is away for a while
            self._fails(f"{error.filename}: {error.strerror}")
            return
        if {path: stat for path, stat in seen.items() if path.startswith(_CODE)} != self.code:
            raise ConfigError("the program was changed; start `deamat watch` again")
        now_s = time.monotonic()
        due = self.arrivals.look(_files(seen), now_s)
        if due or (self.again_s is not None and now_s >= self.again_s):
            self.run()

    def wait(self, notices: Notices) -> None:
        """Wait until something is noticed, a file is complete, or it is time for a look."""
        ends = [_LOOK_s]
        now_s = time.monotonic()
        ends += [end - now_s for end in (self.arrivals.next_s(), self.again_s) if end is not None]
        if notices.woken.wait(max(0.0, min(ends))):
            time.sleep(_TOGETHER_s)

    def run(self) -> None:
        """Run on the files that are complete, and say what came of it."""
        self.again_s = None
        try:
            document = run_all(self.folders, self.watching.workers, _silent, hold=self._hold)
        except (PipelineError, OSError, sqlite3.Error) as error:
            # a slip in the configuration, another run at work, a full disk: all of them end
            self._fails(str(error))
            return
        self.failing = ""
        for line in _told(document):
            self.say(line)

    def _fails(self, said: str) -> None:
        """Say once why there is no run, and try again later."""
        if said != self.failing:
            self.say(f"NOT RUN    {said}; trying again every {_AGAIN_s:g} s")
        self.failing = said
        self.again_s = time.monotonic() + _AGAIN_s

    def _hold(self, seen: Mapping[str, Stat]) -> dict[str, Stat]:
        """Hold files back that are not complete."""
        code = {path: stat for path, stat in seen.items() if path.startswith(_CODE)}
        return {**self.arrivals.held_back(_files(seen)), **code}


def _files(seen: Mapping[str, Stat]) -> dict[str, Stat]:
    return {path: stat for path, stat in seen.items() if not path.startswith(_CODE)}


def _told(document: Mapping[str, Any]) -> list[str]:
    """Say in a few lines what a run did."""
    if document["nothing_to_do"]:
        return []
    done = summary.redone(document["redone_by_stage"])
    files = ", ".join(f"{n} {status}" for status, n in document["files"].items() if n)
    rejected = [line for r in document["rejected"] for line in r["reason"].split("\n")]
    return [
        f"{time.strftime('%H:%M:%S')}   {done}; files: {files}",
        *map(_rejected, rejected[:_MOST]),
    ]


def _rejected(line: str) -> str:
    return f"REJECTED   {line}"


def _silent(stage: str, done: int, total: int) -> None:
    """Tell nobody."""
    del stage, done, total
