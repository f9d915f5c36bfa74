"""Published JSON is what the standard library writes, to the byte."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.json_text import indented

VALUES: st.SearchStrategy[Any] = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**53), 2**53)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=30,
)


@given(VALUES, st.sampled_from([1, 2]))
def test_the_bytes_are_those_of_the_standard_library(value: Any, indent: int) -> None:
    text = json.dumps(value, indent=indent, ensure_ascii=False, allow_nan=False) + "\n"
    assert indented(value, indent) == text.encode("utf-8")


def test_a_number_that_json_cannot_hold_is_an_error() -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        indented([float("nan")], 1)
