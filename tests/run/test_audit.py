"""Every file accounted for exactly once, manifests held, and nothing written into raw/."""

from __future__ import annotations

import hashlib
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

import deamat.run.audit
from deamat.core.errors import ConfigError
from deamat.core.ledger import FileEntry
from deamat.run.audit import audit, audit_text
from deamat.run.folders import Folders, look
from deamat.run.register import Registration, register
from tests.run.conftest import curves, run

pytestmark = pytest.mark.usefixtures("quick_figures")


def _fate(folders: Folders, path: Path) -> dict[str, object]:
    name = path.relative_to(folders.raw).as_posix()
    (entry,) = [f for f in audit(folders)["files"] if f["path"] == name]
    return {k: entry[k] for k in ("role", "status", "manifest", "reason")}


def _snapshot(folder: Path) -> dict[str, str]:
    return {
        str(p): hashlib.sha256(p.read_bytes()).hexdigest() for p in folder.rglob("*") if p.is_file()
    }


def test_all_is_well(folders: Folders) -> None:
    before = _snapshot(folders.raw)
    document = audit(folders)
    assert document["exit_code"] == 0
    assert document["unaccounted"] == document["twice"] == []
    assert {f["status"] for f in document["files"]} == {"used"}
    assert {f["path"] for f in document["files"]} == {
        p.relative_to(folders.raw).as_posix() for p in folders.raw.rglob("*") if p.is_file()
    }
    assert _snapshot(folders.raw) == before


def test_a_changed_file_is_rejected_until_it_is_accepted(folders: Folders) -> None:
    path = curves(folders)[0]
    path.write_bytes(path.read_bytes().replace(b"0.2", b"0.3", 1))
    assert audit(folders)["exit_code"] == 1
    assert _fate(folders, path)["status"] == "rejected"
    assert "file content differs from the manifest" in str(_fate(folders, path)["reason"])
    shown = register(folders.raw, "demo")
    assert shown.pending
    assert f"changed  {path.relative_to(folders.raw / 'demo').as_posix()}" in shown.text
    assert audit(folders)["exit_code"] == 1
    register(folders.raw, "demo", accept_all=True)
    assert audit(folders)["exit_code"] == 0


def test_a_missing_file_is_named_once(folders: Folders) -> None:
    path = curves(folders)[0]
    path.unlink()
    document = audit(folders)
    assert document["exit_code"] == 1
    assert document["twice"] == []
    assert _fate(folders, path)["role"] == "missing"
    assert path.name in audit_text(document)


def test_a_file_that_no_register_names_is_rejected(folders: Folders) -> None:
    path = curves(folders)[0].with_name("stray.txt")
    path.write_text("1,2,3\n")
    assert _fate(folders, path) == {
        "role": "unnamed",
        "status": "rejected",
        "manifest": "extra",
        "reason": "demo/compression/specimens.csv does not name it; add a row (`deamat add` proposes one) or an exclusion",
    }


def test_an_exclusion_makes_all_well(folders: Folders) -> None:
    path = curves(folders)[0]
    path.write_bytes(b"nonsense")
    assert run(folders)["exit_code"] == 1
    name = path.relative_to(folders.raw).as_posix()
    (folders.config / "exclusions.toml").write_text(
        f'[[exclude]]\npath = "{name}"\nreason = "the plate slipped"\n'
    )
    document = run(folders)
    assert document["exit_code"] == 0
    assert document["excluded"] == [{"path": name, "reason": "the plate slipped"}]


def test_an_unregistered_file_is_used_flagged_and_reported(folders: Folders) -> None:
    manifest = folders.raw / "demo" / "MANIFEST.sha256"
    lines = manifest.read_text().splitlines(keepends=True)
    manifest.write_text("".join(x for x in lines if curves(folders)[0].name not in x))
    document = run(folders)
    assert document["exit_code"] == 1
    assert len(document["manifest"][0]["extra"]) >= 1
    text = (folders.processed / "cards" / "sylgard-182-10to1.json").read_text()
    assert "unregistered: " in text
    assert register(folders.raw, "demo").pending is False
    assert run(folders)["exit_code"] == 0


