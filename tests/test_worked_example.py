"""The pages with code run and print what they say; the worked example's pictures are marked."""

from __future__ import annotations

import contextlib
import io
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

import deamat
import deamat.run.draw
from deamat.run.draw import FigureJob
from deamat.run.folders import Folders
from deamat.twin.campaign import SEED, simulate
from tests.run.conftest import ROOT, run

PAGE = ROOT / "docs" / "worked-example.md"
API = ROOT / "docs" / "api.md"
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


def printed(page: Path) -> list[tuple[str, str]]:
    """Run a page's code; what each block should print, and what the code before it printed."""
    names: dict[str, Any] = {}
    out = io.StringIO()
    found = []
    for kind, text in BLOCKS.findall(page.read_text("utf-8")):
        if kind == "text":
            found.append((text, out.getvalue()))
            continue
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(text, str(page), "exec"), names)
    return found


@pytest.mark.parametrize(("page", "count"), [(PAGE, 4), (API, 11)], ids=["worked-example", "api"])
def test_it_prints_what_the_page_says(
    home: Path, monkeypatch: pytest.MonkeyPatch, page: Path, count: int
) -> None:
    monkeypatch.chdir(home)
    shown = printed(page)
    assert len(shown) == count
    for said, found in shown:
        assert found == said
    for name in re.findall(r"\(img/([\w-]+\.svg)\)", page.read_text("utf-8")):
        assert "SYNTHETIC DATA" in (home / "img" / name).read_text()


def test_the_page_of_the_api_names_every_public_name_and_imports_nothing_else() -> None:
    text = API.read_text("utf-8")
    table = text.split("| to | there is |")[1].split("\n\n")[0]
    assert sorted(re.findall(r"`(\w+)`", table)) == sorted(deamat.__dict__["__all__"])
    assert not re.findall(r"^(?:from|import) deamat\.", text, re.MULTILINE)


def test_its_pictures_are_committed_small_and_marked() -> None:
    page = PAGE.read_text("utf-8")
    assert "SYNTHETIC" in page
    named = re.findall(r"\((img/[\w-]+\.svg)\)", page)
    assert len(named) == 3
    for name in named:
        path = PAGE.parent / name
        assert path.stat().st_size < 100_000
        assert "SYNTHETIC DATA" in path.read_text("utf-8")
