"""What ends a ramp is told apart: collapse, limit, switch, flashover, end of the file."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.techniques.breakdown.config import BreakdownConfig
from deamat.techniques.breakdown.ramp import Breakdown, find_breakdown
from deamat.techniques.breakdown.rise import audit_rise

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
    return find_breakdown(voltage_V, current_A, 0.01, CRITERIA)


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
    assert (end(slow).broken, end(slow).sure) == (True, False)
    assert end(slow).end == "slow fall without current"
    turned = ramp(*np.linspace(5900.0, 0.0, 60))
    assert (end(turned).broken, end(turned).sure, end(turned).end) == (False, False, "turned down")


def test_a_fall_without_a_current_is_a_switch_and_not_a_breakdown() -> None:
    volts = ramp(0.0, 0.0, 0.0)
    found = end(volts, current(volts))
    assert (found.voltage_V, found.broken, found.end) == (5950.0, False, "turned down")
    assert end(volts, current(volts, (50, 5e-4))).end == "turned down"  # a weak spike elsewhere
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


@pytest.mark.parametrize("held", [0.3, 0.6, 0.9])
def test_what_the_current_limit_holds_of_the_voltage_is_a_breakdown(held: float) -> None:
    volts = ramp(*[held * 5950.0] * 30)
    amperes = current(volts)
    amperes[100:] = 0.02
    found = end(volts, amperes)
    assert (found.voltage_V, found.broken, found.sure) == (5950.0, True, True)
    assert found.end == ("collapse" if held < 0.5 else "held by the current limit")
    assert end(volts, current(volts)).end == "turned down"  # a part is lost, but no current flows


def test_a_part_that_is_lost_for_good_without_a_current_channel_is_not_sure() -> None:
    found = end(ramp(4000.0, 4000.0, 4100.0))
    assert (found.voltage_V, found.broken, found.sure) == (5950.0, True, False)
    assert found.end == "part lost without current"


@pytest.mark.parametrize("samples", [2, 8, 30])
def test_a_voltage_that_falls_slowly_while_current_flows_is_a_breakdown(samples: int) -> None:
    fall = 5950.0 * np.exp(-np.arange(1.0, 6.0 * samples) / samples)
    volts = ramp(*fall)
    amperes = current(volts)
    amperes[100 : 100 + 2 * samples] = 8e-3
    found = end(volts, amperes)
    assert (found.voltage_V, found.broken, found.sure, found.peak) == (5950.0, True, True, 99)
    unseen = end(volts)
    assert (unseen.voltage_V, unseen.broken) == (5950.0, samples < 30)
    assert unseen.sure == (samples == 2)


@pytest.mark.parametrize(("spike_A", "dip"), [(2e-4, 0.01), (8e-3, 0.05), (0.02, 0.3), (8e-3, 0.0)])
def test_the_first_of_the_breakdowns_that_cleared_counts(spike_A: float, dip: float) -> None:
    volts, events = ramp(0.0, 0.0, 0.0), (40, 60, 75)
    for at in events:
        volts[at] *= 1.0 - dip
    amperes = current(volts, *((at, spike_A) for at in events), (100, 0.02))
    found = end(volts, amperes)
    before = 1000.0 + 50.0 * (40 - (dip > 0.0))
    assert (found.voltage_V, found.broken, found.end) == (before, True, "self-clearing")
    assert [e.lost for e in found.clearings] == pytest.approx([dip] * 3)
    assert found.greatest_V == 5950.0
    last = find_breakdown(volts, amperes, 0.05, replace(CRITERIA, after_clearing="final collapse"))
    assert (last.voltage_V, last.end, len(last.clearings)) == (5950.0, "collapse", 3)


def test_a_weak_spike_without_a_dip_is_told_and_counts_for_nothing() -> None:
    volts = ramp(0.0, 0.0)
    found = end(volts, current(volts, (40, 2e-4), (100, 0.02)))
    assert (found.voltage_V, found.end, found.clearings) == (5950.0, "collapse", ())
    (spike,) = found.spikes
    assert (spike.voltage_V, spike.current_A) == (3000.0, 2e-4)


def test_a_current_that_charges_the_film_is_no_spike() -> None:
    volts = np.concatenate((np.zeros(5), ramp(0.0, 0.0)))
    found = end(volts, current(volts, (5, 5e-3), (105, 0.02)))
    assert (found.voltage_V, found.end, found.spikes) == (5950.0, "collapse", ())


def test_a_log_too_slow_for_the_arc_does_not_tell_a_collapse_from_a_switch() -> None:
    volts = ramp(0.0, 0.0, 0.0)
    found = find_breakdown(volts, current(volts), 1.0, CRITERIA)
    assert (found.end, found.broken, found.sure) == ("collapse without current", True, False)
    fast = find_breakdown(volts, current(volts), 0.01, CRITERIA)
    assert (fast.end, fast.broken, fast.sure) == ("turned down", False, True)


@pytest.mark.parametrize("noise_V", [10.0, 40.0, 100.0, 200.0])
@pytest.mark.parametrize("slowly", [False, True])
def test_noise_of_the_monitor_makes_no_events_and_does_not_raise_the_voltage(
    noise_V: float, slowly: bool
) -> None:
    rng = np.random.default_rng(3)
    errors = []
    for _ in range(40):
        fall = 8000.0 * np.exp(-np.arange(1.0, 40.0) / 5.0) if slowly else np.zeros(30)
        clean = ramp(*fall, start=0.0, step=50.0, n=161)
        amperes = current(clean)
        amperes[161 : 161 + (15 if slowly else 1)] = 8e-3
        found = end(clean + noise_V * rng.standard_normal(clean.size), amperes)
        assert (found.broken, found.sure, found.flashovers, found.clearings) == (True, True, (), ())
        errors.append((found.voltage_V - 8000.0) / max(found.u_V, 1e-9))
        assert found.noise_V == pytest.approx(noise_V, rel=0.4)
    assert abs(np.mean(errors)) < 0.6
    assert np.std(errors) < 1.5


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
