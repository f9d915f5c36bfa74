"""What is made of one indentation."""

from __future__ import annotations

from dataclasses import dataclass

from deamat.core.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class LoadingLaw:
    """The loading law of a flat or spherical tip, $P = K h^m$.

    Parameters
    ----------
    stiffness : K `[N/m^m]`
    exponent : m
    """

    stiffness: float
    exponent: float


@dataclass(frozen=True, slots=True)
class Indent:
    """Depth and load from contact on; of a refused indent as they were read.

    Parameters
    ----------
    depth_m, force_N : shape (n,) each
    law : None for a pyramid, whose unloading is fitted, and for a refused indent
    """

    depth_m: FloatArray
    force_N: FloatArray
    law: LoadingLaw | None = None

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Depth and load."""
        return {"depth_m": self.depth_m, "force_N": self.force_N}
