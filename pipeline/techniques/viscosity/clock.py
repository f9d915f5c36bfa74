"""From what the clock of a log says to the time since mixing."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta, tzinfo
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.recording import Recording, Specimen

_DAY_S = 86400.0
_HALF_DAY_S = 43200.0
CLOCKS = ("utc_s", "local_clock_s", "time_of_day_s")


def since_mixing_s(specimen: Specimen, recording: Recording, timezone: str) -> FloatArray:
    """Return the time since mixing of every reading, shape (n,) `[s]`.

    Stamps without an offset are the clock of the campaign's time zone, through changes to and from
    summer time; stamps without a date start at the first such time of day after mixing. Elapsed
    times are since mixing already.

    Raises
    ------
    FitRefused : stamps without `mixed_at`, a `mixed_at` that is no date and time, a time zone that
        is not known, or readings before mixing or out of order
    """
    columns = recording.columns
    if "time_s" in columns:
        return columns["time_s"]
    clock = next((name for name in CLOCKS if name in columns), None)
    if clock is None:
        raise FitRefused("the file has no time: neither elapsed nor stamped")
    zone = _zone(timezone)
    mixed = _mixed_at(specimen, zone)
    values = columns[clock]
    if clock == "time_of_day_s":
        elapsed = _from_time_of_day(values, mixed.astimezone(zone))
    elif clock == "local_clock_s":
        elapsed = _local_to_utc(values, zone) - mixed.timestamp()
    else:
        elapsed = values - mixed.timestamp()
    if elapsed[0] < 0:
        raise FitRefused(
            f"the first reading is stamped {-elapsed[0]:g} s before mixing; correct `mixed_at` or "
            "the campaign's time zone"
        )
    if np.any(np.diff(elapsed) < 0):
        at = int(np.argmin(np.diff(elapsed)))
        raise FitRefused(
            f"the clock steps back by {-np.diff(elapsed)[at]:g} s after line "
            f"{int(columns['line'][at])}, which no change of time in {timezone} explains"
        )
    return elapsed


def refuse_impossible_end(time_s: FloatArray, possible_s: tuple[float, float]) -> None:
    """Refuse a run that ends too early or too late after mixing for any cure.

    Raises
    ------
    FitRefused : so it does
    """
    low, high = possible_s
    if not time_s.size or low <= time_s[-1] <= high:
        return
    end_s = float(time_s[-1])
    side = f"before {low:g} s" if end_s < low else f"after {high / _DAY_S:g} days"
    raise FitRefused(
        f"the run ends {end_s:g} s after mixing ({end_s / _DAY_S:.3g} days), {side}: its time is "
        "in another unit, such as minutes for seconds; correct the unit over the column, or "
        "`run_s` in [viscosity]",
        {"end_s": end_s},
    )


def _zone(name: str) -> tzinfo:
    if name == "UTC":
        return UTC
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError) as error:
        raise FitRefused(f"campaign.toml names an unknown time zone {name!r}") from error


def _mixed_at(specimen: Specimen, zone: tzinfo) -> datetime:
    if "mixed_at" not in specimen.notes:
        raise FitRefused(
            "the readings are stamped by the clock, and the register has no `mixed_at`; fill it in "
            "(2022-03-01T20:15:00)"
        )
    text = specimen.notes["mixed_at"]
    try:
        mixed = datetime.fromisoformat(text)
    except ValueError:
        mixed = None
    if mixed is None or len(text) < len("2022-03-01T20:30"):
        raise FitRefused(
            f"`mixed_at` {text!r} is not a date and time; write it as 2022-03-01T20:15:00"
        )
    return mixed if mixed.tzinfo else mixed.replace(tzinfo=zone)


def _local_to_utc(values: FloatArray, zone: tzinfo) -> FloatArray:
    """Take the later of the two meanings of an hour that comes twice once the clock fell back."""
    found: list[float] = []
    for value in values.tolist():
        local = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(seconds=value)
        first = local.replace(tzinfo=zone, fold=0).timestamp()
        if found and first < found[-1]:
            first = local.replace(tzinfo=zone, fold=1).timestamp()
        found.append(first)
    return np.array(found)


def _from_time_of_day(values: FloatArray, mixed: datetime) -> FloatArray:
    of_day = mixed.hour * 3600.0 + mixed.minute * 60.0 + mixed.second
    first = (float(values[0]) - of_day) % _DAY_S
    if first > _HALF_DAY_S:
        raise FitRefused(
            f"stamps without a date: the first is {first / 3600:.1f} h after mixing or "
            f"{(_DAY_S - first) / 3600:.1f} h before it; stamp with the date"
        )
    return np.asarray(values - values[0] + first)
