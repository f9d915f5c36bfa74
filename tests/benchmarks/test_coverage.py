"""The intervals of every property hold the truth about as often as they say; and what would not.

A reduced set of `python -m benchmarks.coverage`, whose full table is `docs/coverage.md`: enough to
break if an interval were half or twice as wide, too few to tell 95 from 93 %.
"""

from __future__ import annotations

import math
import re
import statistics
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import chain

import pytest

from benchmarks.coverage import SIMULATED, Answer, answers, by_key, table
from benchmarks.coverage_truth import NOT_ON_CARDS, table_of, truth_of
from deamat.core.errors import MissingProperty
from deamat.core.properties import PROPERTIES
from deamat.core.quantity import Quantity
from deamat.core.records import PropertyRecord
from deamat.techniques import TECHNIQUES

FIRST, CAMPAIGNS = 50_000, 12
OF_LIQUIDS = ("viscosity", "handling")
SOLIDS = tuple(key for key in SIMULATED if key not in OF_LIQUIDS)
LIQUIDS = ("sylgard-184-10to1", "sylgard-186-40to1")  # a Newtonian one and a power law
# Of one property, with a dozen independent errors or more: one set in fifty of sound intervals is
# outside at most, and that of these seeds is not. Errors are 0.5 half widths, root mean square, of
# a sound interval, and some of three runs are far out.
LEAST_SHARE, GREATEST_OFF = 0.80, 1.00
ALL = (0.93, 0.97)  # of all properties together


@pytest.fixture(scope="module")
def found() -> list[Answer]:
    """Simulate, write and read again; the laws of liquids take most of the time."""
    seeds = range(FIRST, FIRST + CAMPAIGNS)
    solids = (answers(seed, SOLIDS) for seed in seeds)
    liquids = (answers(seed, OF_LIQUIDS, LIQUIDS) for seed in seeds)
    return list(chain.from_iterable(chain(solids, liquids)))


def _unsound(found: Iterable[Answer]) -> set[str]:
    """Name the properties whose intervals hold the truth too seldom, or miss it by too much."""
    return {
        key
        for key, mine in by_key(a for a in found if a.estimate).items()
        if _share(mine) < LEAST_SHARE
        or math.sqrt(statistics.fmean(a.off**2 for a in mine)) > GREATEST_OFF
    }


def _share(mine: Sequence[Answer]) -> float:
    return sum(a.holds for a in mine) / len(mine)


def _scaled(a: Answer, factor: float) -> Answer:
    middle, half = 0.5 * (a.low + a.high), 0.5 * factor * (a.high - a.low)
    return replace(a, low=middle - half, high=middle + half)


def test_every_property_of_the_twins_cards_is_held_against_a_truth(found: list[Answer]) -> None:
    checked = set(by_key(a for a in found if not a.law))
    yielded = {key for technique in SIMULATED for key in TECHNIQUES[technique].yields}
    assert checked == yielded - NOT_ON_CARDS.keys()
    assert NOT_ON_CARDS.keys() <= PROPERTIES.keys()


def test_every_interval_holds_the_truth_about_as_often_as_it_says(found: list[Answer]) -> None:
    assert _unsound(found) == set()
    low, high = ALL
    assert low <= _share([a for a in found if a.estimate]) <= high


def test_intervals_half_as_wide_would_be_noticed_in_every_property(found: list[Answer]) -> None:
    on_cards = [a for a in found if a.estimate and not a.law]
    assert _unsound(_scaled(a, 0.5) for a in on_cards) == set(by_key(on_cards))


def test_intervals_twice_as_wide_would_be_noticed(found: list[Answer]) -> None:
    assert _share([_scaled(a, 2.0) for a in found if a.estimate]) > ALL[1]


def test_handling_times_lie_where_the_last_clean_line_was(found: list[Answer]) -> None:
    times = by_key(found)["handling_time"]
    assert not any(a.estimate for a in times)
    assert all(a.low == a.truth < a.high for a in times)


def test_no_limit_of_the_viscosity_then_lies_beyond_the_truth_too_often(
    found: list[Answer],
) -> None:
    then = by_key(found)["viscosity_at_handling_time"]
    assert not any(a.estimate for a in then)
    assert 0.9 < _share(then) <= 1.0


def test_a_property_of_which_no_truth_is_told_stops_the_study() -> None:
    record = PropertyRecord(
        key="mass_density",
        material="x",
        campaign="c",
        quantity=Quantity(1000.0, "kg/m3"),
        n=1,
        sd=None,
        ci95=(990.0, 1010.0),
        conditions={},
        method="",
        budget=(),
        origins=(),
    )
    message = "the twin tells no truth of mass_density of x ({}); let its part state one"
    with pytest.raises(MissingProperty, match=f"^{re.escape(message)}$"):
        truth_of(record, table_of(()))


def test_the_table_counts_campaigns_and_makes_no_number_of_what_holds_by_construction() -> None:
    held = [Answer(seed, "a", 0.0, 2.0, 1.0 + (seed == 0) * 2.0) for seed in (0, 0, 1, 1)]
    bound = [Answer(0, "b", 1.0, float("inf"), 1.0, estimate=False)]
    one, two = table(held + bound)
    assert one == {
        "property": "a",
        "intervals": 4,
        "coverage %": "50.0",
        "standard error %": "50.0",
        "truth below %": "0.0",
        "truth above %": "50.0",
        "middle off, half widths": "-1.00",
    }
    assert (two["coverage %"], two["middle off, half widths"]) == ("by construction", "")
