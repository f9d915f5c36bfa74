"""Promises of the breakdown room for one specimen: fields, censoring, refusals and their hints."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Specimen
from tests.techniques.breakdown.breakdowns import MICROMETER, film, ramp_file, reduce, steps_file
from tests.techniques.curves import recording


def test_a_ramp_gives_the_field_on_the_thickness_with_both_kinds_of_uncertainty() -> None:
    measured = reduce(film(thickness_m=MICROMETER), ramp_file())
    (value,) = measured.values
    assert value.key == "breakdown_field"
    assert value.quantity.value == pytest.approx(59.5e6)
    assert value.flags == ()
    assert value.diagnostics["censored"] == 0
    assert value.diagnostics["voltage_V"] == 5950.0
    assert value.diagnostics["time_to_end_s"] == 198.0
    assert value.diagnostics["rate_V_per_s"] == pytest.approx(25.0)
    assert value.lines == (9, 109)
    assert "D149 (made for AC; for DC: ASTM D3755" in value.method
    relative = {c.source: c.u / value.quantity.value for c in value.budget}
    assert relative == pytest.approx(
        {
            "broke within a sampling step: its place": 50 / 5950 / math.sqrt(12),
            "broke within a sampling step: half of it": 25 / 5950,
            "voltage calibration": 0.005,
            "thickness reading": 0.01,
            "thickness gauge": 0.02,
        }
    )
    assert [c.shared for c in value.budget] == [False, True, True, False, True]
    assert list(measured.curve) == ["time_s", "voltage_V", "current_A"]


def test_polarity_does_not_matter_and_thickness_divides() -> None:
    file = ramp_file()
    turned = recording(**{**file.columns, "voltage_V": -file.columns["voltage_V"]})
    thick = film(thickness_m=Quantity(200e-6, "m"))
    assert reduce(thick, turned).values[0].quantity.value == pytest.approx(59.5e6 / 2)


@pytest.mark.parametrize(
    ("change", "flags"),
    [
        ({"dt": 1.0}, {"fast-rise": "it broke after 99 s; a slow rise takes more than 120 s"}),
        (
            {"spike": False, "dt": 0.01},
            {
                "right-censored": "the voltage was turned down, no current spiked: it bore this "
                "field unbroken"
            },
        ),
        (
            {"spike": False},
            {
                "end-unsure": "the voltage collapsed within a sampling step and no current spiked: "
                "it broke and the log was too slow to show the current, or it was switched off: "
                "counted as broken; declare `censored` (yes, no) in the register where the "
                "laboratory knows"
            },
        ),
        (
            {"top_V": 1400.0},
            {"high-start": "the ramp started at 71.4 % of the voltage reached"},
        ),
    ],
)
def test_what_a_reader_must_know_of_a_ramp_is_flagged(
    change: dict[str, Any], flags: dict[str, str]
) -> None:
    value = reduce(film(thickness_m=MICROMETER), ramp_file(**change)).values[0]
    assert {f.name: f.detail for f in value.flags} == flags
    assert value.diagnostics["censored"] == ("right-censored" in flags)
    if "right-censored" in flags:
        assert "broke within" not in " ".join(c.source for c in value.budget)


def test_a_rate_that_is_not_the_one_set_is_flagged() -> None:
    set_at_50 = film(thickness_m=MICROMETER, rate_V_per_s=Quantity(50.0, "V/s"))
    (flag,) = reduce(set_at_50, ramp_file()).values[0].flags
    assert str(flag) == (
        "rate-of-rise: 25 V/s on the whole, 1 to 1 times that in parts, and 50 V/s were set"
    )


def test_the_register_decides_where_the_log_does_not_tell() -> None:
    for said, censored in (("yes", 1), ("no", 0)):
        row = film(notes={"censored": said}, thickness_m=MICROMETER)
        (value,) = reduce(row, ramp_file(spike=False)).values
        assert value.diagnostics["censored"] == censored
        assert "end-unsure" not in [f.name for f in value.flags]


@pytest.mark.parametrize("step_V", [250.0, 500.0, 1000.0])
@pytest.mark.parametrize("hold_s", [10.0, 20.0, 60.0])
def test_a_step_by_step_test_is_read_by_its_own_rule(step_V: float, hold_s: float) -> None:
    file = steps_file(step_V, hold_s)
    (value,) = reduce(film(thickness_m=MICROMETER), file).values
    assert value.diagnostics["voltage_V"] == 6000.0
    assert value.diagnostics["step_V"] == step_V
    assert value.diagnostics["hold_s"] == hold_s
    assert value.method.startswith(
        "voltage of the step at which it broke (ASTM D149, method B) in a DC test in steps of "
        f"{step_V:g} V, each held {hold_s:g} s"
    )
    relative = {c.source: c.u / value.quantity.value for c in value.budget}
    assert relative["broke within a step of the test: half of it"] == pytest.approx(step_V / 12e3)
    assert value.flags == ()
    (held,) = reduce(film(thickness_m=MICROMETER), file, step_rule="IEC 60243-1").values
    assert held.diagnostics["voltage_V"] == 6000.0 - step_V
    assert "IEC 60243-1" in held.method


@pytest.mark.parametrize("noise_V", [10.0, 40.0])
def test_noise_does_not_hide_the_steps(noise_V: float) -> None:
    (value,) = reduce(film(thickness_m=MICROMETER), steps_file(noise_V=noise_V)).values
    assert value.diagnostics["voltage_V"] == pytest.approx(6000.0, abs=1.5 * noise_V)
    assert value.diagnostics["step_V"] == pytest.approx(500.0, abs=noise_V)


def test_a_step_that_was_just_reached_counts_and_one_on_the_way_does_not() -> None:
    file = steps_file()
    volts = file.columns["voltage_V"]
    for last, expected in ((6000.0, 6000.0), (5700.0, 5500.0)):
        kept = np.append(volts[volts == 5500.0], last)
        cut = np.concatenate([volts[volts < 5500.0][:-3], kept, np.zeros(3)])
        amperes = np.where(np.arange(cut.size) == cut.size - 3, 8e-3, 2e-6)
        tested = recording(
            time_s=2.0 * np.arange(float(cut.size)), voltage_V=cut, current_A=amperes
        )
        (value,) = reduce(film(thickness_m=MICROMETER), tested).values
        assert value.diagnostics["voltage_V"] == expected


def test_steps_that_end_at_the_amplifiers_limit_were_borne() -> None:
    (value,) = reduce(film(thickness_m=MICROMETER), steps_file(), amplifier_limit_V=6000.0).values
    assert value.diagnostics["voltage_V"] == 6000.0
    assert value.diagnostics["end"] == "amplifier limit"
    assert value.method.startswith("voltage of the last step of a DC test in steps of 500 V")
    assert "right-censored" in [flag.name for flag in value.flags]


def test_a_ramp_sampled_too_slowly_says_so() -> None:
    columns = {k: v[3::8] for k, v in ramp_file().columns.items()}
    columns["voltage_V"][-1] = 0.0
    columns["current_A"] = np.where(np.arange(13) == 12, 0.02, 0.0)
    (value,) = reduce(film(thickness_m=MICROMETER), recording(**columns)).values
    assert [f.name for f in value.flags] == ["coarse-sampling"]


def test_without_a_current_channel_the_collapse_alone_counts() -> None:
    columns = dict(ramp_file().columns)
    del columns["current_A"]
    (value,) = reduce(film(thickness_m=MICROMETER), recording(**columns)).values
    assert value.diagnostics["censored"] == 0
    assert [f.name for f in value.flags] == ["no-current-channel"]


def test_the_ramp_counts_where_the_register_says_otherwise() -> None:
    row = film(
        notes={"censored": "yes"}, thickness_m=MICROMETER, breakdown_voltage_V=Quantity(5e3, "V")
    )
    (value,) = reduce(row, ramp_file()).values
    assert value.diagnostics["voltage_V"] == 5950.0
    assert [str(f) for f in value.flags] == [
        "register-disagrees: 5000 V in the register, 5950 V in the ramp; the ramp was used",
        "register-disagrees: censored: yes in the register, collapse; the ramp was used",
    ]


def test_a_register_may_hold_the_voltage_or_the_field_alone() -> None:
    voltage = Quantity(6e3, "V", 30.0)
    value = reduce(film(thickness_m=MICROMETER, breakdown_voltage_V=voltage)).values[0]
    assert value.quantity.value == pytest.approx(60e6)
    assert value.quantity.u_shared == pytest.approx(60e6 * math.hypot(0.005, 0.02))
    assert value.quantity.u_independent == pytest.approx(60e6 * math.hypot(0.005, 0.01))
    assert [f.name for f in value.flags] == ["no-ramp"]
    field = reduce(film(breakdown_field_V_per_m=60e6)).values[0]
    assert field.quantity == Quantity(60e6, "V/m")
    assert [f.name for f in field.flags] == ["field-as-given"]
    assert field.method == "field of breakdown as the register gives it"


def refusal(specimen: Specimen, file: Recording | None = None) -> str:
    measured = reduce(specimen, file)
    assert measured.values == ()
    (refused,) = measured.refusals
    assert (refused.key, refused.specimen) == ("breakdown_field", "a")
    return refused.reason


@pytest.mark.parametrize(
    ("specimen", "file", "reason"),
    [
        (
            film(breakdown_voltage_V=Quantity(5e3, "V")),
            None,
            "the register gives no thickness of this specimen, so its breakdown voltage is not a "
            "field; add thickness_<unit>, measured at the place of the breakdown",
        ),
        (
            film(thickness_m=Quantity(0.0, "m")),
            ramp_file(),
            "the register gives a thickness of 0 m; it must be above zero",
        ),
        (
            film(thickness_m=MICROMETER),
            None,
            "the register names no ramp file and gives neither breakdown_voltage_<unit> nor "
            "breakdown_field_<unit>; fill in one of them",
        ),
        (
            film(notes={"censored": "perhaps"}, breakdown_field_V_per_m=1e7),
            None,
            "the register's `censored` says 'perhaps'; write yes for a specimen that did not "
            "break, no for one that did",
        ),
        (
            film(thickness_m=MICROMETER, breakdown_voltage_V=Quantity(5e6, "V")),
            None,
            "5e+06 V is beyond the amplifier's 20000 V; correct the unit (V or kV), or declare the "
            "limit of the amplifier that was used",
        ),
        (
            film(thickness_m=MICROMETER),
            recording(time_s=np.arange(9.0), voltage_V=np.arange(9.0)),
            "the voltage never passes 8 V, and a ramp reaches 100 V at least; correct the unit (V "
            "or kV) or the channel",
        ),
        (
            film(thickness_m=MICROMETER),
            recording(time_s=np.arange(9.0), force_N=np.arange(9.0)),
            "the file has no voltage_V; it holds time_s, force_N; log the voltage of the ramp over "
            "time",
        ),
        (
            film(thickness_m=MICROMETER),
            recording(time_s=np.array([0.0, 1.0, 1.0]), voltage_V=np.arange(3.0)),
            "time does not increase at 1 of 3 samples, the first after 1 s; log one ramp to one "
            "file",
        ),
    ],
)
def test_a_specimen_without_a_certain_field_is_refused_by_reason(
    specimen: Specimen, file: Recording | None, reason: str
) -> None:
    assert refusal(specimen, file) == reason
