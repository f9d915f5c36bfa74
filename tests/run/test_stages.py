"""A result is made by the code that it names: an edited copy of the package redoes what uses it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

import deamat
from deamat.techniques import TECHNIQUES
from tests.run.conftest import ROOT, all_of_one_material

_FIRM, _FLUID = "sylgard-182-10to1", "sylgard-184-40to1"  # the second has no modulus
_MODULI = {"compression", "tension", "nanoindentation"}

# One run with the package found on PYTHONPATH, with words in the place of figures.
_RUN = """
import json, sys
from pathlib import Path
import deamat.run.draw
from deamat.materials.database import open_database
from deamat.materials.trace import trace
from deamat.run import explain, run_all
from deamat.run.folders import Folders

def words(folder, job):
    for name in job.files:
        path = folder.parent / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"SYNTHETIC {job.title}")

deamat.run.draw.draw_one = words
folders = Folders(*(Path(name) for name in ("raw", "config", "processed")))
foretold = explain(folders)["now"]
document = run_all(folders, 1, lambda *_: None)
redone = [] if document["nothing_to_do"] else document["redone"]
with open_database("processed") as database:
    card = database["sylgard-182-10to1"]
    moduli = {key: card.record(key, age="after cure").quantity.value
              for key in ("compressive_modulus", "tensile_modulus")}
    told = trace(database, "sylgard-182-10to1", "compressive_modulus", age="after cure")
    made_by = {key: told.to_document()[key] for key in ("stages", "environment")}
