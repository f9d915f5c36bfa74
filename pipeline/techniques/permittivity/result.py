"""What is made of one film's sweep over frequency."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from deamat.core.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Dependence:
    """How the permittivity of a film depends on frequency.

    Parameters
    ----------
    stated : frequency `[Hz]` to permittivity, of the stated frequencies that the sweep reaches
    slope_per_decade, u_slope_per_decade : over the whole sweep, with its standard error `[1]`
    top_frequency_Hz : highest of the sweep
    change_to_top : relative, from the card's frequency to the highest
    u_change_by_meter : standard uncertainty of that change by the meter's limits alone
    """

    stated: Mapping[float, float]
    slope_per_decade: float
    u_slope_per_decade: float
    top_frequency_Hz: float
    change_to_top: float
    u_change_by_meter: float


@dataclass(frozen=True, slots=True)
class FilmSpectrum:
    """Permittivity and loss of a film at every usable point of its sweep.

    Parameters
    ----------
    frequency_Hz, relative_permittivity, loss_tangent : shape (n,) each
    dependence : None where the sweep says nothing at the card's frequency
    """

    frequency_Hz: FloatArray
    relative_permittivity: FloatArray
    loss_tangent: FloatArray
    dependence: Dependence | None = None

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Frequency, permittivity and loss."""
        return {
            "frequency_Hz": self.frequency_Hz,
            "relative_permittivity": self.relative_permittivity,
            "loss_tangent": self.loss_tangent,
        }
