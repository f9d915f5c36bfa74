"""The pytest plugin of both passes: who runs what and for how long; and which test fails first."""

from __future__ import annotations

import json
import os
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.mutation import hits


class Recorder:
    """Note for each test the blocks that it runs and the processor time that it takes."""

    def __init__(self, report: Path) -> None:
        self.report = report
        self.seconds: dict[str, float] = defaultdict(float)
        self.failed: set[str] = set()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> Iterator[None]:
        """A fixture may serve all tests of its file, so what it runs is noted for the file."""
        return (yield from self._noted(item.nodeid.split("::")[0], item))

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Iterator[None]:
        """Note what the test itself runs."""
        return (yield from self._noted(item.nodeid, item))

    def _noted(self, context: str, item: pytest.Item) -> Iterator[None]:
        hits.begin(context)
        started = sum(os.times()[:4])
        try:
            return (yield)
        finally:
            self.seconds[item.nodeid] += sum(os.times()[:4]) - started

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """A test that fails or is skipped kills nothing."""
        if report.outcome != "passed":
            self.failed.add(report.nodeid)

    def pytest_sessionfinish(self) -> None:
        """Write the times of the tests that passed."""
        passed = {name: took for name, took in self.seconds.items() if name not in self.failed}
        self.report.write_text(json.dumps({"seconds": passed, "failed": sorted(self.failed)}))


class Selected:
    """Run the chosen tests only, in the chosen order of files; remember the first that fails."""

    def __init__(self, names: list[str]) -> None:
        self.names = set(names)
        self.killer = ""

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Leave out what is not chosen."""
        items[:] = [item for item in items if item.nodeid in self.names]

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Remember who fails."""
        if report.outcome == "failed":
            self.killer = self.killer or report.nodeid

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """A module that cannot be imported fails its tests."""
        if report.outcome == "failed":
            self.killer = self.killer or report.nodeid


if __name__ == "__main__":
    import sys

    options = ["-p", "no:cacheprovider", "-p", "no:xdist", "-q"]
    raise SystemExit(pytest.main([*options, *sys.argv[2:]], plugins=[Recorder(Path(sys.argv[1]))]))