print(json.dumps({
    "foretold": foretold, "redone": redone, "moduli": moduli, "release": document["release"],
    **made_by,
}))
"""


@dataclass(frozen=True)
class Copy:
    """A copy of the package with a small campaign, its settings and what it made of them."""

    place: Path

    def edit(self, module: str, old: str, new: str) -> None:
        """Change the source of one module."""
        path = self.place / "lib" / "deamat" / module
        text = path.read_text()
        assert text.count(old) == 1
        path.write_text(text.replace(old, new))

    def run(self, python: str = sys.executable) -> dict[str, Any]:
        """Run in a process of its own, which imports the copy."""
        environment = {**os.environ, "PYTHONPATH": str(self.place / "lib")}
        done = subprocess.run(
            [python, "-c", _RUN],
            cwd=self.place, env=environment, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        document: dict[str, Any] = json.loads(done.stdout)
        return document

    @property
    def first(self) -> dict[str, Any]:
        """What the run before any edit told."""
        document: dict[str, Any] = json.loads((self.place / "first.json").read_text())
        return document

    def cards(self) -> dict[str, bytes]:
        """The bytes of every card."""
        return {p.stem: p.read_bytes() for p in (self.place / "processed" / "cards").iterdir()}


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Copy:
    """The copy as it is after its first run; tests edit copies of it."""
    place = tmp_path_factory.mktemp("copy")
    package = Path(deamat.__file__).parent
    hidden = shutil.ignore_patterns("__pycache__")
    shutil.copytree(package, place / "lib" / "deamat", ignore=hidden)
    shutil.copytree(ROOT / "config", place / "config")
    all_of_one_material(place / "raw" / "demo", _FIRM, most=3)
    all_of_one_material(place / "raw" / "batch", _FLUID, most=1)
    copy = Copy(place)
    done = copy.run()
    (place / "first.json").write_text(json.dumps(done))
    return copy


@pytest.fixture
def copy(first: Copy, tmp_path: Path) -> Iterator[Copy]:
    """A copy of the copy, to be edited."""
    place = tmp_path / "edited"
    shutil.copytree(first.place, place, symlinks=True)
    yield Copy(place)
    shutil.rmtree(place)


def _subjects(redone: list[str], stage: str) -> set[str]:
    named = [line.partition(": ")[0].partition(" ") for line in redone]
    return {subject for name, _, subject in named if name == stage}


def _techniques(redone: list[str], stage: str) -> set[str]:
    return {subject.split("/")[1] for subject in _subjects(redone, stage)}


def test_a_doubled_slope_redoes_every_modulus_and_what_comes_after(copy: Copy) -> None:
    before, cards = copy.first, copy.cards()
    copy.edit("estimators/curves/slope.py", "slope=slope,", "slope=2.0 * slope,")
    done = copy.run()
    assert done["moduli"] == {
        key: pytest.approx(2.0 * value) for key, value in before["moduli"].items()
    }
    assert done["release"] != before["release"]
    changed = {s for s, code in done["stages"].items() if code != before["stages"][s]}
    assert {f"measurement {technique}" for technique in _MODULI} <= changed
    assert {stage.partition(" ")[2] for stage in changed} == _MODULI
    redone = done["redone"]
    needing = {t.key for t in TECHNIQUES.values() if {"compressive_modulus"} & set(t.needs)}
    assert needing == {"permittivity"}
    for stage in ("measurement", "summary"):
        assert _techniques(redone, stage) == {*_MODULI, *needing}
        assert {s for s in _subjects(redone, stage) if s.startswith("batch/")} == set()
    because = dict(line.split(": ", 1) for line in redone)
    whys = {why for name, why in because.items() if name.startswith("measurement")}
    assert whys == {"code changed", "needs changed"}
    drawn = {name.rpartition("/")[2] for name in _subjects(redone, "figure")}
    used = {t for t in TECHNIQUES if any(f"-{t}" in name for name in drawn)}
    assert used <= {*_MODULI, *needing}
    assert "moduli" in drawn
    assert _subjects(redone, "card") == {_FIRM}
    assert copy.cards()[_FLUID] == cards[_FLUID]
    assert copy.cards()[_FIRM] != cards[_FIRM]


@pytest.mark.parametrize(
    ("module", "old", "new", "measured"),
    [
        ("estimators/curves/slope.py", "    n = x.size\n", "    n = x.size  # samples\n", _MODULI),
        ("techniques/tension/reduce.py", '"""', '"""In other words: ', {"tension"}),
        ("techniques/tension/figure.py", '"""', '"""In other words: ', set()),
        ("report/chart/page.py", '"""', '"""In other words: ', set()),
        ("materials/card.py", '"""', '"""In other words: ', set()),
    ],
)
def test_a_refactoring_changes_no_card(
    module: str, old: str, new: str, measured: set[str], copy: Copy
) -> None:
    cards = copy.cards()
    path = copy.place / "lib" / "deamat" / module
    path.write_text(path.read_text().replace(old, new, 1))
    done = copy.run()
    assert _techniques(done["redone"], "measurement") == measured
    assert any(line.endswith("code changed") for line in done["redone"])
    assert copy.cards() == cards
    assert done["release"] == copy.first["release"]
    assert done["stages"] != copy.first["stages"]
    foretold = {line.partition(": ")[0] for line in done["foretold"]}
    assert foretold >= {line.partition(": ")[0] for line in done["redone"]}


@pytest.mark.parametrize(("library", "measured"), [("numpy", set(TECHNIQUES)), ("h5py", set())])
def test_another_version_of_a_library_is_seen(library: str, measured: set[str], copy: Copy) -> None:
    cards = copy.cards()
    assert copy.run()["redone"] == []
    pretended = copy.place / "lib" / f"{library}-99.9.dist-info"
    pretended.mkdir()
    (pretended / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {library}\nVersion: 99.9\n")
    done = copy.run()
    assert done["environment"][library] == "99.9"
    assert done["release"] == copy.first["release"]
    assert _techniques(done["redone"], "measurement") == measured
    again = {line.split()[0]: line.partition(": ")[2] for line in done["redone"]}
    assert again
    assert all(f"library {library} changed" in why for why in again.values())
    assert ("figure" in again) == (library == "numpy")
    assert copy.cards() == cards
    assert copy.run()["redone"] == []


@pytest.mark.parametrize("minor", [m for m in range(11, 15) if m != sys.version_info.minor])
def test_another_python_gives_the_same_release(minor: int, copy: Copy) -> None:
    python = shutil.which(f"python3.{minor}")
    if python is None:
        pytest.skip(f"no python3.{minor} on the PATH")
    wanted = {n: v for n, v in copy.first["environment"].items() if n not in ("Python", "platform")}
    ask = "import sys, importlib.metadata as m; print(*map(m.version, sys.argv[1:]))"
    asked = [python, "-c", ask, *wanted]
    there = subprocess.run(asked, capture_output=True, text=True, check=False).stdout.split()
    if there != list(wanted.values()):
        pytest.skip(f"the libraries of {python} are not those of this Python")
    cards = copy.cards()
    done = copy.run(python)
    measured = [line for line in done["redone"] if line.startswith("measurement")]
    assert {line.partition(": ")[2] for line in measured} == {"Python changed"}
    assert done["environment"]["Python"].startswith(f"3.{minor}.")
    assert done["release"] == copy.first["release"]
    assert copy.cards() == cards


def test_every_technique_is_keyed_on_the_room_that_it_comes_from() -> None:
    for key, technique in TECHNIQUES.items():
        rooms = {f.__module__ for f in (technique.reduce, technique.summarise, technique.config)}
        assert {".".join(room.split(".")[:3]) for room in rooms} == {f"deamat.techniques.{key}"}
