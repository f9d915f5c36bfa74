"""A law of viscosity against time, with the two kinds of error that it has."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.core.laws import POLYNOMIAL, evaluate
from deamat.core.records import Detail, Flag

_BISECTIONS = 200


@dataclass(frozen=True, slots=True)
class Estimate:
    """An answer with its standard uncertainties, all in its own unit.

    Parameters
    ----------
    scatter : from the readings about the law, with `dof` degrees of freedom
    calibration, thermal : from the instrument and from a correction of temperature
    """

    value: float
    scatter: float
    calibration: float
    thermal: float
    dof: float


@dataclass(frozen=True, slots=True)
class TimeLaw:
    """What was fitted to a run, or to several runs together.

    Parameters
    ----------
    kind, coefficients, parts : as `core.laws.FORMS` takes them
    covariance : from the scatter of the readings, shape (p, p)
    drift : change of the coefficients for one standard uncertainty of the calibration, shape (p,)
    thermal : the same for the activation energy by which readings were brought to one temperature
    valid : range of times `[s]`
    rates : range of nominal shear rates `[1/s]`; None for a Newtonian law
    rate_per_rpm_per_s : nominal shear rate over speed; None for a Newtonian law
    relative_error : root mean square of residual over law
    dof : degrees of freedom of the scatter
    name, reason : of the law chosen, and why
    """

    kind: str
    coefficients: FloatArray
    parts: tuple[int, ...]
    covariance: FloatArray
    drift: FloatArray
    thermal: FloatArray
    valid: tuple[float, float]
    rates: tuple[float, float] | None
    relative_error: float
    dof: int
    name: str
    reason: str
    diagnostics: Mapping[str, Detail]
    flags: tuple[Flag, ...] = ()
    rate_per_rpm_per_s: float | None = None

    def at(self, time_s: float) -> tuple[float, FloatArray]:
        """Return viscosity and its derivatives by coefficient, at the usual rate if there is one.

        Raises
        ------
        OutOfRange : a time outside `valid`
        """
        low, high = self.valid
        if not low <= time_s <= high:
            raise OutOfRange(
                f"the law holds from {low / 3600:.4g} h to {high / 3600:.4g} h after mixing, not "
                f"at {time_s / 3600:.4g} h"
            )
        return evaluate(self.kind, self.coefficients, self.parts, time_s, self.usual_rate)

    def at_rate(self, time_s: float, rate_per_s: float) -> tuple[float, FloatArray]:
        """Give viscosity and its derivatives at any shear rate, also outside those measured.

        Raises
        ------
        OutOfRange : a time outside `valid`
        """
        self.at(time_s)
        return evaluate(self.kind, self.coefficients, self.parts, time_s, rate_per_s)

    @property
    def usual_rate(self) -> float | None:
        """Geometric middle of the rates measured throughout `[1/s]`, where it is best known."""
        return None if self.rates is None else math.sqrt(self.rates[0] * self.rates[1])

    def estimate(self, value: float, slopes: FloatArray) -> Estimate:
        """Give what has these derivatives by the coefficients its uncertainties."""
        variance = float(slopes @ self.covariance @ slopes)
        return Estimate(
            value,
            math.sqrt(max(variance, 0.0)),
            abs(float(slopes @ self.drift)),
            abs(float(slopes @ self.thermal)),
            self.dof,
        )

    def time_of(self, times: float, start_s: float) -> tuple[float, FloatArray]:
        """Find when viscosity has grown by a factor since `start_s`.

        Parameters
        ----------
        times : the factor
        start_s : `[s]`

        Returns
        -------
        time `[s]` and its derivatives by coefficient

        Raises
        ------
        FitRefused : it does not within the range of the law
        """
        first, first_slopes = self.at(start_s)
        end = self.valid[1]
        last = self.at(end)[0]
        if last < times * first:
            raise FitRefused(
                f"at the end of the law, {end / 3600:.4g} h after mixing, viscosity is "
                f"{last / first:.3g} times that at {start_s / 3600:.4g} h, not {times:g} times; "
                "measure longer",
                {"factor_at_end": last / first},
            )
        found = self._crossing(times * first, start_s)
        return found, self._inverse(found, self.at(found)[1] - times * first_slopes)

    def time_at(self, viscosity_Pas: float) -> tuple[float, FloatArray]:
        """Find when viscosity reaches a limit: time `[s]` and its derivatives by coefficient.

        Raises
        ------
        FitRefused : not within the range of the law
        """
        low, high = self.valid
        first, last = self.at(low)[0], self.at(high)[0]
        if not first <= viscosity_Pas <= last:
            raise FitRefused(
                f"viscosity goes from {first:.4g} to {last:.4g} Pa.s in the range of the law, "
                f"{low / 3600:.4g} h to {high / 3600:.4g} h, and does not reach "
                f"{viscosity_Pas:g} Pa.s in it"
            )
        found = self._crossing(viscosity_Pas, low)
        return found, self._inverse(found, self.at(found)[1])

    def _crossing(self, value: float, start_s: float) -> float:
        low, high = start_s, self.valid[1]
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            low, high = (middle, high) if self.at(middle)[0] < value else (low, middle)
        return high

    def rise(self, time_s: float) -> float:
        """Rate at which viscosity grows `[Pa.s/s]`."""
        low, high = self.valid
        step = 1e-4 * (high - low)
        before, after = max(low, time_s - step), min(high, time_s + step)
        return (self.at(after)[0] - self.at(before)[0]) / (after - before)

    def _inverse(self, time_s: float, slopes: FloatArray) -> FloatArray:
        """Turn derivatives of a viscosity into those of the time at which it is reached."""
        rise = self.rise(time_s)
        if not rise > 0:
            raise FitRefused(
                f"viscosity does not rise at {time_s / 3600:.4g} h, so that the time at which it "
                "is reached is not determined"
            )
        return -slopes / rise


def drift_of(
    covariance: FloatArray,
    error_variance: float,
    slopes: FloatArray,
    sigma: FloatArray,
    shift: FloatArray,
) -> FloatArray:
    r"""Tell how the coefficients move when every reading moves by `shift`.

    $\delta c = (J^T W J)^{-1} J^T W \delta y$, where $(J^T W J)^{-1}$ is the covariance over the
    variance of unit weight: exact for linear forms.

    Parameters
    ----------
    slopes : J, shape (n, p)
    sigma, shift : shape (n,)
    """
    if error_variance > 0:
        return np.asarray((covariance / error_variance) @ (slopes.T @ (shift / sigma**2)))
    # a law that meets every reading exactly, as with a display that never moves
    weighted = slopes / sigma[:, None]
    size = np.linalg.norm(weighted, axis=0)
    return np.asarray(np.linalg.lstsq(weighted / size, shift / sigma, rcond=None)[0] / size)


def growth(law: TimeLaw) -> FloatArray:
    """Change of the coefficients when viscosity grows by a factor, per unit of the factor."""
    c = law.coefficients.copy()
    if law.kind == POLYNOMIAL:
        return c
    c[law.parts[0] if law.parts else 1 :] = 0.0
    return c


def relative_error(viscosity: FloatArray, law: FloatArray) -> float:
    """Root mean square of residual over law."""
    return float(np.sqrt(np.mean(np.square(viscosity / law - 1.0))))
