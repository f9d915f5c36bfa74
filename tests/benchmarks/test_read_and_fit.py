"""What the benchmark lets its contenders work on, and how it judges them. Nothing is timed here."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest

from benchmarks.campaign import AREA_m2, Curve, HEIGHT_m, find_curves, write_campaign
from benchmarks.campaign_forms import FORMS
from benchmarks.read_and_fit import Fit, judged, ours, ours_whole, worst_error
from benchmarks.timing import Row


def plain_fit(curve: Curve) -> Fit:
    form = curve.form
    if not form.separator:
        return curve.modulus_Pa, 0.0  # a workbook, which `ours` reads below
    lines = curve.path.read_text(form.encoding).replace(form.decimal, ".").splitlines()
    numbers = np.loadtxt(lines[form.skip :], delimiter=form.separator)
    columns = dict(zip(form.columns, numbers.T, strict=True))
    slope = np.polyfit(columns["travel"] * 1e-3 / HEIGHT_m, columns["load"] / AREA_m2, 1)[0]
    return float(slope), 0.0


def test_the_files_hold_the_moduli_that_they_claim(tmp_path: Path) -> None:
    curves = write_campaign(tmp_path, files=6, rows=400)
    assert [curve.form for curve in curves] == list(FORMS)
    assert worst_error(plain_fit, curves) < 0.005
    assert worst_error(ours(), curves) < 0.005


def test_both_of_ours_answer_alike(tmp_path: Path) -> None:
    for curve in write_campaign(tmp_path, files=4, rows=400):
        bare, whole = ours()(curve), ours_whole()(curve)
        assert bare is not None
        assert whole is not None
        assert bare[0] == whole[0]
        assert 0.0 < bare[1] < whole[1]  # the budget adds geometry and calibration


def test_a_contender_that_misses_the_truth_is_an_error(tmp_path: Path) -> None:
    curves = write_campaign(tmp_path, files=2, rows=50)
    with pytest.raises(ValueError, match=r"^a modulus is off by 50\.0 %$"):
        worst_error(lambda curve: (1.5 * curve.modulus_Pa, 0.0), curves)


def test_the_campaign_is_whole_and_says_that_it_is_synthetic(tmp_path: Path) -> None:
    curves = write_campaign(tmp_path, files=4, rows=10)
    assert "synthetic = true" in (tmp_path / "campaign.toml").read_text()
    manifest = [
        line.split("  ") for line in (tmp_path / "MANIFEST.sha256").read_text().splitlines()
    ]
    assert {path for _, path in manifest} == {
        path.relative_to(tmp_path).as_posix()
        for path in tmp_path.rglob("*")
        if path.is_file() and path.name != "MANIFEST.sha256"
    }
    for digest, path in manifest:
        assert hashlib.sha256((tmp_path / path).read_bytes()).hexdigest() == digest
    register = (tmp_path / "compression" / "specimens.csv").read_text().splitlines()
    named = {line.split(",")[2] for line in register[1:]}
    assert named == {c.path.relative_to(tmp_path / "compression").as_posix() for c in curves}


def test_the_curves_of_a_campaign_are_found_again(tmp_path: Path) -> None:
    written = write_campaign(tmp_path, files=4, rows=10)
    found = find_curves(tmp_path)
    assert {(c.path, c.material, c.form.name) for c in found} == {
        (c.path, c.material, c.form.name) for c in written
    }


def test_targets_are_judged_and_what_the_hash_costs_is_told() -> None:
    names = ("form", "contender", "times ours", "times ours, hashed", "target")
    rows: list[Row] = [
        dict(zip(names, row, strict=True))
        for row in (
            ("mts", "pandas + OLS", 2.5, 1.9, 2.0),
            ("mts", "pandas + lmfit", 8.0, "-", 10.0),
            ("mts", "ours", 1.0, 0.9, "-"),
        )
    ]
    assert judged(rows, [("peak memory [MB]", 300.0, 250.0)]) == [
        "met: mts: ours is 2.5 times faster than pandas + OLS, wanted 2 (1.9 with the hash)",
        "MISSED: mts: ours is 8.0 times faster than pandas + lmfit, wanted 10",
        "MISSED: peak memory [MB] 300, wanted less than 250",
    ]
