from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.arrays import FloatArray
from deamat.estimators.least_squares.double_double import (
    DoubleDouble,
    add,
    divide,
    multiply,
    two_product,
    two_sum,
)

moderate = st.floats(1e-60, 1e60) | st.floats(-1e60, -1e-60)


def exact(pair: tuple[float, float]) -> Fraction:
    return Fraction(pair[0]) + Fraction(pair[1])


@given(moderate, moderate)
def test_sum_and_product_with_their_errors_are_exact(a: float, b: float) -> None:
    assert exact(two_sum(a, b)) == Fraction(a) + Fraction(b)
    assert exact(two_product(a, b)) == Fraction(a) * Fraction(b)


@given(moderate, moderate, moderate, moderate)
def test_operations_keep_a_hundred_bits(a: float, b: float, c: float, d: float) -> None:
    x, y = two_product(a, b), two_product(c, d)
    tiny = Fraction(1, 2**100)
    assert abs(exact(multiply(x, y)) - exact(x) * exact(y)) <= tiny * abs(exact(x) * exact(y))
    assert abs(exact(divide(x, y)) - exact(x) / exact(y)) <= tiny * abs(exact(x) / exact(y))
    # A sum may cancel: its error is small against the terms.
    size = abs(exact(x)) + abs(exact(y))
    assert abs(exact(add(x, y)) - exact(x) - exact(y)) <= tiny * size


def fractions(a: DoubleDouble) -> list[list[Fraction]]:
    return [
        [exact((float(h), float(w))) for h, w in zip(hs, ws, strict=True)]
        for hs, ws in zip(a.high, a.low, strict=True)
    ]


def random(rng: np.random.Generator, shape: tuple[int, int]) -> DoubleDouble:
    high: FloatArray = rng.normal(size=shape)
    return DoubleDouble(high, high * 2.0**-54 * rng.uniform(-1, 1, size=shape))


@pytest.mark.parametrize("inner", [1, 3, 500])
def test_matrix_product_keeps_ninety_five_bits(inner: int) -> None:
    rng = np.random.default_rng(inner)
    a, b = random(rng, (4, inner)), random(rng, (inner, 3))
    found = fractions(a @ b)
    left, right = fractions(a), fractions(b)
    for i in range(4):
        for j in range(3):
            wanted = sum((left[i][k] * right[k][j] for k in range(inner)), Fraction(0))
            assert abs(found[i][j] - wanted) < Fraction(inner, 2**95)
