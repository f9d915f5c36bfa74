"""A simulated sweep looks like its meter's, its truth can be found in it, and its faults are met."""

from __future__ import annotations

import csv
import io
import math
import statistics

import numpy as np
import pytest

from deamat.core.errors import ConfigError, MissingProperty, RawFileError
from deamat.core.recording import Recording
from deamat.estimators.dielectric.impedance import loss_tangent
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.twin.campaign import SEED
from deamat.twin.permittivity import (
    FUNCTIONS,
    METER,
    TABLE,
    complex_permittivity,
    draw_lcr_calibration,
    permittivity_part,
    simulate_permittivity,
    sweep_log,
)
from deamat.twin.truth import materials, true_value
from tests.twin.lcr_quirks import (
    GREEK_MU,
    MICRO_SIGN,
    in_microfarad,
    marked_out,
    over_range_point,
    sentinel_marked_ok,
    with_units_row,
    without_function,
)
from tests.twin.quirks import Quirk, as_utf16, cut_short, quirky_campaign

LOG = "permittivity/sylgard-184-10to1/synthetic-2.log"
CSV = f"permittivity/{TABLE}/synthetic-1.csv"
EPS0 = 8.8541878188e-12
FILES = permittivity_part(SEED).files


def read(path: str, *quirks: Quirk) -> Recording:
    contents: dict[str, bytes] = dict(FILES)
    for quirk in quirks:
        contents = dict(quirk(contents))
    file = RawFile(path, contents[path])
    return detect(file).read(file)


def refused(path: str, *quirks: Quirk) -> str:
    with pytest.raises(RawFileError) as caught:
        read(path, *quirks)
    return str(caught.value)


def rows() -> list[dict[str, str]]:
    text = FILES["permittivity/specimens.csv"].decode()
    return list(csv.DictReader(io.StringIO(text), strict=True))


@pytest.mark.parametrize("material", materials())
def test_capacitance_gives_the_permittivity_back(material: str) -> None:
    """With the true thickness and area: scatter of films, and the meter's own error at 10 Hz."""
    ratios = []
    for seed in range(200):
        sweep = simulate_permittivity(seed, material, 1)
        errors = draw_lcr_calibration(seed)
        vacuum = EPS0 * errors.plate_length_m * errors.plate_width_m / sweep.truth["thickness_m"]
        ratios.append(sweep.capacitance_F.real[0] / vacuum)
    truth = true_value("relative_permittivity", material).value
    sd = math.hypot(0.015, 0.0063)
    assert statistics.fmean(ratios) == pytest.approx(truth, rel=4 * sd / math.sqrt(200))
    assert statistics.stdev(ratios) / truth == pytest.approx(sd, rel=0.25)


def test_the_thickness_is_read_under_the_micrometers_force() -> None:
    """p/Y = (1/lambda - lambda^2) / 3 with 7.07 kPa, within the errors of force and gauge."""
    for material in materials():
        ratio = 5 / (math.pi / 4 * 0.03**2) / true_value("compressive_modulus", material).value
        stretches = []
        for seed in range(100):
            sweep = simulate_permittivity(seed, material, 3)
            stretches.append(sweep.numbers["thickness_m"].value / sweep.truth["thickness_m"])
        stretch = statistics.fmean(stretches)
        assert (1 / stretch - stretch**2) / 3 == pytest.approx(ratio, rel=0.02, abs=1e-3)


def test_the_permittivity_falls_a_little_and_the_loss_peaks_at_low_frequency() -> None:
    f = np.logspace(0, 4, 401)
    eps = complex_permittivity(2.63, f)
    assert eps.real[100] == pytest.approx(2.63, rel=1e-12)
    assert np.all(np.diff(eps.real) < 0)
    assert 0.01 < 1 - eps.real[-1] / 2.63 < 0.03
    loss = loss_tangent(eps)
    assert 10 < f[loss.argmax()] < 20
    assert 0.001 < loss.max() < 0.02


def test_noise_grows_towards_low_frequency_and_errors_are_the_campaigns() -> None:
    """Relative to another film of the same campaign the meter's error cancels, noise does not."""
    pairs = [
        [simulate_permittivity(seed, "sylgard-182-10to1", n).capacitance_F.real for n in (1, 2)]
        for seed in range(100)
    ]
    ratios = np.array([a / b for a, b in pairs])
    noise = (ratios / ratios[:, 15:16]).std(axis=0)
    assert 5 < noise[:3].mean() / noise[-3:].mean() < 20
    assert noise.max() < 5e-4
    first = np.array([a for a, _ in pairs])
    between = (first[:, 0] / first[:, -1]).std() / (first[:, 0] / first[:, -1]).mean()
    assert between == pytest.approx(0.0063, rel=0.25)


def test_a_resistance_in_series_bends_the_sweep_as_asked() -> None:
    plain, bent = (simulate_permittivity(4, TABLE, 1, series_ohm=ohm) for ohm in (0.0, 2e4))
    added = loss_tangent(bent.capacitance_F) - loss_tangent(plain.capacitance_F)
    w = 2 * math.pi * plain.frequency_Hz
    assert added == pytest.approx(w * 2e4 * plain.capacitance_F.real, rel=0.01, abs=1e-5)
    assert bent.capacitance_F.real[-1] < 0.97 * plain.capacitance_F.real[-1]


