"""What a card says of the Weibull form: wrong ones by name, and what so few films could not show."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.quantity import Quantity
from deamat.core.records import PropertyRecord
from tests.techniques.breakdown.breakdowns import (
    B1,
    B10,
    LAWLESS_I,
    MICROMETER,
    SHAPE,
    STRENGTH,
    fields,
    film,
    ramp_file,
    records,
    reduce,
    steps_file,
)


def flag(record: PropertyRecord, name: str) -> str:
    (found,) = [f.detail for f in record.flags if f.name == name]
    return found


def test_quantiles_say_what_so_few_films_could_not_have_shown() -> None:
    found = records(fields(LAWLESS_I))
    told = flag(found[B1], "form-untested")
    assert told.startswith("20 specimens do not test the Weibull form: a tail of weak films")
    assert "of a second, weaker population of up to 14 % of all films they may hold none" in told
    for key in (B1, B10):
        details = found[key].diagnostics
        assert 0.0 < float(details["form_unseen_lower"]) < 1.0
        assert details["weak_fraction_unseen"] == pytest.approx(1 - 0.05 ** (1 / 20))
    assert "form_unseen_lower" not in found[STRENGTH].diagnostics
    rng = np.random.default_rng(7)
    many = records(fields((70.0 * rng.weibull(9.0, 3000)).tolist()))
    assert "form-untested" not in {f.name for key in (B1, B10) for f in many[key].flags}


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (
            lambda rng: 70.0 * rng.weibull(9.0, 60) * np.where(np.arange(60) < 6, 0.4, 1.0),
            "two pop",
        ),
        (lambda rng: np.minimum(70 * rng.weibull(12, 60), 120 * rng.weibull(2, 60)), "competing"),
        (lambda rng: 40.0 + 30.0 * rng.weibull(1.2, 60), "a threshold"),
    ],
)
def test_a_wrong_form_is_named(
    values: Callable[[np.random.Generator], FloatArray], words: str
) -> None:
    found = records(fields(values(np.random.default_rng(8)).tolist()))
    for record in found.values():
        assert words in flag(record, "form-curved")
        assert words in flag(record, "poor-fit")


def test_a_field_that_follows_the_thickness_is_said_and_in_the_interval() -> None:
    rng = np.random.default_rng(9)
    measured = []
    for i in range(2, 32):
        thickness = Quantity(rng.uniform(60e-6, 200e-6), "m", 1e-6)
        field = 70e6 * (thickness.value / 110e-6) ** -0.6 * rng.weibull(9.0)
        voltage = Quantity(field * thickness.value, "V")
        measured.append(
            reduce(film(f"s{i}", i, thickness_m=thickness, breakdown_voltage_V=voltage))
        )
    found = records(measured)
    told = flag(found[SHAPE], "thickness-dependence")
    assert told.startswith("the field at breakdown follows the thickness as t^-0.")
    details = found[SHAPE].diagnostics
    assert (
        float(details["thickness_exponent_low"]) < 0.6 < float(details["thickness_exponent_high"])
    )
    assert found[SHAPE].ci95[0] < found[SHAPE].quantity.value < float(details["shape_at_centre"])
    assert found[SHAPE].ci95[1] > 9.0


def test_intervals_of_mixed_limits_say_how_often_they_hold() -> None:
    limits = np.linspace(40.0, 55.0, 20)
    values = np.array(LAWLESS_I)
    marks = values > limits
    record = records(fields(np.minimum(values, limits).tolist(), marks.tolist()))[STRENGTH]
    least, greatest = (float(record.diagnostics[f"coverage_{k}"]) for k in ("least", "greatest"))
    assert 0.85 < least <= greatest <= 1.0
    told = flag(record, "approximate-interval")
    assert f"in {100 * least:.0f} to {100 * greatest:.0f} % of" in told


def test_ramps_and_held_steps_in_one_sample_are_said_to_be_mixed() -> None:
    rng = np.random.default_rng(10)
    measured = [
        reduce(film(f"s{i}", i, thickness_m=MICROMETER), ramp_file(1000.0 * rng.uniform(5.0, 6.0)))
        for i in range(2, 7)
    ]
    stepped = reduce(film("s8", 8, thickness_m=MICROMETER), steps_file())
    assert "mixed-tests" in {f.name for f in records([*measured, stepped])[STRENGTH].flags}
