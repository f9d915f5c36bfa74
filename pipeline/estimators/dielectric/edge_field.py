r"""The edge field of two equal plates, by the empirical formulas of ASTM D150.

With the perimeter P and the thickness t in mm the edge adds, in pF,

- flush (film cut at the plates' edge): $C_e = (0.0087 - 0.00252 \ln t)\, P$
- overhanging (film larger than the plates):
  $C_e = (0.0019\, \epsilon_r - 0.00252 \ln t + 0.0068)\, P$

both for plates much thinner than t; thick plates have a little more. Both are linear in the
permittivity, so that they can be undone without iterating.

Source: ASTM D150-98, Table 1, after Scott and Curtis 1939; recalled, not checked against the text.
"""

from __future__ import annotations

import math

from deamat.core.errors import FitRefused

EPS0_F_per_m = 8.8541878188e-12  # CODATA 2022
EDGES = ("flush", "overhanging")

_PF_PER_MM = 1e-9  # in F/m


def edge_terms(edge: str, thickness_m: float, perimeter_m: float) -> tuple[float, float]:
    r"""Return a and b of the edge's complex capacitance $C_e^* = a + b\, \epsilon_r^*$ `[F]`.

    Parameters
    ----------
    edge : `"flush"` or `"overhanging"`
    thickness_m, perimeter_m : of the film, and of one plate

    Raises
    ------
    FitRefused : no such edge, or a thickness that is not positive
    """
    if edge not in EDGES:
        raise FitRefused(f"an edge is {' or '.join(EDGES)}, not {edge!r}")
    if not thickness_m > 0.0:
        raise FitRefused(f"a film has a thickness above zero, not {thickness_m:g} m")
    logarithm = -0.00252 * math.log(1e3 * thickness_m)
    scale = _PF_PER_MM * perimeter_m
    if edge == "flush":
        return scale * (0.0087 + logarithm), 0.0
    return scale * (0.0068 + logarithm), scale * 0.0019


def vacuum_capacitance(area_m2: float, thickness_m: float) -> float:
    r"""Capacitance of the plates without film and edge, $\epsilon_0 A / d$ `[F]`."""
    return EPS0_F_per_m * area_m2 / thickness_m
