"""A value that is a limit says so, and cannot say anything else."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from deamat.core.errors import OutOfRange
from deamat.core.present import readable_record
from deamat.core.quantity import Quantity
from deamat.core.records import Bound, PropertyRecord


def _record(interval: tuple[float, float], bound: Bound) -> PropertyRecord:
    return PropertyRecord(
        key="handling_time",
        material="m",
        campaign="c",
        quantity=Quantity(43200.0, "s"),
        n=1,
        sd=None,
        ci95=interval,
        conditions={},
        method="last clean line",
        budget=(),
        origins=(),
        bound=bound,
    )


def test_a_limit_is_the_lower_end_of_its_interval() -> None:
    assert _record((43200.0, math.inf), "lower").bound == "lower"
    assert _record((43200.0, 46800.0), "interval").bound == "interval"
    assert _record((40000.0, 46800.0), "exact").bound == "exact"


@pytest.mark.parametrize(
    ("interval", "bound", "said"),
    [
        ((43200.0, 46800.0), "lower", "from 43200 to 46800"),
        ((43200.0, math.inf), "interval", "from 43200 to inf"),
        ((40000.0, math.inf), "lower", "from 40000 to inf"),
        ((40000.0, 46800.0), "interval", "from 40000 to 46800"),
    ],
)
def test_a_limit_that_is_none_is_refused(
    interval: tuple[float, float], bound: Bound, said: str
) -> None:
    message = f"handling_time of m: 43200 s cannot be its {bound} bound with the interval {said}"
    with pytest.raises(OutOfRange, match=f"^{message}$"):
        _record(interval, bound)


@pytest.mark.parametrize(
    ("interval", "bound", "text"),
    [
        ((43200.0, math.inf), "lower", ">= 12 h"),
        ((43200.0, 46800.0), "interval", "12 to 13 h"),
        ((40000.0, 46800.0), "exact", "12 h"),
    ],
)
def test_a_limit_is_written_as_one(interval: tuple[float, float], bound: Bound, text: str) -> None:
    assert readable_record(_record(interval, bound)) == text


def test_a_limit_is_written_without_the_uncertainty_of_an_estimate() -> None:
    known = replace(_record((43200.0, 46800.0), "interval"), quantity=Quantity(43200.0, "s", 36.0))
    assert readable_record(known) == "12.000 to 13.000 h"
