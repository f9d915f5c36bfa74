"""Every file accounted for exactly once, manifests held, and nothing written into raw/."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from deamat.core.errors import ConfigError
from deamat.run.audit import audit, audit_text
from deamat.run.folders import Folders
from deamat.run.register import register
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
    shown = register(folders.raw, "demo", accept=False)
    assert shown.pending
    assert f"changed  {path.relative_to(folders.raw / 'demo').as_posix()}" in shown.text
    assert audit(folders)["exit_code"] == 1
    register(folders.raw, "demo", accept=True)
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
        "reason": "demo/compression/specimens.csv does not name it; add a row or an exclusion",
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
    assert register(folders.raw, "demo", accept=False).pending is False
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
        register(folders.raw, "nowhere", accept=False)
