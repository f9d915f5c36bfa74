"""What is installed beside this package is part of what made a result."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from deamat.run.environment import installed


def test_every_distribution_but_this_one_counts_with_its_version(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = tmp_path / "first", tmp_path / "second"
    for place in (
        first / "numpy-2.4.6.dist-info", first / "numpy", first / "deamat-1.0.dist-info",
        second / "attrs-26.1.egg-info", second / "click-8.5.dist-info",
    ):  # fmt: skip
        place.mkdir(parents=True)
    path = [str(first), str(second), str(first), str(tmp_path / "none")]
    monkeypatch.setattr(sys, "path", path)
    told = [sys.implementation.cache_tag, sys.platform]
    names = ["numpy-2.4.6.dist-info", "attrs-26.1.egg-info", "click-8.5.dist-info"]
    assert json.loads(installed()) == [*told, *names]
