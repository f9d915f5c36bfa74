"""Which files are complete: told from what was noticed of them and from how long they stay alike.

Nothing in a table of numbers says that it is whole, so completeness is a matter of the writer. One
that closed its file after writing, or moved it into place, is done (`settle_s` later: programs that
rewrite a file often open it twice). One that has not been seen to close it may pause, so its file
must stay alike for `unclosed_s`; so must every file of a folder in which a closed file has grown:
there the writer opens it again for each burst.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from deamat.run.folders import Stat

HELD = "it may still be written to; it was not opened"
_NO_CURVES = (".toml", ".md", ".sha256", "specimens.csv", "observations.csv")


@dataclass(frozen=True, slots=True)
class Patience:
    """How long files must stay as they are `[s]`.

    Parameters
    ----------
    settle_s : of a file whose writer closed it, or that was moved into place
    unclosed_s : of any other: longer than writers pause
    gone_s : before a file that is no longer there, or changes again, is taken back
    """

    settle_s: float = 0.2
    unclosed_s: float = 60.0
    gone_s: float = 1.0


@dataclass(frozen=True, slots=True)
class Note:
    """What was last noticed of a file: that it was written to, or closed or moved into place."""

    closed: bool
    at_s: float


@dataclass(frozen=True, slots=True)
class _Waiting:
    stat: Stat | None  # None: it is no longer there
    since_s: float


@dataclass
class Arrivals:
    """Follows the files of a folder from look to look.

    Parameters
    ----------
    settled : files as they were when they were last complete
    bursts : folders in which a file has grown after it was closed
    """

    patience: Patience
    settled: dict[str, Stat] = field(default_factory=dict)
    bursts: set[str] = field(default_factory=set)
    _waiting: dict[str, _Waiting] = field(default_factory=dict)
    _notes: dict[str, Note] = field(default_factory=dict)
    _taken_back: set[str] = field(default_factory=set)

    def note(self, path: str, note: Note) -> None:
        """Remember what was noticed of a file."""
        self._notes[path] = note

    def look(self, seen: Mapping[str, Stat], now_s: float) -> bool:
        """Compare the files with those of the last look; say whether a run is due.

        Parameters
        ----------
        seen : every file there is
        now_s : on the clock of the notes
        """
        due = False
        gone = [path for path in self.settled if path not in seen]
        changed = [path for path, stat in seen.items() if self.settled.get(path) != stat]
        for path in (*gone, *changed):
            stat = seen.get(path)
            if path not in self._waiting or self._waiting[path].stat != stat:
                self._waiting[path] = _Waiting(stat, now_s)
        for path, waiting in list(self._waiting.items()):
            if seen.get(path) != waiting.stat or self.settled.get(path) == waiting.stat:
                del self._waiting[path]  # it is again as it was
                self._notes.pop(path, None)
            elif self._ends_s(path, waiting) <= now_s:
                self._settle(path, waiting)
                due = True
        self._forget_notes(seen, now_s)
        return self._takes_back(now_s) or due

    def next_s(self) -> float | None:
        """Return when the next run is due if nothing more happens; None if nothing waits."""
        ends = [self._ends_s(path, waiting) for path, waiting in self._waiting.items()]
        ends += [
            waiting.since_s + self.patience.gone_s
            for path, waiting in self._waiting.items()
            if path in self.settled and path not in self._taken_back
        ]
        return min(ends, default=None)

    def held_back(self, seen: Mapping[str, Stat]) -> dict[str, Stat]:
        """Return the files as a run may see them: what is not complete must not be opened."""
        return {
            path: stat if self.settled.get(path) == stat else Stat(0, 0, 0, 0, stat.odd or HELD)
            for path, stat in seen.items()
        }

    def begin(self, seen: Mapping[str, Stat], age_s: Mapping[str, float], now_s: float) -> None:
        """Take the files that are there for complete, but for those written a moment ago."""
        for path, stat in seen.items():
            if age_s[path] >= self.patience.unclosed_s or path.endswith(_NO_CURVES):
                self.settled[path] = stat
            else:
                self._waiting[path] = _Waiting(stat, now_s - max(0.0, age_s[path]))

    def _ends_s(self, path: str, waiting: _Waiting) -> float:
        """Return when a file is complete if it stays as it is."""
        if waiting.stat is None:
            return waiting.since_s + self.patience.gone_s
        note = self._notes.get(path)
        closed = note is not None and note.closed
        slow = path.rpartition("/")[0] in self.bursts and not path.endswith(_NO_CURVES)
        patience = self.patience.settle_s if closed and not slow else self.patience.unclosed_s
        return max(waiting.since_s, note.at_s if note else 0.0) + patience

    def _settle(self, path: str, waiting: _Waiting) -> None:
        del self._waiting[path]
        self._notes.pop(path, None)
        old = self.settled.pop(path, None)
        if waiting.stat is None:
            return
        grown = old is not None and old.inode == waiting.stat.inode and old.size < waiting.stat.size
        if grown and not path.endswith(_NO_CURVES):
            self.bursts.add(path.rpartition("/")[0])
        self.settled[path] = waiting.stat

    def _takes_back(self, now_s: float) -> bool:
        """Say whether a file has been changing for a while: what was read of it is old."""
        late = {
            path
            for path, waiting in self._waiting.items()
            if path in self.settled
            and waiting.stat is not None
            and now_s - waiting.since_s >= self.patience.gone_s
        }
        new = late - self._taken_back
        self._taken_back = (self._taken_back | late) & set(self._waiting)
        return bool(new)

    def _forget_notes(self, seen: Mapping[str, Stat], now_s: float) -> None:
        """Forget what was noticed of files that are settled or have gone."""
        for path, note in list(self._notes.items()):
            if path not in self._waiting and (
                path not in seen or now_s - note.at_s > self.patience.unclosed_s
            ):
                del self._notes[path]
