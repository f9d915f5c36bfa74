"""Names made to escape, to collide or to mislead: nothing is written where it should not be."""

from __future__ import annotations

import csv
import json
import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

import deamat.run.draw
from deamat.core.errors import ConfigError
from deamat.core.slug import LONGEST_STEM, Spellings, nearest_slug
from deamat.run.folders import Folders
from deamat.run.measure import Group
from deamat.run.register import register
from tests.run.conftest import MATERIALS, ROOT, run, small_campaign, write_words
from tests.run.test_observations import look

MATERIAL_NAMES = (
    "../../../../escaped", "..", ".", "/tmp/escaped", "C:\\escaped", "..\\..\\escaped",
    "EF30/1:1 10% BT", "ef30/../../escaped", "EF30", "Ef30", "CON", "con", "nul.txt", "aux", "com1",
    "m" * 300, ".hidden", "-rf", "_m", "ends.", "two words", "tab\tinside", "line\u2028separator",
    "nul\x00byte", "bell\x07", "right\u202eleft", "zero\u200bwidth", "\u0435f30", "\uff45f30",
    "sylgard-182-10TO1", "~", "$HOME", "a;b", "%2e%2e%2f",
)  # fmt: skip
CONDITIONS = (
    "../../../../escaped", "/absolute", "con", "2 months " * 30, "100 \u00b0C 1 h", "50 % BT/EF: 1*?",
)  # fmt: skip
CAMPAIGNS = ("My Campaign", "CON", "ends.", "-rf", "Demo", "c" * 90, "r\u202el")


