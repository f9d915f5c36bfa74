"""Indentations for the tests of their room: exact ones made here, and those of the twin."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Measurement
from deamat.core.technique import Context
from deamat.techniques.nanoindentation import TECHNIQUE
from deamat.techniques.nanoindentation.config import MODULUS
from deamat.techniques.nanoindentation.result import Indent
from deamat.twin.nanoindentation import simulate_nanoindentation, tip_of
from tests.techniques.curves import EXACT, lengths, source

TRAVEL_M = 5e-6
FLAT = {"tip": "flat"}, lengths(tip_radius_m=50e-6, height_m=5e-3)
SPHERE = {"tip": "spherical"}, lengths(tip_radius_m=150e-6, height_m=5e-3)
BERKOVICH = {"tip": "Berkovich"}, lengths(height_m=5e-3)


def specimen(notes: Mapping[str, str], numbers: Mapping[str, Quantity], line: int = 2) -> Specimen:
    return Specimen(
        f"n{line}", "m", "c", "nanoindentation", "a.txt", None, numbers, {}, notes, "c/n/s.csv", line
    )  # fmt: skip


def recording(depth_m: FloatArray, force_N: FloatArray) -> Recording:
    return Recording({"depth_m": depth_m, "force_N": force_N}, {}, {}, source(depth_m.size))


def law(modulus_Pa: float, tip: str, radius_m: float, nu: float = 0.49) -> tuple[float, float]:
    """Stiffness and exponent of the loading law, written down anew."""
    reduced = modulus_Pa / (1.0 - nu**2)
    if tip == "flat":
        return 2.0 * reduced * radius_m, 1.0
    return 4.0 / 3.0 * reduced * math.sqrt(radius_m), 1.5


def elastic(
    stiffness: float, exponent: float, deepest_m: float, samples: int = 300, lift_m: float = 1e-6
) -> tuple[FloatArray, FloatArray]:
    """Depth and load of a way down and the same way up, contact at a reading of 0.2 um."""
    surface = 2e-7
    down = np.linspace(-lift_m, surface + deepest_m, samples)
    depth = np.concatenate([down, down[-2::-1]])
    return depth, 3e-7 + 0.1 * depth + stiffness * np.maximum(depth - surface, 0.0) ** exponent


def pyramid(modulus_Pa: float, peak_N: float, nu: float = 0.49) -> tuple[FloatArray, FloatArray]:
    """Depth and load of an ideal Berkovich indent whose unloading has the exponent 1.5."""
    reduced = modulus_Pa / (1.0 - nu**2)
    contact = math.sqrt(peak_N / 24.5 / (0.1 * reduced))  # as deep as a hardness of E*/10 lets it
    stiffness = 1.034 * 2.0 / math.sqrt(math.pi) * reduced * math.sqrt(24.5) * contact
    deepest = contact + 0.75 * peak_N / stiffness
    rise = peak_N / (stiffness / 1.5)
    air = np.linspace(-0.3 * deepest, 0.0, 60, endpoint=False)
    up, back = np.linspace(0.0, peak_N, 300), np.linspace(peak_N, 0.0, 300)
    depth = np.concatenate(
        [air, deepest * np.sqrt(up / peak_N), deepest - rise * (1.0 - (back / peak_N) ** (2 / 3))]
    )
    return depth, np.concatenate([np.zeros(60), up, back])


def reduce(
    tip: tuple[Mapping[str, str], Mapping[str, Quantity]],
    curve: tuple[FloatArray, FloatArray],
    machine: Machine = EXACT,
    **config: object,
) -> Measurement[Indent]:
    context = Context(TECHNIQUE.config.model_validate(config), machine, {})
    return TECHNIQUE.reduce(specimen(*tip), recording(*curve), context)


def twin(seed: int, material: str, number: int) -> tuple[Measurement[Indent], float]:
    """One simulated indentation, reduced without a file, and its specimen's own modulus."""
    test = simulate_nanoindentation(seed, material, number)
    made = Specimen(
        test.specimen, material, "c", "nanoindentation", "a.txt", None, test.numbers,
        {"age": test.age}, {"tip": tip_of(material)}, "c/n/s.csv", number + 1,
    )  # fmt: skip
    context = Context(TECHNIQUE.config(), Machine(max_travel_m=TRAVEL_M), {})
    measured = TECHNIQUE.reduce(made, recording(test.displacement_m, test.force_N), context)
    return measured, test.truth["indentation_modulus"]


MODULUS_Pa = 1e6
CONTEXT = Context(TECHNIQUE.config(), EXACT, {})
FLAT_CURVE = elastic(*law(MODULUS_Pa, "flat", 50e-6), 1e-6)
SPHERE_CURVE = elastic(*law(MODULUS_Pa, "spherical", 150e-6), 4e-6)


def flags(measurement: Measurement[Indent]) -> list[str]:
    return [str(flag) for flag in measurement.values[0].flags]


def reason(measurement: Measurement[Indent]) -> str:
    (refusal,) = measurement.refusals
    assert measurement.values == ()
    assert (refusal.key, refusal.material, refusal.specimen) == (MODULUS, "m", "n2")
    return refusal.reason


def noisy(curve: tuple[FloatArray, FloatArray], sd_N: float) -> tuple[FloatArray, FloatArray]:
    depth, force = curve
    return depth, force + np.random.default_rng(0).normal(0.0, sd_N, force.size)
