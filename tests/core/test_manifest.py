"""Manifests: what `sha256sum -c` reads, and how files depart from them."""

from __future__ import annotations

import pytest

from deamat.core.errors import RawFileError
from deamat.core.manifest import Difference, compare, format_manifest, parse_manifest

_A, _B = "a" * 64, "b" * 64


def test_round_trip() -> None:
    hashes = {"x/y z.csv": _A, "campaign.toml": _B}
    assert parse_manifest(format_manifest(hashes), "M") == hashes


def test_departures_are_told_apart() -> None:
    found = compare(
        {"kept": _A, "changed": _A, "missing": _A}, {"kept": _A, "changed": _B, "new": _A}
    )
    assert found == Difference(("changed",), ("missing",), ("new",))


@pytest.mark.parametrize(
    ("text", "message"),
    [("abc  file\n", "M, line 1: not a line of sha256sum"), (f"{_A}  f\n{_B}  f\n", "M, line 2: a file is listed twice")],
)  # fmt: skip
def test_a_bad_line_is_named(text: str, message: str) -> None:
    with pytest.raises(RawFileError) as caught:
        parse_manifest(text, "M")
    assert message in str(caught.value)
