"""What is no regular file is never opened: it is named, and everything else is read."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deamat.core.errors import CardError, ConfigError, RawFileError
from deamat.materials.card import read_card
from deamat.run.audit import audit
from deamat.run.folders import Folders
from deamat.run.measure import measure
from deamat.run.register import register
from tests.run.conftest import MATERIALS, curves, run

pytestmark = pytest.mark.usefixtures("quick_figures")


def _socket(path: Path) -> None:
    """Bind in the folder itself: the name of a socket is short."""
    here = Path.cwd()
    os.chdir(path.parent)
    try:
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(path.name)
    finally:
        os.chdir(here)


def _loop(path: Path) -> None:
    path.symlink_to(path.name)


def _not_utf8(path: Path) -> Path:
    return Path(os.fsdecode(os.fsencode(path) + b"\xe9"))


def _folder_not_utf8(path: Path) -> None:
    folder = _not_utf8(path)
    folder.mkdir()
    (folder / "a.txt").write_text("1\n")


_ITSELF = "a link that leads back to itself"
_NOT_TEXT = "its name is not UTF-8 text; rename it"
_CONTROL = "its name holds a control character; rename it"
ODD: dict[str, tuple[Callable[[Path], Any], str]] = {
    "pipe": (os.mkfifo, "a named pipe (FIFO), no regular file; it was not opened"),
    "socket": (_socket, "a socket, no regular file; it was not opened"),
    "nowhere": (lambda p: p.symlink_to("nothing"), "a link that leads nowhere"),
    "loop": (_loop, _ITSELF),
    "above": (lambda p: p.symlink_to(".."), _ITSELF),
    "device": (
        lambda p: p.symlink_to("/dev/null"),
        "a device, no regular file; it was not opened",
    ),
    "caf\\xe9": (lambda p: _not_utf8(p.with_name("caf")).write_text("1\n"), _NOT_TEXT),
    "folder\\xe9": (lambda p: _folder_not_utf8(p.with_name("folder")), _NOT_TEXT),
    "a\nb": (lambda p: p.write_text("1\n"), _CONTROL),
}


def test_each_is_named_once_wherever_it_is_and_the_rest_is_read(folders: Folders) -> None:
    expected = {}
    for place in ("", "demo/", "demo/compression/", "demo/documents/"):
        (folders.raw / place).mkdir(exist_ok=True)
        for name, (make, reason) in ODD.items():
            make(folders.raw / place / name)
            expected[f"{place}{name}"] = f"{place}{name}: {reason}"
    document = run(folders)
    assert document["exit_code"] == 1
    assert {r["path"]: r["reason"] for r in document["rejected"]} == expected
    assert len(document["rejected"]) == len(expected)
    assert document["values"] == 4
    assert document["manifest"] == document["internal_errors"] == document["ignored"] == []
    told = audit(folders)
    assert (told["unaccounted"], told["twice"]) == ([], [])
    said = register(folders.raw, "demo").text
    ignored = {f"ignored  {r.removeprefix('demo/')}" for p, r in expected.items() if "/" in p}
    assert all(line in said for line in ignored)
    assert said.count("ignored  ") == len(ignored)


@pytest.mark.parametrize("make", [os.mkfifo, _loop])
def test_a_registered_file_that_is_none_any_more(
    folders: Folders, make: Callable[[Path], None]
) -> None:
    path = curves(folders)[0]
    path.unlink()
    make(path)
    document = run(folders)
    (rejected,) = document["rejected"]
    assert rejected["path"] == path.relative_to(folders.raw).as_posix()
    assert [m["changed"] for m in document["manifest"]] == [
        [path.relative_to(folders.raw / "demo").as_posix()]
    ]
    assert set(MATERIALS) == {p.stem for p in (folders.processed / "cards").iterdir()}


@pytest.mark.parametrize("name", ["campaign.toml", "MANIFEST.sha256", "compression/specimens.csv"])
def test_a_file_that_makes_the_campaign(folders: Folders, name: str) -> None:
    path = folders.raw / "demo" / name
    path.unlink()
    os.mkfifo(path)
    document = run(folders)
    assert document["exit_code"] == 1
    assert f"demo/{name}" in {r["path"] for r in document["rejected"]}
    assert (document["values"] == 4) == (name == "MANIFEST.sha256")
    if name == "MANIFEST.sha256":
        with pytest.raises(RawFileError, match="a named pipe"):
            register(folders.raw, "demo", accept_all=True)


def test_links_to_files_and_folders_are_followed(folders: Folders, tmp_path: Path) -> None:
    (folders.raw / "demo" / "compression").rename(tmp_path / "elsewhere")
    (folders.raw / "demo" / "compression").symlink_to(tmp_path / "elsewhere")
    path = curves(folders)[0].resolve()
    path.rename(tmp_path / "curve")
    path.symlink_to(tmp_path / "curve")
    document = run(folders)
    assert (document["exit_code"], document["values"]) == (0, 4)
    assert register(folders.raw, "demo").text == "demo: 8 files, all as in the manifest"


@pytest.mark.parametrize(
    "error", [PermissionError(13, "Permission denied"), OSError(5, "I/O error")]
)
def test_a_file_that_cannot_be_read_is_tried_again(
    folders: Folders, error: OSError, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = curves(folders)[0]
    read = Path.read_bytes

    def refuse(self: Path) -> bytes:
        if self == path:
            raise error
        return read(self)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "read_bytes", refuse)
        (rejected,) = run(folders)["rejected"]
    assert rejected["reason"].endswith(f"{path.name}: it cannot be read: {error.strerror}")
    assert run(folders)["exit_code"] == 0


def test_a_folder_that_cannot_be_listed(folders: Folders, monkeypatch: pytest.MonkeyPatch) -> None:
    closed = folders.raw / "demo" / "closed"
    closed.mkdir()
    scan = os.scandir

    def refuse(path: Any) -> Any:
        if str(path) == str(closed):
            raise PermissionError(13, "Permission denied")
        return scan(path)

    with monkeypatch.context() as patch:
        patch.setattr(os, "scandir", refuse)
        document = run(folders)
    assert [r["reason"] for r in document["rejected"]] == [
        "demo/closed: it cannot be read: Permission denied"
    ]
    assert document["values"] == 4
    assert run(folders)["exit_code"] == 0


def test_a_file_that_vanishes_in_mid_run(folders: Folders, monkeypatch: pytest.MonkeyPatch) -> None:
    path = curves(folders)[0]

    def late(*arguments: Any) -> Any:
        path.unlink(missing_ok=True)
        return measure(*arguments)

    monkeypatch.setattr("deamat.run.process.measure", late)
    (rejected,) = run(folders)["rejected"]
    assert rejected["reason"].endswith("it vanished while the run was at work; run again")


def test_configuration_and_cards_that_are_no_regular_files(folders: Folders) -> None:
    os.mkfifo(folders.raw / "card.json")
    with pytest.raises(CardError, match=r"card\.json: no regular file"):
        read_card(folders.raw / "card.json")
    (folders.config / "methods.toml").unlink()
    os.mkfifo(folders.config / "methods.toml")
    with pytest.raises(ConfigError, match=r"methods\.toml is no regular file"):
        run(folders)
