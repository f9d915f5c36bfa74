"""Days are read without a guess, and days that cannot be are refused."""

from __future__ import annotations

from datetime import date, timedelta

import pytest

from deamat.core.dates import read_date, stated_age


@pytest.mark.parametrize(
    "text", ["2022-01-31", "31.01.2022", "2022-01-31T10:15:00", "2022-01-31 10:15"]
)
def test_days(text: str) -> None:
    assert read_date(text) == date(2022, 1, 31)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("2022-02-30", "a day that is in no calendar"),
        ("yesterday", "not a date"),
        ("2222-01-01", "a year that is not between 1950 and 2100"),
        ("01/02/2022", "not a date"),
        ("22-01-01", "not a date"),
    ],
)
def test_days_that_cannot_be(text: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        read_date(text)


def test_ages() -> None:
    assert stated_age("2 months") == timedelta(days=60.88)
    assert stated_age("24 h") == timedelta(days=1)
    assert stated_age("30 min") == timedelta(minutes=30)
    assert stated_age("after cure") is None
