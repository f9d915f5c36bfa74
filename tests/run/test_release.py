"""A release appears whole or not at all, with the same bytes everywhere."""

from __future__ import annotations

import json
import os
import re
import shutil
import stat
from pathlib import Path

import pytest

import deamat.run.publish
from deamat import open_database
from deamat.core.errors import ConfigError
from deamat.run.folders import Folders
from deamat.run.published import listing
from deamat.run.register import register
from deamat.run.release import Release, _same
from deamat.run.state import State
from tests.run.conftest import curves, run


def _bytes(processed: Path) -> dict[str, bytes]:
    place = (processed / "releases" / "current").resolve()
    return {str(p.relative_to(place)): p.read_bytes() for p in place.rglob("*") if p.is_file()}


def test_two_runs_in_two_places_give_the_same_bytes(folders: Folders, tmp_path: Path) -> None:
    first = run(folders)
    other = Folders(tmp_path / "elsewhere" / "raw", folders.config, tmp_path / "elsewhere" / "out")
    shutil.copytree(folders.raw, other.raw)
    second = run(other)
    assert second["release"] == first["release"]
    assert _bytes(other.processed) == _bytes(folders.processed)


def test_going_back_gives_the_first_release_again(folders: Folders) -> None:
    first, before = run(folders)["release"], _bytes(folders.processed)
    path = curves(folders)[0]
    kept = path.read_bytes()
    path.write_bytes(kept.replace(b"0.2", b"0.3", 1))
    register(folders.raw, "demo", accept_all=True)
    assert run(folders)["release"] != first
    path.write_bytes(kept)
    register(folders.raw, "demo", accept_all=True)
    assert run(folders)["release"] == first
    assert _bytes(folders.processed) == before


