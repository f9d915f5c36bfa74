"""Promises of the nanoindentation room, on simulated (synthetic) indents and on a real one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pipeline.core.config import load_config
from pipeline.core.instruments import Machine
from pipeline.core.quantity import Quantity
from pipeline.core.records import FloatArray, Measurement, Recording, Summary
from pipeline.core.register import read_register
from pipeline.core.technique import Context
from pipeline.formats.detect import detect
from pipeline.formats.hysitron import FORMAT
from pipeline.formats.rawfile import RawFile
from pipeline.techniques import TECHNIQUES
from pipeline.techniques.nanoindentation import MODULUS, TECHNIQUE
from pipeline.twin.nanoindentation import (
    SPECIMENS,
    TOO_SOFT,
    nanoindentation_part,
    true_modulus,
)
from tests.conftest import ROOT
from tests.techniques.curves import EXACT, lengths
from tests.techniques.indents import (
    BERKOVICH,
    FLAT,
    SPHERE,
    elastic,
    law,
    pyramid,
    recording,
    reduce,
    specimen,
    twin,
)

MODULUS_Pa = 1e6
CONTEXT = Context(TECHNIQUE.config(), EXACT, {})
FLAT_CURVE = elastic(*law(MODULUS_Pa, "flat", 50e-6), 1e-6)
SPHERE_CURVE = elastic(*law(MODULUS_Pa, "spherical", 150e-6), 4e-6)


def flags(measurement: Measurement) -> list[str]:
    return [str(flag) for flag in measurement.values[0].flags]


def reason(measurement: Measurement) -> str:
    (refusal,) = measurement.refusals
    assert measurement.values == ()
    assert (refusal.key, refusal.material, refusal.specimen) == (MODULUS, "m", "n2")
    return refusal.reason


def noisy(curve: tuple[FloatArray, FloatArray], sd_N: float) -> tuple[FloatArray, FloatArray]:
    depth, force = curve
    return depth, force + np.random.default_rng(0).normal(0.0, sd_N, force.size)


# --- values


@pytest.mark.parametrize(("tip", "curve"), [(FLAT, FLAT_CURVE), (SPHERE, SPHERE_CURVE)])
def test_an_exact_loading_gives_its_modulus_and_no_flag(
    tip: tuple[dict[str, str], dict[str, Quantity]], curve: tuple[FloatArray, FloatArray]
) -> None:
    measured = reduce(tip, curve, u_poisson_ratio=0.0)
    (value,) = measured.values
    assert value.quantity.value == pytest.approx(MODULUS_Pa, rel=1e-6)
    assert value.quantity.standard_uncertainty < 10.0
    assert value.flags == ()
    assert value.diagnostics["contact_depth_reading_m"] == pytest.approx(2e-7, abs=1e-12)
    assert value.diagnostics["tilt_in_air_N_per_m"] == pytest.approx(0.1, rel=1e-4)
    assert measured.curve["depth_m"][0] == pytest.approx(-1.2e-6, abs=1e-11)
    assert np.abs(measured.curve["force_N"][:50]).max() < 1e-11
    # the whole loading up to 95 % of the peak, with the lines of the file that hold it
    first, last = value.lines or (0, 0)
    assert first == 9
    assert 9 + 285 < last < 9 + 300


def test_an_exact_unloading_of_a_pyramid_gives_its_modulus() -> None:
    measured = reduce(BERKOVICH, pyramid(7e10, 3e-3), u_poisson_ratio=0.0)
    (value,) = measured.values
    assert value.quantity.value == pytest.approx(7e10, rel=1e-5)
    assert value.diagnostics["unloading_exponent"] == pytest.approx(1.5, rel=1e-5)
    lines = {c.source: c.u / value.quantity.value for c in value.budget if c.shared}
    assert lines == pytest.approx(
        {"area function of the tip": 0.01, "pyramid against cone (beta)": 0.015}, rel=1e-6
    )


def test_the_stated_error_of_a_pyramid_is_that_of_the_scatter() -> None:
    rng = np.random.default_rng(3)
    depth, force = pyramid(7e10, 3e-3)
    pulls = []
    for _ in range(150):
        shaken = (
            depth + rng.normal(0.0, 2e-10, depth.size),
            force + rng.normal(0.0, 2e-7, force.size),
        )
        quantity = reduce(BERKOVICH, shaken).values[0].quantity
        pulls.append((quantity.value - 7e10) / quantity.u_independent)
    assert abs(np.mean(pulls)) < 0.3
    assert 0.83 < np.std(pulls) < 1.17


def test_an_elastic_pyramid_on_an_elastomer_agrees_within_its_uncertainty() -> None:
    """Loading and unloading of a cone of equal area, P = 2/pi E* tan(70.32 deg) h^2, are one."""
    reduced = MODULUS_Pa / (1.0 - 0.49**2)
    stiffness = 2.0 / math.pi * reduced * math.tan(math.radians(70.32))
    curve = noisy(elastic(stiffness, 2.0, math.sqrt(100e-6 / stiffness)), 1e-7)
    (value,) = reduce(BERKOVICH, curve).values
    assert value.diagnostics["unloading_exponent"] == pytest.approx(2.0, abs=0.05)
    assert value.quantity.value == pytest.approx(MODULUS_Pa, rel=0.03)
    assert abs(value.quantity.value - MODULUS_Pa) < 2.0 * value.quantity.standard_uncertainty


def test_an_area_function_is_a_sum_of_falling_powers() -> None:
    """The ideal area written with a second, small term changes the modulus by half of it."""
    curve = pyramid(7e10, 3e-3)
    plain = reduce(BERKOVICH, curve)
    depth = float(plain.values[0].diagnostics["contact_depth_m"])
    blunt = reduce(BERKOVICH, curve, area_function=(24.5, 24.5 * 0.02 * depth))
    ratio = blunt.values[0].quantity.value / plain.values[0].quantity.value
    assert ratio == pytest.approx(1.02**-0.5, rel=1e-6)
    assert "ideal-tip-area" in flags(plain)[0]
    assert not any("ideal-tip-area" in flag for flag in flags(blunt))
    assert "it was calibrated for other depths" in reason(
        reduce(BERKOVICH, curve, area_function=(-24.5,))
    )


def test_poissons_ratio_and_its_uncertainty_are_declared() -> None:
    half, third = (reduce(SPHERE, SPHERE_CURVE, poisson_ratio=nu) for nu in (0.5, 0.3))
    ratio = third.values[0].quantity.value / half.values[0].quantity.value
    assert ratio == pytest.approx(0.91 / 0.75, rel=1e-9)
    (line,) = [c for c in half.values[0].budget if c.source == "Poisson's ratio"]
    assert line.shared
    assert line.u / half.values[0].quantity.value == pytest.approx(0.005 / 0.75, rel=1e-9)
    assert "nu = 0.5 declared and a rigid tip" in half.values[0].method


@pytest.mark.parametrize(
    ("tip", "curve", "load", "depth", "radius"),
    [(FLAT, FLAT_CURVE, 1.0, 1.0, 1.0), (SPHERE, SPHERE_CURVE, 1.0, 1.5, 0.5)],
)
def test_calibrations_and_the_tip_are_shared(
    tip: tuple[dict[str, str], dict[str, Quantity]],
    curve: tuple[FloatArray, FloatArray],
    load: float,
    depth: float,
    radius: float,
) -> None:
    notes, numbers = tip
    told = {**numbers, "tip_radius_m": replace(numbers["tip_radius_m"], u_independent=1e-6)}
    machine = Machine(u_force_calibration=0.01, u_displacement_calibration=0.02)
    (value,) = reduce((notes, told), curve, machine).values
    shared = {c.source: c.u / value.quantity.value for c in value.budget if c.shared}
    assert shared["load calibration"] == pytest.approx(0.01 * load, rel=1e-6)
    assert shared["depth calibration"] == pytest.approx(0.02 * depth, rel=1e-6)
    part = 1e-6 / numbers["tip_radius_m"].value
    assert shared["tip radius"] == pytest.approx(radius * part, rel=1e-6)


def test_only_the_first_indent_after_the_farthest_retraction_counts() -> None:
    """A surface search before the indent, and a hold at its peak, change nothing."""
    depth, force = SPHERE_CURVE
    search = np.linspace(1e-7, -1e-6, 40, endpoint=False)
    touch = 3e-7 + 0.1 * search + 1e-6 * (search > 5e-8)
    held = np.full(30, depth.max())
    longer = np.concatenate([search, depth[:300], held, depth[300:]])
    loads = np.concatenate([touch, force[:300], np.full(30, force.max()), force[300:]])
    plain, more = reduce(SPHERE, (depth, force)).values, reduce(SPHERE, (longer, loads)).values
    assert more[0].quantity.value == pytest.approx(plain[0].quantity.value, rel=1e-6)
    assert (more[0].lines or (0, 0))[0] == (plain[0].lines or (0, 0))[0] + 40


# --- refusals


@pytest.mark.parametrize(
    ("tip", "message"),
    [
        (
            ({}, SPHERE[1]),
            "the register does not say which tip was used; fill in `tip`: flat, spherical, "
            "berkovich",
        ),
        (
            ({"tip": "cube corner"}, SPHERE[1]),
            "the register's tip is 'cube corner'; the laws are known for flat, spherical, berkovich",
        ),
        (
            ({"tip": "flat"}, lengths(height_m=5e-3)),
            "the register gives no tip_radius of this specimen; fill in its column (tip_radius_mm)",
        ),
    ],
)
def test_a_tip_that_is_not_declared_is_refused(
    tip: tuple[Mapping[str, str], Mapping[str, Quantity]], message: str
) -> None:
    assert reason(reduce(tip, SPHERE_CURVE)) == message


def test_a_specimen_without_file_or_depth_is_refused() -> None:
    made = TECHNIQUE.reduce(specimen(*SPHERE), None, CONTEXT)
    assert reason(made) == ("the register names no data file for this specimen; fill in `file`")
    bare = Recording({"force_N": SPHERE_CURVE[1]}, {}, {}, recording(*SPHERE_CURVE).source)
    assert reason(TECHNIQUE.reduce(specimen(*SPHERE), bare, CONTEXT)) == (
        "the file has no column that is depth_m; export depth and load"
    )


def test_an_indent_into_air_is_refused() -> None:
    depth = SPHERE_CURVE[0]
    assert reason(reduce(SPHERE, noisy((depth, 0.3 * depth), 1e-7))) == (
        "no contact, or a specimen too soft to feel: over 5.2 um of approach the load keeps to a "
        "straight line within 0.101 uN, its noise being 0.101 uN; find the surface again, or use "
        "a larger tip"
    )


def test_a_load_lost_in_its_noise_is_refused() -> None:
    curve = noisy(elastic(*law(MODULUS_Pa / 200, "spherical", 150e-6), 4e-6), 4e-8)
    assert reason(reduce(SPHERE, curve)) == (
        "no contact, or a specimen too soft to feel: the load rises by 0.743 uN, 18 times its noise "
        "of 0.0409 uN, and 20 times are needed; indent deeper or use a larger tip"
    )


def test_a_stiffness_that_is_not_known_well_enough_is_refused() -> None:
    depth, force = noisy(SPHERE_CURVE, 3e-6)
    few = slice(0, 300, 9)
    assert reason(
        reduce(SPHERE, (depth[few], force[few]), min_air_samples=3, max_relative_uncertainty=0.01)
    ) == (
        "the stiffness of the contact is known to 3.4 % only (1 % is allowed), its contact point to "
        "0.115 um in 3.73 um of depth; indent deeper, start farther above the surface or sample "
        "longer"
    )


@pytest.mark.parametrize(
    ("travel", "asked", "message"),
    [
        (
            5e-6,
            None,
            "too soft for this transducer: the test ended at 179 uN and 4.95 um deep of 5 um "
            "travel; use a larger tip, a transducer of longer travel or a lower peak load",
        ),
        (
            5e-6,
            300e-6,
            "too soft for this transducer: the test ended at 179 uN of the 300 uN that it was to "
            "reach and 4.95 um deep of 5 um travel; use a larger tip, a transducer of longer travel "
            "or a lower peak load",
        ),
        (
            None,
            300e-6,
            "too soft for this transducer: the test ended at 179 uN of the 300 uN that it was to "
            "reach and 4.95 um deep; use a larger tip, a transducer of longer travel or a lower "
            "peak load",
        ),
        (5e-6, 170e-6, None),
        (6e-6, None, None),
    ],
)
def test_a_test_that_the_transducer_could_not_finish_is_refused(
    travel: float | None, asked: float | None, message: str | None
) -> None:
    curve = elastic(*law(MODULUS_Pa * 0.8, "spherical", 150e-6), 4.75e-6)
    notes, numbers = SPHERE
    if asked is not None:
        numbers = {**numbers, "peak_load_N": Quantity(asked, "N")}
    machine = Machine(u_force_calibration=0.0, u_displacement_calibration=0.0, max_travel_m=travel)
    measured = reduce((notes, numbers), curve, machine)
    if message is None:
        assert measured.values[0].quantity.value == pytest.approx(0.8 * MODULUS_Pa, rel=1e-5)
    else:
        assert reason(measured) == message


def test_a_recording_that_starts_in_contact_is_refused() -> None:
    depth, force = SPHERE_CURVE
    assert reason(reduce(SPHERE, (depth[75:], force[75:]))).startswith(
        "the load rises from the start: fewer than 10 samples lie in air before the contact point"
    )


def test_a_pyramid_without_unloading_or_contact_is_refused() -> None:
    depth, force = pyramid(7e10, 3e-3)
    assert reason(reduce(BERKOVICH, (depth[:365], force[:365]))).endswith(
        "samples in 40-95 % of the peak load of the unloading, 20 are needed; record the unloading, "
        "or sample it faster"
    )
    assert reason(reduce(BERKOVICH, (depth[60:], force[60:]))).startswith(
        "the load rises from the start"
    )


# --- flags


def test_another_tip_than_the_declared_one_shows() -> None:
    said = (
        "the load follows the law of a spherical tip within 0.102 uN, that of the declared flat one "
        "within 3.34 uN; check the tip in the register"
    )
    assert reason(reduce(FLAT, noisy(SPHERE_CURVE, 1e-7))) == said
    assert "law of a flat tip" in reason(reduce(SPHERE, noisy(FLAT_CURVE, 1e-7)))
    lenient = reduce(FLAT, noisy(SPHERE_CURVE, 1e-7), max_relative_uncertainty=10.0)
    assert f"another-tip-fits-better: {said}" in flags(lenient)


def test_a_contact_that_is_not_small_is_flagged() -> None:
    small = {"tip": "spherical"}, lengths(tip_radius_m=20e-6, height_m=1e-4)
    curve = elastic(*law(MODULUS_Pa, "spherical", 20e-6), 4e-6)
    assert flags(reduce(small, curve)) == [
        "deep-indentation: 3.86 um are 19.3 % of the tip's radius; Hertz's law holds for small "
        "depths (10 %)"
    ]
    thin = {"tip": "flat"}, lengths(tip_radius_m=50e-6, height_m=4e-4)
    assert flags(reduce(thin, FLAT_CURVE)) == [
        "finite-height: a depth of 0.948 um and a contact radius of 50 um on a specimen 400 um high: "
        "what lies below is felt and the modulus comes out too large (10 % are allowed)"
    ]
    unknown = {"tip": "flat"}, lengths(tip_radius_m=50e-6)
    assert flags(reduce(unknown, FLAT_CURVE)) == [
        "height-unknown: the register gives no height: what lies below may be felt"
    ]


def test_a_tip_that_is_held_back_is_flagged() -> None:
    depth, force = (column.copy() for column in SPHERE_CURVE)
    leaving = slice(540, 560)
    force[leaving] -= 2e-5
    assert flags(reduce(SPHERE, (depth, force))) == [
        "adhesion: the tip was held back by 20 uN on its way out, 12 % of the peak load; a law "
        "without adhesion takes the contact for smaller than it was and the modulus for larger"
    ]


def test_a_loading_that_departs_from_its_law_is_flagged() -> None:
    depth, force = SPHERE_CURVE
    wavy = force + 5e-7 * np.sin(depth * 3e6)
    assert any(
        flag.startswith("few-independent-samples") for flag in flags(reduce(SPHERE, (depth, wavy)))
    )


# --- means, the twin, the figure


@pytest.mark.parametrize("material", ["sylgard-184-10to1", "sylgard-182-20to1"])
def test_intervals_cover_the_truth_as_often_as_they_say(material: str) -> None:
    """200 simulated campaigns of five specimens, a flat tip and a sphere."""
    truth = true_modulus(material).value
    covered, ratios = 0, []
    for seed in range(200):
        measured = [twin(seed, material, number)[0] for number in range(1, SPECIMENS + 1)]
        (record,) = TECHNIQUE.summarise(measured, CONTEXT).records
        assert record.n == SPECIMENS
        covered += record.ci95[0] <= truth <= record.ci95[1]
        ratios.append(record.quantity.value / truth)
    assert 0.905 <= covered / 200 <= 0.985  # 3 standard errors about 95 %
    assert abs(np.mean(ratios) - 1.0) < 4.0 * 0.022 / math.sqrt(200)


def test_the_files_of_seed_2022_give_the_truth_back_or_are_refused() -> None:
    """The whole way of a file: register, reader, declared machine and gauges, room, mean."""
    files = nanoindentation_part(2022).files
    config = load_config(ROOT / "config", {t.key: t.config for t in TECHNIQUES.values()})
    folder = "c/nanoindentation"
    register = read_register(
        files["nanoindentation/specimens.csv"], f"{folder}/specimens.csv", "c", TECHNIQUE.key,
        TECHNIQUE.required, config.instruments.gauges, TECHNIQUE.register,
    )  # fmt: skip
    measured: dict[str, list[Measurement]] = {}
    for row in register.specimens:
        file = RawFile(row.file or "", files[(row.file or "").removeprefix("c/")])
        machine = config.instruments.machine(row.notes["instrument"])[1]
        assert machine.max_travel_m == 5e-6
        context = Context(TECHNIQUE.config(), machine, {})
        made = TECHNIQUE.reduce(row, detect(file).read(file), context)
        measured.setdefault(row.material, []).append(made)
    for material, members in measured.items():
        summary = TECHNIQUE.summarise(members, CONTEXT)
        if material in TOO_SOFT:
            assert (summary.records, len(summary.refusals)) == ((), 3)
            continue
        (record,) = summary.records
        low, high = record.ci95
        assert low <= true_modulus(material).value <= high
        assert record.flags == ()
        assert {origin.reader for origin in record.origins} == {"hysitron@1"}
    assert len(measured) == 6


@pytest.mark.parametrize("material", TOO_SOFT)
def test_what_was_too_soft_in_the_paper_is_refused(material: str) -> None:
    for seed in range(5):
        measured, _ = twin(seed, material, 1)
        (refusal,) = measured.refusals
        assert refusal.reason.startswith("too soft for this transducer: the test ended at ")
        assert " of the 50 uN that it was to reach and " in refusal.reason
        assert refusal.diagnostics["deepest_m"] == pytest.approx(5e-6, rel=0.01)
    summary = TECHNIQUE.summarise([measured], CONTEXT)
    assert (summary.records, len(summary.refusals)) == ((), 1)


def test_a_mean_keeps_the_shared_part_whole() -> None:
    measured = [twin(7, "sylgard-184-10to1", number)[0] for number in range(1, 6)]
    (record,) = TECHNIQUE.summarise(measured, CONTEXT).records
    own = measured[0].values[0].quantity
    assert record.quantity.u_shared == pytest.approx(own.u_shared, rel=0.1)
    assert record.bound == "exact"
    assert record.conditions == {"age": "after cure"}
    (backwards,) = TECHNIQUE.summarise(measured[::-1], CONTEXT).records
    assert backwards == record


class Axes:
    """Remembers what was drawn."""

    def __init__(self) -> None:
        self.lines: list[tuple[Any, Any]] = []
        self.labels: list[str] = []
        self.names: list[object] = []

    def plot(self, x: Any, y: Any, **style: object) -> None:
        self.lines.append((x, y))
        self.names += [style["label"]] if "label" in style else []

    def set_xlabel(self, text: str) -> None:
        self.labels.append(text)

    def set_ylabel(self, text: str) -> None:
        self.labels.append(text)


def test_the_figure_shows_curve_and_law_from_contact() -> None:
    assert TECHNIQUE.figure is not None
    axes = Axes()
    TECHNIQUE.figure(axes, [reduce(SPHERE, SPHERE_CURVE)], Summary(()))
    (_, load), (depth, fitted) = axes.lines
    assert depth[-1] == pytest.approx(4.0, rel=1e-5)
    assert fitted[-1] == pytest.approx(float(load.max()), rel=1e-4)
    assert axes.labels == ["depth from contact [um]", "load [uN]"]
    stiff = Axes()
    TECHNIQUE.figure(stiff, [reduce(BERKOVICH, pyramid(7e10, 3e-3))], Summary(()))
    assert len(stiff.lines) == 1
    refused = Axes()
    bare = reduce(({}, SPHERE[1]), SPHERE_CURVE)
    nothing = TECHNIQUE.reduce(specimen(*SPHERE), None, CONTEXT)
    TECHNIQUE.figure(refused, [bare, nothing], Summary(()))
    assert refused.lines[0][0] == pytest.approx(1e6 * SPHERE_CURVE[0])
    assert refused.names == ["n2, refused: as read"]
    assert stiff.labels[0] == "depth from contact [nm]"


# --- a real indent


@pytest.mark.shared
def test_real_steel_gives_the_modulus_of_a_metal_and_is_flagged(shared: Path) -> None:
    path = shared / "real" / "nanoindentation" / "hysitron" / "RobinSteel0000LC.txt"
    file = FORMAT.read(RawFile(path.name, path.read_bytes()))
    steel = specimen({"tip": "berkovich"}, {})
    context = Context(TECHNIQUE.config(poisson_ratio=0.3, u_poisson_ratio=0.01), Machine(), {})
    measured = TECHNIQUE.reduce(steel, file, context)
    (value,) = measured.values
    # 218 GPa for a rigid tip; pile-up makes an indent into steel look some 20 % too stiff
    assert value.quantity.value == pytest.approx(218e9, rel=0.01)
    assert value.diagnostics["contact_depth_reading_m"] == pytest.approx(-1.2e-9, abs=1e-9)
    assert value.diagnostics["contact_depth_m"] == pytest.approx(150e-9, rel=0.01)
    load, depth = file.columns["force_N"], file.columns["depth_m"]
    back = np.arange(load.size) > 3302
    inside = back & (load >= 0.4 * load.max()) & (load <= 0.95 * load.max())
    # the secant of 40-95 % that was computed elsewhere (179.53 uN/nm); the tangent is steeper
    secant = np.polyfit(depth[inside], load[inside], 1)[0]
    assert secant == pytest.approx(179.53e3, rel=1e-4)
    assert value.diagnostics["unloading_stiffness_N_per_m"] == pytest.approx(
        1.153 * secant, rel=0.01
    )
    (record,) = TECHNIQUE.summarise([measured], context).records
    names = [flag.name for flag in record.flags]
    assert names == [
        *("ideal-tip-area", "tip-not-rigid", "height-unknown", "single-specimen", "implausible"),
    ]
    assert any("20.9 % of 1/E* is the tip's" in str(flag) for flag in record.flags)