def test_a_campaign_file_that_cannot_be_read_rejects_the_campaign(folders: Folders) -> None:
    (folders.raw / "demo" / "campaign.toml").write_text("title = 'x'\n")
    document = run(folders)
    assert document["exit_code"] == 1
    assert any("synthetic: Field required" in r["reason"] for r in document["rejected"])
    assert document["values"] == 0


def test_folders_without_a_campaign_file_are_named_and_ignored(folders: Folders) -> None:
    (folders.raw / "loose").mkdir()
    (folders.raw / "loose" / "a.csv").write_text("1\n")
    document = run(folders)
    assert document["ignored"] == ["loose/"]
    assert document["exit_code"] == 0


def test_registering_no_campaign_is_wrong_usage(folders: Folders) -> None:
    with pytest.raises(ConfigError, match=r"nowhere is no campaign: it has no campaign\.toml"):
        register(folders.raw, "nowhere")


def test_a_file_that_the_account_lacks_is_unaccounted(
    folders: Folders, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folders.raw / "loose").mkdir()
    (folders.raw / "loose" / "a.csv").write_text("1\n")
    run(folders)
    seen = look(folders)
    stat = seen["raw/demo/campaign.toml"]
    monkeypatch.setattr(
        deamat.run.audit, "look", lambda _: {**seen, "raw/demo/late.txt": stat, "raw/x": stat}
    )
    document = audit(folders)
    assert document["unaccounted"] == ["demo/late.txt"]
    assert document["ignored"] == ["loose/"]


def test_the_account_as_a_page() -> None:
    entries = [
        FileEntry("demo/campaign.toml", "1" * 64, 9, "campaign", "used"),
        FileEntry("demo/t/a.csv", "2" * 64, 9, "recording", "used"),
        FileEntry("demo/t/b.csv", "3" * 64, 9, "recording", "used", "extra", "not in the manifest"),
        FileEntry("demo/t/c.csv", "4" * 64, 9, "recording", "refused", reason="E: too short"),
        FileEntry("demo/t/d.csv", "5" * 64, 9, "recording", "excluded", reason="it slipped"),
        FileEntry("demo/t/e.csv", "6" * 64, 9, "recording", "rejected", reason="line 2\nline 3"),
    ]
    error = {"stage": "card", "subject": "gel-a", "files": ["demo/t/a.csv"], "error": "E: burst"}
    document: dict[str, Any] = {
        "release": "0123abcd",
        "files": [asdict(entry) for entry in entries],
        "internal_errors": [
            {**error, "traceback": "Traceback:\n  E: burst"},
            {**error, "traceback": ""},
        ],
        "warnings": ["a name twice"],
        "stale": ["card gel-b: code changed"],
        "unaccounted": ["demo/t/late.txt"],
        "twice": ["demo/t/a.csv"],
        "ignored": ["loose/", "old/"],
    }
    assert audit_text(document) == (
        """\
release 0123abcd: 6 files, each accounted for once

demo                         campaign   used          1
demo                         recording  excluded      1
demo                         recording  refused       1
demo                         recording  rejected      1
demo                         recording  used          2

rejected:
  demo/t/e.csv: line 2
  line 3

refused:
  demo/t/c.csv: E: too short

excluded:
  demo/t/d.csv: it slipped

differs from the manifest:
  [extra] demo/t/b.csv: not in the manifest

internal errors:
  card gel-a (demo/t/a.csv)
    Traceback:
      E: burst
  card gel-a (demo/t/a.csv)
    E: burst
warning: a name twice
not up to date, and cannot be written: card gel-b: code changed
unaccounted: demo/t/late.txt
twice: demo/t/a.csv

ignored: loose/, old/"""
    )


