"""A file appears whole or not at all, and nothing is left beside it."""

from __future__ import annotations

import errno
import os
import stat
import threading
from pathlib import Path

import pytest

from deamat.core.atomic import new_folder, turn_link, whole_folder, write_atomically


def test_writes_the_bytes_and_makes_the_folder(tmp_path: Path) -> None:
    target = tmp_path / "cards" / "deep" / "card.json"
    write_atomically(target, b"\x00\xffcard\r\n")
    assert target.read_bytes() == b"\x00\xffcard\r\n"
    assert [p.name for p in target.parent.iterdir()] == ["card.json"]


def test_replaces_the_old_file(tmp_path: Path) -> None:
    target = tmp_path / "card.json"
    target.write_bytes(b"a much longer old content")
    write_atomically(target, b"new")
    assert target.read_bytes() == b"new"


def test_the_file_has_the_permissions_of_any_other_new_file(tmp_path: Path) -> None:
    (tmp_path / "ordinary").write_bytes(b"")
    write_atomically(tmp_path / "ours", b"")
    modes = {stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("ordinary", "ours")}
    assert len(modes) == 1


def test_a_name_as_long_as_the_file_system_allows_can_be_written(tmp_path: Path) -> None:
    target = tmp_path / ("n" * 255)
    write_atomically(target, b"x")
    assert target.read_bytes() == b"x"


def test_a_full_disk_leaves_the_old_file_and_nothing_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "card.json"
    target.write_bytes(b"old")

    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_atomically(target, b"new")
    assert target.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["card.json"]


def test_an_interrupt_leaves_nothing_either(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(descriptor: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_atomically(tmp_path / "card.json", b"new")
    assert list(tmp_path.iterdir()) == []


def test_a_target_that_is_a_folder_is_an_error_that_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "cards").mkdir()
    with pytest.raises(IsADirectoryError):
        write_atomically(tmp_path / "cards", b"new")
    assert [p.name for p in tmp_path.iterdir()] == ["cards"]


def test_the_bytes_are_on_the_disk_before_the_file_takes_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "card.json"
    seen: list[bool] = []
    really = os.fsync

    def watched(descriptor: int) -> None:
        seen.append(target.exists())
        really(descriptor)

    monkeypatch.setattr(os, "fsync", watched)
    write_atomically(target, b"new")
    assert seen == [False, True]  # the file first, then the folder that holds its new name


def test_writers_at_the_same_time_never_mix_their_bytes(tmp_path: Path) -> None:
    target = tmp_path / "card.json"
    contents = [bytes([letter]) * 100_000 for letter in b"abcd"]

    def write(data: bytes) -> None:
        for _ in range(5):
            write_atomically(target, data)

    threads = [threading.Thread(target=write, args=(data,)) for data in contents]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert target.read_bytes() in contents
    assert [p.name for p in tmp_path.iterdir()] == ["card.json"]


def test_a_folder_takes_the_place_of_the_old_one_in_one_step(tmp_path: Path) -> None:
    place = tmp_path / "paper"
    for content in ("one", "two", "three"):
        with whole_folder(place) as folder:
            (folder / "page").write_text(content)
            assert not place.exists() or (place / "page").read_text() != content
        assert (place / "page").read_text() == content
    assert len(list(tmp_path.iterdir())) == 2  # the link and what it leads to


def test_a_folder_that_fails_leaves_the_old_one(tmp_path: Path) -> None:
    place = tmp_path / "paper"
    with whole_folder(place) as folder:
        (folder / "page").write_text("old")

    def stop_halfway() -> None:
        with whole_folder(place) as folder:
            (folder / "page").write_text("new")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stop_halfway()
    assert (place / "page").read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 2


def test_a_new_folder_appears_once_it_is_filled(tmp_path: Path) -> None:
    place = tmp_path / "raw" / "campaign"
    with new_folder(place) as folder:
        (folder / "deep").mkdir()
        (folder / "deep" / "file").write_text("content")
        assert not place.exists()
    assert (place / "deep" / "file").read_text() == "content"
    assert [p.name for p in place.parent.iterdir()] == ["campaign"]


def test_a_new_folder_never_replaces_one_that_is_there(tmp_path: Path) -> None:
    place = tmp_path / "campaign"
    place.mkdir()
    (place / "file").write_text("old")
    with pytest.raises(OSError, match="not empty"), new_folder(place) as folder:
        (folder / "file").write_text("new")
    assert (place / "file").read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["campaign"]


def test_everything_in_a_new_folder_is_on_the_disk_before_it_takes_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = tmp_path / "campaign"
    seen: list[bool] = []
    really = os.fsync

    def watched(descriptor: int) -> None:
        seen.append(place.exists())
        really(descriptor)

    monkeypatch.setattr(os, "fsync", watched)
    with new_folder(place) as folder:
        (folder / "deep").mkdir()
        (folder / "deep" / "file").write_text("content")
    assert seen == [False, False, False, True]  # file, two folders, then the folder of the name


def test_a_link_is_turned_in_one_step(tmp_path: Path) -> None:
    link = tmp_path / "current"
    for target in ("one", "two"):
        turn_link(link, target)
        assert str(link.readlink()) == target
    assert [p.name for p in tmp_path.iterdir()] == ["current"]
