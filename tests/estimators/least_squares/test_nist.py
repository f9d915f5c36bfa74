"""Certified values of the NIST Statistical Reference Datasets."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.rivals import polynomial as rivals
from deamat.estimators.least_squares.linear import fit_linear
from deamat.estimators.least_squares.nonlinear import fit_nonlinear
from deamat.estimators.least_squares.polynomial import fit_polynomial
from tests.estimators.least_squares.nist import MODELS, digits, predictors, problems

LINEAR = problems("linear")
NONLINEAR = problems("nonlinear")
POLYNOMIAL = sorted(set(LINEAR) - {"Longley", "NoInt1", "NoInt2"})


def design(problem: dict[str, Any]) -> np.ndarray[Any, np.dtype[np.float64]]:
    columns = list(predictors(problem).values())
    if len(problem["parameters"]) > len(columns):
        columns = [np.ones(len(problem["y"])), *columns]
    return np.stack(columns, axis=1)


@pytest.mark.parametrize("name", ["Longley", "NoInt1", "NoInt2", "Norris"])
def test_linear_fits_have_thirteen_certified_digits(name: str) -> None:
    problem = LINEAR[name]
    fit = fit_linear(design(problem), problem["y"])
    assert digits(fit.parameters, problem["parameters"]) >= 13
    assert digits(fit.standard_errors, problem["standard_errors"]) >= 13
    assert digits(fit.residual_sd, problem["residual_sd"]) >= 13


@pytest.mark.parametrize("name", POLYNOMIAL)
def test_polynomials_have_thirteen_certified_digits(name: str) -> None:
    problem = LINEAR[name]
    fit = fit_polynomial(problem["x"], problem["y"], len(problem["parameters"]) - 1)
    assert digits(fit.coefficients, problem["parameters"]) >= 13
    assert digits(fit.standard_errors, problem["standard_errors"]) >= 13
    assert digits(fit.residual_sd, problem["residual_sd"]) >= 13


@pytest.mark.parametrize("name", ["Filip", "Norris", "Pontius", "Wampler2", "Wampler5"])
def test_polynomials_are_the_exact_solution_for_the_given_floats(name: str) -> None:
    # What is missing to 15 certified digits is the rounding of the printed data, nothing else.
    x, y = np.array(LINEAR[name]["x"], float), np.array(LINEAR[name]["y"], float)
    degree = len(LINEAR[name]["parameters"]) - 1
    fit = fit_polynomial(x, y, degree)
    coefficients, errors = rivals.exact_rationals(x, y, degree)
    np.testing.assert_allclose(fit.coefficients, coefficients, rtol=5e-16)
    np.testing.assert_allclose(fit.standard_errors, errors, rtol=2e-15)


def test_the_exact_rationals_are_right_by_themselves() -> None:
    # y = 1 + 2 x + e with e orthogonal to both columns: nothing to round.
    x, y = np.array([0.0, 1.0, 2.0]), np.array([2.0, 1.0, 6.0])
    coefficients, errors = rivals.exact_rationals(x, y, 1)
    np.testing.assert_array_equal(coefficients, [1.0, 2.0])
    np.testing.assert_allclose(errors, [np.sqrt(6 * 5 / 6), np.sqrt(6 / 2)], rtol=1e-15)


@pytest.mark.parametrize(
    ("rival", "most"),
    [(rivals.numpy_polyfit, 8.5), (rivals.scaled_qr, 9.0), (rivals.raw_normal_equations, 1.0)],
)
def test_rivals_are_right_on_a_line_and_lose_digits_on_filip(rival: Any, most: float) -> None:
    line, hard = LINEAR["Norris"], LINEAR["Filip"]
    coefficients, errors = rival(np.array(line["x"], float), np.array(line["y"], float), 1)
    assert digits(coefficients, line["parameters"]) >= 11
    assert digits(errors, line["standard_errors"]) >= 11
    coefficients, _ = rival(np.array(hard["x"], float), np.array(hard["y"], float), 10)
    assert digits(coefficients, hard["parameters"]) < most


def test_powers_rounded_to_floats_cost_filip_half_its_digits() -> None:
    # The design given as floats is another problem: its condition number says how far off it is.
    problem = LINEAR["Filip"]
    vandermonde = np.vander(np.array(problem["x"], float), 11, increasing=True)
    fit = fit_linear(vandermonde, problem["y"])
    assert 1e9 < fit.condition_number < 1e10
    assert 7 < digits(fit.parameters, problem["parameters"]) < 10


# Lanczos1 has residuals of 1e-13 for data of 2.5 given to 14 digits: the standard deviation is
# one of rounding errors, and floats cannot give more than three digits of it.
STANDARD_ERROR_DIGITS = {"Lanczos1": 2.0}


@pytest.mark.parametrize("start", [0, 1])
@pytest.mark.parametrize("name", sorted(NONLINEAR))
def test_nonlinear_fits_have_ten_certified_digits_from_both_starts(name: str, start: int) -> None:
    problem, model = NONLINEAR[name], MODELS[name]
    x, y = predictors(problem), np.array(problem["y"], float)
    if name == "Nelson":  # a model of log y
        y = np.log(y)
    fit = fit_nonlinear(
        lambda b: model(b, x)[0],
        lambda b: np.stack(model(b, x)[1], axis=1),
        problem["starts"][start],
        y,
    )
    assert digits(fit.parameters, problem["parameters"]) >= 10
    least = STANDARD_ERROR_DIGITS.get(name, 9.5)
    assert digits(fit.standard_errors, problem["standard_errors"]) >= least
    assert digits(fit.residual_sd, problem["residual_sd"]) >= least
    assert fit.curvature > 0.5
    assert fit.returned >= 1


@pytest.mark.shared
@pytest.mark.parametrize("name", [*sorted(LINEAR), *sorted(NONLINEAR)])
def test_problems_are_transcribed_as_nist_prints_them(name: str, shared: Path) -> None:
    kind, problem = ("linear", LINEAR) if name in LINEAR else ("nonlinear", NONLINEAR)
    lines = (shared / "reference" / "nist" / kind / f"{name}.dat").read_text().splitlines()
    columns = [problem[name]["y"], *predictors(problem[name]).values()]
    printed = [[float(v) for v in line.split()] for line in lines[60:] if line.strip()]
    np.testing.assert_array_equal(np.stack(columns, axis=1), printed)
    numbers = {
        float(v)
        for line in lines[:60]
        for v in re.findall(r"[-+.\dE]*\d[.\dE+-]*", line)
        if _is_number(v)
    }
    for key in ("parameters", "standard_errors"):
        assert set(problem[name][key]) <= numbers
    assert problem[name]["residual_sd"] in numbers
    for start in problem[name].get("starts", []):
        assert set(start) <= numbers


def _is_number(text: str) -> bool:
    return re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", text) is not None
