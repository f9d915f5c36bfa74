"""How often the intervals of the room of viscosity hold the truth: many simulated campaigns.

Run: python -m benchmarks.viscosity_coverage [campaigns] [workers] [material ...]
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace

import numpy as np

from benchmarks.coverage_truth import truth_of, viscosity_at
from deamat.core.arrays import FloatArray
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.records import Law
from deamat.core.technique import Context
from deamat.techniques import viscosity
from deamat.techniques.viscosity.config import ViscosityConfig
from deamat.twin.truth import TrueViscosity, true_viscosities
from deamat.twin.viscosity import (
    BATCHES,
    VISCOMETER,
    SimulatedRun,
    machine_of,
    simulate_viscosity,
)

CONTEXT = Context(ViscosityConfig(u_index_beyond=0.0, extrapolation_decades=4.0), VISCOMETER, {})
_CHECKED_PER_LAW = 12


def in_memory(run: SimulatedRun) -> tuple[Specimen, Recording]:
    """Register row and recording of a simulated run, as its file would give them."""
    kept = ~run.over
    columns: dict[str, FloatArray] = {
        "time_s": run.time_s[kept],
        "rotor": run.rotor[kept],
        "speed_rpm": run.speed_rpm[kept],
        "viscosity_Pas": run.viscosity_Pas[kept],
        "torque": run.torque[kept],
        "line": np.flatnonzero(kept).astype(np.float64) + 3.0,
    }
    source = Source("synthetic", "0" * 64, 3, len(kept) + 2, "utf-8", "twin")
    specimen = Specimen(
        str(run.batch), run.material, "twin", "viscosity", "synthetic", None, {}, {}, {},
        "specimens.csv", run.batch + 1,
    )  # fmt: skip
    return specimen, Recording(columns, {}, {}, source)


def one(task: tuple[int, str]) -> Counter[tuple[str, str, bool]]:
    """Count hits and misses of one material in one campaign: (material, key, inside)."""
    seed, material = task
    truth = true_viscosities()[material]
    runs = [in_memory(simulate_viscosity(seed, material, b)) for b in range(1, BATCHES + 1)]
    context = replace(CONTEXT, machine=machine_of(material))
    measurements = [viscosity.TECHNIQUE.reduce(*run, context) for run in runs]
    summary = viscosity.TECHNIQUE.summarise(measurements, CONTEXT)
    counts: Counter[tuple[str, str, bool]] = Counter()
    for record in summary.records:
        low, high = record.ci95
        name = f"{record.key} at {float(str(record.conditions['time_s'])) / 3600:g} h"
        counts[material, name, low <= truth_of(record, {}) <= high] += 1
    for law in summary.laws:
        if law.key == "viscosity":
            for inside in law_hits(truth, law):
                counts[material, "law", inside] += 1
            counts[material, f"form {law.kind} {len(law.coefficients)}", True] += 1
    return counts


def law_hits(truth: TrueViscosity, law: Law) -> list[bool]:
    """Whether the 95 % interval of a law holds the truth, along its range."""
    hits = []
    for rate in law.rates or (None,):
        for time_s in np.linspace(*law.valid, _CHECKED_PER_LAW).tolist():
            low, high = law.ci95(time_s, rate)
            true = viscosity_at(truth, time_s, rate or 1.0)
            hits.append(low <= true <= high)
    return hits


def main(campaigns: int, workers: int, materials: Sequence[str]) -> None:
    """Print coverage per material and key, and which forms the laws took."""
    tasks = [(seed, m) for m in materials or true_viscosities() for seed in range(1, campaigns + 1)]
    total: Counter[tuple[str, str, bool]] = Counter()
    with ProcessPoolExecutor(workers) as pool:
        for counts in pool.map(one, tasks, chunksize=5):
            total += counts
    for material, name in sorted({(m, k) for m, k, _ in total}):
        hits, misses = total[material, name, True], total[material, name, False]
        said = f"{hits / (hits + misses):7.1%}" if not name.startswith("form") else "       "
        sys.stdout.write(f"{material:20s} {name:44s} {said} of {hits + misses}\n")


if __name__ == "__main__":
    given = sys.argv[1:]
    campaigns, workers = (int(a) for a in (given[:2] + ["200", "2"][len(given[:2]) :]))
    main(campaigns, workers, given[2:])