def test_registers_and_files_are_what_the_paper_says() -> None:
    table = rows()
    assert [(r["material"], r["specimen"]) for r in table] == [
        (m, f"p-{m}-{n}") for m in materials() for n in range(1, 6)
    ]
    assert {f"permittivity/{r['file']}" for r in table} == set(FILES) - {
        "permittivity/specimens.csv"
    }
    assert {(r["micrometer_force_N"], r["anvil_diameter_mm"]) for r in table} == {("5", "30")}
    assert len({(r["plate_length_mm"], r["plate_width_mm"]) for r in table}) == 1
    for row in table:
        assert row["comment"] == "SYNTHETIC: simulated, not measured"
        assert row["instrument"].startswith("simulated")
        assert float(row["plate_length_mm"]) == pytest.approx(45, abs=0.1)
        thick = float(row["thickness_um"])
        aspect = 45e3 / thick
        assert aspect > 100
    assert all(
        b"SYNTHETIC: simulated, not measured" in data.partition(b"\n")[0]
        for path, data in FILES.items()
        if path != "permittivity/specimens.csv"
    )


def test_a_log_looks_like_the_meters() -> None:
    lines = FILES[LOG].decode("ascii").split("\n")
    assert lines[:5] == [
        "# SYNTHETIC: simulated, not measured",
        "# *IDN? => LCR-6020,REV C1.06,SIMULATED,Good Will Instrument Co., Ltd.",
        "# FUNC? => Cp-D",
        "# LEV:VOLT? => 1.000e+00V",
        "# APER? => SLOW,1",
    ]
    assert lines[5].startswith("1.00000e+01,+1.")
    assert lines[35].startswith("1.00000e+04,+1.")
    assert lines[35].endswith(",OK")
    assert lines[36:] == [""]


@pytest.mark.parametrize("function", ["Cp-D", "Cp-Rp", "Cs-D", "Cs-Rs", "R-X"])
def test_a_sweep_reads_back_to_six_digits_whatever_the_function(function: str) -> None:
    sweep = simulate_permittivity(SEED, "sylgard-184-10to1", 2)
    file = RawFile("x.log", sweep_log(sweep, function))
    columns = list(detect(file).read(file).columns.values())
    from deamat.estimators.dielectric.impedance import complex_capacitance

    seen = complex_capacitance(function, columns[0], columns[1], columns[2])
    assert seen.real == pytest.approx(sweep.capacitance_F.real, rel=2e-5)
    assert set(FUNCTIONS.values()) == {"Cp-D", "Cs-D", "R-X"}


def test_campaigns_and_films_differ_and_seeds_repeat() -> None:
    one, two = (simulate_permittivity(1, TABLE, n) for n in (1, 2))
    assert one.truth != two.truth
    assert np.array_equal(simulate_permittivity(1, TABLE, 1).capacitance_F, one.capacitance_F)
    assert draw_lcr_calibration(1) != draw_lcr_calibration(2)
    assert permittivity_part(SEED).files == FILES


def test_the_other_techniques_keep_their_bytes() -> None:
    """Streams have their own keys: the gauges' errors are the campaign's, for every technique."""
    from deamat.twin.draws import draw_calibration

    tension, lcr = draw_calibration(SEED, "tension"), draw_lcr_calibration(SEED)
    assert (tension.caliper_m, tension.micrometer_m) == (lcr.caliper_m, lcr.micrometer_m)


def test_what_cannot_be_simulated_is_refused() -> None:
    with pytest.raises(MissingProperty, match=r"^the twin knows no relative_permittivity of ecof"):
        simulate_permittivity(0, "ecoflex", 1)
    with pytest.raises(ConfigError, match=r"^the seed must be 0 or more, not -1$"):
        simulate_permittivity(-1, TABLE, 1)


# --- faults of real logs, by name


@pytest.mark.parametrize(
    "quirk",
    [
        over_range_point(LOG, "1.00000e+02"),
        over_range_point(LOG, "1.00000e+02", "OUT "),
        marked_out(LOG, "1.00000e+02"),
        sentinel_marked_ok(LOG, "1.00000e+02"),
    ],
)
def test_an_over_range_point_is_marked_and_named(quirk: Quirk) -> None:
    recording = read(LOG, quirk)
    assert list(np.flatnonzero(recording.columns["over_range"])) == [10]
    assert [str(flag) for flag in recording.flags] == [
        "over-range: 1 of 31 points are marked as invalid by the meter and are not used: line 16 (100 Hz)"
    ]


def test_a_log_without_its_function_is_refused_by_name() -> None:
    assert "does not say which function the meter measured" in refused(LOG, without_function(LOG))


@pytest.mark.parametrize("mu", [MICRO_SIGN, GREEK_MU])
def test_either_mu_gives_the_same_capacitance(mu: str) -> None:
    changed, plain = read(CSV, in_microfarad(CSV, mu)), read(CSV)
    assert changed.columns["parallel_capacitance_F"] == pytest.approx(
        plain.columns["parallel_capacitance_F"], rel=1e-6
    )


def test_a_row_of_units_is_read() -> None:
    changed, plain = read(CSV, with_units_row(CSV)), read(CSV)
    for name, values in plain.columns.items():
        assert np.array_equal(changed.columns[name], values)
    assert changed.source.first_line == plain.source.first_line + 1


def test_utf_16_is_read_and_a_cut_file_is_not() -> None:
    assert read(LOG, as_utf16(LOG)).columns["frequency_Hz"].size == 31
    assert "line 36, column 4: an unknown status (found 'O')" in refused(LOG, cut_short(LOG))


def test_a_quirk_of_what_is_not_there_is_an_error() -> None:
    with pytest.raises(ConfigError, match="which the campaign does not hold"):
        quirky_campaign(SEED, without_function("permittivity/x.log"))
    with pytest.raises(ConfigError, match=r"^a quirk names '3', which '.*' does not hold$"):
        quirky_campaign(SEED, marked_out(LOG, "3"))


def test_the_meter_is_declared_as_the_configuration_declares_it() -> None:
    assert METER.high_impedance_per_ohm == ((150e3, 0.03e-9),)
