"""The meter's limits of error, against the tables they are taken from."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import ValidationError

from deamat.core.instruments import LcrAccuracy, Machine


def limit(f: float, ohm: float, level: float = 1.0, fast: bool = False) -> float:
    return float(LcrAccuracy().limit(np.array([f]), np.array([ohm]), level, fast=fast)[0])


@pytest.mark.parametrize(
    ("f", "ohm", "expected"),
    [
        (10.0, 1e8, 5e-4 + 0.3e-9 * 1e8 * 1.07 * 10**0.5 + 3e-4),
        (100.0, 1e7, 5e-4 + 0.3e-9 * 1e7 * 1.07 + 3e-4),
        (1e3, 1e6, 5e-4 + 0.3e-9 * 1e6 * 1.07 + 3e-4),
        (2e3, 5e5, 5e-4 + 1e-9 * 5e5 * 1.07 + 3e-4),
        (1e4, 1e5, 5e-4 + 3e-9 * 1e5 * 1.07 + 3e-4),
        (1e6, 1e3, 5e-4 + 3e-9 * 1e3 * 1.07 + 3e-4),
        (1e3, 10.0, 5e-4 + 1e-3 / 10.0 * 1.2 + 3e-4),
        (25.0, 10.0, 5e-4 + 1e-3 / 10.0 * 1.2 * 2.0 + 3e-4),
    ],
)
def test_the_limit_is_the_makers_formula(f: float, ohm: float, expected: float) -> None:
    assert limit(f, ohm) == pytest.approx(expected, rel=1e-12)


def test_a_film_at_10_hz_is_promised_to_ten_percent_and_at_1_khz_to_a_thousandth() -> None:
    assert limit(10.0, 1e8) == pytest.approx(0.10, abs=0.01)
    assert limit(1e3, 1e6) == pytest.approx(1e-3, rel=0.2)


def test_level_and_speed_widen_it() -> None:
    assert limit(1e3, 1e3, level=0.1) - limit(1e3, 1e3, level=0.4) > 7e-4
    slow, fast = limit(1e3, 1e6), limit(1e3, 1e6, fast=True)
    assert fast - 3e-4 == pytest.approx(2 * (slow - 3e-4))


def test_it_is_declared_with_its_source_and_nothing_unknown() -> None:
    assert "B&K Precision 894" in Machine().impedance.source
    with pytest.raises(ValidationError):
        LcrAccuracy.model_validate({"basik": 1e-3})
