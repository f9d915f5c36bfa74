"""The simulated indents hold what they claim, in the form of the instrument's export."""

from __future__ import annotations

import csv
import io
import re

import numpy as np
import pytest

from deamat.core.errors import MissingProperty, RawFileError
from deamat.core.instruments import Gauge
from deamat.core.register import read_register
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.twin.campaign import SEED, campaign_files
from deamat.twin.draws import draw_calibration
from deamat.twin.nanoindentation import (
    MODULUS,
    SPECIMENS,
    TECHNIQUE,
    TOO_SOFT,
    U_TIP_RADIUS_M,
    nanoindentation_part,
    simulate_nanoindentation,
    tip_of,
    true_modulus,
)
from deamat.twin.truth import document, materials, true_value
from tests.twin.quirks import Quirk, as_utf16, cut_short, open_ended, quirky_campaign, rows_lost

FILE = "nanoindentation/sylgard-182-20to1/synthetic-2.txt"


@pytest.fixture(scope="module")
def contents() -> dict[str, bytes]:
    return dict(nanoindentation_part(SEED).files)


def test_the_true_modulus_is_the_twins_own_and_no_value_of_the_paper() -> None:
    factor = document()["indentation"]["stiffening"]
    for material in materials():
        compressive = true_value("compressive_modulus", material).value
        assert true_modulus(material).value == factor * compressive
    with pytest.raises(MissingProperty, match=r"^the twin knows no compressive_modulus of ecoflex"):
        true_modulus("ecoflex")


@pytest.mark.parametrize("material", ["sylgard-184-10to1", "sylgard-182-20to1"])
def test_an_indent_follows_the_law_of_its_tip(material: str) -> None:
    for seed in range(10):
        test = simulate_nanoindentation(seed, material, 1)
        errors = draw_calibration(seed, TECHNIQUE)
        reduced = test.truth[MODULUS] / (1.0 - test.truth["poisson_ratio"] ** 2)
        radius = test.truth["tip_radius_m"]
        depth = test.displacement_m / (1.0 + errors.displacement) - test.truth["surface_m"]
        force = test.force_N / (1.0 + errors.force)
        pressed = depth > 0.0
        law = (
            2.0 * radius * reduced * depth[pressed]
            if tip_of(material) == "flat"
            else 4.0 / 3.0 * reduced * np.sqrt(radius) * depth[pressed] ** 1.5
        )
        air = np.polyfit(depth[~pressed], force[~pressed], 1)
        assert abs(air[0]) < 1.5  # N/m that the springs leave
        rest = force[pressed] - law - np.polyval(air, depth[pressed])
        assert rest.std() < 1e-2 * law.max()
        assert np.all(np.diff(test.time_s) > 0)
        assert force.max() == pytest.approx(test.numbers["peak_load_N"].value, rel=0.08)
        assert test.displacement_m.max() < 4.9e-6


@pytest.mark.parametrize("material", TOO_SOFT)
def test_what_is_too_soft_ends_at_the_travel_and_not_at_the_load(material: str) -> None:
    for seed in range(10):
        test = simulate_nanoindentation(seed, material, 1)
        assert test.displacement_m.max() == pytest.approx(5e-6, rel=0.01)
        assert np.ptp(test.force_N) < 0.8 * test.numbers["peak_load_N"].value


def test_files_and_register_hold_the_simulated_numbers(contents: dict[str, bytes]) -> None:
    register = contents["nanoindentation/specimens.csv"]
    rows = list(csv.DictReader(io.StringIO(register.decode()), strict=True))
    assert len(rows) == 4 * SPECIMENS + 2 * 3
    assert {f"nanoindentation/{row['file']}" for row in rows} == set(contents) - {
        "nanoindentation/specimens.csv"
    }
    assert {(row["material"], row["peak_load_uN"]) for row in rows} == {
        (material, "100" if material.endswith("10to1") else "50") for material in materials()
    }
    for row in rows:
        assert row["comment"] == "SYNTHETIC: simulated, not measured"
        assert row["instrument"].startswith("simulated")
        assert "synthetic" in row["file"]
    read = read_register(
        register, "c/nanoindentation/specimens.csv", "c", TECHNIQUE, (),
        {"tip_radius": Gauge(u_reading_m=0.0, u_calibration_m=U_TIP_RADIUS_M)},
    )  # fmt: skip
    assert read.errors == ()
    for specimen in read.specimens:
        test = simulate_nanoindentation(SEED, specimen.material, int(specimen.id[-1]))
        radius = specimen.numbers["tip_radius_m"]
        assert radius.value == pytest.approx(test.numbers["tip_radius_m"].value, rel=1e-12)
        assert (radius.u_independent, radius.u_shared) == (0.0, U_TIP_RADIUS_M)
        asked = test.numbers["peak_load_N"].value
        assert specimen.numbers["peak_load_N"].value == pytest.approx(asked, rel=1e-12)
        assert specimen.numbers["height_m"].value == pytest.approx(
            test.numbers["height_m"].value, abs=1e-12
        )


def test_a_file_is_in_the_instruments_own_form(contents: dict[str, bytes]) -> None:
    test = simulate_nanoindentation(SEED, "sylgard-182-20to1", 2)
    lines = contents[FILE].decode("latin-1").split("\n")
    assert re.fullmatch(r"Thu Jan 20 \d\d:\d\d:\d\d 2022", lines[0])
    assert lines[1:4] == [
        "",
        f"Number of Points = {test.time_s.size}",
        "Depth (nm)\tLoad (\u00b5N)\tTime (s)\tDepth (V)\tLoad (V)",
    ]
    assert lines[-1] == ""
    assert lines[4:-1].count("") == 2  # between approach, hold and way back
    file = RawFile(FILE, contents[FILE])
    found = detect(file)
    recording = found.read(file)
    assert (found.name, file.encoding, recording.flags) == ("hysitron", "latin-1", ())
    assert recording.columns["depth_m"] == pytest.approx(test.displacement_m, abs=1e-15)
    assert recording.columns["force_N"] == pytest.approx(test.force_N, abs=1e-12)
    assert recording.columns["time_s"] == pytest.approx(test.time_s, abs=1e-6)


@pytest.mark.parametrize(
    ("quirk", "reason"),
    [
        (rows_lost(FILE, 25), " points; the file seems cut"),
        (cut_short(FILE), "no line end after the last row"),
        (open_ended(FILE), "no line end after the last row"),
        (as_utf16(FILE), None),
    ],
)
def test_each_quirk_is_read_right_or_rejected(quirk: Quirk, reason: str | None) -> None:
    plain = RawFile(FILE, campaign_files(SEED)[FILE])
    if reason is None:
        utf8 = {FILE: plain.data.decode("latin-1").encode()}
        quirky = RawFile(FILE, quirk(utf8)[FILE])
        assert detect(quirky).read(quirky).columns["force_N"].tobytes() == (
            detect(plain).read(plain).columns["force_N"].tobytes()
        )
        return
    quirky = RawFile(FILE, quirky_campaign(SEED, quirk)[FILE])
    with pytest.raises(RawFileError) as caught:
        detect(quirky).read(quirky)
    assert reason in str(caught.value)
    assert caught.value.line is not None
