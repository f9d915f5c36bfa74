"""The committed campaign gives back every value that it was simulated from."""

from __future__ import annotations

from pathlib import Path

import pytest

from deamat import open_database
from deamat.core.properties import REFERENCE_AGE
from deamat.run.folders import Folders
from deamat.twin.truth import AGED, materials, true_value
from tests.run.conftest import ROOT, run

pytestmark = pytest.mark.usefixtures("quick_figures")

_ASKED = (
    ("compressive_modulus", REFERENCE_AGE),
    ("compressive_modulus", AGED),
    ("tensile_modulus", REFERENCE_AGE),
    ("tensile_strength", REFERENCE_AGE),
    ("elongation_at_break", REFERENCE_AGE),
)


def test_every_value_of_table_4_lies_in_its_interval(tmp_path: Path) -> None:
    folders = Folders(ROOT / "raw", ROOT / "config", tmp_path / "out")
    document = run(folders)
    assert document["exit_code"] == 0
    compositions = [m for m in materials() if m.startswith("sylgard-18")]
    assert len(compositions) == 6
    with open_database(folders.processed) as database:
        for material in compositions:
            for key, age in _ASKED:
                record = database[material].record(key, age=age)
                truth = true_value(key, material, age).value
                assert record.ci95[0] <= truth <= record.ci95[1], (material, key, age)
                assert record.n == 5
