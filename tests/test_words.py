"""Words that a reader of the field would stumble over stay out of messages, help and docs."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.run.conftest import ROOT

# word: what to write in its place
ODD = {
    r"mend(s|ed)?": "hint, correct",
    r"stands? twice": "listed twice",
    r"left alone": "ignored",
    r"bears? one": "have the same",
    r"blam(e|ed|es)": "rejected because of",
    r"amiss": "wrong",
    r"spelt": "spelled",
    r"told (once|as|in)": "stated",
    r"by (its|their|the meter's) own word": "marked as",
    r"it gives? (back|out)": "returns",
    r"as part of (the|its|full)": "as a fraction of",
    r"part of the (reading|greatest|full)": "fraction of",
    r"(un)?asked nobody": "was not asked for",
}
_PATTERN = re.compile("|".join(rf"\b{word}\b" for word in ODD), re.IGNORECASE)


def _texts(path: Path) -> Iterator[tuple[int, str]]:
    """Every text of a module: messages, help, descriptions, docstrings."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


@pytest.mark.parametrize(
    "folder", sorted(p.name for p in (ROOT / "pipeline").iterdir() if p.is_dir())
)
def test_no_odd_word_is_said(folder: str) -> None:
    found = [
        f"{path.relative_to(ROOT)}:{line}: {match[0]}"
        for path in sorted((ROOT / "pipeline" / folder).rglob("*.py"))
        for line, text in _texts(path)
        for match in _PATTERN.finditer(text)
    ]
    assert found == []


def test_no_odd_word_is_written_in_the_documentation() -> None:
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")]
    pages += [*(ROOT / "docs" / "methods").glob("*.md"), *(ROOT / "pipeline").rglob("*.j2")]
    found = [
        f"{page.relative_to(ROOT)}: {match[0]}"
        for page in pages
        for match in _PATTERN.finditer(page.read_text("utf-8"))
    ]
    assert found == []


def test_an_odd_word_would_be_found() -> None:
    assert _PATTERN.search("what would mend it")
    assert _PATTERN.search("a file that Stands Twice")
