"""What the judge of spoilt files calls right, flagged, refused, rejected, gone, silent and worse."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from benchmarks.fuzz.cases import MUTATIONS, Case, draw
from benchmarks.fuzz.fuzzer import Fuzzer
from benchmarks.fuzz.good import good_campaigns
from benchmarks.fuzz.judge import Judged, judge
from benchmarks.fuzz.page import page, silent_per_10000
from benchmarks.fuzz.runner import Hang, Outcome, within
from benchmarks.fuzz.study import Entry, study
from deamat.core.flags import Flag
from deamat.core.kinds import Condition
from deamat.core.ledger import Failure
from deamat.core.quantity import Quantity
from deamat.core.records import PropertyRecord

TOE = Flag("toe", "as always")


def record(
    value: float,
    half: float = 1.0,
    *,
    flags: tuple[Flag, ...] = (TOE,),
    conditions: Mapping[str, Condition] = {},
    material: str = "m",
) -> PropertyRecord:
    return PropertyRecord(
        key="compressive_modulus", material=material, quantity=Quantity(value, "Pa", half / 2.0),
        sd=None, ci95=(value - half, value + half), n=1, conditions=conditions, campaign="fuzz",
        method="made", budget=(), origins=(), flags=flags,
    )  # fmt: skip


def limit(value: float) -> PropertyRecord:
    return replace(record(value), ci95=(value, math.inf), bound="lower")


GOOD = Outcome((record(10.0),))


@pytest.mark.parametrize(
    ("spoilt", "verdict"),
    [
        (Outcome((record(11.9),)), "right"),
        (Outcome((record(12.1),)), "SILENT"),
        (Outcome((record(12.1, flags=(TOE, Flag("slack", ""))),)), "flagged"),
        (Outcome((record(12.1, flags=(Flag("toe", "longer than before"),)),)), "SILENT"),
        (Outcome((record(30.0, half=11.0),)), "right"),
        (Outcome((limit(9.0),)), "right"),
        (Outcome((limit(11.0),)), "SILENT"),
        (Outcome((record(10.0), record(20.0, material="m-2"))), "SILENT"),
        (Outcome(refused=(("compressive_modulus", "too few"),)), "refused"),
        (Outcome(rejected=("x: not a number",)), "rejected"),
        (Outcome((record(10.0),), rejected=("x: not a number",)), "rejected"),
        (Outcome(), "gone"),
        (Outcome(failures=(Failure("measurement", "a", "ValueError", "", ()),)), "crash"),
        (Outcome(hang=True), "hang"),
    ],
)
def test_a_verdict_is_that_of_the_worst_value(spoilt: Outcome, verdict: str) -> None:
    assert judge(GOOD, spoilt).verdict == verdict
    assert judge(GOOD, GOOD) == Judged("right")


def test_a_value_of_another_time_is_no_answer() -> None:
    good = Outcome(tuple(record(v, conditions={"time_s": t}) for v, t in ((10, 1.0), (20, 2.0))))
    assert judge(good, good).verdict == "right"
    assert judge(good, Outcome(good.records[:1])).verdict == "gone"
    other_cure = Outcome((record(10.0, conditions={"cure": "hot"}),))
    assert judge(GOOD, other_cure).verdict == "right"


def test_what_takes_more_than_its_time_is_stopped() -> None:
    def for_ever() -> None:
        with within(0.05):
            while True:
                pass

    with pytest.raises(Hang):
        for_ever()


def test_a_case_is_the_same_whenever_it_is_made() -> None:
    goods = good_campaigns()
    for seed in range(60):
        case = draw(seed, goods)
        again = Case(case.good, case.mutation, seed)
        assert draw(seed, goods) == again
        good = goods[case.good]
        spoilt = case.spoil(good)
        assert spoilt is not None
        assert spoilt == again.spoil(good)
        assert spoilt[1] != good.group


def test_mutations_have_names_of_their_own() -> None:
    names = [name for kind in MUTATIONS.values() for name in kind]
    assert len(names) == len(set(names)) > 60


@pytest.mark.parametrize(
    ("good", "mutation", "verdict"),
    [
        ("mark10/sylgard-182-40to1", "nul", "rejected"),
        ("mark10/sylgard-182-40to1", "other_sign", "right"),
        ("hysitron/sylgard-184-10to1", "drop_column", "rejected"),
        ("handling/sylgard-184-10to1", "field_too_many", "rejected"),
    ],
)
def test_a_case_is_run_as_a_campaign_is(
    tmp_path: Path, good: str, mutation: str, verdict: str
) -> None:
    with Fuzzer(tmp_path) as fuzzer:
        assert set(fuzzer.judge(Case(good, mutation, 3)).verdicts().values()) == {verdict}


def test_a_study_goes_on_where_it_was_stopped(tmp_path: Path) -> None:
    done = tmp_path / "done.jsonl"
    first = study(range(3), ["handling"], 1, done)
    assert [entry.seed for entry in first] == [0, 1, 2]
    key, *lines = done.read_text().splitlines()
    marked = json.loads(lines[0]) | {"why": "read, not judged again"}
    done.write_text("\n".join([key, json.dumps(marked), lines[1], lines[2][:20]]))
    again = study(range(4), ["handling"], 1, done)
    assert again[0].why == "read, not judged again"
    assert again[1:3] == first[1:]
    assert len(done.read_text().splitlines()) == 5
    assert study(range(1), ["tension"], 1, done) != again[:1]


def test_the_page_counts_silence_in_10000_files() -> None:
    entry = Entry(0, "tension", "wrong", "bluehill/x", "gain", "SILENT", "right", "off")
    entries = [entry, *(replace(entry, seed=i, alone="refused") for i in range(1, 4))]
    assert silent_per_10000(entries, ["wrong"]) == {"tension": {"alone": 2500.0, "group": 0.0}}
    text = page(entries)
    assert "| tension |  |  | 2500 | 0 |  |  |" in text
    assert "| tension | wrong | 4 | 0.0 | 0.0 | 75.0 | 0.0 | 0.0 | 25.0 |" in text
    assert "| tension | gain | 4 | 1 |" in text
    assert entry.replay == "python -m benchmarks.fuzz --replay bluehill/x gain 0"
