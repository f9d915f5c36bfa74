"""The cell with which a spectrometer computed permittivities: what its file says of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from deamat.core.quantity import Contribution, Quantity
from deamat.core.units import from_si
from deamat.estimators.dielectric.edge_field import vacuum_capacitance
from deamat.techniques.permittivity.config import PermittivityConfig
from deamat.techniques.permittivity.film import Film

DIMENSIONS = ("thickness_m", "plate_length_m", "plate_width_m")


@dataclass(frozen=True, slots=True)
class Cell:
    """Round plates with a film between them, as their operator typed them in.

    Parameters
    ----------
    thickness_m, diameter_m : of the film, and of one plate
    edge_corrected : the software took the edge field off
    """

    thickness_m: float
    diameter_m: float
    edge_corrected: bool

    @property
    def vacuum_F(self) -> float:
        """Capacitance of the empty cell `[F]`."""
        return vacuum_capacitance(math.pi / 4.0 * self.diameter_m**2, self.thickness_m)

    def film(self, config: PermittivityConfig) -> Film:
        """Take the film from the file, where the register says nothing of it."""
        u = config.u_stated_dimension
        return Film(
            thickness_m=self.thickness_m,
            read_m=self.thickness_m,
            sticking_m=self.thickness_m,
            area_m2=math.pi / 4.0 * self.diameter_m**2,
            perimeter_m=math.pi * self.diameter_m,
            budget=(
                Contribution("film thickness, as the file states it", u, shared=True),
                Contribution("plate area, as the file states it", 2.0 * u, shared=True),
            ),
            correction=(
                f"thickness of {from_si(self.thickness_m, 'mm'):.4g} mm and plates of "
                f"{from_si(self.diameter_m, 'mm'):.4g} mm as the file states them"
            ),
            edge_corrected=self.edge_corrected,
        )


def stated_cell(metadata: Mapping[str, str]) -> Cell | None:
    """Return the cell that a file states (see `formats.novocontrol`), or None."""
    if "cell_thickness_m" not in metadata or "cell_diameter_m" not in metadata:
        return None
    return Cell(
        float(metadata["cell_thickness_m"]),
        float(metadata["cell_diameter_m"]),
        metadata.get("edge_field") == "corrected",
    )


def says_nothing(numbers: Mapping[str, Quantity]) -> bool:
    """Say whether a row of the register holds none of the dimensions of a film."""
    return not any(name in numbers for name in DIMENSIONS)
