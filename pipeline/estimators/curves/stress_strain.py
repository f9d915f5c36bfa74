"""Parts of a stress-strain curve: loading branch, strain window, bins, zero of a toe."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused

IndexArray = NDArray[np.intp]

_REVERSAL = 0.05  # a return by this fraction of the greatest strain ends a loading, less is wobble
_EDGE = 1e-9  # strain: 1.5 mm / 30 mm belongs to a window that ends at 5 %, however it rounds
MISSABLE = 0.1  # part of a window that may be missing at either end


def loading_branch(strain: FloatArray) -> int:
    """Count the samples up to and including the first maximum of strain.

    A maximum is followed by a return of more than 5 % of the greatest strain, or by the end.

    Parameters
    ----------
    strain : nominal strain, loading positive, shape (n,) `[1]`
    """
    if (strain[1:] >= strain[:-1]).all():  # the usual test, at a quarter of the cost
        return int(strain.argmax()) + 1
    fallen = np.maximum.accumulate(strain) - strain > _REVERSAL * strain.max()
    turn = int(fallen.argmax())
    return int((strain[:turn] if fallen[turn] else strain).argmax()) + 1


def reloads(strain: FloatArray, branch: int) -> bool:
    """Say whether the specimen is loaded again after its first loading branch."""
    if branch >= strain.size:
        return False
    tail = strain[branch:]
    risen = tail - np.minimum.accumulate(tail)
    return bool(risen.max() > _REVERSAL * strain.max())


def window(
    strain: FloatArray, low: float, high: float, min_samples: int, tolerance: float
) -> IndexArray:
    """Find the samples with `low <= strain <= high`, or say why they cannot carry a slope.

    Parameters
    ----------
    strain : nominal strain of the loading branch, in the order of time, shape (n,) `[1]`
    low, high : ends of the window, both inside it `[1]`
    min_samples : how many samples a slope needs
    tolerance : how far strain may go back before it counts as unloading `[1]`; where the noise of
        the displacement is greater, six times its standard deviation

    Returns
    -------
    indices of the samples, shape (k,)

    Raises
    ------
    FitRefused : too few samples, unloading among them, or a window that the data do not cover
    """
    inside = ((strain >= low - _EDGE) & (strain <= high + _EDGE)).nonzero()[0]
    n = inside.size
    found: dict[str, float | int | str] = {"samples": n, "samples_needed": min_samples}
    if n < min_samples:
        name = _window_name(low, high)
        raise FitRefused(
            f"{n} {'sample' if n == 1 else 'samples'} in the window of {name}, {min_samples} are "
            f"needed (`min_samples`); {_denser(strain, low, high, min_samples)}",
            found,
        )
    x = strain[inside]
    first, last, back = float(x[0]), float(x[-1]), 0.0
    if not (x[1:] >= x[:-1]).all():
        highest = np.maximum.accumulate(x)
        first, last = float(np.minimum.reduce(x)), float(highest[-1])
        back = float(np.maximum.reduce(highest - x))
    if back > tolerance and back > 6.0 * _noise(x):
        name = _window_name(low, high)
        raise FitRefused(
            f"unloading inside the window of {name}: strain goes back by {100 * back:.3g} % among "
            f"its {n} samples ({min_samples} are needed, all of one loading); export the loading "
            "alone or start the test below the window",
            {**found, "goes_back": back},
        )
    spare = max(MISSABLE * (high - low), 2.0 * (last - first) / (n - 1))
    if first > low + spare or last < high - spare:
        name = _window_name(low, high)
        raise FitRefused(
            f"the window of {name} is not covered: its {n} samples ({min_samples} are needed) "
            f"reach from {100 * first:.3g} % to {100 * last:.3g} %; load from below the window to "
            "beyond it, with the displacement zeroed at contact",
            {**found, "first_strain": first, "last_strain": last},
        )
    return inside


def _window_name(low: float, high: float) -> str:
    return f"{100 * low:g}-{100 * high:g} % strain"


def _noise(x: FloatArray) -> float:
    """Estimate the noise of a smooth series from its second differences (median, so robust)."""
    return float(np.median(np.abs(np.diff(x, 2)))) * 1.4826 / math.sqrt(6.0)


def _denser(strain: FloatArray, low: float, high: float, min_samples: int) -> str:
    """Say what would put enough samples into the window."""
    if strain.size < 2:
        return "a curve of one sample has no slope: record the whole test"
    start = int(np.searchsorted(np.maximum.accumulate(strain), low - _EDGE))
    near = strain[max(start - 1, 0) : start + min_samples]
    step = float(near.max() - near.min()) / max(near.size - 1, 1)
    there = f"the first sample is at {100 * float(strain[0]):.3g} % strain"
    greatest = float(strain.max())
    if greatest < low or step <= 0.0:
        return f"{there} and the greatest at {100 * greatest:.3g} %: load further"
    times = math.ceil(min_samples * step / (high - low))
    return (
        f"{there} and one follows every {100 * step:.2g} %: a sampling rate at least "
        f"{max(times, 2)} times higher, or a speed as many times lower, would give enough"
    )


@dataclass(frozen=True, slots=True)
class Bins:
    """Least squares slopes in bins of strain.

    Parameters
    ----------
    slope : of each bin, nan where it has fewer than three samples `[y/x]`
    mean_x, mean_y : centre of each bin's samples; meaningless where there are none
    count : samples in each bin
    """

    slope: tuple[float, ...]
    mean_x: tuple[float, ...]
    mean_y: tuple[float, ...]
    count: tuple[int, ...]

    @property
    def steepest(self) -> int:
        """The bin with the greatest slope; `FitRefused` where no bin has three samples."""
        if max(self.count) < 3:
            raise FitRefused(
                f"no bin of strain has 3 samples for a slope (at most {max(self.count)}); a higher "
                "sampling rate or wider bins would give them"
            )
        return max(range(len(self.slope)), key=self._rank)

    def _rank(self, bin_number: int) -> float:
        slope = self.slope[bin_number]
        return -math.inf if math.isnan(slope) else slope


def bin_slopes(x: FloatArray, y: FloatArray, low: float, high: float, width: float) -> Bins:
    """Fit a line in each bin of x.

    Parameters
    ----------
    x, y : shape (n,)
    low, high : where the first bin starts and the last ends
    width : of a bin; the last one may be narrower
    """
    bins = max(math.ceil((high - low) / width - 1e-6), 1)
    where = ((x - low) * (1.0 / width)).astype(np.intp)  # rounds towards zero: the edge joins it
    np.minimum(where, bins - 1, out=where)
    # sums of squares keep their digits when taken from a point among the samples
    x0, y0 = float(x[0]), float(y[0])
    dx, dy = x - x0, y - y0
    count = np.bincount(where, minlength=bins).tolist()
    sums = zip(
        count,
        np.bincount(where, dx, bins).tolist(),
        np.bincount(where, dy, bins).tolist(),
        np.bincount(where, dx * dx, bins).tolist(),
        np.bincount(where, dx * dy, bins).tolist(),
        strict=True,
    )
    slope, mean_x, mean_y = [], [], []
    for n, sx, sy, sxx, sxy in sums:
        mx, my = (sx / n, sy / n) if n else (0.0, 0.0)
        spread = sxx - n * mx * mx
        slope.append((sxy - n * mx * my) / spread if n >= 3 and spread > 0.0 else math.nan)
        mean_x.append(mx + x0)
        mean_y.append(my + y0)
    return Bins(tuple(slope), tuple(mean_x), tuple(mean_y), tuple(count))


def zero_of_tangent(bins: Bins) -> float:
    r"""Extrapolate the tangent at the steepest bin to $y = 0$: $x_0 = \bar x - \bar y / b$.

    Raises
    ------
    FitRefused : no bin has a slope, or the steepest does not rise

    Source: ASTM D638, annex A1 (toe compensation of a curve with a Hookean region).
    """
    k = bins.steepest
    slope = bins.slope[k]
    if not slope > 0.0:
        raise FitRefused(f"the steepest part of the window does not rise (slope {slope:.4g})")
    return bins.mean_x[k] - bins.mean_y[k] / slope
