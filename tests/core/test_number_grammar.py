"""One grammar for numbers, whoever reads them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deamat.core.number_grammar import NUMBER, is_number

_PACKAGE = Path(__file__).resolve().parents[2] / "pipeline"


@pytest.mark.parametrize("text", ["0", "-1", "+2.5", ".5", "5.", "1e3", "1.5E-07", "007", "-.2e+1"])
def test_a_number(text: str) -> None:
    assert is_number(text)
    float(text)


@pytest.mark.parametrize(
    "text",
    [
        "", ".", "+", "e5", "1e", "1e+", "1 000", "1_000", "1,5", "nan", "inf", "0x10", "--1", " 1",
        "1\n", "\u0661\u0662", "\uff11", "1.2.3", "\u00bd", "1d5",
    ],
)  # fmt: skip
def test_no_number_though_float_may_take_it(text: str) -> None:
    assert not is_number(text)


def test_no_other_module_writes_the_grammar_again() -> None:
    own = re.compile(r"\[eE\]\[\+-\]\?(?:\\d|\[0-9\])\+")
    found = {p.name for p in _PACKAGE.rglob("*.py") if own.search(p.read_text(encoding="utf-8"))}
    # numbers with decimal commas are a dialect of exports alone
    assert found == {"number_grammar.py", "cells.py"}
    cells = (_PACKAGE / "formats" / "cells.py").read_text(encoding="utf-8")
    assert len(own.findall(cells)) == 1
    assert "," in next(line for line in cells.splitlines() if own.search(line))
    assert NUMBER.groups == 0  # it stands inside other patterns
