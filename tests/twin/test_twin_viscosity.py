"""The simulated viscosity runs: read back, recovered, and spoilt on purpose."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deamat.core.config import load_config
from deamat.core.errors import MissingProperty
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Law, Measurement, Summary
from deamat.core.register import read_register
from deamat.core.technique import Context
from deamat.core.viscometer import full_scale_Pas
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.techniques import TECHNIQUES, viscosity
from deamat.techniques.viscosity.config import ViscosityConfig
from deamat.techniques.viscosity.result import Run
from deamat.twin.campaign import SEED
from deamat.twin.truth import true_viscosities
from deamat.twin.viscosity import (
    BATCHES,
    ON_STRONGER_SPRING,
    RATE_PER_RPM_PER_S,
    STRONGER,
    VISCOMETER,
    machine_of,
    simulate_viscosity,
    viscosity_part,
)
from tests.twin.quirks import Quirk
from tests.twin.viscometer_quirks import (
    below_zero,
    contradicting,
    over_range,
    rotor_misnoted,
    without_dates,
    wrong_unit,
)

ROOT = Path(__file__).resolve().parents[2]
CONTEXT = Context(ViscosityConfig(), VISCOMETER, {})
INSTRUMENTS = load_config(
    ROOT / "config", {t.key: t.config for t in TECHNIQUES.values()}
).instruments
FILES = viscosity_part(SEED).files
LOG = "viscosity/sylgard-182-10to1/synthetic-1.log"
CSV = "viscosity/sylgard-182-40to1/synthetic-1.csv"


def register(files: Mapping[str, bytes] = FILES) -> dict[str, Specimen]:
    data = files["viscosity/specimens.csv"]
    found = read_register(data, "viscosity/specimens.csv", "twin", "viscosity", (), {})
    assert found.errors == ()
    return {str(s.file): s for s in found.specimens}


def context_of(row: Specimen) -> Context[ViscosityConfig]:
    """The viscometer that the configuration declares under the name in the register."""
    return replace(CONTEXT, machine=INSTRUMENTS.machine(row.notes["instrument"]))


def read(path: str, files: Mapping[str, bytes] = FILES) -> Recording:
    file = RawFile(path, files[path])
    return detect(file).read(file)


def spoilt(path: str, quirk: Quirk) -> Measurement[Run]:
    files = quirk(FILES)
    return viscosity.TECHNIQUE.reduce(register(files)[path], read(path, files), CONTEXT)


@pytest.fixture(scope="module")
def measurements() -> dict[str, Measurement[Run]]:
    """Every run of the committed seed, reduced from its file."""
    return {
        path: viscosity.TECHNIQUE.reduce(row, read(path), context_of(row))
        for path, row in register().items()
    }


@pytest.fixture(scope="module")
def summaries(measurements: dict[str, Measurement[Run]]) -> dict[str, Summary]:
    """What the room says of every material."""
    runs: dict[str, list[Measurement[Run]]] = {}
    for measured in measurements.values():
        runs.setdefault(measured.specimen.material, []).append(measured)
    return {material: viscosity.TECHNIQUE.summarise(of, CONTEXT) for material, of in runs.items()}


def law(summary: Summary, key: str = "viscosity") -> Law:
    return next(found for found in summary.laws if found.key == key)


@pytest.mark.parametrize(
    ("material", "kind", "parts"),
    [
        ("sylgard-182-10to1", "polynomial", 2),
        ("sylgard-182-40to1", "polynomial", 2),
        ("sylgard-184-10to1", "polynomial", 5),
        ("sylgard-184-40to1", "polynomial", 4),
        ("sylgard-186-10to1", "power-law-fluid", (4, 3)),
        ("sylgard-186-40to1", "power-law-fluid", (2, 2)),
    ],
)
def test_table_2_comes_out_as_curves_over_1_to_12_h_within_2_percent_and_inside_its_intervals(
    summaries: dict[str, Summary], material: str, kind: str, parts: int | tuple[int, int]
) -> None:
    truth, found = true_viscosities()[material], law(summaries[material])
    assert found.kind == kind
    assert (found.parts or len(found.coefficients)) == parts
    assert found.valid == (3600.0, 43200.0)
    for rate in found.rates or (None,):
        for time_s in np.linspace(*found.valid, 60).tolist():
            true = float(truth(np.array([time_s]), np.array([rate or 1.0]))[0])
            assert found(time_s, rate).value == pytest.approx(true, rel=0.02)
            low, high = found.ci95(time_s, rate)
            assert low <= true <= high


def test_the_files_tell_which_reading_of_the_printed_exponent_is_true(
    summaries: dict[str, Summary],
) -> None:
    for material in ("sylgard-186-10to1", "sylgard-186-40to1"):
        printed = true_viscosities()[material].index
        n = law(summaries[material], "flow_index")(2 * 3600.0)
        exponent = float(np.polynomial.polynomial.polyval(2.0, printed))
        readings = {"n": exponent, "n - 1": 1.0 + exponent, "1 - n": 1.0 - exponent}
        apart = {name: abs(n.value - v) / n.standard_uncertainty for name, v in readings.items()}
        assert apart["n"] < 3
        assert min(apart["n - 1"], apart["1 - n"]) > 50


def test_a_file_holds_the_simulated_readings_over_range_apart() -> None:
    for material in true_viscosities():
        for batch in range(1, BATCHES + 1):
            run = simulate_viscosity(SEED, material, batch)
            row = next(s for s in register().values() if s.id == f"v-{material}-{batch}")
            found = read(str(row.file))
            kept = ~run.over
            assert found.columns["viscosity_Pas"] == pytest.approx(run.viscosity_Pas[kept])
            assert found.columns["torque"] == pytest.approx(run.torque[kept])
            assert found.columns["speed_rpm"].tolist() == run.speed_rpm[kept].tolist()
            left_out = [flag for flag in found.flags if flag.name == "over-range"]
            assert bool(left_out) == bool(run.over.any())


def test_logs_are_stamped_in_three_ways_and_all_go_past_midnight(
    measurements: dict[str, Measurement],
) -> None:
    clocks = {}
    for path, measured in measurements.items():
        row = measured.specimen
        assert measured.values, path
        run = simulate_viscosity(SEED, row.material, int(row.id[-1]))
        times = run.time_s[~run.over]
        assert set(np.round(measured.curve["time_s"])) <= set(times.tolist())
        clocks[path] = set(read(path).columns) & {
            "time_s", "utc_s", "local_clock_s", "time_of_day_s",
        }  # fmt: skip
    assert clocks[LOG] == {"local_clock_s"}
    assert clocks[LOG.replace("-1.log", "-2.log")] == {"time_of_day_s"}
    assert clocks[LOG.replace("-1.log", "-3.log")] == {"utc_s"}
    assert clocks[CSV] == {"time_s"}


def test_readings_obey_the_identity_and_change_their_speed() -> None:
    run = simulate_viscosity(SEED, "sylgard-184-10to1", 1)
    kept = ~run.over
    full = 2.0 * 60.0 / run.speed_rpm[kept]
    assert np.abs(run.viscosity_Pas[kept] / full - run.torque[kept]).max() < 0.001
    assert len(set(run.speed_rpm)) >= 5
    assert run.over.sum() >= 4


def test_every_row_says_that_it_is_synthetic() -> None:
    rows = list(csv.DictReader(io.StringIO(FILES["viscosity/specimens.csv"].decode())))
    assert len(rows) == 6 * BATCHES
    assert {row["comment"] for row in rows} == {"SYNTHETIC: simulated, not measured"}
    for path, data in FILES.items():
        if not path.endswith("specimens.csv"):
            assert data.startswith(b"# SYNTHETIC: simulated, not measured\n")
    assert {row["instrument"] for row in rows if row["material"] != ON_STRONGER_SPRING} == {
        "simulated NDJ-8S"
    }
    assert {row["instrument"] for row in rows if row["material"] == ON_STRONGER_SPRING} == {
        "simulated RV-type viscometer, full scale 10.669 times that of an NDJ-8S"
    }


def test_the_same_seed_gives_the_same_run_and_another_does_not() -> None:
    once, again = (simulate_viscosity(SEED, "sylgard-182-10to1", 1) for _ in range(2))
    assert once.viscosity_Pas.tolist() == again.viscosity_Pas.tolist()
    other = simulate_viscosity(SEED + 1, "sylgard-182-10to1", 1)
    assert once.viscosity_Pas.tolist() != other.viscosity_Pas.tolist()
    with pytest.raises(MissingProperty, match="the twin knows no viscosity of ecoflex"):
        simulate_viscosity(SEED, "ecoflex", 1)


def test_186_10to1_is_beyond_an_ndj_8s_and_within_the_stronger_spring() -> None:
    truth = true_viscosities()[ON_STRONGER_SPRING]
    rate = np.array([RATE_PER_RPM_PER_S * 0.3])
    end = truth(np.array([12 * 3600.0]), rate)[0]
    assert end / full_scale_Pas(4, 0.3) == pytest.approx(6.5, abs=0.1)
    assert truth(np.array([6.0 * 3600.0]), rate)[0] > full_scale_Pas(4, 0.3)
    assert end / full_scale_Pas(4, 0.3, STRONGER.spring_torque) == pytest.approx(0.61, abs=0.01)
    run = simulate_viscosity(SEED, ON_STRONGER_SPRING, 1)
    kept = ~run.over
    assert sorted(set(run.rotor.tolist())) == [3, 4]
    full = np.array(
        [
            full_scale_Pas(int(r), s, STRONGER.spring_torque)
            for r, s in zip(run.rotor[kept].tolist(), run.speed_rpm[kept].tolist(), strict=True)
        ]
    )
    assert np.abs(run.viscosity_Pas[kept] / full - run.torque[kept]).max() < 0.0006


def test_the_configuration_declares_the_viscometers_that_the_twin_simulates() -> None:
    for row in register().values():
        declared = context_of(row).machine.model_dump(exclude={"match", "source", "entry", "held"})
        assert declared == machine_of(row.material).model_dump(exclude={"match", "source"})


def test_the_stronger_spring_taken_for_an_ndj_8s_is_refused() -> None:
    path = f"viscosity/{ON_STRONGER_SPRING}/synthetic-1.log"
    measured = viscosity.TECHNIQUE.reduce(register()[path], read(path), CONTEXT)
    assert measured.values == ()
    assert measured.refusals[0].reason.startswith(
        "viscosity, torque and speed contradict each other in "
    )


@pytest.mark.parametrize(
    ("quirk", "said"),
    [
        (over_range(LOG, 20), "over-range: "),
        (below_zero(LOG, 20), "below-zero: 1 readings left out: lines 20"),
        (
            contradicting(LOG, 20),
            "contradicting: viscosity, torque and speed disagree: 1 readings left out, lines 20",
        ),
    ],
)
def test_single_faults_are_left_out_by_line(quirk: Quirk, said: str) -> None:
    measured = spoilt(LOG, quirk)
    flags = [str(flag) for flag in measured.values[0].flags] + [
        str(flag) for flag in read(LOG, quirk(FILES)).flags
    ]
    assert any(flag.startswith(said) for flag in flags)
    assert 20 not in measured.curve["line"]
    plain = viscosity.TECHNIQUE.reduce(register()[LOG], read(LOG), CONTEXT)
    assert len(measured.curve["line"]) == len(plain.curve["line"]) - 1


def test_dates_that_are_missing_change_nothing() -> None:
    plain = viscosity.TECHNIQUE.reduce(register()[LOG], read(LOG), CONTEXT)
    undated = spoilt(LOG, without_dates(LOG))
    assert undated.curve["time_s"] == pytest.approx(plain.curve["time_s"])
    assert [v.quantity for v in undated.values] == [v.quantity for v in plain.values]


def test_a_wrong_rotor_and_a_wrong_unit_are_refused() -> None:
    for path, quirk in ((LOG, rotor_misnoted(LOG, 2)), (CSV, wrong_unit(CSV))):
        measured = spoilt(path, quirk)
        assert measured.values == ()
        assert measured.refusals[0].reason.startswith(
            "viscosity, torque and speed contradict each other in "
        )


def test_a_worse_calibration_widens_the_shared_part_alone() -> None:
    path = CSV
    worse = replace(CONTEXT, machine=VISCOMETER.model_copy(update={"u_torque_calibration": 0.01}))
    a, b = (
        viscosity.TECHNIQUE.reduce(register()[path], read(path), c).values[1]
        for c in (CONTEXT, worse)
    )
    assert b.quantity.u_shared == pytest.approx(4.0 * a.quantity.u_shared, rel=0.05)
    assert b.quantity.u_independent == pytest.approx(a.quantity.u_independent, rel=0.05)
