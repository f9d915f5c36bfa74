"""An activation energy: exact data, honest intervals of few temperatures, refusals."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import FitRefused
from deamat.core.laws import FORMS
from deamat.estimators.least_squares.arrhenius import fit_arrhenius
from deamat.estimators.mean import coverage_factor

KELVIN = np.array([283.15, 298.15, 313.15, 328.15])
TRUE = np.array([1e-4, 2.6e4])


def viscosity(kelvin: np.ndarray) -> np.ndarray:
    return FORMS["arrhenius"](TRUE, kelvin, None, ())[0]


def test_exact_data_give_their_coefficients() -> None:
    fit = fit_arrhenius(KELVIN, viscosity(KELVIN), np.full(4, 0.01))
    assert fit.coefficients == pytest.approx(TRUE, rel=1e-10)
    assert fit.dof == np.inf
    assert fit.relative_scatter == pytest.approx(0.01)
    inverse = 1.0 / (8.314462618 * KELVIN)
    u = 0.01 / np.sqrt(np.square(inverse - inverse.mean()).sum())
    assert fit.covariance[1, 1] == pytest.approx(u**2, rel=1e-9)


@pytest.mark.parametrize("temperatures", [3, 4])
def test_intervals_of_few_temperatures_hold(temperatures: int) -> None:
    kelvin, rng = KELVIN[:temperatures], np.random.default_rng(7)
    energies, values = 0, 0
    for _ in range(1000):
        y = viscosity(kelvin) * np.exp(0.02 * rng.normal(size=temperatures))
        try:
            fit = fit_arrhenius(kelvin, y, np.zeros(temperatures))
        except FitRefused:  # an interval that holds zero and everything else
            energies, values = energies + 1, values + 1
            continue
        factor = coverage_factor(fit.dof)
        off = abs(fit.coefficients[1] - TRUE[1])
        energies += off <= factor * np.sqrt(fit.covariance[1, 1])
        found, slopes = FORMS["arrhenius"](fit.coefficients, kelvin[:1], None, ())
        u = np.sqrt(slopes[0] @ fit.covariance @ slopes[0])
        values += abs(found[0] - viscosity(kelvin[:1])[0]) <= factor * u
    assert 930 <= energies <= 970
    assert 930 <= values <= 970


def test_what_is_no_activation_energy_is_refused() -> None:
    with pytest.raises(FitRefused, match="needs 3 temperatures, not 2"):
        fit_arrhenius(KELVIN[[0, 1, 1]], [3.0, 2.0, 2.1], np.zeros(3))
    with pytest.raises(FitRefused, match=r"^the activation energy, -26 -\+ "):
        fit_arrhenius(KELVIN, 1.0 / viscosity(KELVIN), np.full(4, 0.01))
    with pytest.raises(FitRefused, match="cannot be told from zero"):
        fit_arrhenius(KELVIN, np.ones(4), np.zeros(4))
    with pytest.raises(FitRefused, match="must be positive"):
        fit_arrhenius(KELVIN, [3.0, 2.0, 1.0, -1.0], np.zeros(4))
