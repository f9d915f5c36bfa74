"""Promises of the handling room, on written-down (synthetic) prints."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable

import pytest

from deamat.core.chart import Line as Stroke
from deamat.core.chart import Points
from deamat.core.instruments import Machine
from deamat.core.recording import Recording
from deamat.core.records import Measurement, PropertyRecord, Summary
from deamat.core.register import read_register
from deamat.core.technique import Context
from deamat.techniques.handling import TECHNIQUE
from deamat.techniques.handling.config import KEY, HandlingConfig
from deamat.techniques.handling.runs import Line
from deamat.twin.campaign import SEED
from deamat.twin.handling import ROOM_C, handling_part, true_handling_times
from tests.techniques.shown import marks, windows

HEADER = "material,batch,bed_temperature_C,time_h,line,defect,limit\n"
NO_FILE: Recording | None = None


def measured(text: str, header: str = HEADER, **config: object) -> list[Measurement[Line]]:
    """Read a register and reduce every row of it."""
    register = read_register(
        (header + text).encode(), "c/handling/observations.csv", "c", "handling",
        TECHNIQUE.required, {}, TECHNIQUE.register,
    )  # fmt: skip
    return [TECHNIQUE.reduce(s, NO_FILE, context(**config)) for s in register.specimens]


def context(**config: object) -> Context[HandlingConfig]:
    return Context(HandlingConfig.model_validate(config), Machine(), {})


def summary(text: str, **config: object) -> Summary:
    return TECHNIQUE.summarise(measured(text, HEADER, **config), context(**config))


def record(text: str, **config: object) -> PropertyRecord:
    (found,) = summary(text, **config).records
    return found


def reasons(text: str) -> list[str]:
    found = summary(text)
    assert found.records == ()
    return [refusal.reason for refusal in found.refusals]


def run(batch: str, clean: Iterable[float], *ends: tuple[float, str, str]) -> str:
    """Rows of one run: clean lines, then (time, defect, limit)."""
    rows = [(time, "none", "") for time in clean] + list(ends)
    return "".join(
        f"m,{batch},22,{time:g},{line},{defect},{limit}\n"
        for line, (time, defect, limit) in enumerate(rows, start=1)
    )


def names(found: PropertyRecord) -> list[str]:
    return [flag.name for flag in found.flags]


def said(found: PropertyRecord, name: str) -> str:
    (flag,) = [flag for flag in found.flags if flag.name == name]
    return flag.detail


# --- Table 3


def test_every_value_of_table_3_comes_back_from_the_twins_file() -> None:
    text = handling_part(SEED).files["handling/observations.csv"].decode()
    header, _, rows = text.partition("\n")
    found = {}
    lines = sorted(measured(rows, header + "\n"), key=_group)
    for group, members in itertools.groupby(lines, _group):
        (one,) = TECHNIQUE.summarise(list(members), context()).records
        found[group] = (one.quantity.value, one.bound)
        assert one.conditions == {"temperature_K": group[1]}
        assert (one.n, one.key) == (1, KEY)
    assert found == {
        (truth.material, truth.temperature_K): (
            truth.value,
            "lower" if truth.lower_bound else "interval",
        )
        for truth in true_handling_times().values()
    }
    hours = sorted(value / 3600.0 for value, _ in found.values())
    assert hours == [4, 5, 6, 6, 9, 9, 11, 12]
    assert [m for (m, _), (_, bound) in sorted(found.items()) if bound == "lower"] == [
        "sylgard-182-40to1",
        "sylgard-186-40to1",
    ]


def _group(one: Measurement[Line]) -> tuple[str, float]:
    temperature = one.specimen.conditions["temperature_K"]
    assert isinstance(temperature, float)
    return one.specimen.material, temperature


@pytest.mark.parametrize("seed", range(20))
def test_the_interval_holds_the_moment_at_which_defects_truly_began(seed: int) -> None:
    part = handling_part(seed)
    header, _, rows = part.files["handling/observations.csv"].decode().partition("\n")
    lines = sorted(measured(rows, header + "\n"), key=_group)
    for (material, temperature), members in itertools.groupby(lines, _group):
        (one,) = TECHNIQUE.summarise(list(members), context()).records
        bed = round(temperature - 273.15)
        name = f"h-{material}" + (f"-bed{bed}C" if bed != ROOM_C else "")
        if one.bound == "lower":
            assert "onset_s" not in part.specimens[name]
        else:
            assert one.ci95[0] <= part.specimens[name]["onset_s"] <= one.ci95[1]


# --- what a run says


def test_the_value_is_the_last_clean_line_and_the_interval_ends_with_the_first_defect() -> None:
    found = record(run("a", (0.5, 1, 1.5), (2, "dripping", ""), (2.5, "gap", "")))
    assert (found.quantity.value, found.quantity.unit) == (5400.0, "s")
    assert found.quantity.standard_uncertainty == 0.0
    assert (found.bound, found.ci95, found.n, found.sd) == ("interval", (5400.0, 7200.0), 1, None)
    assert found.method == "time since mixing of the last line before which every line was clean"
    assert found.diagnostics == {
        "lines": 5,
        "clean_until_s (a)": 5400.0,
        "defective_from_s (a)": 7200.0,
        "ended_by (a)": "defect: dripping",
    }
    assert names(found) == ["single-run"]


def test_every_line_is_an_origin_of_the_value() -> None:
    found = record(run("a", (0.5, 1), (1.5, "gap", "")))
    assert [(o.specimen, o.value, o.register_line) for o in found.origins] == [
        ("m a 22 0.5 1", 1800.0, 2),
        ("m a 22 1 2", 3600.0, 3),
        ("m a 22 1.5 3", 5400.0, 4),
    ]
    assert {o.register for o in found.origins} == {"c/handling/observations.csv"}
    assert {o.technique for o in found.origins} == {"handling"}
    assert [o.diagnostics for o in found.origins][-1] == {"defect": "gap"}


def test_a_test_that_stopped_gives_a_lower_bound() -> None:
    found = record(run("a", range(1, 13)))
    assert (found.quantity.value, found.bound, found.ci95) == (
        43200.0,
        "lower",
        (43200.0, math.inf),
    )
    assert said(found, "right-censored") == "no defect was seen in a; the printing just stopped"


@pytest.mark.parametrize("defect", ["none", "no flow"])
def test_a_limit_of_the_equipment_gives_a_lower_bound(defect: str) -> None:
    """Whether the line at the limit came out or not; a clean one counts."""
    found = record(run("a", (1, 2, 3), (4, defect, "viscosity"), (5, "gap", "")))
    hours = 4 if defect == "none" else 3
    assert (found.quantity.value, found.bound) == (3600.0 * hours, "lower")
    assert said(found, "right-censored") == "no defect was seen in a before a limit: viscosity"
    assert found.diagnostics["ended_by (a)"] == "equipment limit: viscosity"


def test_a_limit_called_none_is_none() -> None:
    found = record(run("a", (1,), (2, "none", "None"), (3, "gap", "none")))
    assert (found.quantity.value, found.bound) == (7200.0, "interval")


def test_a_defect_beats_a_limit_that_another_line_met_at_the_same_time() -> None:
    found = record(run("a", (1,), (2, "none", "viscosity"), (2, "gap", "")))
    assert (found.quantity.value, found.ci95) == (3600.0, (3600.0, 7200.0))


def test_a_time_is_clean_only_if_every_line_of_it_is() -> None:
    found = record(run("a", (1, 1, 2), (2, "gap", ""), (3, "gap", "")))
    assert found.ci95 == (3600.0, 7200.0)


def test_a_clean_line_after_a_defective_one_is_not_believed() -> None:
    found = record(run("a", (1, 2), (3, "gap", ""), (4, "none", ""), (5, "none", "")))
    assert found.quantity.value == 7200.0
    assert said(found, "clean-again") == (
        "2 lines in a are clean after the one at 3 h that ended it, the first at 4 h; they are not "
        "believed"
    )


def test_a_wide_interval_is_flagged() -> None:
    found = record(run("a", (1, 6), (14, "gap", "")))
    assert said(found, "wide-interval") == (
        "8 h lie between the last clean and the first defective line in a; print more often"
    )
    assert "wide-interval" not in names(record(run("a", (1, 6), (14, "gap", "")), max_gap_s=3e4))


def test_the_order_of_the_rows_and_the_unit_of_time_do_not_matter() -> None:
    text = run("a", (0.5, 1, 1.5), (2, "gap", "")) + run("b", (1, 2), (3, "dripping", ""))
    rows = measured(text)
    forward = TECHNIQUE.summarise(rows, context())
    assert TECHNIQUE.summarise(rows[::-1], context()) == forward
    minutes = "".join(
        ",".join([*cells[:3], f"{60 * float(cells[3]):g}", *cells[4:]]) + "\n"
        for cells in (line.split(",") for line in text.splitlines())
    )
    (other,) = TECHNIQUE.summarise(
        measured(minutes, HEADER.replace("time_h", "time_min")), context()
    ).records
    assert (other.ci95, other.bound) == (forward.records[0].ci95, forward.records[0].bound)


# --- several runs


def test_several_runs_say_what_every_one_of_them_reached() -> None:
    found = record(run("a", (1, 2, 3), (4, "gap", "")) + run("b", (1, 2.5), (3.5, "gap", "")))
    assert (found.quantity.value, found.ci95, found.n) == (9000.0, (9000.0, 12600.0), 2)
    assert found.method.endswith("clean, the shortest of 2 runs")
    assert names(found) == []


def test_runs_that_contradict_each_other_are_flagged() -> None:
    found = record(run("a", (1, 2, 3), (4, "gap", "")) + run("b", (1,), (2, "gap", "")))
    assert found.ci95 == (3600.0, 7200.0)
    assert said(found, "runs-differ") == (
        "one run was clean until 3 h, another defective from 2 h on; the value is what every run "
        "reached"
    )


def test_a_run_that_was_stopped_before_the_others_is_flagged() -> None:
    found = record(run("a", (1, 2)) + run("b", (1, 2, 3), (4, "gap", "")))
    assert (found.quantity.value, found.ci95, found.bound) == (
        7200.0,
        (7200.0, 14400.0),
        "interval",
    )
    assert said(found, "stopped-early") == (
        "a that sets the value ended at 2 h without a defect, another was clean until 3 h"
    )


def test_runs_without_any_defect_stay_a_lower_bound() -> None:
    found = record(run("a", (1, 2, 3)) + run("b", (1, 2, 3), (4, "no flow", "torque")))
    assert (found.quantity.value, found.bound, found.n) == (10800.0, "lower", 2)
    assert names(found).count("right-censored") == 2


def test_mixtures_are_told_apart_by_when_they_were_mixed() -> None:
    rows = "".join(
        f"m,2022-03-0{day}T08:00:00,{time},{defect}\n"
        for day, time, defect in ((1, 1, "none"), (1, 2, "gap"), (2, 1, "none"), (2, 3, "gap"))
    )
    lines = measured(rows, "material,mixed_at,time_h,defect\n")
    (found,) = TECHNIQUE.summarise(lines, context()).records
    assert (found.n, found.ci95, found.conditions) == (2, (3600.0, 7200.0), {})


# --- refusals


def test_a_word_that_is_not_known_refuses_the_whole_run() -> None:
    text = run("a", (1, 2), (3, "Tropfen", ""), (4, "dripping", ""))
    assert reasons(text) == [
        "c/handling/observations.csv, line 4: the defect 'tropfen' is neither clean (none) nor "
        "known (dripping, gap, under-extrusion, over-extrusion, bulging, no flow); correct it, or "
        "add it to [handling] in config/methods.toml",
        "1 of 4 lines cannot be told clean from defective, and any of them may be the first "
        "defective one",
    ]
    found = record(text, defects=("dripping", "tropfen"))
    assert found.ci95 == (7200.0, 10800.0)


def test_a_run_without_a_clean_line_is_refused() -> None:
    rest = run("b", (1,), (2, "gap", ""))
    for first in ((0.5, "gap", ""), (0.5, "no flow", "viscosity")):
        assert reasons(run("a", (), first, (1, "gap", "")) + rest) == [
            "the first line in a, at 0.5 h, is not clean; what was before is not known: print the "
            "first line earlier"
        ]


def test_a_time_that_no_silicone_has_is_flagged() -> None:
    found = record(run("a", (0.001,), (0.002, "gap", "")))
    assert said(found, "implausible") == "0.001 h; a silicone prints for 60 to 1e+07 s"


# --- the figure


def test_the_figure_shows_every_line_and_the_interval() -> None:
    assert TECHNIQUE.figure is not None
    text = run("a", (1, 2), (3, "gap", "")) + run("b", (1, 2), (3, "no flow", "torque"))
    rows = measured(text)
    chart = TECHNIQUE.figure(rows, TECHNIQUE.summarise(rows, context()))
    shown = {mark.label: list(zip(mark.x, mark.y, strict=True)) for mark in marks(chart, Points)}
    assert shown == {
        "clean": [(1.0, 0), (2.0, 0), (1.0, 1), (2.0, 1)],
        "defective": [(3.0, 0), (3.0, 1)],
        "equipment limit": [(3.0, 1)],
    }
    assert windows(chart) == [(2.0, 3.0)]
    clean = [(list(mark.x), list(mark.y)) for mark in marks(chart, Stroke)]
    assert clean == [([0.0, 2.0], [0.0, 0.0]), ([0.0, 2.0], [1.0, 1.0])]
    assert chart.y.ticks == ((0.0, "a"), (1.0, "b"))
    assert (chart.x.label, chart.y.label) == ("time since mixing [h]", "run")
    rows = measured(run("a", (1, 2)))
    assert windows(TECHNIQUE.figure(rows, TECHNIQUE.summarise(rows, context()))) == []
