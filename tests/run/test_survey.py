"""The first account of a campaign: what each file is to it, and what speaks against it."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from deamat.techniques import TECHNIQUES
from tests.run.test_observations import look

HEADER = "specimen,material,file,diameter_mm,height_mm\n"
GOOD = (HEADER + "a,m,a.csv,28,12\nb,m,b.csv,28,12\n").encode()
FILES = {"compression/a.csv": b"1", "compression/b.csv": b"2"}


def manifest(contents: dict[str, bytes]) -> bytes:
    lines = [f"{hashlib.sha256(data).hexdigest()}  {name}\n" for name, data in contents.items()]
    return "".join(sorted(lines, key=lambda line: line[66:])).encode()


def test_each_file_has_its_role(tmp_path: Path) -> None:
    others = {
        "README.md": b"", "notes.csv": b"", "MANIFEST.sha256": b"", "photos/x.png": b"",
        "compression/protocol.PDF": b"", "compression/old/a.csv": b"", "compression/deep.txt": b"",
        "compression/old/specimens.csv": b"",
    }  # fmt: skip
    seen = look(tmp_path / "demo", {**FILES, **others, "compression/specimens.csv": GOOD})
    assert {path.removeprefix("demo/"): e.role for path, e in seen.entries.items()} == {
        "campaign.toml": "campaign",
        "MANIFEST.sha256": "manifest",
        "README.md": "document",
        "notes.csv": "document",
        "photos/x.png": "document",
        "compression/protocol.PDF": "document",
        "compression/specimens.csv": "register",
        "compression/a.csv": "recording",
        "compression/b.csv": "recording",
        "compression/old/a.csv": "unnamed",
        "compression/old/specimens.csv": "unnamed",
        "compression/deep.txt": "unnamed",
    }
    assert [specimen.id for specimen in seen.specimens] == ["a", "b"]
    assert seen.entries["demo/compression/deep.txt"].status == "rejected"


def test_a_manifest_is_held_against_every_file(tmp_path: Path) -> None:
    contents = {**FILES, "compression/specimens.csv": GOOD}
    listed = {**contents, "compression/b.csv": b"other", "gone.md": b"", "compression/c.csv": b""}
    seen = look(tmp_path / "demo", {**contents, "MANIFEST.sha256": manifest(listed)})
    told = {path: (e.role, e.status, e.manifest) for path, e in seen.entries.items()}
    assert told["demo/compression/a.csv"] == ("recording", "used", "ok")
    assert told["demo/compression/b.csv"] == ("recording", "used", "changed")
    assert told["demo/campaign.toml"] == ("campaign", "used", "extra")
    assert told["demo/MANIFEST.sha256"] == ("manifest", "used", "ok")
    for path in ("demo/gone.md", "demo/compression/c.csv"):
        assert told[path] == ("missing", "rejected", "missing")
        assert seen.entries[path].reason == "in the manifest, but not there"
        assert (seen.entries[path].sha256, seen.entries[path].size) == ("", 0)


def test_of_two_registers_of_a_technique_neither_is_read(tmp_path: Path) -> None:
    two = {"compression/specimens.csv": GOOD, "compression/specimens.ods": GOOD}
    seen = look(tmp_path / "demo", {**FILES, **two})
    for one, other in zip(two, reversed(two), strict=True):
        entry = seen.entries[f"demo/{one}"]
        assert entry.status == "rejected"
        assert f"two registers of compression: this one and demo/{other}" in entry.reason
    assert seen.specimens == []


@pytest.mark.parametrize(
    ("data", "reason"), [(b"\xff\n", "not UTF-8"), (b"not a digest\n", "MANIFEST.sha256, line 1")]
)
def test_a_manifest_that_cannot_be_read_is_rejected_alone(
    data: bytes, reason: str, tmp_path: Path
) -> None:
    contents = {**FILES, "compression/specimens.csv": GOOD, "MANIFEST.sha256": data}
    seen = look(tmp_path / "demo", contents)
    entry = seen.entries["demo/MANIFEST.sha256"]
    assert entry.status == "rejected"
    assert reason in entry.reason
    assert len(seen.specimens) == 2
    assert seen.entries["demo/compression/a.csv"].manifest == "extra"


def test_pictures_and_texts_in_other_folders_are_documents(tmp_path: Path) -> None:
    names = ["photos/a.JPG", "photos/plan.docx", "instron/read.me.pdf", "instron/notes.md"]
    seen = look(tmp_path / "demo", dict.fromkeys(names, b"1"))
    for name in names:
        entry = seen.entries[f"demo/{name}"]
        assert (entry.role, entry.status) == ("document", "used")


@pytest.mark.parametrize(
    ("name", "then", "manifest"),
    [
        ("compression/specimens.csv", GOOD + b"s9,m,,28,8\n", "extended"),
        ("compression/specimens.csv", GOOD.replace(b"28", b"29", 1), "changed"),
        ("compression/a.csv", b"12", "changed"),
        ("compression/a.csv", b"1\n2\n", "changed"),
    ],
)
def test_rows_appended_to_a_register_extend_it(
    name: str, then: bytes, manifest: str, tmp_path: Path
) -> None:
    before = {**FILES, "compression/specimens.csv": GOOD}
    sums = "".join(f"{hashlib.sha256(d).hexdigest()}  {n}\n" for n, d in before.items())
    contents = {**before, name: then, "MANIFEST.sha256": sums.encode()}
    seen = look(tmp_path / "demo", contents)
    assert seen.entries[f"demo/{name}"].manifest == manifest
    assert {p for p, e in seen.entries.items() if e.manifest != "ok"} == {
        "demo/campaign.toml",  # not in the manifest
        f"demo/{name}",
    }


def test_without_a_manifest_every_file_is_unregistered(tmp_path: Path) -> None:
    seen = look(tmp_path / "demo", {**FILES, "compression/specimens.csv": GOOD})
    assert {e.manifest for e in seen.entries.values()} == {"extra"}


@pytest.mark.parametrize(
    ("technique", "hint"),
    [
        ("compresion", "did you mean 'compression'?"),
        ("Compression", "did you mean 'compression'?"),
        ("instron", "did you mean 'compression' or 'tension'?"),
        ("lcr 2022", "did you mean 'permittivity'?"),
        ("dma", f"a folder is called after its technique: {', '.join(sorted(TECHNIQUES))}"),
    ],
)
def test_files_of_an_unknown_technique_wait_for_it(
    technique: str, hint: str, tmp_path: Path
) -> None:
    contents = {f"{technique}/specimens.csv": GOOD, f"{technique}/a.csv": b"1"}
    seen = look(tmp_path / "demo", {**contents, f"{technique}/c.csv": b"3"})
    for name, role in (("specimens.csv", "register"), ("a.csv", "recording")):
        entry = seen.entries[f"demo/{technique}/{name}"]
        assert (entry.role, entry.status, entry.awaits) == (role, "refused", technique)
        assert entry.reason == f"no technique is called {technique!r}; {hint}"
    assert f"demo/{technique}/b.csv" not in seen.entries
    unread = seen.entries[f"demo/{technique}/c.csv"]
    assert (unread.role, unread.status, unread.awaits) == ("unnamed", "refused", technique)
    assert unread.reason == f"no technique is called {technique!r}; {hint}"
    assert seen.specimens == []


@pytest.mark.parametrize(
    ("register", "named"),
    [
        (b"\xef\xbb\xbfspecimen, file \na, a.csv \nb,\nc\n", ["a.csv"]),
        (b"specimen\na\n", []),
        (b"", []),
        (b"file\na.csv\n" + b"x" * 140_000 + b"\n", []),  # more than a field may hold
    ],
)
def test_whatever_a_register_names_waits_with_it(
    register: bytes, named: list[str], tmp_path: Path
) -> None:
    seen = look(tmp_path / "demo", {"dma/specimens.csv": register, "dma/a.csv": b"1"})
    waiting = {path: e.role for path, e in seen.entries.items() if e.awaits == "dma"}
    role = "recording" if named else "unnamed"
    assert waiting == {"demo/dma/specimens.csv": "register", "demo/dma/a.csv": role}


def test_a_register_that_cannot_be_read_rejects_the_files_that_it_names(tmp_path: Path) -> None:
    register = b"specimen,material,file,diameter_mm\na,m,a.csv,28\n"
    seen = look(tmp_path / "demo", {**FILES, "compression/specimens.csv": register})
    entry = seen.entries["demo/compression/a.csv"]
    assert (entry.role, entry.status) == ("recording", "rejected")
    assert entry.reason.startswith("its register cannot be read: demo/compression/specimens.csv")
    assert seen.entries["demo/compression/specimens.csv"].status == "rejected"
    assert seen.entries["demo/compression/b.csv"].reason.endswith(
        "add a row (`deamat add` proposes one) or an exclusion"
    )


def test_a_campaign_file_that_cannot_be_read_rejects_the_files_that_are_there(
    tmp_path: Path,
) -> None:
    contents = {**FILES, "campaign.toml": b"title = 1\n", "compression/specimens.csv": GOOD}
    listed = manifest({"gone.md": b""})
    seen = look(tmp_path / "demo", {**contents, "MANIFEST.sha256": listed})
    assert seen.campaign is None
    assert seen.specimens == []
    reasons = {path.removeprefix("demo/"): e.reason for path, e in seen.entries.items()}
    assert "title" in reasons["campaign.toml"]
    assert reasons["gone.md"] == "in the manifest, but not there"
    assert reasons["compression/a.csv"] == "demo/campaign.toml cannot be read"


def test_a_row_without_a_file_is_measured_and_one_without_its_file_is_not(tmp_path: Path) -> None:
    rows = HEADER + "a,m,,28,12\nb,m,gone.csv,28,12\n"
    seen = look(tmp_path / "demo", {"compression/specimens.csv": rows.encode()})
    assert [specimen.id for specimen in seen.specimens] == ["a"]
    entry = seen.entries["demo/compression/gone.csv"]
    assert (entry.role, entry.status) == ("missing", "rejected")
    assert entry.reason == "named in demo/compression/specimens.csv, line 3, but not there"
