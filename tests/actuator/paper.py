"""Designs of Sikulskyi et al. 2022 (doi 10.3389/frobt.2022.1034914, CC BY), and what they come to.

Printed values are those of its Tables 1 and 5; recomputed ones follow from its printed inputs.
"""

from __future__ import annotations

from dataclasses import dataclass

from deamat.actuator.figure_of_merit import Unimorph

POISSON_RATIO = 0.49
UM, MPA = 1e-6, 1e6


@dataclass(frozen=True, slots=True)
class Row:
    """One design: its layers, film and field; curvature and optimum, printed and recomputed."""

    unimorph: Unimorph
    relative_permittivity: float
    field_V_m: float
    printed: tuple[float | None, float | None, float | None]
    recomputed: tuple[str, str | None, str | None]


def _row(
    layers: tuple[float, float, float, float, float, float],
    n: int,
    film: tuple[float, float],
    printed: tuple[float | None, float | None, float | None],
    recomputed: tuple[str, str | None, str | None],
) -> Row:
    tp, yp, ta, ya, te, ye = layers  # micrometres and megapascals, as the tables have them
    unimorph = Unimorph(tp * UM, yp * MPA, ta * UM, ya * MPA, te * UM, ye * MPA, n)
    return Row(unimorph, film[0], film[1], printed, recomputed)


# (curvature 1/m, best passive thickness um, curvature there 1/m), linear strain in the films
DESIGN_1 = _row(
    (304, 0.957, 446, 0.957, 10, 3.5),
    1,
    (2.58, 22.2e6),
    (8.71, None, 8.78),
    ("8.713", None, "8.776"),
)
DESIGN_2 = _row(
    (234, 0.957, 521, 0.095, 10, 3.5),
    1,
    (2.63, 12.8e6),
    (25.1, None, 25.15),
    ("13.11", None, "13.23"),
)
# Electrodes of 304 and 458 um: the table's numbers come out with their mean
HAGHIASHTIANI_2018 = _row(
    (313, 0.168, 516, 0.0398, (304 + 458) / 2, 0.0088),
    1,
    (4.16, 5440 / 516e-6),
    (39.7, 179, 41.4),
    ("39.68", "179.2", "41.42"),
)
SIKULSKYI_2020 = _row(
    (25.4, 2100, 90, 1, 10, 6),
    1,
    (2.63, 2400 / 90e-6),
    (11.7, 2.5, 39.4),
    ("11.76", "2.48", "39.36"),
)
SIKULSKYI_2022 = _row(
    (350, 0.761, 300, 0.761, 20, 3.5),
    1,
    (3.75, 5200 / 300e-6),
    (8.04, 237, 8.58),
    ("8.037", "236.6", "8.57"),
)
# The printed optimum, 0.65 um and 83.9 1/m, does not follow from the printed inputs
ARAROMI_2012 = _row(
    (50, 200_000, 89, 0.56, 1, 10),
    4,
    (3.68, 3540 / 89e-6),
    (0.88, 0.65, 83.9),
    ("0.881", "0.40", "146"),
)
# These two come out with Eq. 4 as printed, and thinned films
KADOOKA_2016 = _row(
    (63, 1660, 15, 300, 12, 4.9),
    10,
    (50, 550 / 15e-6),
    (4.17, 46, 4.23),
    ("4.169", "46.06", "4.23"),
)
DUDUTA_2016 = _row(
    (12.5, 1000, 30, 1.8, 0.1, 100),
    12,
    (3, 1750 / 30e-6),
    (77.3, 9.5, 77.5),
    ("77.32", "9.32", "77.52"),
)


def shows(value: float, digits: str) -> bool:
    """Does a value, rounded to as many decimals as `digits` has, read the same?"""
    decimals = len(digits.partition(".")[2])
    return f"{float(value):.{decimals}f}" == digits
