"""`docs/first-hour.md` runs as it stands: an empty folder becomes a card in at most 8 commands."""

from __future__ import annotations

import csv
import doctest
import json
import re
import shlex
from collections import defaultdict
from pathlib import Path

import pytest
from click.testing import CliRunner

from deamat.cli import cli
from tests.first_hour_files import MODULUS_Pa, write_inbox
from tests.run.conftest import ROOT

PAGE = (ROOT / "docs" / "first-hour.md").read_text("utf-8")
TABLES = "## 4. Dimensions"


def commands(page: str) -> list[tuple[list[str], str]]:
    """Return each command of a page and what it prints by it."""
    found = []
    for block in re.findall(r"```console\n(.*?)```", page, re.DOTALL):
        for told in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            line, _, printed = told.partition("\n")
            program, *words = shlex.split(line)
            assert program == "deamat"
            found.append((words, printed))
    return found


def fill_in(home: Path) -> None:
    """Put the page's values in place of every mark, and save as a German Excel does."""
    cells: dict[str, dict[str, str]] = defaultdict(dict)
    for row in re.findall(r"^\| (\w+) \| (\w+) \| (.*?) ?\|$", PAGE, re.MULTILINE):
        cells[row[0]][row[1]] = row[2]
    tables = sorted((home / "to-fill-in" / "spring").glob("*.csv"))
    assert {path.stem for path in tables} == set(cells) - {"table"}
    for path in tables:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.DictReader(file))
        with path.open("w", encoding="cp1252", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]), delimiter=";")
            writer.writeheader()
            for row in rows:
                writer.writerow({c: cells[path.stem][c] if v == "?" else v for c, v in row.items()})


def test_the_page_does_what_it_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_inbox(tmp_path / "inbox")
    assert len(list((tmp_path / "inbox").iterdir())) == 10
    before, after = PAGE.split(TABLES)
    compare, loosely = doctest.OutputChecker(), doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    for part in (before, after):
        for words, printed in commands(part):
            done = CliRunner().invoke(cli, words)
            assert done.exit_code == 0, done.output
            told = done.stdout if printed else ""
            assert compare.check_output(printed, told, loosely), f"{words}\n{done.stdout}"
        if part == before:
            fill_in(tmp_path)
    assert len(commands(PAGE)) <= 8
    card = json.loads((tmp_path / "processed" / "cards" / "gel-a.json").read_text())
    assert card["synthetic"] is True
    values = {p["key"]: p["value"] for p in card["properties"]}
    assert values["compressive_modulus"] == pytest.approx(MODULUS_Pa, rel=0.06)
    assert values["tensile_modulus"] == pytest.approx(MODULUS_Pa, rel=0.1)
    assert values["relative_permittivity"] == pytest.approx(2.73, rel=0.02)
    assert [r["key"] for r in card["refused"]] == ["viscosity_at_printing_rate"]
