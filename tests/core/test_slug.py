"""Names that become files: one rule, a proposal for what breaks it, and short names of any text."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.slug import (
    LONGEST_STEM,
    Spellings,
    file_stem,
    label_fault,
    nearest_label,
    nearest_slug,
    short_slug,
    slug_fault,
)


@pytest.mark.parametrize(
    "name", ["sylgard-182-10to1", "ef50_0t", "7", "temperature-drift-5K", "rtv615.b", "a" * 80]
)
def test_an_id_is_its_own_nearest_or_differs_from_it_in_case(name: str) -> None:
    assert slug_fault(name) is None
    assert nearest_slug(name) == name.casefold()


@pytest.mark.parametrize(
    ("name", "reason", "nearest"),
    [
        ("EF30/1:1 10% BT", "not '/'", "ef30-1-1-10-bt"),
        ("../../../../escaped", "not '/'", "escaped"),
        ("EF30", "starts with a lower-case letter or a digit", "ef30"),
        (".hidden", "starts with a lower-case letter or a digit", "hidden"),
        ("ef30.", "end with a dot", "ef30"),
        ("con", "device name", "con-1"),
        ("lpt1.txt", "device name", "lpt1-txt"),
        ("ef\u043630", "U+0436 (CYRILLIC SMALL LETTER ZHE)", "ef-30"),
        ("\u0435f30", "U+0435 (CYRILLIC SMALL LETTER IE)", "ef30"),
        ("a\x00b", "U+0000 (a control character)", "a-b"),
        ("a\u202eb", "U+202E (RIGHT-TO-LEFT OVERRIDE)", "a-b"),
        ("", "empty", "id-e3b0c442"),
        ("a" * 81, "81 characters where 80 are allowed", "a" * 80),
    ],
)
def test_what_is_no_id_is_told_with_the_nearest(name: str, reason: str, nearest: str) -> None:
    assert reason in str(slug_fault(name))
    assert nearest_slug(name) == nearest


@given(st.text())
def test_what_is_proposed_for_any_text_holds(text: str) -> None:
    assert slug_fault(nearest_slug(text)) is None
    assert slug_fault(short_slug(text)) is None
    assert label_fault(nearest_label(text)) is None


@given(st.lists(st.text(), min_size=1))
def test_a_stem_of_any_parts_is_a_short_slug(parts: list[str]) -> None:
    stem = file_stem(*parts)
    assert len(stem) <= LONGEST_STEM
    assert slug_fault(stem) is None or len(stem) > 80


def test_a_short_slug_is_readable_and_tells_apart_what_it_cuts() -> None:
    assert short_slug("2 h at 90 C") == "2-h-at-90-c-7b067732"
    long = "2 h at 90 C, then seven days in dry air"
    assert short_slug(long).startswith("2-h-at-90-c-then-seven-")
    assert short_slug(long) != short_slug(long + " and light")
    assert short_slug("2 months") != short_slug("2-months")
    assert short_slug("same", "of one") != short_slug("same", "of another")


def test_a_stem_that_is_too_long_ends_in_its_digest() -> None:
    one, other = (file_stem("m" * 80, "compression", end * 60) for end in "ab")
    assert one != other
    assert {len(one), len(other)} == {LONGEST_STEM}


@pytest.mark.parametrize(
    ("label", "reason", "nearest"),
    [
        ("2\u00a0months", "U+00A0 (NO-BREAK SPACE)", "2 months"),
        ("two\nlines", "U+000A (a control character)", "two lines"),
        ("\u202e2 months", "U+202E (RIGHT-TO-LEFT OVERRIDE)", "2 months"),
    ],
)
def test_a_label_is_one_printable_line(label: str, reason: str, nearest: str) -> None:
    assert reason in str(label_fault(label))
    assert nearest_label(label) == nearest
    assert label_fault("100 \u00b0C 1 h, 50 % BT/Ecoflex") is None
    assert "501 characters where 500 are allowed" in str(label_fault("x" * 501))


def test_a_second_spelling_names_the_first() -> None:
    spellings = Spellings()
    assert spellings.other("material", "ef30-5K", "line 2") is None
    assert spellings.other("material", "ef30-5K", "line 3") is None
    assert spellings.other("age", "EF30-5K", "line 3") is None
    assert spellings.other("material", "ef30-5k", "line 4") == "'ef30-5K' in line 2"
    assert spellings.other("age", "ef30-5K ", "line 5") == "'EF30-5K' in line 3"
