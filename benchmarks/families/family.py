"""What a family of estimators tells the chart."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import nan

from benchmarks.measure import front
from benchmarks.timing import Row


@dataclass(frozen=True, slots=True)
class Family:
    """One family and how it is judged.

    Parameters
    ----------
    key : file name of its chart
    title : over the chart
    error : column of the rows that is drawn against time, and by which the front is found
    axis : what the error is called on the axis, with its unit
    rows : measures; `scale` multiplies the number of samples
    why : the sentence under the chart, from what was measured
    """

    key: str
    title: str
    error: str
    axis: str
    rows: Callable[[float], list[Row]]
    why: Callable[[Sequence[Row]], str]


def number(row: Row, column: str) -> float:
    """Take a number from a row."""
    return float(row[column])


def default_of(rows: Sequence[Row]) -> Row:
    """Return the row of the default."""
    return next(row for row in rows if row["kind"] == "default")


def named(rows: Sequence[Row], name: str) -> Row:
    """Return the row of one contender."""
    return next(row for row in rows if row["contender"] == name)


def with_front(rows: Sequence[Row], error: str) -> list[Row]:
    """Add a column that says who is on the front.

    Batches compete with nobody, nor does who was too slow for all samples: on other samples another
    error is to be expected.
    """
    most = max(number(row, "fits") for row in rows)
    times = [
        nan if row["kind"] == "batch" or number(row, "fits") < most else number(row, "us per fit")
        for row in rows
    ]
    errors = [number(row, error) for row in rows]
    on_front = front(times, errors)
    return [{**row, "front": "yes" if i in on_front else "no"} for i, row in enumerate(rows)]
