"""Calibrations on cards, in traces and in flags; what campaigns share by them."""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from deamat import open_database
from deamat.core.records import PropertyRecord
from deamat.materials.correlation import shared_covariance
from deamat.materials.database import Database
from deamat.materials.trace import trace
from deamat.run import summary
from deamat.run.folders import Folders
from deamat.run.register import register
from tests.run.conftest import MATERIALS, run

pytestmark = pytest.mark.usefixtures("quick_figures")

KEY = "compressive_modulus"
CELL = """
[calibrations.{name}]
date = {date}
valid_until = {until}
covers = ["force"]
u_relative = 0.004
certificate = "D-K-1"
"""


def calibrate(folders: Folders, names: str, *entries: str) -> None:
    """Let the machine of the campaign name calibrations, and declare these."""
    path = folders.config / "instruments.toml"
    text = path.read_text().split("\n[calibrations.")[0]
    text = "".join(line for line in text.splitlines(keepends=True) if "calibration = [" not in line)
    text = text.replace(
        'match = "CS225*5 kg"\n', f'match = "CS225*5 kg"\ncalibration = [{names}]\n'
    )
    path.write_text(text + "".join(entries))


def cell(name: str, date: str = "2021-06-01", until: str = "2023-06-01") -> str:
    return CELL.format(name=name, date=date, until=until)


def change(folders: Folders, campaign: str, old: str, new: str) -> None:
    path = folders.raw / campaign / "compression" / "specimens.csv"
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    register(folders.raw, campaign, accept_all=True)


@contextmanager
def opened(folders: Folders) -> Iterator[Database]:
    with open_database(folders.processed) as database:
        yield database


def modulus(database: Database, campaign: str = "demo") -> PropertyRecord:
    return database[MATERIALS[0]].record(KEY, age="after cure", campaign=campaign)


def flags(document: dict[str, Any]) -> dict[str, str]:
    return {flag["name"]: flag["detail"] for flag in document["flags"]}


def test_card_trace_and_database_name_the_calibration(folders: Folders) -> None:
    calibrate(folders, '"cell-7"', cell("cell-7"))
    document = run(folders)
    assert not {name for name in flags(document) if name.startswith("calibration")}
    with opened(folders) as database:
        card, record = database[MATERIALS[0]], modulus(database)
        told = trace(database, MATERIALS[0], KEY, age="after cure")
    (one,) = card.calibrations
    assert (one.calibration, one.date, one.valid_until) == ("cell-7", "2021-06-01", "2023-06-01")
    (line,) = [line for line in record.budget if line.calibration is not None]
    assert (line.source, line.calibrated) == ("load cell calibration", "force")
    assert line.u == pytest.approx(0.004 * record.quantity.value)
    assert {origin.calibrations for origin in record.origins} == {("cell-7",)}
    assert "load cell calibration (cell-7)" in told.text()
    assert "  cell-7  force  u = 0.4 %  valid 2021-06-01 to 2023-06-01  D-K-1" in told.text()
    assert told.to_document()["calibrations"][0]["certificate"] == "D-K-1"
    assert card == type(card).from_document(card.to_document())


def test_a_test_outside_the_validity_is_flagged_with_id_and_dates(folders: Folders) -> None:
    calibrate(folders, '"old"', cell("old", "2020-01-01", "2021-12-31"))
    said = flags(run(folders))["calibration-expired"]
    assert (
        "calibration old (D-K-1) is valid from 2020-01-01 to 2021-12-31; tested on 2022-01-" in said
    )
    calibrate(folders, '"new"', cell("new", "2022-02-01", "2023-01-31"))
    found = flags(run(folders))
    assert "calibration-expired" not in found
    assert "days before it was made" in found["calibration-after-test"]


def test_a_test_without_a_date_is_flagged(folders: Folders) -> None:
    calibrate(folders, '"cell-7"', cell("cell-7"))
    change(folders, "demo", "tested_on", "day_of_the_test")
    assert "calibration cell-7" in flags(run(folders))["calibration-not-dated"]


def second_campaign(folders: Folders, tested: str = "2022-01-") -> None:
    """Another campaign on the same materials with the same machine."""
    shutil.copytree(folders.raw / "demo", folders.raw / "later")
    for path in (folders.raw / "later" / "compression").rglob("*.txt"):
        path.write_bytes(path.read_bytes().replace(b"\r\n", b"\n"))
    change(folders, "later", ",2022-01-", f",{tested}")


def correlation(folders: Folders) -> float:
    with opened(folders) as database:
        one, other = modulus(database), modulus(database, "later")
    shared = [math.sqrt(math.fsum(c.u**2 for c in r.budget if c.calibration)) for r in (one, other)]
    return shared_covariance(one, other) / (shared[0] * shared[1])


def test_two_campaigns_share_the_calibration_that_both_name(folders: Folders) -> None:
    calibrate(folders, '"cell-7"', cell("cell-7"))
    second_campaign(folders)
    run(folders)
    assert correlation(folders) == pytest.approx(1.0)
    calibrate(
        folders, '"cell-7", "cell-8"', cell("cell-7"), cell("cell-8", "2022-06-01", "2023-01-01")
    )
    change(folders, "later", ",2022-01-", ",2022-07-")
    run(folders)
    assert correlation(folders) == 0.0


def test_default_limits_are_said_in_the_budget_and_once_at_the_end(folders: Folders) -> None:
    assert run(folders)["default_limits"] == []
    change(folders, "demo", "CS225", "CS999")
    document = run(folders)
    assert document["default_limits"] == [
        {"instrument": "simulated AMETEK CS999, 5 kg cell", "of": ["demo/compression"]}
    ]
    (line,) = [x for x in summary.text(document).splitlines() if "default limits" in x]
    assert "simulated AMETEK CS999, 5 kg cell (demo/compression)" in line
    assert "[machines.NAME]" in line
    with opened(folders) as database:
        sources = {line.source for line in modulus(database).budget}
    assert "load cell calibration, default limits" in sources
    assert "displacement calibration, default limits" in sources
    assert "height, gauge calibration" in sources
