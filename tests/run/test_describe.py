"""What a run says of itself: its exit code, and what waits for a technique."""

from __future__ import annotations

from pathlib import Path

import pytest

from deamat.core.config import load_config
from deamat.core.ledger import Failure, FileEntry
from deamat.run.build_cache import BuildCache
from deamat.run.describe import describe
from deamat.run.folders import Folders
from deamat.run.measure import RunContext
from deamat.run.stages import Stages
from deamat.run.state import State
from deamat.run.vanished import Published
from deamat.run.workers import Workers
from deamat.techniques import TECHNIQUES
from tests.conftest import ROOT

GOOD = FileEntry("demo/compression/a.txt", "a" * 64, 9, "recording", "used")
BAD = FileEntry("demo/compression/b.txt", "b" * 64, 9, "recording", "rejected", reason="torn")
WAITS = FileEntry(
    "demo/dma/c.txt", "c" * 64, 9, "recording", "refused", reason="no dma", awaits="dma"
)
BROKEN = Failure("card", "gel-a", "ValueError", "", ())


@pytest.mark.parametrize(
    ("files", "failures", "code"),
    [([GOOD], [], 0), ([GOOD, WAITS], [], 0), ([GOOD, BAD], [], 1), ([GOOD, BAD], [BROKEN], 3)],
)
def test_the_exit_code_says_how_a_run_ended(
    files: list[FileEntry], failures: list[Failure], code: int, tmp_path: Path
) -> None:
    folders = Folders(tmp_path / "raw", ROOT / "config", tmp_path / "processed")
    config = load_config(folders.config, {key: t.config for key, t in TECHNIQUES.items()})
    with State(folders.processed) as state, Workers(1) as workers:
        cache = BuildCache(state)
        run = RunContext(folders, config, Stages({}), [], cache, workers, lambda *_: None, False)
        for failure in failures:
            run.fail(failure)
        document = describe(run, [], files, [], "0123456789ab", Published({}, {}))
    assert document["exit_code"] == code
    assert [one["path"] for one in document["rejected"]] == [f.path for f in files if f is BAD]
    assert document["waiting"] == (
        [{"reason": "demo/dma: no dma", "files": 1}] if WAITS in files else []
    )
