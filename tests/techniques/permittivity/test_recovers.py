"""From raw files to the permittivities of Table 4, and how often the intervals cover them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from deamat.core.config import load_config
from deamat.core.instruments import Machine
from deamat.core.properties import REFERENCE_AGE
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.records import PropertyRecord
from deamat.core.register import read_register
from deamat.core.technique import AnyTechnique, Context
from deamat.estimators.dielectric.impedance import loss_tangent
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.techniques import TECHNIQUES
from deamat.techniques.permittivity.config import PermittivityConfig
from deamat.twin.campaign import SEED
from deamat.twin.compression import compression_part
from deamat.twin.permittivity import (
    METER,
    U_FORCE,
    SimulatedSweep,
    permittivity_part,
    simulate_permittivity,
)
from deamat.twin.truth import materials, true_value

CONFIG = load_config(
    Path(__file__).resolve().parents[3] / "config", {k: t.config for k, t in TECHNIQUES.items()}
)
ROOM = TECHNIQUES["permittivity"]
KEY = "relative_permittivity"


def records(
    technique: AnyTechnique, files: dict[str, bytes], needs: dict[str, dict[str, Quantity]]
) -> dict[str, list[PropertyRecord]]:
    """Read, reduce and summarise one technique's files as the driver does."""
    path = f"{technique.key}/specimens.csv"
    register = read_register(
        files[path], f"c/{path}", "c", technique.key, technique.required, CONFIG.instruments.gauges
    )
    assert register.errors == ()
    config = CONFIG.methods[technique.key]
    found: dict[str, list[PropertyRecord]] = {}
    for material in materials():
        measured = []
        for s in register.specimens:
            if s.material == material and s.conditions["age"] == REFERENCE_AGE and s.file:
                file = RawFile(s.file, files[s.file.removeprefix("c/")])
                machine = CONFIG.instruments.machine(s.notes["instrument"])
                context = Context(config, machine, needs[material])
                measured.append(technique.reduce(s, detect(file).read(file), context))
        assert len(measured) == 5
        summary = technique.summarise(measured, Context(config, Machine(), {}))
        assert summary.refusals == ()
        found[material] = list(summary.records)
    return found


@pytest.fixture(scope="module")
def cards() -> dict[str, list[PropertyRecord]]:
    nothing: dict[str, dict[str, Quantity]] = {m: {} for m in materials()}
    stiffness = records(TECHNIQUES["compression"], dict(compression_part(SEED).files), nothing)
    needs = {
        m: {r.key: r.quantity for r in mine if r.key in ROOM.needs} for m, mine in stiffness.items()
    }
    return records(ROOM, dict(permittivity_part(SEED).files), needs)


@pytest.mark.parametrize("material", materials())
def test_table_4_comes_out_of_the_raw_files(
    cards: dict[str, list[PropertyRecord]], material: str
) -> None:
    record, loss = cards[material]
    truth = true_value(KEY, material).value
    assert (record.key, record.n) == (KEY, 5)
    assert record.ci95[0] <= truth <= record.ci95[1]
    assert record.quantity.value == pytest.approx(truth, rel=0.04)
    assert (record.ci95[1] - record.ci95[0]) / 2 < 0.045 * truth
    assert record.conditions["frequency_Hz"] == 10.0
    assert "eps_r falls by" in record.method
    assert 0.005 < 1 - float(record.diagnostics["relative_permittivity_10000_Hz"]) / truth < 0.06
    truths = permittivity_part(SEED).specimens
    true_loss = np.mean([truths[o.specimen]["loss_tangent"] for o in loss.origins])
    assert loss.ci95[0] <= true_loss <= loss.ci95[1]


def test_only_the_soft_films_are_called_squeezed(cards: dict[str, list[PropertyRecord]]) -> None:
    squeezed = {
        material
        for material, (record, _) in cards.items()
        if "squeezed-film" in {flag.name for flag in record.flags}
    }
    assert squeezed == {"sylgard-182-30to1", "sylgard-182-40to1"}


def test_the_simulated_meter_and_force_are_those_that_are_declared() -> None:
    machine = CONFIG.instruments.machine(
        "simulated GW Instek LCR-6020, checked against a reference capacitor"
    )
    assert (machine.entry, machine.impedance) == ("lcr-6020-checked", METER)
    assert CONFIG.instruments.machine("GW Instek LCR-6020").entry == "lcr-6020"
    assert PermittivityConfig().u_micrometer_force == U_FORCE


def _interval(sweeps: list[SimulatedSweep], modulus: Quantity) -> tuple[float, float]:
    context = Context(ROOM.config(), Machine(impedance=METER), {"compressive_modulus": modulus})
    measured = []
    for sweep in sweeps:
        columns = {
            "frequency_Hz": sweep.frequency_Hz,
            "parallel_capacitance_F": sweep.capacitance_F.real,
            "loss_tangent": loss_tangent(sweep.capacitance_F),
        }
        source = Source("x", "", 1, sweep.frequency_Hz.size, "utf-8", "twin")
        specimen = Specimen(
            sweep.specimen, sweep.material, "c", ROOM.key, "x", None, sweep.numbers, {}, {}, "r", 1
        )
        recording = Recording(columns, {"level_V": "1.0"}, {}, source)
        measured.append(ROOM.reduce(specimen, recording, context))
    summary = ROOM.summarise(measured, context)
    assert all(refused.key == "loss_tangent" for refused in summary.refusals)
    assert summary.records[0].key == KEY
    return summary.records[0].ci95


def test_the_intervals_of_200_campaigns_cover_the_truth() -> None:
    """The modulus is known to 1.3 % and, together for all materials, 0.6 %, as from compression."""
    covered = []
    for seed in range(10_000, 10_200):
        rng = np.random.default_rng(seed)
        cell = rng.normal(0.0, 0.006)
        for material in materials():
            truth = true_value("compressive_modulus", material).value
            modulus = truth * (1.0 + cell + rng.normal(0.0, 0.013))
            low, high = _interval(
                [simulate_permittivity(seed, material, n) for n in range(1, 6)],
                Quantity(modulus, "Pa", 0.013 * modulus, 0.006 * modulus),
            )
            covered.append(low <= true_value(KEY, material).value <= high)
    assert len(covered) == 1200
    assert 0.93 <= float(np.mean(covered)) <= 0.97
