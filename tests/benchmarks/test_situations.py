"""The judge of the study of situations tells right, limits, causes, refusals and silence apart."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks.situations import judge as judging
from benchmarks.situations.page import page
from deamat.twin.situations import SITUATIONS
from deamat.twin.situations.situation import Situation

NAME = "tension-untared"


def _judged(monkeypatch: pytest.MonkeyPatch, situation: Situation, severity: float) -> str:
    monkeypatch.setitem(SITUATIONS, NAME, situation)
    return judging.cell((NAME, severity, 1, 1))[0].verdict


def test_a_cause_that_is_corrected_is_right(monkeypatch: pytest.MonkeyPatch) -> None:
    assert _judged(monkeypatch, SITUATIONS[NAME], 0.1) == "right"


def test_a_value_far_off_is_silent_unless_a_flag_names_its_cause(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sound = SITUATIONS[NAME]
    off = replace(sound, make=lambda rng, s: replace(sound.make(rng, s), truth=1.0))
    assert _judged(monkeypatch, off, 0.1) == "flagged"
    assert _judged(monkeypatch, replace(off, causes=("slip",)), 0.1) == "SILENT"


def test_a_wrong_statement_is_silent_however_right_the_value(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sound = SITUATIONS[NAME]
    wrong = replace(sound, make=lambda rng, s: replace(sound.make(rng, s), misstated=True))
    assert _judged(monkeypatch, wrong, 0.1) == "flagged"
    assert _judged(monkeypatch, replace(wrong, causes=()), 0.1) == "SILENT"
    assert _judged(monkeypatch, replace(wrong, causes=()), 0.0) == "right"


def test_the_page_lists_a_silent_cell_with_its_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    silent = judging.Judged("SILENT", 0.1, False, frozenset())
    clean = judging.Judged("right", 0.0, False, frozenset({"toe"}))
    known = replace(SITUATIONS[NAME], undetectable={0.1: "nothing tells"})
    monkeypatch.setitem(SITUATIONS, NAME, known)
    text = page({(NAME, 0.0): [clean], (NAME, 0.1): [silent]})
    assert "| tension-untared | 0.1 | 1 | 100.0 | 0.0 | 0 | nothing tells |" in text
    assert "| tension | 1 | toe | warning | 100.0 |" in text
