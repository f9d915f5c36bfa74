"""A bad file in a campaign: read correctly or rejected by place and reason; the rest goes on."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest

from deamat.run.folders import Folders
from deamat.run.register import register
from tests.run.conftest import curves, run

pytestmark = pytest.mark.usefixtures("quick_figures")

_LINE = 120


def _cell(new: bytes) -> Callable[[bytes], bytes]:
    """Replace the load in one line."""

    def change(data: bytes) -> bytes:
        lines = data.split(b"\r\n")
        cells = lines[_LINE - 1].split(b"\t")
        cells[1] = new
        lines[_LINE - 1] = b"\t".join(cells)
        return b"\r\n".join(lines)

    return change


def _insert(new: bytes) -> Callable[[bytes], bytes]:
    def change(data: bytes) -> bytes:
        lines = data.split(b"\r\n")
        return b"\r\n".join([*lines[: _LINE - 1], new, *lines[_LINE - 1 :]])

    return change


def _header_only(data: bytes) -> bytes:
    lines = data.split(b"\r\n")
    names = next(i for i, line in enumerate(lines) if line.startswith(b"Reading\t"))
    return b"\r\n".join(lines[: names + 1]) + b"\r\n"


REJECTED: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "over-range text": (_cell(b"OVER"), f"line {_LINE}, column 2"),
    "blank cell": (_cell(b""), f"line {_LINE}, column 2"),
    "NA": (_cell(b"NA"), f"line {_LINE}, column 2"),
    "extra field": (_cell(b"1.0\t2.0"), f"line {_LINE}"),
    "short last row": (lambda d: d.rstrip().rpartition(b"\t")[0] + b"\r\n", "line "),
    "decimal comma": (_cell(b"1,25"), f"line {_LINE}, column 2"),
    "thousands separator": (_cell(b"1,234.5"), f"line {_LINE}, column 2"),
    "NUL byte": (_cell(b"1.\x005"), f"line {_LINE}"),
    "repeated header": (_insert(b"Reading\tLoad\tTravel\tTime"), f"line {_LINE}"),
    "header only": (_header_only, "no data"),
    "cut in its last number": (lambda d: d.rstrip()[:-1], "line "),
}
READ: dict[str, Callable[[bytes], bytes]] = {
    "UTF-16": lambda d: d.decode().encode("utf-16"),
    "BOM": lambda d: b"\xef\xbb\xbf" + d,
    "cut between lines": lambda d: b"\r\n".join(d.split(b"\r\n")[:-40]) + b"\r\n",
}


@pytest.mark.parametrize("name", sorted(REJECTED))
def test_rejected_by_place_and_reason(folders: Folders, name: str) -> None:
    change, place = REJECTED[name]
    path = curves(folders)[0]
    path.write_bytes(change(path.read_bytes()))
    register(folders.raw, "demo", accept_all=True)
    document = run(folders)
    assert document["exit_code"] == 1
    (rejected,) = document["rejected"]
    assert rejected["path"] == path.relative_to(folders.raw).as_posix()
    assert place in rejected["reason"]
    card = json.loads((folders.processed / "cards" / "sylgard-182-10to1.json").read_text())
    used = {o["path"] for p in card["properties"] for o in p["origins"]}
    assert rejected["path"] not in used
    assert {p["n"] for p in card["properties"]} == {2}
    assert document["materials"] == 2


@pytest.mark.parametrize("name", sorted(READ))
def test_read_as_if_nothing_had_happened(folders: Folders, name: str) -> None:
    def value() -> float:
        document = run(folders)
        assert document["exit_code"] == 0
        card = json.loads((folders.processed / "cards" / "sylgard-182-10to1.json").read_text())
        (modulus,) = [p for p in card["properties"] if p["key"] == "compressive_modulus"]
        return float(modulus["value"])

    before = value()
    path = curves(folders)[0]
    path.write_bytes(READ[name](path.read_bytes()))
    register(folders.raw, "demo", accept_all=True)
    assert value() == before
