"""A register of observations in a campaign: its role, its name, and its bad rows."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path

from deamat.core.config import load_config
from deamat.core.slug import Spellings
from deamat.run.folders import Input
from deamat.run.survey import Survey, survey
from deamat.techniques import TECHNIQUES
from deamat.twin.handling import handling_part

ROOT = Path(__file__).resolve().parents[2]
CAMPAIGN = b'title = "t"\nlaboratory = "l"\nlicence = "CC0"\nsource = "s"\nsynthetic = true\n'
OBSERVATIONS = handling_part(7).files["handling/observations.csv"]


def look(folder: Path, contents: Mapping[str, bytes], spellings: Spellings | None = None) -> Survey:
    for name, data in {"campaign.toml": CAMPAIGN, **contents}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    found = [path for path in folder.rglob("*") if path.is_file()]
    names = {path.relative_to(folder.parent).as_posix(): path.read_bytes() for path in found}
    return survey(
        folder,
        {n: Input(len(data), hashlib.sha256(data).hexdigest()) for n, data in names.items()},
        TECHNIQUES,
        load_config(ROOT / "config", {t.key: t.config for t in TECHNIQUES.values()}),
        spellings or Spellings(),
    )


def test_each_printed_line_is_a_specimen_with_the_temperature_of_the_bed(tmp_path: Path) -> None:
    seen = look(tmp_path / "demo", {"handling/observations.csv": OBSERVATIONS})
    entry = seen.entries["demo/handling/observations.csv"]
    assert (entry.role, entry.status) == ("register", "used")
    assert len(seen.specimens) == OBSERVATIONS.count(b"\n") - 1
    assert len({s.id for s in seen.specimens}) == len(seen.specimens)
    beds = {(s.material, s.conditions["temperature_K"]) for s in seen.specimens}
    assert len(beds) == 8
    assert {t for m, t in beds if m == "sylgard-182-10to1"} == {295.15, 323.15, 363.15}


def test_one_bad_row_rejects_all_of_it(tmp_path: Path) -> None:
    bad = OBSERVATIONS.replace(b",2.0,4,none,", b",2.0,4,,", 1)
    seen = look(tmp_path / "demo", {"handling/observations.csv": bad})
    entry = seen.entries["demo/handling/observations.csv"]
    assert (entry.status, entry.line, entry.column) == ("rejected", 5, 6)
    assert seen.specimens == []


def test_a_register_of_another_name_is_rejected(tmp_path: Path) -> None:
    for technique, name, right in (
        ("handling", "specimens.csv", "observations.csv"),
        ("compression", "observations.csv", "specimens.csv"),
    ):
        seen = look(tmp_path / technique, {f"{technique}/{name}": OBSERVATIONS})
        entry = seen.entries[f"{technique}/{technique}/{name}"]
        assert (entry.role, entry.status) == ("register", "rejected")
        assert str(entry) == (
            f"{technique}/{technique}/{name}: the register of {technique} is called {right}; "
            "give it that name"
        )


def test_a_file_that_no_observation_names_is_pointed_to_its_register(tmp_path: Path) -> None:
    seen = look(tmp_path / "demo", {"handling/photo.png": b"x"})
    assert seen.entries["demo/handling/photo.png"].reason == (
        "there is no register demo/handling/observations.csv"
    )
