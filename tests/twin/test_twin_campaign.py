"""A campaign is written whole, the same from the same seed, and says that it is synthetic."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import re
import tomllib
from collections import Counter
from datetime import date, datetime, time
from pathlib import Path

import numpy as np
import pytest

from deamat.core.errors import ConfigError
from deamat.twin.campaign import NAME, PARTS, SEED, campaign_files, simulate, write_campaign
from deamat.twin.compression import simulate_compression
from deamat.twin.tension import simulate_tension
from deamat.twin.truth import AGED, materials, truth_table
from deamat.twin.writers import bluehill_csv, chatillon_log
from tests.twin.quirks import as_utf16, cut_short, open_ended, quirky_campaign

COMMITTED = Path(__file__).resolve().parents[2] / "raw" / NAME
LOG = "compression/sylgard-182-40to1/synthetic-2-months-3.txt"
CSV = "tension/sylgard-186-10to1/synthetic-4.csv"


@pytest.fixture(scope="module")
def contents() -> dict[str, bytes]:
    return campaign_files(SEED)


def _on_disk(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def _register(contents: dict[str, bytes], technique: str) -> list[dict[str, str]]:
    text = contents[f"{technique}/specimens.csv"].decode()
    return list(csv.DictReader(io.StringIO(text), strict=True))


def test_the_committed_campaign_comes_out_of_its_seed(contents: dict[str, bytes]) -> None:
    committed = _on_disk(COMMITTED)
    assert committed.keys() == contents.keys()
    assert [path for path, data in contents.items() if committed[path] != data] == []


def test_two_writes_are_equal_and_another_seed_is_not(
    tmp_path: Path, contents: dict[str, bytes]
) -> None:
    written = simulate(tmp_path / "raw", SEED)
    assert written == tmp_path / "raw" / NAME
    assert _on_disk(written) == contents
    other = campaign_files(SEED + 1)
    assert other.keys() == contents.keys()
    assert all(other[path] != data for path, data in contents.items())


def test_it_is_small(contents: dict[str, bytes]) -> None:
    assert sum(map(len, contents.values())) < 4e6
    assert max(map(len, contents.values())) < 1e5


def test_the_manifest_names_every_file_but_itself(contents: dict[str, bytes]) -> None:
    lines = contents["MANIFEST.sha256"].decode().splitlines()
    stated = {line[66:]: line[:64] for line in lines}
    found = {path: hashlib.sha256(data).hexdigest() for path, data in contents.items()}
    del found["MANIFEST.sha256"]
    assert stated == found
    assert list(stated) == sorted(stated)
    assert {line[64:66] for line in lines} == {"  "}
    assert {"campaign.toml", "compression/specimens.csv", "tension/specimens.csv"} <= set(stated)


def test_it_says_everywhere_that_it_is_synthetic(contents: dict[str, bytes]) -> None:
    declared = tomllib.loads(contents["campaign.toml"].decode())
    assert declared["synthetic"] is True
    assert set(declared) == {"title", "laboratory", "licence", "source", "synthetic", "note"}
    assert f"--seed {SEED}" in declared["note"]
    assert declared["note"].startswith("SYNTHETIC")
    for technique in ("compression", "tension", "viscosity"):
        for row in _register(contents, technique):
            assert row["comment"] == "SYNTHETIC: simulated, not measured"
            assert row["instrument"].startswith("simulated")
            assert "synthetic" in row["file"]
    for path, data in contents.items():
        if path.startswith("tension/") and path.endswith("synthetic-1.csv"):
            assert data.startswith(b'General : Comment,"SYNTHETIC: simulated, not measured"\r\n')


def test_registers_hold_five_specimens_each_and_name_every_file(
    contents: dict[str, bytes],
) -> None:
    compressed, pulled = _register(contents, "compression"), _register(contents, "tension")
    assert Counter((r["material"], r["age"]) for r in compressed) == {
        (m, age): 5 for m in materials() for age in ("after cure", AGED)
    }
    assert Counter((r["material"], r["age"]) for r in pulled) == {
        (m, "after cure"): 5 for m in materials()
    }
    assert len({r["specimen"] for r in compressed + pulled}) == 90
    named = {f"compression/{r['file']}" for r in compressed} | {
        f"tension/{r['file']}" for r in pulled
    }
    registers = {"compression/specimens.csv", "tension/specimens.csv"}
    mine = {p for p in contents if p.startswith(("compression/", "tension/"))}
    assert named == mine - registers
    assert list(compressed[0]) == [
        *("specimen", "material", "file", "diameter_mm", "u_diameter_mm", "height_mm"),
        *("speed_mm_per_min", "age", "cure", "cured_on", "tested_on", "temperature_C"),
        *("humidity_percent", "instrument", "comment"),
    ]
    assert list(pulled[0]) == [
        *("specimen", "material", "file", "width_mm", "thickness_um", "gauge_length_mm"),
        *("speed_mm_per_min", "age", "cure", "cured_on", "tested_on", "temperature_C"),
        *("humidity_percent", "instrument", "comment"),
    ]
    assert {r["speed_mm_per_min"] for r in compressed} == {"12"}
    assert {r["speed_mm_per_min"] for r in pulled} == {"40"}


def test_a_compression_log_holds_the_simulated_numbers(contents: dict[str, bytes]) -> None:
    test = simulate_compression(SEED, "sylgard-182-40to1", AGED, 3)
    text = contents[LOG].decode("ascii")
    lines = text.split("\r\n")
    assert re.fullmatch(r"3/14/2022  1?\d:\d\d [AP]M", lines[0])
    assert lines[1:5] == [
        "Units: N",
        "X-Axis: Travel",
        "Travel Unit: mm",
        "Reading\tLoad\tTravel\tTime",
    ]
    assert lines[-1] == ""
    assert "\n" not in text.replace("\r\n", "")
    table = np.array([line.split("\t") for line in lines[5:-1]], dtype=float)
    assert table[:, 0].tolist() == list(range(1, test.time_s.size + 1))
    assert table[:, 1] == pytest.approx(test.force_N, abs=1e-12)
    assert table[:, 2] == pytest.approx(1e3 * test.displacement_m, abs=1e-12)
    assert table[:, 3] == pytest.approx(test.time_s, abs=1e-12)
    row = next(r for r in _register(contents, "compression") if f"compression/{r['file']}" == LOG)
    assert float(row["height_mm"]) == pytest.approx(1e3 * test.numbers["height_m"].value)
    assert float(row["diameter_mm"]) == pytest.approx(1e3 * test.numbers["diameter_m"].value)
    assert float(row["u_diameter_mm"]) == 0.01


def test_a_tension_file_holds_the_simulated_numbers(contents: dict[str, bytes]) -> None:
    test = simulate_tension(SEED, "sylgard-186-10to1", 4)
    lines = contents[CSV].decode("ascii").split("\r\n")
    assert lines[1:6] == [
        'General : Specimen label,"t-sylgard-186-10to1-4"',
        'Test : Rate,"40",mm/min',
        "",
        "Time,Extension,Load",
        "(s),(mm),(N)",
    ]
    table = np.array(list(csv.reader(lines[6:-1])), dtype=float)
    assert table[:, 0] == pytest.approx(test.time_s, abs=1e-12)
    assert table[:, 1] == pytest.approx(1e3 * test.displacement_m, abs=1e-12)
    assert table[:, 2] == pytest.approx(test.force_N, abs=1e-12)
    row = next(r for r in _register(contents, "tension") if f"tension/{r['file']}" == CSV)
    assert float(row["thickness_um"]) == pytest.approx(1e6 * test.numbers["thickness_m"].value)
    assert float(row["width_mm"]) == pytest.approx(1e3 * test.numbers["width_m"].value)
    assert float(row["gauge_length_mm"]) == pytest.approx(
        1e3 * test.numbers["gauge_length_m"].value
    )


def test_large_numbers_have_thousands_commas_inside_the_quotes() -> None:
    data = bluehill_csv([], np.array([1234.5]), np.array([1.25]), np.array([-2000.0]))
    assert data.decode().split("\r\n")[-2] == '"1,234.500","1,250.0000","-2,000.00000"'


def test_a_stamp_is_written_as_the_stand_writes_it() -> None:
    one = np.zeros(1)
    for day, hour, stamp in (
        (date(2022, 1, 8), time(0, 5), "1/8/2022  12:05 AM"),
        (date(2022, 11, 30), time(15, 30), "11/30/2022  3:30 PM"),
    ):
        started = datetime.combine(day, hour)
        assert chatillon_log(started, one, one, one).decode().split("\r\n")[0] == stamp


def test_the_truth_lies_apart_and_is_no_part_of_the_campaign(tmp_path: Path) -> None:
    written = simulate(tmp_path / "raw", 7, tmp_path / "truth.json")
    truth = json.loads((tmp_path / "truth.json").read_text())
    assert truth["synthetic"] is True
    assert (truth["campaign"], truth["seed"]) == (NAME, 7)
    written_down = [(v["key"], v["material"], v["age"], v["value"]) for v in truth["values"]]
    assert len(written_down) == len(set(written_down)) == sum(len(p(7).truth) for p in PARTS)
    # what the paper prints as such; the rest follows from its laws or is the twin's own choice
    printed = {(e.key, e.material, e.age, e.value) for e in truth_table()}
    assert len(printed) == 6 * 6 + 4
    assert printed <= set(written_down)
    assert len(truth["specimens"]) == sum(len(p(7).specimens) for p in PARTS)
    assert set(truth["calibration_errors"]) == {p(7).technique for p in PARTS}
    assert (
        truth["calibration_errors"]["compression"]["caliper_m"]
        == (truth["calibration_errors"]["tension"]["caliper_m"])
    )
    assert "truth" not in " ".join(_on_disk(written))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["raw", "truth.json"]


def test_the_truth_is_refused_among_the_raw_files(tmp_path: Path) -> None:
    inside = tmp_path / "raw" / "truth.json"
    message = (
        f"the truth must not lie among the raw files: {inside} is inside {tmp_path / 'raw'}; "
        "name a file outside it"
    )
    with pytest.raises(ConfigError, match=f"^{re.escape(message)}$"):
        simulate(tmp_path / "raw", 7, inside)
    assert not (tmp_path / "raw").exists()


def test_a_campaign_that_is_there_is_never_overwritten(tmp_path: Path) -> None:
    (tmp_path / NAME).mkdir()
    message = (
        f"{tmp_path / NAME} exists already and raw files are never overwritten; "
        "remove it or choose another folder"
    )
    with pytest.raises(ConfigError, match=f"^{re.escape(message)}$"):
        simulate(tmp_path, 7, tmp_path.parent / "truth.json")
    assert list((tmp_path / NAME).iterdir()) == []
    assert not (tmp_path.parent / "truth.json").exists()


def test_a_write_that_fails_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[Path] = []
    write = Path.write_bytes

    def full_disk(path: Path, data: bytes) -> int:
        if len(written) == 3:
            raise OSError(28, "No space left on device")
        written.append(path)
        return write(path, data)

    monkeypatch.setattr(Path, "write_bytes", full_disk)
    with pytest.raises(OSError, match="No space left"):
        write_campaign(tmp_path, 7)
    assert list(tmp_path.iterdir()) == []


def test_what_a_killed_run_left_is_cleared_away(tmp_path: Path) -> None:
    leftover = tmp_path / f".{NAME}.part"
    leftover.mkdir()
    (leftover / "half").write_text("of a file")
    written = write_campaign(tmp_path, 7)
    assert list(tmp_path.iterdir()) == [written]
    assert not (written / "half").exists()


def test_quirks_change_their_file_and_the_manifest_agrees(contents: dict[str, bytes]) -> None:
    quirky = quirky_campaign(SEED, cut_short(CSV), open_ended(LOG))
    changed = {path for path in contents if quirky[path] != contents[path]}
    assert changed == {CSV, LOG, "MANIFEST.sha256"}
    assert quirky[LOG] == contents[LOG][:-2]
    assert quirky[CSV] == contents[CSV][: len(quirky[CSV])]
    assert quirky[CSV][-1:].isdigit()
    assert hashlib.sha256(quirky[CSV]).hexdigest() in quirky["MANIFEST.sha256"].decode()
    wide = quirky_campaign(SEED, as_utf16(LOG))[LOG]
    assert wide.startswith(b"\xff\xfe")
    assert wide.decode("utf-16").encode() == contents[LOG]


def test_a_quirk_of_a_file_that_is_not_there_is_refused() -> None:
    message = "a quirk names 'tension/x.csv', which the campaign does not hold"
    with pytest.raises(ConfigError, match=f"^{re.escape(message)}$"):
        quirky_campaign(SEED, cut_short("tension/x.csv"))


def test_every_part_keeps_to_its_own_folder() -> None:
    for part in (make(SEED) for make in PARTS):
        assert all(path.startswith(f"{part.technique}/") for path in part.files)
