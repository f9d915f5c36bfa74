"""One small campaign in a folder of its own, surveyed, measured and summarised as a run does it."""

from __future__ import annotations

import hashlib
import signal
import warnings
from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import FrameType

from deamat.core.config import Config
from deamat.core.fingerprint import Fingerprint
from deamat.core.ledger import Failure
from deamat.core.records import Law, PropertyRecord
from deamat.run.boundary import attempt
from deamat.run.build_cache import BuildCache
from deamat.run.folders import Folders, Input
from deamat.run.measure import RunContext
from deamat.run.process import look_at_raw, measure_all
from deamat.run.stages import Stages
from deamat.run.state import State
from deamat.run.workers import Workers
from deamat.techniques import TECHNIQUES

CAMPAIGN = "fuzz"
_CAMPAIGN_TOML = 'title = "fuzz"\nlaboratory = "none"\nlicence = "none"\nsynthetic = true\n'
BUDGET_s = 1.0  # of processor time for one campaign


class Hang(BaseException):
    """The budget of processor time is spent; not an Exception, so that no boundary keeps it."""


@dataclass(frozen=True, slots=True)
class Files:
    """What a laboratory hands over for one technique: a register and the files that it names.

    Parameters
    ----------
    files : path relative to the register's folder to content
    """

    technique: str
    register: bytes
    files: Mapping[str, bytes]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a run says of a campaign.

    Parameters
    ----------
    refused : keys of values that were refused, with the reasons
    rejected : reasons for which files, registers or rows were rejected or refused whole
    failures : internal errors
    hang : the budget of processor time was spent
    """

    records: tuple[PropertyRecord, ...] = ()
    laws: tuple[Law, ...] = ()
    refused: tuple[tuple[str, str], ...] = ()
    rejected: tuple[str, ...] = ()
    failures: tuple[Failure, ...] = ()
    hang: bool = False


class Runner:
    """A raw folder with one campaign, and what it takes to run it.

    Specimens whose file and row are as they were are not measured again: the account of the run
    sees to that, as it does in `deamat all`.

    Parameters
    ----------
    place : an empty folder
    records, laws : of other techniques, by material, for those that need them
    """

    def __init__(self, place: Path, config: Config) -> None:
        self.config = config
        self.folders = Folders(place / "raw", place / "config", place / "processed")
        self.records: dict[str, list[PropertyRecord]] = {}
        self.laws: dict[str, list[Law]] = {}
        self._state = State(self.folders.processed)
        self._stages = Stages(defaultdict(lambda: Fingerprint("", ())))
        self._there: dict[str, bytes] = {}
        self._write({f"{CAMPAIGN}/campaign.toml": _CAMPAIGN_TOML.encode()})

    def close(self) -> None:
        """Close the account of what was measured."""
        self._state.__exit__(None, None, None)

    def outcome(self, given: Files, budget_s: float = BUDGET_s) -> Outcome:
        """Run the campaign of one technique; whatever goes wrong is in the outcome."""
        folder = f"{CAMPAIGN}/{given.technique}"
        register = TECHNIQUES[given.technique].register.file
        contents = {f"{folder}/{name}": data for name, data in given.files.items()}
        contents[f"{folder}/{register}"] = given.register
        contents[f"{CAMPAIGN}/campaign.toml"] = _CAMPAIGN_TOML.encode()
        return self.whole(contents, budget_s)

    def whole(self, contents: Mapping[str, bytes], budget_s: float = BUDGET_s) -> Outcome:
        """Run campaigns, given as path below `raw/` to content."""
        self._write(contents)
        try:
            with within(budget_s), warnings.catch_warnings():
                warnings.simplefilter("error")  # what a library mutters ends on somebody's screen
                return self._run(contents)
        except Hang:
            return Outcome(hang=True)

    def _run(self, contents: Mapping[str, bytes]) -> Outcome:
        inputs = {
            f"raw/{path}": Input(len(data), hashlib.sha256(data).hexdigest())
            for path, data in contents.items()
        }
        surveys, broken, _ = look_at_raw(self.folders, inputs, self.config)
        run = RunContext(
            self.folders, self.config, self._stages, surveys, BuildCache(self._state), Workers(1),
            lambda *_: None, dry=False,
            records={(CAMPAIGN, m): list(r) for m, r in self.records.items()},
            laws={(CAMPAIGN, m): list(laws) for m, laws in self.laws.items()},
            failures=broken,
        )  # fmt: skip
        done = attempt("run", CAMPAIGN, [], partial(measure_all, TECHNIQUES, run))
        if isinstance(done, Failure):
            return Outcome(failures=(*run.failures, done))
        measured, groups = done
        summaries = [group.summary for group in groups if group.summary is not None]
        refusals = [r for s in summaries for r in s.refusals]
        errors = [m.reduced.error for m in measured if m.reduced and m.reduced.error]
        bad = [
            e for s in surveys for e in s.entries.values() if e.status in ("rejected", "refused")
        ]
        return Outcome(
            tuple(r for s in summaries for r in s.records),
            tuple(law for s in summaries for law in s.laws),
            tuple(dict.fromkeys((r.key, r.reason) for r in refusals)),
            (*map(str, bad), *map(str, errors)),
            tuple(run.failures),
        )

    def _write(self, contents: Mapping[str, bytes]) -> None:
        """Write what is not there as it should be; the survey goes by what it is told is there."""
        for path, data in contents.items():
            if self._there.get(path) != data:
                place = self.folders.raw / path
                place.parent.mkdir(parents=True, exist_ok=True)
                place.write_bytes(data)
                self._there[path] = data


@contextmanager
def within(budget_s: float) -> Iterator[None]:
    """Let a block use so much processor time and no more.

    Raises
    ------
    Hang : it used more
    """

    def stop(_number: int, _frame: FrameType | None) -> None:
        raise Hang

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, budget_s)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
