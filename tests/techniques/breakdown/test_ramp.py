"""What ends a ramp is told apart: collapse, limit, switch, flashover, end of the file."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.techniques.breakdown.config import BreakdownConfig
from deamat.techniques.breakdown.ramp import Breakdown, audit_rise, find_breakdown

CRITERIA = BreakdownConfig().criteria()
QUIET = 1e-6


def ramp(*values: float, start: float = 1000.0, step: float = 50.0, n: int = 100) -> FloatArray:
    """A ramp of n samples, and what comes after it."""
    return np.concatenate((start + step * np.arange(n), values))


def current(voltage_V: FloatArray, *spikes: tuple[int, float]) -> FloatArray:
    rng = np.random.default_rng(1)
    amperes = QUIET * rng.standard_normal(voltage_V.size)
    for at, value in spikes:
        amperes[at] = value
    return amperes


def end(voltage_V: FloatArray, current_A: FloatArray | None = None) -> Breakdown:
    return find_breakdown(voltage_V, current_A, CRITERIA)


@pytest.mark.parametrize("spike_at", [99, 100, 102])
def test_a_collapse_with_a_spike_is_a_breakdown_at_the_greatest_voltage(spike_at: int) -> None:
    volts = ramp(200.0, 100.0, 0.0, 0.0)
    found = end(volts, current(volts, (spike_at, -0.02)))
    assert (found.voltage_V, found.broken, found.end, found.peak) == (5950.0, True, "collapse", 99)
    assert found.spike_A == 0.02
    assert found.step_V == 50.0
    assert found.flashovers == ()


def test_a_collapse_may_take_some_sampling_steps() -> None:
    volts = ramp(5000.0, 4000.0, 2000.0, 0.0)
    assert end(volts).broken
    slow = ramp(5300.0, 5000.0, 4500.0, 4000.0, 3500.0, 3000.0, 2500.0, 0.0)
    assert (end(slow).broken, end(slow).end) == (False, "turned down")


def test_a_fall_without_a_current_is_a_switch_and_not_a_breakdown() -> None:
    volts = ramp(0.0, 0.0, 0.0)
    found = end(volts, current(volts))
    assert (found.voltage_V, found.broken, found.end) == (5950.0, False, "turned down")
    assert end(volts, current(volts, (50, 0.02))).end == "turned down"  # a spike elsewhere
    assert end(volts, current(volts, (100, 4e-5))).end == "turned down"  # too small a one
    assert end(volts, current(volts, (100, 6e-5))).end == "collapse"


def test_a_spike_must_stand_out_from_its_own_noise() -> None:
    volts = ramp(0.0, 0.0, 0.0)
    noisy = 100.0 * current(volts)
    noisy[100] = 3e-4
    assert end(volts, noisy).end == "turned down"
    noisy[100] = 3e-3
    assert end(volts, noisy).end == "collapse"


def test_a_part_that_is_lost_and_comes_back_is_a_flashover_and_the_ramp_goes_on() -> None:
    volts = ramp(0.0, 0.0)
    volts[40] *= 0.7
    volts[60:62] *= 0.6
    found = end(volts)
    assert (found.voltage_V, found.broken, found.peak) == (5950.0, True, 99)
    assert found.flashovers == (2950.0, 3950.0)


def test_a_part_that_does_not_come_back_leaves_the_specimen_unbroken() -> None:
    found = end(ramp(4000.0, 4000.0, 4100.0))
    assert (found.voltage_V, found.broken, found.end) == (5950.0, False, "flashover")


def test_the_first_collapse_counts_even_if_the_voltage_comes_back() -> None:
    volts = ramp()
    volts[50:52] = 100.0
    found = end(volts)
    assert (found.voltage_V, found.broken, found.peak) == (3450.0, True, 49)


@pytest.mark.parametrize("after", [(), (20e3, 20e3), (20e3, 100.0, 0.0)])
def test_who_reaches_the_limit_is_not_broken_there(after: tuple[float, ...]) -> None:
    volts = ramp(*after, step=190.0, n=101)
    found = end(volts)
    assert (found.voltage_V, found.broken, found.end) == (20e3, False, "amplifier limit")


def test_a_file_that_just_ends_says_only_what_was_borne() -> None:
    found = end(ramp())
    assert (found.voltage_V, found.broken, found.end) == (5950.0, False, "file ended")


def test_noise_before_the_ramp_is_no_collapse() -> None:
    rng = np.random.default_rng(2)
    volts = np.concatenate((2.0 * rng.standard_normal(50), ramp(0.0, 0.0)))
    volts[:100] += 2.0 * rng.standard_normal(100)
    assert end(volts).voltage_V == 5950.0
    rise = audit_rise(0.5 * np.arange(float(volts.size)), volts, end(volts).peak, 0.1)
    assert rise.start_V == pytest.approx(1000.0, abs=10.0)
    assert rise.rate_V_per_s == pytest.approx(100.0, rel=1e-3)
    assert rise.duration_s == 49.5


@given(
    scale=st.floats(0.1, 3.0),
    step=st.floats(5.0, 60.0),
    n=st.integers(20, 90),
    dt=st.floats(0.1, 2),
)
def test_volts_and_seconds_only_scale(scale: float, step: float, n: int, dt: float) -> None:
    volts = ramp(0.0, 0.0, step=step, n=n)
    one, other = end(volts), end(scale * volts)
    assert other.voltage_V == pytest.approx(scale * one.voltage_V)
    assert (other.end, other.peak) == (one.end, one.peak) == ("collapse", n - 1)
    t = dt * np.arange(float(volts.size))
    rise = audit_rise(t, scale * volts, one.peak, 0.1)
    assert rise.rate_V_per_s == pytest.approx(scale * step / dt)
    assert (rise.slowest, rise.fastest) == pytest.approx((1.0, 1.0))


def test_a_rate_that_changes_shows_in_the_parts_and_flashovers_do_not() -> None:
    t = np.arange(100.0)
    volts = 500.0 + np.where(t < 50, 10.0 * t, 500.0 + 20.0 * (t - 50))
    rise = audit_rise(t, volts, 99, 0.1)
    assert rise.fastest / rise.slowest == pytest.approx(2.0, rel=1e-6)
    steady = 500.0 + 10.0 * t
    steady[60:63] *= 0.5
    rise = audit_rise(t, steady, 99, 0.1)
    assert (rise.slowest, rise.fastest) == pytest.approx((1.0, 1.0))
    assert rise.start_V == 500.0


def test_a_switch_is_no_ramp() -> None:
    volts = np.array([0.0, 0.0, 4000.0, 4100.0, 0.0])
    with pytest.raises(FitRefused) as caught:
        audit_rise(np.arange(5.0), volts, 3, 0.1)
    assert caught.value.reason == (
        "2 samples of a rising voltage; at least 5 are needed to tell a ramp from a switch: sample "
        "faster, or raise the voltage more slowly"
    )
