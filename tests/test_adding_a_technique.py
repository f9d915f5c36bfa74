"""The page on adding a technique, run: its blocks make a copy of the package measure hardness."""

from __future__ import annotations

import filecmp
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

import deamat
from tests.conftest import ROOT

PAGE = (ROOT / "docs" / "adding-a-technique.md").read_text(encoding="utf-8")
ORIGINAL = Path(deamat.__file__).parent
ROOM = "pipeline/techniques/hardness/"
FILES = dict(
    re.findall(rf"^\*\*`{ROOM}(\w+\.py)`\*\*.*?```python\n(.*?)```", PAGE, re.MULTILINE | re.DOTALL)
)
REGISTER, CAMPAIGN = (
    re.findall(rf"```{kind}\n(.*?)```", PAGE, re.DOTALL)[0] for kind in ("csv", "toml")
)
(TEST,) = (t for t in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL) if "def test_" in t)
KEY, LINE, COMMANDS, REFUSED = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)


class Place:
    """A copy of the package in which the page was followed."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.package = folder / "lib" / "deamat"
        shutil.copytree(ORIGINAL, self.package, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copytree(ROOT / "config", folder / "config")

    def add_after(self, module: str, line: str, added: str) -> None:
        """Put a line behind another one."""
        path = self.package / module
        text = path.read_text(encoding="utf-8")
        assert text.count(line) == 1, (module, line)
        path.write_text(text.replace(line, line + added), encoding="utf-8")

    def touched(self) -> set[str]:
        """What differs from the package, by its path in it."""
        names = {p.relative_to(self.package) for p in self.package.rglob("*") if p.is_file()}
        return {
            name.as_posix()
            for name in names
            if "__pycache__" not in name.parts
            and not (
                (ORIGINAL / name).is_file()
                and filecmp.cmp(ORIGINAL / name, self.package / name, shallow=False)
            )
        }

    def write(self, name: str, text: str) -> None:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def call(self, *words: str, codes: Sequence[int] = (0,)) -> str:
        """Run a module of the copy in a process of its own."""
        done = subprocess.run(
            [sys.executable, "-m", *words],
            cwd=self.folder,
            env={**os.environ, "PYTHONPATH": str(self.package.parent)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode in codes, done.stdout + done.stderr
        return done.stdout + done.stderr


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Place:
    place = Place(tmp_path_factory.mktemp("house"))
    for name, text in FILES.items():
        place.write(f"lib/deamat/techniques/hardness/{name}", text)
    place.add_after("core/properties.py", '"ASTM D792"),\n', KEY)
    place.add_after("techniques/__init__.py", "        handling.TECHNIQUE,\n", LINE)
    place.add_after("techniques/__init__.py", "    handling,\n", "    hardness,\n")
    place.write("raw/demo/hardness/specimens.csv", REGISTER)
    place.write("raw/demo/campaign.toml", CAMPAIGN)
    return place


def test_the_page_writes_a_whole_room_and_edits_two_other_files(place: Place) -> None:
    assert {"__init__.py", "config.py", "reduce.py", "summarise.py", "figure.py"} <= set(FILES)
    outside = place.touched() - {f"techniques/hardness/{name}" for name in FILES}
    assert outside == {"core/properties.py", "techniques/__init__.py"}


def test_what_the_page_adds_comes_out_on_a_card_with_its_refusals(place: Place) -> None:
    said = ""
    for command in COMMANDS.splitlines():
        said = place.call("deamat", *command.removeprefix("$ deamat ").split())
    for line in REFUSED.splitlines():
        assert line in said
    card = json.loads((place.folder / "processed" / "cards" / "gel-a.json").read_text())
    (record,) = card["properties"]
    assert (record["key"], record["value"], record["n"]) == ("shore_A_hardness", 45.0, 3)
    # three readings that scatter by 1 about their mean, and the durometer's 1 in all of them
    assert record["u_independent"] == pytest.approx(3**-0.5)
    assert record["u_shared"] == pytest.approx(1.0)
    figures = {p.name for p in (place.folder / "processed" / "figures" / "demo").iterdir()}
    assert "gel-a-hardness.svg" in figures
    trace = place.call("deamat", "trace", "gel-a", "shore_A_hardness")
    assert "demo/hardness/specimens.csv" in trace


def test_the_tests_of_the_page_pass(place: Place) -> None:
    place.write("test_hardness.py", TEST)
    assert "3 passed" in place.call("pytest", "-q", "-p", "no:cacheprovider", "test_hardness.py")


def test_the_page_is_checked_as_the_house_is(place: Place) -> None:
    code = place.package / "techniques" / "hardness"
    settings = f"--config={ROOT / 'pyproject.toml'}"
    place.call("ruff", "check", settings, str(code))
    place.call("ruff", "format", "--check", settings, str(code))
