"""Simulated ramps: their truth comes out of their files, and every quirk is read or named."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cache, reduce

import numpy as np
import pytest

from deamat.core.errors import ConfigError, MissingProperty, RawFileError
from deamat.core.instruments import Machine
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.records import MeasuredValue, Measurement, PropertyRecord
from deamat.core.register import read_register
from deamat.core.technique import Context
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.techniques.breakdown import TECHNIQUE
from deamat.techniques.breakdown.result import FilmTest
from deamat.twin.breakdown import (
    MATERIALS,
    SPECIMENS,
    breakdown_part,
    breakdown_truth,
    keeps_log,
    simulate_breakdown,
    true_shape,
)
from deamat.twin.draws import MACHINE, MICROMETER
from deamat.twin.part import SYNTHETIC
from deamat.twin.truth import true_value
from tests.twin.quirks import Quirk, as_utf16, cut_short
from tests.twin.ramp_quirks import (
    ended_early,
    in_volts,
    mislabelled,
    to_the_limit,
    with_flashover,
    without_current,
    without_spike,
)

DAQ = "breakdown/sylgard-182-10to1/synthetic-1.csv"
PLAIN = "breakdown/sylgard-182-30to1/synthetic-2.csv"
SETTINGS = Context(TECHNIQUE.config(), MACHINE, {})
SEED = 2022  # of the files below; the committed campaign may be of another
TRUTH = {(t.key, t.material): t.value for t in breakdown_truth()} | {
    ("weibull_shape_unbiased", m): true_shape(m) for m in MATERIALS
}


@cache
def contents() -> Mapping[str, bytes]:
    return breakdown_part(SEED).files


def rows(files: Mapping[str, bytes]) -> list[Specimen]:
    register = read_register(
        files["breakdown/specimens.csv"], "c/breakdown/specimens.csv", "c", "breakdown",
        TECHNIQUE.required, {"thickness": MICROMETER},
    )  # fmt: skip
    assert register.errors == ()
    return list(register.specimens)


def measure(specimen: Specimen, files: Mapping[str, bytes]) -> Measurement[FilmTest]:
    if specimen.file is None:
        return TECHNIQUE.reduce(specimen, None, SETTINGS)
    file = RawFile(specimen.file, files[specimen.file.removeprefix("c/")])
    return TECHNIQUE.reduce(specimen, detect(file).read(file), SETTINGS)


def summarise(measured: Sequence[Measurement[FilmTest]]) -> list[PropertyRecord]:
    summary = TECHNIQUE.summarise(measured, SETTINGS)
    assert summary.refusals == ()
    return list(summary.records)


def one(path: str, *quirks: Quirk) -> Measurement[FilmTest]:
    """Measure the specimen of one file after quirks."""
    files = reduce(lambda made, quirk: quirk(made), quirks, contents())
    (row,) = [s for s in rows(files) if s.file == f"c/{path}"]
    return measure(row, files)


def value_of(path: str, *quirks: Quirk) -> MeasuredValue:
    (value,) = one(path, *quirks).values
    return value


@pytest.mark.parametrize("material", MATERIALS)
def test_every_strength_of_table_4_lies_in_its_interval(material: str) -> None:
    files = contents()
    found = summarise([measure(s, files) for s in rows(files) if s.material == material])
    assert [r.key for r in found] == list(TECHNIQUE.yields)
    strength = true_value("breakdown_strength", material).value
    assert found[0].ci95[0] <= strength <= found[0].ci95[1]
    for record in found:
        assert record.ci95[0] <= TRUTH[record.key, material] <= record.ci95[1]
        assert record.n == SPECIMENS
        assert record.conditions["electrode_area_m2"] == pytest.approx(78.5e-6)
        assert all((o.path is not None) == keeps_log(material) for o in record.origins)


def in_memory(seed: int, material: str) -> list[Measurement[FilmTest]]:
    source = Source("x", "0" * 64, 1, 2, "utf-8", "none")
    measured = []
    for number in range(1, SPECIMENS + 1):
        ramp = simulate_breakdown(seed, material, number)
        row = Specimen(
            ramp.specimen, material, "c", "breakdown", None, None, ramp.numbers, {}, {}, "r", number
        )
        columns = {
            "time_s": ramp.time_s, "voltage_V": ramp.voltage_V, "current_A": ramp.current_A
        }  # fmt: skip
        file = Recording(columns, {}, {}, source) if keeps_log(material) else None
        measured.append(TECHNIQUE.reduce(row, file, SETTINGS))
    return measured


def test_every_interval_covers_the_truth_of_two_hundred_campaigns() -> None:
    """Two of the four compositions of each campaign by turns: 400 intervals of every key."""
    hits: Counter[str] = Counter()
    campaigns = 200
    for seed in range(campaigns):
        for material in MATERIALS[seed % 2 :: 2]:
            for record in summarise(in_memory(seed, material)):
                low, high = record.ci95
                hits[record.key] += low <= TRUTH[record.key, material] <= high
    assert set(hits) == set(TECHNIQUE.yields)
    for key, count in hits.items():
        assert 0.93 <= count / (2 * campaigns) <= 0.97, key


@pytest.mark.parametrize("material", [m for m in MATERIALS if keeps_log(m)])
def test_the_breakdown_is_found_within_one_sampling_step(material: str) -> None:
    measured = in_memory(5, material)
    error = simulate_breakdown(5, material, 1)
    gain = breakdown_part(5).calibration.voltage
    assert error.material == material
    for number, found in enumerate(measured, start=1):
        truth = simulate_breakdown(5, material, number).truth
        details = found.values[0].diagnostics
        short = (1.0 + gain) * truth["breakdown_voltage_V"] - float(details["voltage_V"])
        assert -5.0 <= short <= float(details["sampling_step_V"]) + 5.0
        assert details["end"] == "collapse"
        assert details["flashovers"] == 0


def test_the_fields_follow_the_distribution_that_is_true() -> None:
    material = MATERIALS[1]
    scale, shape = true_value("breakdown_strength", material).value, true_shape(material)
    fields = [
        simulate_breakdown(s, material, n).truth["breakdown_field"]
        for s in range(25)
        for n in range(1, 21)
    ]
    uniform = np.sort(-np.expm1(-((np.array(fields) / scale) ** shape)))
    grid = (np.arange(uniform.size) + 0.5) / uniform.size
    assert np.abs(uniform - grid).max() < 1.36 / np.sqrt(uniform.size)


def test_the_files_say_that_they_are_synthetic_and_stay_small() -> None:
    files = contents()
    assert sum(map(len, files.values())) < 2.5e6
    table = list(csv.DictReader(io.StringIO(files["breakdown/specimens.csv"].decode())))
    assert Counter(r["material"] for r in table) == dict.fromkeys(MATERIALS, SPECIMENS)
    named = {f"breakdown/{r['file']}" for r in table if r["file"]}
    assert named == set(files) - {"breakdown/specimens.csv"}
    for row in table:
        assert row["comment"] == SYNTHETIC
        assert row["instrument"].startswith("simulated")
        assert bool(row["file"]) != bool(row["breakdown_voltage_kV"])
    for path in named:
        assert files[path].startswith(f"# {SYNTHETIC}\n".encode())
    times = [measure(s, files).values[0].diagnostics for s in rows(files) if s.file]
    lives = [float(d["time_to_end_s"]) for d in times]
    assert min(lives) < 120 < np.median(lives)


def test_the_errors_are_those_that_the_core_declares() -> None:
    assert MACHINE.u_voltage_calibration == Machine().u_voltage_calibration
    gains = [breakdown_part(seed).calibration.voltage for seed in range(3)]
    assert len(set(gains)) == 3
    assert max(map(abs, gains)) < 0.02


def test_a_flashover_is_discarded_and_the_breakdown_found_all_the_same() -> None:
    plain, flashed = value_of(DAQ), value_of(DAQ, with_flashover(DAQ, 100))
    assert flashed.quantity == plain.quantity
    (flag,) = [f for f in flashed.flags if f.name == "flashover"]
    assert flag.detail.endswith("kV a part of the voltage was lost and came back; discarded")
    assert "rate-of-rise" not in {f.name for f in flashed.flags}


def test_a_specimen_that_reaches_the_limit_is_censored_there_and_stays_in_the_fit() -> None:
    files = to_the_limit(DAQ)(contents())
    limited = value_of(DAQ, to_the_limit(DAQ))
    assert limited.diagnostics["censored"] == 1
    assert limited.diagnostics["voltage_V"] == 20e3
    assert "it reached the amplifier's limit: it bore this field unbroken" in {
        f.detail for f in limited.flags
    }
    mine = [measure(s, files) for s in rows(files) if s.material == MATERIALS[0]]
    strength = summarise(mine)[0]
    assert (strength.n, strength.diagnostics["failures"]) == (20, 19)
    assert strength.diagnostics["ended by amplifier limit"] == 1


def test_an_end_without_a_breakdown_is_censored() -> None:
    value = value_of(DAQ, ended_early(DAQ, 150))
    assert (value.diagnostics["end"], value.diagnostics["censored"]) == ("file ended", 1)
    assert "right-censored" in {f.name for f in value.flags}


def test_a_collapse_without_a_spike_in_a_slow_log_is_counted_both_ways() -> None:
    """At 2 Hz the arc may lie between two samples: the interval holds both readings."""
    measured = one(DAQ, without_spike(DAQ))
    assert measured.values[0].diagnostics["end"] == "collapse without current"
    assert "end-unsure" in {f.name for f in measured.values[0].flags}
    mine = [measure(s, contents()) for s in rows(contents()) if s.material == MATERIALS[0]]
    plain = summarise(mine)[0]
    strength = summarise([measured, *mine[1:]])[0]
    assert strength.quantity.value == plain.quantity.value
    assert strength.ci95[0] == plain.ci95[0]
    assert strength.ci95[1] > plain.ci95[1]
    assert "counted-both-ways" in {f.name for f in strength.flags}


def test_a_missing_current_channel_is_flagged_and_changes_no_number() -> None:
    plain, bare = value_of(DAQ), value_of(DAQ, without_current(DAQ))
    assert bare.quantity == plain.quantity
    assert "no-current-channel" in {f.name for f in bare.flags}


def test_volts_and_kilovolts_may_be_mixed_and_a_wrong_label_is_refused() -> None:
    plain = value_of(PLAIN)
    assert value_of(PLAIN, in_volts(PLAIN)).quantity.value == pytest.approx(
        plain.quantity.value, rel=1e-9
    )
    (refusal,) = one(PLAIN, mislabelled(PLAIN)).refusals
    assert "is beyond the amplifier's 20000 V; correct the unit (V or kV)" in refusal.reason


def test_a_truncated_log_is_rejected_by_line_and_another_encoding_is_read() -> None:
    with pytest.raises(RawFileError, match="so its last number may be cut"):
        one(DAQ, cut_short(DAQ))
    assert value_of(DAQ, as_utf16(DAQ)).quantity == value_of(DAQ).quantity


def test_a_flashover_must_lie_on_the_ramp() -> None:
    with pytest.raises(ConfigError, match="a flashover in row 9999 of 'breakdown/"):
        with_flashover(DAQ, 9999)(contents())


def test_only_materials_with_a_strength_can_be_broken() -> None:
    with pytest.raises(MissingProperty, match="the twin knows no breakdown_strength"):
        simulate_breakdown(1, "sylgard-184-10to1", 1)
