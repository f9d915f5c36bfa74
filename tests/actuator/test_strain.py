from __future__ import annotations

from decimal import Decimal, localcontext
from typing import Any

import numpy as np
import pytest

from deamat.actuator.strain import (
    PULL_IN_DRIVE,
    amplification,
    drive,
    film_drive,
    in_plane_strain,
    paper_eq4,
    pull_in_field,
    pull_in_voltage,
    thickness_strain,
)
from deamat.core.errors import OutOfRange

UP_TO_PULL_IN = np.concatenate(
    [
        np.logspace(-15, np.log10(PULL_IN_DRIVE * 0.999), 4000),
        PULL_IN_DRIVE * (1.0 - np.logspace(-15, -3, 500)),
        [PULL_IN_DRIVE],
    ]
)


def test_the_strain_solves_its_equation_to_the_last_digits_from_nothing_to_pull_in() -> None:
    s = np.asarray(thickness_strain(UP_TO_PULL_IN))
    assert np.max(np.abs(s * (1 - s) ** 2 - UP_TO_PULL_IN) / UP_TO_PULL_IN) < 1e-14
    assert np.all(np.diff(np.asarray(thickness_strain(np.sort(UP_TO_PULL_IN)))) >= 0.0)
    assert thickness_strain(PULL_IN_DRIVE) == pytest.approx(1 / 3, abs=1e-15)


@pytest.mark.parametrize("s0", [1e-15, 1e-9, 1e-3, 0.1, 0.148])
def test_the_strain_agrees_with_forty_digits(s0: float) -> None:
    found = float(thickness_strain(s0))
    with localcontext(prec=40):
        s = Decimal(found)
        for _ in range(4):
            s -= (s * (1 - s) ** 2 - Decimal(s0)) / ((1 - s) * (1 - 3 * s))
        relative = abs(float(Decimal(found) / s - 1))
    # Near pull-in the rounding of the input itself is amplified
    assert relative < 4e-16 * (1 + float(amplification(found)) * s0 / found)


def test_scalars_and_arrays_agree_and_no_voltage_gives_no_strain() -> None:
    s0 = np.array([0.0, 1e-6, 0.05, 0.14])
    one_by_one = np.array([float(thickness_strain(float(v))) for v in s0])
    assert np.allclose(thickness_strain(s0), one_by_one, rtol=4e-16, atol=0.0)
    assert thickness_strain(0.0) == 0.0


def test_the_printed_equation_has_the_other_sign() -> None:
    """The article's discrepancy: at a drive of 0.1 it prints 0.0850 where thinning gives 0.1330."""
    assert f"{float(paper_eq4(0.1)):.4f}" == "0.0850"
    assert f"{float(thickness_strain(0.1)):.4f}" == "0.1330"
    s = np.asarray(paper_eq4(np.linspace(1e-3, 0.14, 50)))
    assert np.allclose(s * (1 + s) ** 2, np.linspace(1e-3, 0.14, 50), rtol=1e-12)


def test_amplification_is_the_slope_and_grows_without_bound() -> None:
    s0 = np.array([1e-6, 0.01, 0.1, 0.14])
    h = 1e-6 * s0
    slope = (np.asarray(thickness_strain(s0 + h)) - np.asarray(thickness_strain(s0 - h))) / (2 * h)
    assert np.allclose(amplification(thickness_strain(s0)), slope, rtol=1e-6)
    assert amplification(0.0) == 1.0
    assert amplification(thickness_strain(0.148)) == pytest.approx(40.59, abs=0.01)
    assert amplification(1 / 3) == np.inf


def test_at_the_pull_in_voltage_the_drive_is_4_27_and_the_true_field_is_the_pull_in_field() -> None:
    volts = pull_in_voltage(446e-6, 0.957e6, 2.58)
    assert film_drive(volts * (1 - 1e-15), 446e-6, 0.957e6, 2.58) == pytest.approx(4 / 27)
    true_field = volts / (446e-6 * (1 - 1 / 3))
    assert pull_in_field(0.957e6, 2.58) == pytest.approx(true_field, rel=1e-14)


def test_with_the_true_field_the_drive_is_the_strain() -> None:
    s = float(thickness_strain(film_drive(9800.0, 446e-6, 0.957e6, 2.58)))
    assert drive(2.58, 9800.0 / (446e-6 * (1 - s)), 0.957e6) == pytest.approx(s, rel=1e-14)
    # Table 5 gives 22.2 V/um on the thinned film for these 9.8 kV
    assert f"{9800.0 / (446e-6 * (1 - s)) / 1e6:.1f}" == "22.2"


def test_both_in_plane_rules_and_their_agreement_when_incompressible() -> None:
    assert in_plane_strain(0.02, 0.49, "poisson") == pytest.approx(0.0098)
    assert in_plane_strain(0.02, 0.49, "maxwell") == pytest.approx(0.01)
    assert in_plane_strain(0.02, 0.5, "poisson") == in_plane_strain(0.02, 0.5, "maxwell")


def test_above_pull_in_the_message_names_the_pull_in_voltage() -> None:
    with pytest.raises(OutOfRange) as raised:
        film_drive(np.array([1e3, 5e4]), 446e-6, 0.957e6, 2.58, "layer 3 (de)")
    assert str(raised.value) == (
        "voltage_V of layer 3 (de) is 50000 V; allowed is 0 to 35136.2 V; above the pull-in "
        "voltage the film has no equilibrium: lower the voltage, or take a thicker, stiffer or "
        "less permittive film"
    )


@pytest.mark.parametrize("bad", [0.2, -1e-3, np.nan, np.inf])
def test_a_drive_without_equilibrium_is_refused(bad: float) -> None:
    with pytest.raises(OutOfRange) as raised:
        thickness_strain(bad)
    assert str(raised.value) == (
        f"drive eps0 eps_r (V/t0)^2 / Y is {bad:g}; allowed is 0 to 0.148148; beyond 4/27 the film "
        "pulls in and has no equilibrium"
    )


def test_other_bad_input_is_refused() -> None:
    unknown: Any = "none"
    with pytest.raises(OutOfRange, match=r"^in-plane rule is 'none'; allowed are 'poisson' and"):
        in_plane_strain(0.1, 0.49, unknown)
    with pytest.raises(OutOfRange, match=r"^field_V_m is -1 V/m; allowed is 0 to 1e\+10 V/m"):
        drive(2.6, -1.0, 1e6)
    with pytest.raises(OutOfRange, match=r"^modulus_Pa is 0\.957 Pa; .*: was it given in megapas"):
        drive(2.6, 1e6, 0.957)
    with pytest.raises(OutOfRange, match=r"^thickness strain is 0\.4; allowed is 0 to 0\.333333"):
        amplification(0.4)
