"""Manifests: what `sha256sum -c` reads, and how files depart from them."""

from __future__ import annotations

import hashlib

import pytest

from deamat.core.errors import RawFileError
from deamat.core.manifest import Difference, compare, extends, format_manifest, parse_manifest

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


@pytest.mark.parametrize(
    ("old", "new", "grown"),
    [
        (b"a,b\n1,2\n", b"a,b\n1,2\n3,4\n", True),
        (b"a,b\n1,2\n", b"a,b\n1,2\n3,4", True),
        (b"a,b\r\n1,2", b"a,b\r\n1,2\r\n3,4\r\n", True),  # the last line had no end
        (b"a,b\n1,2", b"a,b\n1,23\n", False),  # a longer number is no further row
        (b"a,b\n1,2\n", b"a,b\n0,0\n1,2\n", False),
        (b"a,b\n1,2\n", b"a,b\n", False),
    ],
)
def test_rows_appended_leave_what_was_registered(old: bytes, new: bytes, grown: bool) -> None:
    sha256 = hashlib.sha256(old).hexdigest()
    assert extends(new, sha256) is grown
    difference = compare({"r.csv": sha256}, {"r.csv": "0"}, lambda _, sha: extends(new, sha))
    assert difference.extended == (("r.csv",) if grown else ())
    assert difference.changed == (() if grown else ("r.csv",))
