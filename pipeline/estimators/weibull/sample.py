"""Samples of a Weibull variable: what is refused, what is warned of, and the logarithms used."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused

BoolArray = NDArray[np.bool_]
Warnings = tuple[tuple[str, str], ...]
Censoring = Literal["complete", "type II", "type I or random"]

MIN_DISTINCT = 3
MIN_SPREAD = 1e-6
MIN_RATIO = 1e-300  # below it x / max x loses digits
FEW_FAILURES = 5
COARSE_STEP = 0.5  # of a standard deviation: rounding then adds 2 % to the variance


@dataclass(frozen=True, slots=True)
class LogSamples:
    """Samples as the likelihood needs them: logarithms relative to the largest value.

    With z = ln(x / max x) no power overflows, and a sample keeps its digits in any unit.

    Parameters
    ----------
    log_ratio : z, one column a sample, shape (n, m)
    mean_failed : mean of z over the failures, shape (m,)
    failures : number r of failures, shape (m,)
    largest : max x, shape (m,)
    """

    log_ratio: FloatArray
    mean_failed: FloatArray
    failures: FloatArray
    largest: FloatArray

    def power_sums(self, shape: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return S0, S1/S0 and S2/S0 - (S1/S0)^2 with S_j = sum z^j exp(shape z), each (m,)."""
        term = np.exp(shape * self.log_ratio)
        s0 = term.sum(axis=0)
        term *= self.log_ratio
        mean = term.sum(axis=0) / s0
        term *= self.log_ratio
        return s0, mean, term.sum(axis=0) / s0 - mean * mean


def log_samples(x: FloatArray, failed: BoolArray | None) -> LogSamples:
    """Take logarithms of accepted samples, shape (m, n); `failed` None means complete."""
    columns = np.ascontiguousarray(x.T)
    largest = columns.max(axis=0)
    ratio = columns / largest
    z = np.log(ratio)
    # x - max x is exact for x > max x / 2, so log1p keeps every digit of a narrow sample
    np.log1p((columns - largest) / largest, out=z, where=ratio > 0.5)
    if failed is None:
        failures = np.full(z.shape[1], float(z.shape[0]))
        total = z.sum(axis=0)
    else:
        failures = failed.sum(axis=1, dtype=float)
        total = np.einsum("ij,ji->j", z, failed)
    return LogSamples(z, total / failures, failures, largest)


def accepted(x: FloatArray, failed: BoolArray | None) -> BoolArray:
    """Say which of m samples can be fitted: the criteria of `check_sample`, shape (m,)."""
    low, high = x.min(axis=1), x.max(axis=1)
    with np.errstate(invalid="ignore"):
        usable: BoolArray = (low > 0) & np.isfinite(high) & (low >= MIN_RATIO * high)
    if failed is None:
        between = (x != low[:, None]) & (x != high[:, None])
    else:
        low = np.where(failed, x, np.inf).min(axis=1)
        high = np.where(failed, x, 0.0).max(axis=1)
        between = failed & (x != low[:, None]) & (x != high[:, None])
    with np.errstate(invalid="ignore"):
        usable &= between.any(axis=1) & (high - low >= MIN_SPREAD * high)
    return usable


def check_sample(x: ArrayLike, censored: ArrayLike | None) -> tuple[FloatArray, BoolArray]:
    """Check one sample and give it as (values, failed), shape (n,) each.

    Raises
    ------
    FitRefused : values that are not finite and positive, fewer than 3 distinct failures, or
        failures that differ by less than 1e-6 of the largest
    """
    values, failed = as_arrays(x, censored, ndim=1)
    n = values.size
    for wrong, what in (
        (~np.isfinite(values), "not finite"),
        (~(values > 0), "not positive"),
    ):
        if wrong.any():
            first = int(np.argmax(wrong))
            raise FitRefused(
                f"{int(wrong.sum())} of {n} values are {what} (the first is value {first + 1}: "
                f"{values[first]:g}); a Weibull fit needs finite values above 0",
                {"n": n, "wrong": int(wrong.sum()), "first": first + 1},
            )
    if values.min() < MIN_RATIO * values.max():
        raise FitRefused(
            f"the values span {values.min():g} to {values.max():g}, more than 300 decades: "
            "one of them must be wrong",
            {"n": n, "smallest": float(values.min()), "largest": float(values.max())},
        )
    _check_failures(values[failed], n)
    return values, failed


def _check_failures(failures: FloatArray, n: int) -> None:
    distinct = np.unique(failures).size
    if distinct == 0:
        raise FitRefused(
            f"all {n} values are censored: nothing failed; at least {MIN_DISTINCT} distinct "
            "failures are needed",
            {"n": n, "failures": 0, "distinct": 0},
        )
    if distinct < MIN_DISTINCT:
        raise FitRefused(
            f"only {distinct} distinct failure(s) among {n} values; at least {MIN_DISTINCT} are "
            "needed: test more specimens, or read the instrument to more digits",
            {"n": n, "failures": failures.size, "distinct": distinct},
        )
    spread = float((failures.max() - failures.min()) / failures.max())
    if spread < MIN_SPREAD:
        raise FitRefused(
            f"the {failures.size} failures differ by {spread:.1e} of the largest; less than "
            f"{MIN_SPREAD:g} is rounding, not strength",
            {"n": n, "failures": failures.size, "relative_spread": spread},
        )


def as_arrays(x: ArrayLike, censored: ArrayLike | None, ndim: int) -> tuple[FloatArray, BoolArray]:
    """Bring values and censoring marks to arrays of one shape: (values, failed)."""
    values = np.asarray(x, dtype=np.float64)
    if values.ndim != ndim or values.size == 0:
        wanted = "(n,)" if ndim == 1 else "(m, n)"
        raise FitRefused(f"values must have shape {wanted} and not be empty, not {values.shape}")
    if censored is None:
        return values, np.ones(values.shape, dtype=np.bool_)
    marks = np.asarray(censored)
    if marks.dtype != np.bool_ or marks.shape != values.shape:
        raise FitRefused(
            f"`censored` must hold true or false for each of the values, shape {values.shape}; "
            f"found {marks.dtype} of shape {marks.shape}"
        )
    return values, ~marks


def censoring_of(values: FloatArray, failed: BoolArray) -> Censoring:
    """Name the censoring: type II when all the censored values equal the largest failure."""
    if failed.all():
        return "complete"
    if (values[~failed] == values[failed].max()).all():
        return "type II"
    return "type I or random"


def sample_warnings(values: FloatArray, failed: BoolArray) -> Warnings:
    """Say what weakens a fit that is still given: few failures, coarse rounding."""
    failures = values[failed] / values.max()  # so that squares of tiny values do not vanish
    distinct = np.unique(failures)
    found = []
    if failures.size < FEW_FAILURES:
        found.append(
            ("few_failures", f"{failures.size} failures; {FEW_FAILURES} are the usual least")
        )
    # ties alone do not hurt, and three specimens may lie far apart: only both together are coarse
    if distinct.size < failures.size:
        step = float(np.diff(distinct).min() / failures.std(ddof=1))
        if step > COARSE_STEP:
            told = f"{distinct.size} distinct values in {failures.size} failures"
            found.append(("coarse_rounding", f"{told}, {step:.2g} sd apart"))
    return tuple(found)