def test_registering_says_what_it_wrote_and_what_waits(folders: Folders) -> None:
    place = folders.raw / "demo"
    assert register(folders.raw, "demo") == Registration(
        "demo: 8 files, all as in the manifest", pending=False
    )
    (place / "notes.md").write_text("new\n")
    shown = register(folders.raw, "demo")
    assert shown == Registration("new      notes.md\ndemo: 9 files registered", pending=False)
    (place / "notes.md").unlink()
    (place / "README.md").write_text("new\n")
    shown = register(folders.raw, "demo")
    assert shown.pending
    assert shown.text.splitlines()[0] == "new      README.md"
    assert shown.text.splitlines()[1].startswith("missing  notes.md (was 7aa7a5359173)")
    assert shown.text.splitlines()[2:] == [
        "demo: 1 changed or missing file is not accepted; if a change is right, say "
        "`deamat register demo --accept notes.md`",
        "demo: 10 files registered",
    ]
    assert "README.md" in (place / "MANIFEST.sha256").read_text()
    assert "notes.md" in (place / "MANIFEST.sha256").read_text()
    shown = register(folders.raw, "demo", accept_all=True)
    assert shown.text.endswith("demo: 9 files registered")
    assert not shown.pending
    assert "notes.md" not in (place / "MANIFEST.sha256").read_text()


def test_one_change_is_accepted_and_the_others_wait(folders: Folders) -> None:
    first, second, third = curves(folders)[:3]
    for path in (first, second):
        path.write_bytes(path.read_bytes().replace(b"0.2", b"0.3", 1))
    third.unlink()
    names = [p.relative_to(folders.raw / "demo").as_posix() for p in (first, second, third)]
    before = (folders.raw / "demo" / "MANIFEST.sha256").read_text()
    shown = register(folders.raw, "demo", [names[0]])
    assert shown.pending
    assert "2 changed or missing files are not accepted" in shown.text
    after = (folders.raw / "demo" / "MANIFEST.sha256").read_text()
    assert [line[66:] for line in after.splitlines() if line not in before.splitlines()] == [
        names[0]
    ]
    assert register(folders.raw, "demo", [f"demo/{name}" for name in names[1:]]).pending is False
    assert audit(folders)["exit_code"] == 1  # the missing file is still in the register
    with pytest.raises(ConfigError, match=r"is no changed or missing file of demo$"):
        register(folders.raw, "demo", [names[0]])


def test_an_appended_row_needs_no_acceptance(folders: Folders) -> None:
    table = folders.raw / "demo" / "compression" / "specimens.csv"
    old = table.read_bytes()
    row = old.splitlines()[-1].split(b",")
    new = curves(folders)[0].with_name("new.txt")
    new.write_bytes(curves(folders)[-1].read_bytes().replace(b"0.01", b"0.02", 1))
    header = old.splitlines()[0].split(b",")
    row[header.index(b"specimen")] = b"new-1"
    row[header.index(b"file")] = new.relative_to(table.parent).as_posix().encode()
    table.write_bytes(old + b",".join(row) + b"\n")
    document = run(folders)
    assert document["manifest"] == [{
        "campaign": "demo", "changed": [], "missing": [],
        "extra": [new.relative_to(folders.raw / "demo").as_posix()],
        "extended": ["compression/specimens.csv"],
    }]  # fmt: skip
    shown = register(folders.raw, "demo")
    assert not shown.pending
    assert "extended compression/specimens.csv" in shown.text
    assert run(folders)["manifest"] == []
    table.write_bytes(old.replace(b"28", b"29", 1))
    assert register(folders.raw, "demo").pending


def test_the_registered_hash_still_holds_what_was_not_accepted(folders: Folders) -> None:
    path = curves(folders)[0]
    path.write_bytes(path.read_bytes().replace(b"0.2", b"0.3", 1))
    register(folders.raw, "demo")
    assert audit(folders)["exit_code"] == 1
    assert _fate(folders, path)["manifest"] == "changed"