@dataclass(frozen=True)
class Ran:
    folders: Folders
    document: dict[str, Any]
    files: dict[str, dict[str, Any]]
    before: set[Path]


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Ran:
    """One run over a good campaign with all these names in its register, and others beside it."""
    top = tmp_path_factory.mktemp("hostile")
    folders = Folders(top / "a" / "raw", top / "a" / "config", top / "a" / "b" / "processed")
    shutil.copytree(ROOT / "config", folders.config)
    small_campaign(folders.raw / "demo")
    for name in CAMPAIGNS:
        small_campaign(folders.raw / name)
    _add_rows(folders)
    folders.processed.mkdir(parents=True)
    before = set(top.rglob("*"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(deamat.run.draw, "draw_one", write_words)
        document = run(folders)
    audit = json.loads((folders.processed / "audit" / "files.json").read_text())
    return Ran(folders, document, {entry["path"]: entry for entry in audit}, before)


def _add_rows(folders: Folders) -> None:
    """Return each good row a condition of its own, and add one row for each name."""
    place = folders.raw / "demo" / "compression"
    with (place / "specimens.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    like = dict(rows[0])
    for row, cure in zip(rows, CONDITIONS, strict=True):
        row["cure"] = cure
    for number, material in enumerate(MATERIAL_NAMES):
        rows.append({**like, "specimen": f"hostile-{number}", "material": material, "file": ""})
    with (place / "specimens.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, list(like))
        writer.writeheader()
        writer.writerows(rows)
    register(folders.raw, "demo", accept_all=True)


@pytest.mark.parametrize("material", MATERIAL_NAMES)
def test_a_hostile_material_is_named_by_row(ran: Ran, material: str) -> None:
    path = "demo/compression/specimens.csv"
    line = 2 + 6 + MATERIAL_NAMES.index(material)
    (reason,) = (
        r for r in ran.files[path]["reason"].split("\n") if r.startswith(f"{path}, line {line}, ")
    )
    shown = material if len(material) <= 80 else material[:80] + "..."
    assert "column 2: " in reason
    assert f"(found {shown!r})" in reason
    if material != "sylgard-182-10TO1":  # its slip is another one: it is not the first of its name
        assert f"nearest valid: {nearest_slug(material)!r}" in reason


@pytest.mark.parametrize("campaign", CAMPAIGNS)
def test_a_hostile_campaign_is_named(ran: Ran, campaign: str) -> None:
    entry = ran.files[f"{campaign}/campaign.toml"]
    assert entry["status"] == "rejected"
    assert repr(campaign) in entry["reason"]
    mine = [e for path, e in ran.files.items() if path.startswith(f"{campaign}/")]
    assert {e["status"] for e in mine} == {"rejected"}


def test_the_good_rows_are_published_and_nothing_else(ran: Ran) -> None:
    assert ran.document["exit_code"] == 1
    assert {p.name for p in (ran.folders.processed / "cards").iterdir()} == {
        f"{material}.json" for material in MATERIALS
    }


def test_nothing_is_written_outside_the_expected_folders(ran: Ran) -> None:
    processed = ran.folders.processed
    top = processed.parents[2]
    release = (processed / "releases" / "current").resolve()
    for path in set(top.rglob("*")) - ran.before:
        assert path.is_relative_to(processed)
        if path.is_relative_to(release) and path.is_file():
            name = path.relative_to(release).as_posix()
            assert re.fullmatch(
                r"materials\.sqlite|curves\.h5|audit/[a-z]+\.json|"
                r"cards/[a-z0-9][A-Za-z0-9._-]*\.json|figures/demo/[a-z0-9][A-Za-z0-9._-]*\.(svg|png)",
                name,
            ), name


def test_figures_of_any_conditions_have_short_names_of_their_own(ran: Ran) -> None:
    figures = [p.stem for p in (ran.folders.processed / "figures" / "demo").glob("*.svg")]
    assert max(map(len, figures)) <= LONGEST_STEM
    of_conditions = [f for f in figures if "-compression-" in f]
    assert len(of_conditions) == len(CONDITIONS)
    assert any(re.search(r"100-c-1-h-[0-9a-f]{8}$", f) for f in of_conditions)


@pytest.mark.parametrize("campaign", ["../outside", "demo/..", "/tmp", "..", ""])
def test_no_manifest_is_written_outside_raw(tmp_path: Path, campaign: str) -> None:
    raw = tmp_path / "raw"
    small_campaign(raw / "demo")
    for folder in (raw, tmp_path / "outside"):
        folder.mkdir(exist_ok=True)
        shutil.copy(raw / "demo" / "campaign.toml", folder)
    before = set(tmp_path.rglob("*"))
    with pytest.raises(ConfigError, match="is not the name of a folder in"):
        register(raw, campaign, accept_all=True)
    assert set(tmp_path.rglob("*")) == before


def test_names_that_differ_only_in_case_are_one_name_over_campaigns_too(tmp_path: Path) -> None:
    spellings = Spellings()
    register_of = "specimen,material,diameter_mm,height_mm\na,m-5{},28,12\n"
    seen = [
        look(place, {"compression/specimens.csv": register_of.format(letter).encode()}, spellings)
        for place, letter in (
            (tmp_path / "one" / "drift-5K", "K"),
            (tmp_path / "other" / "drift-5k", "K"),  # a folder of its own: not every disk has both
            (tmp_path / "one" / "third", "k"),
        )
    ]
    reasons = [{path: e.reason for path, e in one.entries.items() if e.reason} for one in seen]
    assert "differs only in case: 'drift-5K' in raw/" in reasons[1]["drift-5k/campaign.toml"]
    assert (
        "material is spelled differently: 'm-5K' in drift-5K/compression/specimens.csv, line 2"
        in (reasons[2]["third/compression/specimens.csv"])
    )
    assert [len(one.specimens) for one in seen] == [1, 0, 0]


def test_conditions_that_read_alike_are_two_groups() -> None:
    alike = ((("age", "a,cure=b"),), (("age", "a"), ("cure", "b")))
    subjects = {
        Group("c", "m", "compression", conditions, "", (), None).subject for conditions in alike
    }
    assert len(subjects) == 2