def test_a_run_that_dies_leaves_the_last_release_readable(
    folders: Folders, monkeypatch: pytest.MonkeyPatch
) -> None:
    run(folders)
    before = _bytes(folders.processed)
    path = curves(folders)[0]
    path.write_bytes(path.read_bytes().replace(b"0.2", b"0.3", 1))
    register(folders.raw, "demo", accept_all=True)

    def die(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(deamat.run.publish, "draw_all", die)
        with pytest.raises(KeyboardInterrupt):
            run(folders)
    assert _bytes(folders.processed) == before
    with open_database(folders.processed) as database:
        assert "compressive_modulus" in database["sylgard-182-10to1"]
    assert run(folders)["exit_code"] == 0
    assert _bytes(folders.processed) != before


def test_a_second_run_in_the_same_folder_is_turned_away(folders: Folders) -> None:
    with (
        State(folders.processed),
        pytest.raises(ConfigError, match=r"another run is working in .*; wait for it"),
    ):
        run(folders)


def test_a_card_names_no_code_and_no_environment(folders: Folders) -> None:
    run(folders)
    with open_database(folders.processed) as database:
        made_by = database.provenance()
        cards = [(folders.processed / "cards" / f"{m}.json").read_text() for m in database]
    told = {
        made_by.code,
        *(f for _, f in made_by.stages),
        *(f'"{v}"' for _, v in made_by.environment),
    }
    assert len(told) > 20
    for card in cards:
        assert not [word for word in told if word in card]
        origins = [o for p in json.loads(card)["properties"] for o in p["origins"]]
        assert {(o["reader"], o["technique"]) for o in origins} == {("mark10", "compression")}


def test_synthetic_is_said_on_every_output(folders: Folders) -> None:
    run(folders)
    for name, data in _bytes(folders.processed).items():
        if name.endswith((".json", ".svg")) and not name.startswith("audit"):
            assert b"ynthetic" in data or b"SYNTHETIC" in data, name


@pytest.mark.usefixtures("quick_figures")
def test_published_files_cannot_be_written_into(folders: Folders) -> None:
    """What did not change is one file with that of the release before."""
    run(folders)
    first = (folders.processed / "releases" / "current").resolve()
    _another_release(folders, 0)
    second = (folders.processed / "releases" / "current").resolve()
    files = [p for place in (first, second) for p in place.rglob("*") if p.is_file()]
    assert {stat.S_IMODE(p.stat().st_mode) for p in files} == {0o444}
    shared = {p.name for p in files if p.stat().st_nlink > 1}
    assert shared >= {"sylgard-182-40to1.json", "curves.h5"}


@pytest.mark.usefixtures("quick_figures")
def test_without_hard_links_what_did_not_change_is_copied(
    folders: Folders, monkeypatch: pytest.MonkeyPatch
) -> None:
    run(folders)

    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    _another_release(folders, 0)
    card = folders.processed / "cards" / "sylgard-182-40to1.json"
    assert card.stat().st_nlink == 1
    assert run(folders)["nothing_to_do"]


def _another_release(folders: Folders, number: int) -> str:
    """Name a material otherwise and run: a release with other contents."""
    text = (folders.config / "materials.toml").read_text()
    changed = re.sub(r'"Sylgard[^"]*182 \(10:1\)"', f'"Sylgard-{number} 182 (10:1)"', text)
    (folders.config / "materials.toml").write_text(changed)
    return str(run(folders)["release"])


@pytest.mark.usefixtures("quick_figures")
def test_the_oldest_releases_are_deleted_and_nothing_else(folders: Folders) -> None:
    releases = folders.processed / "releases"
    names = [_another_release(folders, 0)]
    (releases / "notes").mkdir()
    (releases / "notes" / "mine.txt").write_text("kept")
    names += [_another_release(folders, number) for number in (1, 2, 3)]
    assert len(set(names)) == 4

    def kept() -> set[str]:
        return {p.name for p in releases.iterdir() if not p.is_symlink()} - {"notes"}

    assert kept() == set(names)  # the current one and three before it
    assert _another_release(folders, 0) == names[0]  # the oldest is current again
    assert kept() == set(names)
    names.append(_another_release(folders, 4))
    assert kept() == {names[0], *names[2:]}  # not the first: it was current just now
    names.append(_another_release(folders, 5))
    assert kept() == {names[0], *names[3:]}
    assert (releases / "notes" / "mine.txt").read_text() == "kept"
    assert (releases / "current").readlink() == Path(names[-1])


def _made(processed: Path, name: str, published: str | None = None, **files: str) -> Path:
    """Publish a release of some files, as a run would."""
    release = Release(processed, published)
    for file, text in files.items():
        release.path(f"cards/{file}").write_text(text)
    return release.publish(name)


def test_what_a_killed_run_left_is_cleared_away(tmp_path: Path) -> None:
    left = tmp_path / "releases" / ".building" / "cards"
    left.mkdir(parents=True)
    (left / "half.json").write_text("half")
    place = _made(tmp_path, "a" * 12, whole="whole")
    assert [p.name for p in place.rglob("*") if p.is_file()] == ["whole"]
    assert sorted(p.name for p in (tmp_path / "releases").iterdir()) == ["a" * 12, "current"]


def test_outputs_are_taken_over_only_if_each_is_as_it_was(tmp_path: Path) -> None:
    place = _made(tmp_path, "a" * 12, one="1", two="2")
    release = Release(tmp_path, listing(place))
    assert release.keep("cards/one", "cards/two")
    assert (release.building / "cards/one").samefile(place / "cards/one")
    release.drop("cards/one", "cards/two", "cards/never", "c" * 300)
    assert [p for p in release.building.rglob("*") if p.is_file()] == []
    assert not release.keep("cards/one", "cards/three")
    (place / "cards/two").chmod(0o644)
    (place / "cards/two").write_text("3")
    assert not release.keep("cards/one", "cards/two")
    assert release.keep("cards/one")
    assert not Release(tmp_path, None).keep("cards/one")


def test_a_release_that_somebody_changed_is_left_as_evidence(tmp_path: Path) -> None:
    place = _made(tmp_path, "a" * 12, card="right")
    assert _made(tmp_path, "a" * 12, card="right") == place
    card = place / "cards/card"
    before = card.stat()
    card.chmod(0o644)
    card.write_text("wrong")  # as long, and as old
    os.utime(card, ns=(before.st_atime_ns, before.st_mtime_ns))
    again = _made(tmp_path, "a" * 12, card="right")
    os.utime(again / "cards/card", ns=(before.st_atime_ns, before.st_mtime_ns))
    assert again.name == f"{'a' * 12}-2"
    assert card.read_text() == "wrong"
    assert (tmp_path / "cards/card").read_text() == "right"
    assert _made(tmp_path, "a" * 12, card="right") == again
    assert _made(tmp_path, "a" * 12, card="right", more="") == place.with_name(f"{'a' * 12}-3")


def test_three_releases_before_the_current_one_are_kept(tmp_path: Path) -> None:
    mine = tmp_path / "releases" / "notes"
    mine.mkdir(parents=True)
    names = [f"{number:012x}" for number in range(6)]
    for age, name in enumerate(names):
        os.utime(_made(tmp_path, name, card=name), ns=(age, age))
    kept = sorted(p.name for p in (tmp_path / "releases").iterdir())
    assert kept == [*names[2:], "current", "notes"]
    assert (tmp_path / "cards/card").read_text() == names[-1]


def test_two_folders_are_the_same_with_the_same_files_of_the_same_bytes_alone(
    tmp_path: Path,
) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    for folder in (one, other):
        (folder / "cards").mkdir(parents=True)
        (folder / "cards" / "gel-a.json").write_text("{}")
    assert _same(one, other)
    (other / "stray").write_text("")
    assert not _same(one, other)
    assert not _same(other, one)
    (other / "stray").unlink()
    (other / "cards" / "gel-a.json").write_text("[]")
    assert not _same(one, other)
