"""The edge field of equal plates, against the formulas worked out by hand."""

from __future__ import annotations

import math

import pytest

from deamat.core.errors import FitRefused
from deamat.estimators.dielectric.edge_field import edge_terms, vacuum_capacitance


def test_a_silicone_film_on_plates_of_45_mm() -> None:
    """P = 180 mm, t = 0.3 mm: (0.0087 + 0.003034) 180 = 2.112 pF; and with 0.0019 eps_r besides."""
    assert edge_terms("flush", 0.3e-3, 0.18) == pytest.approx((2.1121e-12, 0.0), rel=1e-4)
    a, b = edge_terms("overhanging", 0.3e-3, 0.18)
    assert a + 2.63 * b == pytest.approx(2.6695e-12, rel=1e-4)


def test_the_flush_edge_is_that_of_two_strips_in_air_within_a_quarter() -> None:
    """Conformal mapping of wide strips: eps0 / (2 pi) (1 + ln(2 pi w / d)) per length of edge."""
    w, d, perimeter = 45e-3, 0.3e-3, 0.18
    strips = 8.854e-12 / (2 * math.pi) * (1 + math.log(2 * math.pi * w / d)) * perimeter
    assert edge_terms("flush", d, perimeter)[0] == pytest.approx(strips, rel=0.25)


def test_the_empty_plates() -> None:
    assert vacuum_capacitance(45e-3**2, 300e-6) == pytest.approx(59.7658e-12, rel=1e-6)


def test_what_is_no_edge_is_refused() -> None:
    with pytest.raises(FitRefused, match=r"^an edge is flush or overhanging, not 'guarded'$"):
        edge_terms("guarded", 1e-3, 0.1)
    with pytest.raises(FitRefused, match=r"^a film has a thickness above zero, not 0 m$"):
        edge_terms("flush", 0.0, 0.1)
