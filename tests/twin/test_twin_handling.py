"""The simulated prints hold Table 3 as printed, and what people mistype is found."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from pathlib import Path

import pytest

from deamat.core.instruments import Machine
from deamat.core.records import Summary
from deamat.core.register import Register, read_register
from deamat.core.technique import Context
from deamat.techniques.handling import TECHNIQUE
from deamat.twin.campaign import SEED
from deamat.twin.handling import handling_part, simulate_handling, true_handling_times
from tests.twin.quirks import Quirk, quirky_campaign, typed_otherwise

FILE = "handling/observations.csv"
CONTEXT = Context(TECHNIQUE.config(), Machine(), {})


@pytest.mark.shared
def test_the_truth_is_table_3_as_printed(shared: Path) -> None:
    facts = tomllib.loads((shared / "paper" / "facts.toml").read_text("utf-8"))
    truth = tomllib.loads((files("deamat.twin") / "truth.toml").read_text("utf-8"))
    assert truth["table3"] == facts["table3"]


def test_the_truth_tells_beds_and_lower_bounds_apart() -> None:
    truth = true_handling_times()
    assert len(truth) == 8
    heated = truth["sylgard-182-10to1-bed90C"]
    assert (heated.material, heated.value, heated.unit) == ("sylgard-182-10to1", 18000.0, "s")
    assert heated.temperature_K == pytest.approx(363.15)
    assert truth["sylgard-182-10to1"].temperature_K == pytest.approx(295.15)
    assert [name for name, value in truth.items() if value.lower_bound] == [
        "sylgard-186-40to1",
        "sylgard-182-40to1",
    ]


@pytest.mark.parametrize("name", true_handling_times())
def test_lines_are_clean_until_the_printed_time_and_defective_from_the_next_one_on(
    name: str,
) -> None:
    hours = true_handling_times()[name].value / 3600.0
    for seed in range(5):
        run = simulate_handling(seed, name)
        step = 1.0 if hours >= 9 else 0.5
        assert run.time_h == tuple(step * i for i in range(1, len(run.time_h) + 1))
        clean = [t for t, d in zip(run.time_h, run.defect, strict=True) if d == "none"]
        assert clean[-1] == hours
        assert run.time_h[: len(clean)] == tuple(clean)
        later = run.time_h[len(clean) :]
        if run.onset_s is None:
            assert later == ((6.5,) if name == "sylgard-186-40to1" else ())
            assert set(run.limit[len(clean) :]) <= {"equipment viscosity limit"}
        else:
            assert len(later) == 3
            assert hours <= run.onset_s / 3600.0 <= later[0]
            assert set(run.limit) == {""}


def test_another_seed_gives_other_defects_at_the_same_times() -> None:
    runs = [simulate_handling(seed, "sylgard-184-10to1") for seed in range(10)]
    assert len({run.time_h for run in runs}) == 1
    assert len({run.defect for run in runs}) > 3
    assert len({run.onset_s for run in runs}) == 10


def test_every_row_says_that_it_is_synthetic() -> None:
    header, *rows = handling_part(SEED).files[FILE].decode().splitlines()
    assert header.split(",") == [
        *("material", "batch", "bed_temperature_C", "time_h", "line", "defect", "limit"),
        *("instrument", "comment"),
    ]
    assert len(rows) == sum(len(simulate_handling(SEED, n).time_h) for n in true_handling_times())
    assert all('"SYNTHETIC: simulated, not measured"' in row for row in rows)


def _register(quirk: Quirk) -> Register:
    return read_register(
        quirky_campaign(SEED, quirk)[FILE], f"c/{FILE}", "c", "handling", TECHNIQUE.required, {},
        TECHNIQUE.register,
    )  # fmt: skip


def _summary(quirk: Quirk) -> Summary:
    """The summary of Sylgard 184 (10:1), whose lines are the first fifteen rows."""
    mine = [s for s in _register(quirk).specimens if s.material == "sylgard-184-10to1"]
    return TECHNIQUE.summarise([TECHNIQUE.reduce(s, None, CONTEXT) for s in mine], CONTEXT)


def test_a_clean_line_after_the_first_defective_one_is_flagged() -> None:
    (record,) = _summary(typed_otherwise(FILE, 14, "defect", "none")).records
    assert record.quantity.value == 6 * 3600.0
    assert [flag.name for flag in record.flags] == ["clean-again", "single-run"]


def test_an_unknown_defect_refuses_the_run() -> None:
    found = _summary(typed_otherwise(FILE, 3, "defect", "ok"))
    assert found.records == ()
    assert "the defect 'ok' is neither clean (none) nor known" in found.refusals[0].reason


def test_a_time_mistyped_early_shows_as_lines_that_are_clean_again() -> None:
    (record,) = _summary(typed_otherwise(FILE, 13, "time_h", "0.65")).records
    assert record.quantity.value == 1800.0
    assert record.flags[0].name == "clean-again"
    assert record.flags[0].detail.startswith("11 lines in h-sylgard-184-10to1 are clean after")


@pytest.mark.parametrize(
    ("quirk", "message"),
    [
        (
            typed_otherwise(FILE, 4, "time_h", "2.o"),
            "c/handling/observations.csv, line 5, column 4: not a number (found '2.o'); write it "
            "with a decimal point",
        ),
        (
            typed_otherwise(FILE, 4, "defect", ""),
            "c/handling/observations.csv, line 5, column 6: no defect (found '')",
        ),
        (
            typed_otherwise(FILE, 4, "time_h", ""),
            "c/handling/observations.csv, line 5, column 4: must not be empty (found '')",
        ),
    ],
)
def test_a_row_that_cannot_be_read_rejects_the_register(quirk: Quirk, message: str) -> None:
    register = _register(quirk)
    assert register.specimens == ()
    assert [str(error) for _, error in register.errors] == [message]
