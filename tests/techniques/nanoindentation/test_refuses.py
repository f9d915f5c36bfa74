"""What the nanoindentation room refuses or flags, on simulated (synthetic) indents."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording
from deamat.techniques.nanoindentation import TECHNIQUE
from tests.techniques.curves import lengths
from tests.techniques.nanoindentation.indents import (
    BERKOVICH,
    CONTEXT,
    FLAT,
    FLAT_CURVE,
    SPHERE,
    SPHERE_CURVE,
    MODULUS_Pa,
    elastic,
    flags,
    law,
    noisy,
    pyramid,
    reason,
    recording,
    reduce,
    specimen,
)

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
        "no contact, a specimen too soft to feel, or a record that starts in contact: over 5.2 um of "
        "approach the load keeps to a straight line within 0.101 uN, its noise being 0.101 uN; find "
        "the surface again, or use a larger tip"
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


def test_a_pyramid_without_unloading_or_contact_is_refused() -> None:
    depth, force = pyramid(7e10, 3e-3)
    assert reason(reduce(BERKOVICH, (depth[:365], force[:365]))).endswith(
        "samples in 40-95 % of the peak load of the unloading, 20 are needed; record the unloading, "
        "or sample it faster"
    )
    assert reason(reduce(BERKOVICH, (depth[60:], force[60:]))).startswith(
        "the record starts in contact, the load rises from the first sample on: fewer than 10"
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


def test_a_loading_that_departs_from_its_law_is_flagged() -> None:
    depth, force = SPHERE_CURVE
    wavy = force + 5e-7 * np.sin(depth * 3e6)
    assert any(
        flag.startswith("few-independent-samples") for flag in flags(reduce(SPHERE, (depth, wavy)))
    )
