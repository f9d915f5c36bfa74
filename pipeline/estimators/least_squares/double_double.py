"""Numbers as unevaluated sums of two floats: 106 significant bits from ordinary arithmetic.

A pair (high, low) stands for high + low with |low| <= ulp(high) / 2. Sums and products of floats
are then known with their rounding error, on every machine, where the 80-bit long double is a
privilege of one processor family.

Source: T. J. Dekker, Numer. Math. 18 (1971) 224 (product); D. E. Knuth, The Art of Computer
Programming 2, 4.2.2 (sum).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from deamat.core.arrays import FloatArray

Real = TypeVar("Real", float, FloatArray)

_SPLITTER = 134217729.0  # 2^27 + 1 cuts 53 bits into 26 and 26


def two_sum(a: Real, b: Real) -> tuple[Real, Real]:
    """Return fl(a + b) and its exact rounding error."""
    total = a + b
    b_seen = total - a
    return total, (a - (total - b_seen)) + (b - b_seen)


def _split(a: Real) -> tuple[Real, Real]:
    """Cut a float into two of at most 26 bits each, exactly (|a| < 1e300)."""
    shifted = a * _SPLITTER
    high = shifted - (shifted - a)
    return high, a - high


def two_product(a: Real, b: Real) -> tuple[Real, Real]:
    """Return fl(a * b) and its exact rounding error."""
    product = a * b
    a_high, a_low = _split(a)
    b_high, b_low = _split(b)
    error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
    return product, error


def add(a: tuple[Real, Real], b: tuple[Real, Real]) -> tuple[Real, Real]:
    """Return a + b, to 2^-104 of |a| + |b|."""
    high, error = two_sum(a[0], b[0])
    return two_sum(high, error + (a[1] + b[1]))


def multiply(a: tuple[Real, Real], b: tuple[Real, Real]) -> tuple[Real, Real]:
    """Return a * b, to 2^-102 relative."""
    high, error = two_product(a[0], b[0])
    return two_sum(high, error + (a[0] * b[1] + a[1] * b[0]))


def divide(a: tuple[Real, Real], b: tuple[Real, Real]) -> tuple[Real, Real]:
    """Return a / b, to 2^-100 relative: one Newton step on the float quotient."""
    quotient = a[0] / b[0]
    product, error = multiply((quotient, quotient * 0.0), b)
    remainder, rest = add(a, (-product, -error))
    return two_sum(quotient, (remainder + rest) / b[0])


@dataclass(frozen=True, slots=True)
class DoubleDouble:
    """An array of double-double numbers `high + low`, both of one shape."""

    high: FloatArray
    low: FloatArray

    @classmethod
    def exact(cls, values: FloatArray) -> DoubleDouble:
        """Take floats as they are."""
        return cls(values, np.zeros_like(values))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the array."""
        return self.high.shape

    @property
    def transposed(self) -> DoubleDouble:
        """The transposed array."""
        return DoubleDouble(self.high.T, self.low.T)

    def __getitem__(self, index: int | slice | tuple[int | slice | None, ...]) -> DoubleDouble:
        return DoubleDouble(self.high[index], self.low[index])

    def __neg__(self) -> DoubleDouble:
        return DoubleDouble(-self.high, -self.low)

    def __add__(self, other: DoubleDouble) -> DoubleDouble:
        return DoubleDouble(*add((self.high, self.low), (other.high, other.low)))

    def __sub__(self, other: DoubleDouble) -> DoubleDouble:
        return self + (-other)

    def __mul__(self, other: DoubleDouble) -> DoubleDouble:
        return DoubleDouble(*multiply((self.high, self.low), (other.high, other.low)))

    def __truediv__(self, other: DoubleDouble) -> DoubleDouble:
        return DoubleDouble(*divide((self.high, self.low), (other.high, other.low)))

    def __matmul__(self, other: DoubleDouble) -> DoubleDouble:
        """Multiply shapes (n, k) and (k, m), to about 2^-100 of the largest products of a sum.

        Both are cut into slices of so few bits that the matrix products of slices do not round,
        whatever order the sums are taken in: the fast matrix product of floats then does the work.

        Source: K. Ozaki et al., Numer. Algorithms 59 (2012) 95.
        """
        bits = (53 - self.shape[1].bit_length()) // 2
        a, a_tails = _slices(self, 1, bits)
        b, b_tails = _slices(other, 0, bits)
        high, low = a[0] @ b[0], a[0] @ b_tails[2] + a_tails[2] @ other.high
        for i, j in ((0, 1), (1, 0), (0, 2), (1, 1), (2, 0)):
            high, lost = two_sum(high, a[i] @ b[j])
            low += lost
        low += a[1] @ b_tails[1] + a[2] @ b_tails[0]
        return DoubleDouble(*two_sum(high, low))


def _slices(
    values: DoubleDouble, axis: int, bits: int
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Three slices of `bits` bits below the largest entry along an axis, and what each leaves."""
    largest = np.abs(values.high).max(axis=axis, keepdims=True)
    # Adding and taking away 1.5 * 2^e rounds to multiples of 2^(e - 52).
    anchor = np.ldexp(1.5, np.frexp(largest)[1] + (52 - bits))
    high, low = values.high, values.low
    slices, tails = [], []
    for _ in range(3):
        part = (high + anchor) - anchor
        high, low = two_sum(high - part, low)
        slices.append(part)
        tails.append(high)
        anchor = anchor * 2.0**-bits
    return slices, tails
