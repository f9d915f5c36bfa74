"""Each decision in docs/adr/ has a number of its own, and a link to one leads to it."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[1]
DECISIONS = sorted((PROJECT / "docs/adr").glob("*.md"))
DOCUMENTS = [*PROJECT.glob("*.md"), *(PROJECT / "docs").rglob("*.md")]
LINK = re.compile(r"\[ADR (\d+)\]\(([^)]+)\)")


def test_no_number_is_taken_twice() -> None:
    taken = Counter(path.name[:4] for path in DECISIONS)
    assert [number for number, count in taken.items() if count > 1] == []


def test_a_decision_is_headed_by_the_number_of_its_file() -> None:
    assert DECISIONS
    for path in DECISIONS:
        heading = path.read_text(encoding="utf-8").splitlines()[0]
        assert heading.startswith(f"# {int(path.name[:4])}. "), path.name


def test_a_link_leads_to_the_decision_that_it_names() -> None:
    links = [
        (path, number, target)
        for path in DOCUMENTS
        for number, target in LINK.findall(path.read_text(encoding="utf-8"))
    ]
    assert links
    for path, number, target in links:
        decision = (path.parent / target).resolve()
        assert decision in DECISIONS, f"{path.name}: {target}"
        assert int(decision.name[:4]) == int(number), f"{path.name}: {target}"
