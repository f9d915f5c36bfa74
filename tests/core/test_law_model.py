"""A law as an lmfit model: the same curve, its covariance, and fitted again."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.laws import FORMS, evaluate
from tests.core.test_laws import POINTS, law

X = np.linspace(1.0, 5.0, 9)
NAMES = {
    "polynomial": ["c0", "c1", "c2"],
    "exponential": ["a", "b"],
    "power-law-to-gel": ["a", "x_gel", "s"],
    "arrhenius": ["a", "E"],
    "power-law-fluid": ["K0", "K1", "n0", "n1"],
}


@pytest.mark.parametrize("kind", sorted(FORMS))
def test_the_model_is_the_law(kind: str) -> None:
    asked = law(kind)
    rate = POINTS[kind][2]
    model, parameters = asked.model()
    assert list(parameters) == model.param_names == NAMES[kind]
    rates = {} if rate is None else {"rate_per_s": rate}
    found = model.eval(parameters, x=X, **rates)
    assert found.tolist() == [asked(x, rate).value for x in X]
    covariance = np.array(asked.covariance)
    for i, name in enumerate(parameters):
        assert parameters[name].stderr == pytest.approx(covariance[i, i] ** 0.5)
        others = np.delete(covariance[i], i) / np.delete(
            np.sqrt(covariance[i, i] * np.diag(covariance)), i
        )
        assert list(parameters[name].correl) == [n for n in parameters if n != name]
        assert list(parameters[name].correl.values()) == pytest.approx(others.tolist())


@pytest.mark.parametrize("kind", sorted(FORMS))
def test_it_can_be_fitted_again(kind: str) -> None:
    coefficients, parts, rate = POINTS[kind]
    other = np.array(coefficients) * 1.05
    model, parameters = law(kind).model()
    x, rates = X, {}
    if rate is not None:  # readings at one rate cannot tell K from n
        x, rates = np.tile(X, 2), {"rate_per_s": np.repeat([0.1, 0.5], len(X))}
    each = rates["rate_per_s"] if rates else [None] * len(x)
    readings = [evaluate(kind, other, parts, t, q)[0] for t, q in zip(x, each, strict=True)]
    fitted = model.fit(readings, parameters, x=x, **rates)
    assert [p.value for p in fitted.params.values()] == pytest.approx(other, rel=1e-5)


def test_the_gel_point_lies_after_the_last_reading_and_energies_are_positive() -> None:
    bounds = {
        "power-law-to-gel": {"x_gel": pytest.approx(5.0)},
        "arrhenius": {"a": 0.0, "E": 0.0},
    }
    for kind in FORMS:
        parameters = law(kind).model()[1]
        bounded = {
            name: p.min for name, p in parameters.items() if np.isfinite([p.min, p.max]).any()
        }
        assert bounded == bounds.get(kind, {})
    parameters = law("power-law-to-gel").model()[1]
    parameters["x_gel"].value = 4.0
    assert parameters["x_gel"].value > 5.0


def test_a_coefficient_that_is_known_exactly_has_no_correlation() -> None:
    exact = law("exponential", covariance_of=0.0).model()[1]
    assert [(p.stderr, p.correl) for p in exact.values()] == [(0.0, {}), (0.0, {})]
