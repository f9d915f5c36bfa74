"""Numbers that nothing measures are rejected or refused with their place; nothing ends a run."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from deamat.core.config import load_config
from deamat.core.errors import ConfigError
from deamat.run.folders import Folders
from deamat.run.register import register
from deamat.techniques import TECHNIQUES
from tests.run.conftest import ROOT, run, twin_rows, write_campaign

pytestmark = pytest.mark.usefixtures("quick_figures")


def _campaign(folders: Folders, technique: str, change: Callable[[bytes], bytes]) -> Path:
    """One specimen of a technique, with its file changed, beside the small campaign."""
    rows = [row for row in twin_rows(f"{technique}/specimens.csv") if row["file"]][:1]
    folder = folders.raw / "wild"
    write_campaign(rows, folder, f"{technique}/specimens.csv")
    path = folder / technique / rows[0]["file"]
    path.write_bytes(change(path.read_bytes()))
    register(folders.raw, "wild", accept_all=True)
    return path


def _last_cell_below_zero(data: bytes) -> bytes:
    return re.sub(rb'^("[^,]*","[^,]*",)"-?', rb'\1"-', data, flags=re.MULTILINE)


def _capacitance(value: bytes) -> Callable[[bytes], bytes]:
    def change(data: bytes) -> bytes:
        lines = data.splitlines(keepends=True)
        first = next(i for i, line in enumerate(lines) if line[:1].isdigit())
        cells = lines[first + 4].split(b",")
        cells[1] = value
        lines[first + 4] = b",".join(cells)
        return b"".join(lines)

    return change


def _quoted(data: bytes) -> bytes:
    return re.sub(
        rb"^[0-9].*$", lambda m: b'"' + m[0].replace(b",", b'","') + b'"', data, flags=re.MULTILINE
    )


CASES: dict[str, tuple[str, Callable[[bytes], bytes], str, str]] = {
    "no positive force": (
        "tension",
        lambda d: re.sub(rb'"[^",]*"\r?$', b'"-0.5"', d, flags=re.MULTILINE),
        "refused",
        "the greatest stress of the loading is",
    ),
    "tiny": ("permittivity", _capacitance(b"1e-320"), "rejected", "capacitance_F is 9.99989e-321"),
    "huge": (
        "permittivity",
        _capacitance(b"1e300"),
        "rejected",
        "line 10: parallel_capacitance_F is 1e+300 in row 5, which nothing measures",
    ),
    "quoted": ("permittivity", _quoted, "rejected", "line 6, column 4: an unknown status"),
}


@pytest.mark.parametrize("name", CASES)
def test_a_wild_number_in_a_file(folders: Folders, name: str) -> None:
    technique, change, fate, said = CASES[name]
    path = _campaign(folders, technique, change)
    document = run(folders)
    assert document["internal_errors"] == []
    assert document["values"] >= 4  # those of the small campaign
    reasons = [
        r["reason"] for r in document[fate] if "wild" in (r.get("campaign"), r.get("path", "")[:4])
    ]
    assert any(said in reason for reason in reasons), (reasons, path.name)


@pytest.mark.parametrize("value", ["1e300", "1e-320", "1e27", "1e-27", "1e-7"])
def test_a_wild_number_in_a_register(folders: Folders, value: str) -> None:
    table = folders.raw / "demo" / "compression" / "specimens.csv"
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    rows[0]["diameter_mm"] = value
    with table.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    register(folders.raw, "demo", accept_all=True)
    document = run(folders)
    assert (document["exit_code"], document["internal_errors"]) == (1, [])
    (rejected,) = document["rejected"]
    assert "specimens.csv, line 2, column 4: " in rejected["reason"]
    assert f"(found {value!r})" in rejected["reason"]
    assert document["values"] == 4


@pytest.mark.parametrize(
    ("file", "text", "said"),
    [
        ("instruments.toml", '[machines.a]\nmatch = "CS225.*5 kg"\n', "'.*' is of a regular expr"),
        ("instruments.toml", '[machines.a]\nmatch = "^CS225"\n', "'^' is of a regular expression"),
        ("methods.toml", "[compression]\ntoe_bin = 1e-9\n", "compression.toe_bin: Input should be"),
        ("methods.toml", "[compression]\nmin_samples = " + "9" * 5000, "methods.toml: Exceeds the"),
        ("methods.toml", "a = " + "[" * 2000 + "]" * 2000, "methods.toml: its values are nested"),
    ],
)
def test_a_wild_configuration(folders: Folders, file: str, text: str, said: str) -> None:
    (folders.config / file).write_text(text)
    with pytest.raises(ConfigError, match=re.escape(said)):
        run(folders)


def test_a_bracket_in_the_name_of_a_machine_is_a_bracket(folders: Folders) -> None:
    (folders.config / "instruments.toml").write_text('[machines.a]\nmatch = "cell (5 kg*"\n')
    config = load_config(folders.config, {t.key: t.config for t in TECHNIQUES.values()})
    assert config.instruments.machine("CS225, Cell (5 kg, new)").entry == "a"
    assert config.instruments.machine("CS225, 5 kg").entry == ""


@pytest.mark.parametrize("text", ["a = " + "[" * 900 + "]" * 900, "a = " + "9" * 5000])
def test_a_wild_campaign_file_stops_its_campaign_alone(folders: Folders, text: str) -> None:
    whole = (ROOT / "raw" / "sylgard-2022-twin" / "campaign.toml").read_text()
    (folders.raw / "wild").mkdir()
    (folders.raw / "wild" / "campaign.toml").write_text(f"{whole}\n{text}\n")
    document = run(folders)
    assert (document["exit_code"], document["internal_errors"]) == (1, [])
    (rejected,) = document["rejected"]
    assert rejected["reason"].startswith("wild/campaign.toml: not valid TOML: ")
    assert document["values"] == 4
