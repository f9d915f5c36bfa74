"""The timing helpers, with a clock that the test turns: nothing is timed here."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from benchmarks import timing


class Clock:
    """A clock that only goes on when someone works."""

    def __init__(self) -> None:
        self.now = 0.0
        self.log: list[tuple[str, int]] = []

    def __call__(self) -> float:
        return self.now

    def worker(self, name: str, seconds: float) -> Callable[[int], None]:
        def work(part: int) -> None:
            self.log.append((name, part))
            self.now += seconds * part

        return work


def test_every_contender_does_every_part_and_who_begins_moves_on() -> None:
    clock = Clock()
    contenders = {name: clock.worker(name, cost) for name, cost in (("a", 1.0), ("b", 3.0))}
    seconds = timing.interleaved(contenders, [[1, 2], [10, 20], [100]], rounds=2, clock=clock)
    costs = [1.0, 2.0, 10.0, 20.0, 100.0]
    assert seconds["a"].tolist() == [costs, costs]
    assert seconds["b"].tolist() == [[3.0 * cost for cost in costs]] * 2
    assert [(name, item) for name, item in clock.log if item in (1, 10, 100)] == [
        *[("a", 1), ("b", 1), ("b", 10), ("a", 10), ("a", 100), ("b", 100)],
        *[("b", 1), ("a", 1), ("a", 10), ("b", 10), ("b", 100), ("a", 100)],
    ]


def test_a_disturbance_of_one_round_leaves_no_trace() -> None:
    rounds = np.array([[1.0, 2.0, 9.0], [5.0, 2.5, 3.0]])
    assert timing.undisturbed_s(rounds) == 1.0 + 2.0 + 3.0


def test_a_command_that_fails_is_an_error_and_not_a_fast_run() -> None:
    with pytest.raises(subprocess.CalledProcessError):
        timing.wall_times_s([sys.executable, "-S", "-c", "raise SystemExit(1)"], 1)


def test_the_peak_memory_is_that_of_a_python_process() -> None:
    assert 5.0 < timing.own_peak_memory_MB() < 5000.0


def test_a_table_has_aligned_columns() -> None:
    rows: list[timing.Row] = [
        {"form": "mark10", "ms": 1.23456, "n": 3},
        {"form": "x", "ms": 10.0, "n": 12},
    ]
    assert timing.table(rows) == "form    ms     n\nmark10  1.235  3\nx       10     12"


def test_results_are_written_as_csv_and_json(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(timing, "RESULTS", tmp_path)
    timing.write_results("speed", [{"form": "a,b", "ms": 1.5}], ["numpy"])
    assert (tmp_path / "speed.csv").read_text() == 'form,ms\n"a,b",1.5\n'
    result = json.loads((tmp_path / "speed.json").read_text())
    assert result["rows"] == [{"form": "a,b", "ms": 1.5}]
    assert set(result["versions"]) == {"numpy", "python"}
