"""Promises of the way from force and displacement to stress and strain."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deamat.core.errors import FitRefused
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording
from deamat.techniques.shared.geometry import circular_section, rectangular_section, register_length
from deamat.techniques.shared.stress_strain import StressStrain, disagreement, stress_strain
from tests.techniques.curves import recording

TRAVEL = np.linspace(0.0, 3e-3, 31)
FORCE = 2.0 + 4e3 * TRAVEL  # a preload that nobody zeroed
SECTION = circular_section({"diameter_m": Quantity(0.05, "m", 1e-5, 2e-5)})
HEIGHT = Quantity(0.03, "m", 3e-5, 0.0)


def made(file: Recording, machine: Machine | None = None) -> StressStrain:
    return stress_strain(file, SECTION, HEIGHT, "height", machine or Machine())


@pytest.mark.parametrize("travel_sign", [1.0, -1.0])
@pytest.mark.parametrize("force_sign", [1.0, -1.0])
def test_loading_is_positive_whatever_the_exporter_thinks(
    travel_sign: float, force_sign: float
) -> None:
    curve = made(recording(displacement_m=travel_sign * TRAVEL, force_N=force_sign * FORCE))
    assert curve.nominal_strain == pytest.approx(TRAVEL / 0.03, rel=1e-15)
    assert curve.nominal_stress_Pa == pytest.approx(FORCE / (math.pi * 0.025**2), rel=1e-14)


def test_signs_come_from_the_loading_not_from_what_follows() -> None:
    back = TRAVEL[::-1]
    sticking = np.append(FORCE, -5.0 * FORCE.max() * np.ones(31))  # adhesion pulls on the way back
    curve = made(recording(displacement_m=-np.append(TRAVEL, back), force_N=-sticking))
    assert curve.nominal_stress_Pa[30] > 0.0
    assert curve.nominal_strain[30] == pytest.approx(0.1)


def test_the_raw_columns_stay_as_they_were() -> None:
    travel, force = -TRAVEL, -FORCE
    made(recording(displacement_m=travel, force_N=force))
    assert np.array_equal(travel, -TRAVEL)
    assert np.array_equal(force, -FORCE)


def test_budgets_are_relative_and_follow_the_powers() -> None:
    curve = made(recording(displacement_m=TRAVEL, force_N=FORCE), Machine(force_resolution_N=0.01))
    stress = {c.source: (c.u, c.shared) for c in curve.stress_budget}
    assert stress == {
        "load cell calibration": (0.005, True),
        "diameter, reading": (pytest.approx(2 * 1e-5 / 0.05), False),
        "diameter, gauge calibration": (pytest.approx(2 * 2e-5 / 0.05), True),
    }
    strain = {c.source: (c.u, c.shared) for c in curve.strain_budget}
    assert strain == {
        "displacement calibration": (0.002, True),
        "height, reading": (pytest.approx(1e-3), False),
    }
    assert curve.stress_resolution_Pa == pytest.approx(0.01 / (math.pi * 0.025**2))


def test_a_strip_has_width_times_thickness() -> None:
    section = rectangular_section(
        {"width_m": Quantity(6e-3, "m", 6e-5), "thickness_m": Quantity(3e-3, "m", 0.0, 9e-5)}
    )
    assert section.area_m2 == pytest.approx(18e-6)
    assert [(c.source, c.shared) for c in section.budget] == [
        ("width, reading", False),
        ("thickness, gauge calibration", True),
    ]
    assert [c.u for c in section.budget] == pytest.approx([0.01, 0.03])


def test_own_columns_alone_are_used_without_geometry() -> None:
    curve = made(recording(nominal_strain=-TRAVEL / 0.03, nominal_stress_Pa=-FORCE * 500.0))
    assert curve.nominal_strain == pytest.approx(TRAVEL / 0.03)
    assert curve.nominal_stress_Pa == pytest.approx(500.0 * FORCE)
    assert curve.own is None
    assert [c.source for c in curve.stress_budget] == ["load cell calibration"]
    assert [c.source for c in curve.strain_budget] == ["displacement calibration"]
    assert "could not be checked and is in no uncertainty" in curve.basis


def test_own_columns_that_agree_pass_unnoticed_and_others_are_flagged_with_numbers() -> None:
    area = SECTION.area_m2
    inside = np.arange(5, 16)

    def flags(strain_error: float, stress_error: float) -> list[str]:
        curve = made(
            recording(
                displacement_m=TRAVEL,
                force_N=FORCE,
                nominal_strain=-strain_error * TRAVEL / 0.03,
                nominal_stress_Pa=-stress_error * FORCE / area,
            )
        )
        assert "register's cross-section" in curve.basis
        return [str(f) for f in disagreement(curve, inside, 0.01)]

    assert flags(1.0, 1.009) == []
    (flag,) = flags(1.0, 1.04)
    assert flag == (
        "own-columns-disagree: the file's own stress is 1.0400 times what force, displacement and "
        "the register's geometry give; they differ by up to 4 % of the stress there"
    )
    assert len(flags(0.5, 2.0)) == 2


@pytest.mark.parametrize(
    ("file", "message"),
    [
        (
            recording(time_s=TRAVEL, force_N=FORCE),
            (
                "a stress-strain curve needs force_N and displacement_m, or nominal_strain and "
                "nominal_stress_Pa; the file has force_N, time_s"
            ),
        ),
        (
            recording(displacement_m=0.0 * TRAVEL, force_N=FORCE),
            "displacement (or strain) is the same in all 31 samples: nothing was loaded",
        ),
        (
            recording(displacement_m=TRAVEL, force_N=np.append(FORCE[1:], np.nan)),
            "displacement, force, strain or stress holds values that are not finite",
        ),
        (
            recording(displacement_m=np.empty(0), force_N=np.empty(0)),
            "the file has no samples",
        ),
    ],
)
def test_files_that_give_no_curve(file: Recording, message: str) -> None:
    with pytest.raises(FitRefused) as error:
        made(file)
    assert str(error.value) == message


def test_lengths_must_be_there_and_positive() -> None:
    with pytest.raises(
        FitRefused, match=r"^the register gives no height of this specimen; fill in"
    ):
        register_length({}, "height_m")
    with pytest.raises(FitRefused, match=r"^the register's height_m is 0 m; a length must be pos"):
        register_length({"height_m": Quantity(0.0, "m")}, "height_m")
