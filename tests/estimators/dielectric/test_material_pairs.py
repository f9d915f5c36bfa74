"""Every pair that a spectrometer can show of a film stands for the film's one permittivity."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.dielectric.material_pairs import MATERIAL_PAIRS, complex_permittivity

FREQUENCY = np.array([20.0, 1e3, 1e6])
STORED, LOST = np.array([3.1, 2.9, 2.8]), np.array([0.31, 0.0029, 0.028])
EPS0 = 8.8541878128e-12
PAIRS = {
    "Eps'-Eps''": (STORED, LOST),
    "Eps'-tan(delta)": (STORED, np.array([0.1, 0.001, 0.01])),
    "Eps'-Sig'": (STORED, 2.0 * math.pi * FREQUENCY * EPS0 * LOST),
    "M'-M''": ((1.0 / (STORED - 1j * LOST)).real, (1.0 / (STORED - 1j * LOST)).imag),
}


def test_there_is_a_case_for_every_pair() -> None:
    assert set(PAIRS) == set(MATERIAL_PAIRS)


@pytest.mark.parametrize("mode", PAIRS)
def test_a_pair_stands_for_the_permittivity(mode: str) -> None:
    found = complex_permittivity(mode, FREQUENCY, *PAIRS[mode])
    assert found.real == pytest.approx(STORED, rel=1e-9)
    assert -found.imag == pytest.approx(LOST, rel=1e-9)


@pytest.mark.parametrize(
    ("stored", "lost", "refused"), [(0, 0, True), (0, 1, False), (1, 0, False)]
)
def test_only_a_modulus_of_zero_in_both_parts_is_refused(
    stored: float, lost: float, refused: bool
) -> None:
    pair: tuple[FloatArray, FloatArray] = np.array([0.3, stored]), np.array([0.01, lost])
    if refused:
        with pytest.raises(FitRefused, match="an electric modulus of zero at 1000 Hz"):
            complex_permittivity("M'-M''", FREQUENCY[:2], *pair)
    else:
        assert np.isfinite(complex_permittivity("M'-M''", FREQUENCY[:2], *pair)).all()
    assert np.isfinite(complex_permittivity("Eps'-Eps''", FREQUENCY[:2], *pair)).all()
