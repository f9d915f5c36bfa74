"""The worked example runs, prints what its page says, and its pictures are there and marked."""

from __future__ import annotations

import contextlib
import io
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

import deamat.run.draw
from deamat.run.draw import FigureJob
from deamat.run.folders import Folders
from deamat.twin.campaign import SEED, simulate
from tests.run.conftest import ROOT, run

PAGE = ROOT / "docs" / "worked-example.md"
BLOCKS = re.compile(r"```(python|text)\n(.*?)```", re.DOTALL)


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with processed/ and config/, as a designer has it, made from the committed seed."""
    folder = tmp_path_factory.mktemp("home")
    shutil.copytree(ROOT / "config", folder / "config")
    simulate(folder / "raw", SEED)

    def no_pictures(out: Path, job: FigureJob) -> None:
        for name in job.files:
            path = out.parent / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("SYNTHETIC")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(deamat.run.draw, "draw_one", no_pictures)
        document = run(Folders(folder / "raw", folder / "config", folder / "processed"))
    assert document["exit_code"] == 0
    return folder


def blocks() -> list[tuple[str, str]]:
    return BLOCKS.findall(PAGE.read_text("utf-8"))


def test_it_prints_what_the_page_says(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(home)
    names: dict[str, Any] = {}
    printed = ""
    shown = 0
    for kind, text in blocks():
        if kind == "text":
            assert printed == text
            shown += 1
            continue
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(text, str(PAGE), "exec"), names)
        printed = out.getvalue()
    assert shown == 4
    for name in re.findall(r"\(img/([\w-]+\.svg)\)", PAGE.read_text("utf-8")):
        assert "SYNTHETIC DATA" in (home / "img" / name).read_text()


def test_its_pictures_are_committed_small_and_marked() -> None:
    page = PAGE.read_text("utf-8")
    assert "SYNTHETIC" in page
    named = re.findall(r"\((img/[\w-]+\.svg)\)", page)
    assert len(named) == 3
    for name in named:
        path = PAGE.parent / name
        assert path.stat().st_size < 100_000
        assert "SYNTHETIC DATA" in path.read_text("utf-8")
