"""An internal error takes away what it concerns and nothing else, is told, and heals by itself."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import deamat.run.draw
import deamat.run.process
import deamat.run.publish
import deamat.run.work
from deamat import open_database
from deamat.core.records import Measurement
from deamat.run import summary
from deamat.run.audit import audit, audit_text
from deamat.run.folders import Folders
from deamat.run.register import register
from deamat.techniques import TECHNIQUES
from tests.run.conftest import (
    MATERIALS,
    ROOT,
    curves,
    run,
    small_campaign,
    twin_rows,
    write_campaign,
)

pytestmark = pytest.mark.usefixtures("quick_figures")

_GOOD, _BAD = MATERIALS
Patch = pytest.MonkeyPatch


@pytest.fixture(scope="module")
def well(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, bytes]]:
    """The outputs of runs without the bad campaign, and with it where nothing fails."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(deamat.run.draw, "draw_one", _words)
        alone = _campaigns(tmp_path_factory.mktemp("alone"), ["good"])
        both = _campaigns(tmp_path_factory.mktemp("both"), ["good", "bad"])
        assert run(alone)["exit_code"] == run(both)["exit_code"] == 0
    return {"alone": _bytes(alone), "both": _bytes(both)}


def _campaigns(place: Path, names: list[str]) -> Folders:
    folders = Folders(place / "raw", ROOT / "config", place / "processed")
    for name in names:
        small_campaign(folders.raw / name, [_BAD if name == "bad" else _GOOD])
    return folders


def _bytes(folders: Folders) -> dict[str, bytes]:
    place = (folders.processed / "releases" / "current").resolve()
    return {
        p.relative_to(place).as_posix(): p.read_bytes() for p in place.rglob("*") if p.is_file()
    }


def _words(folder: Path, job: deamat.run.draw.FigureJob) -> None:
    for name in job.files:
        (folder.parent / name).parent.mkdir(parents=True, exist_ok=True)
        (folder.parent / name).write_text(f"SYNTHETIC {job.title} {len(job.measurements)}")


def _bursting(stage: Callable[..., Any], concerns: Callable[..., bool]) -> Callable[..., Any]:
    """Let a stage fail where its arguments concern the bad campaign."""

    def burst(*arguments: Any, **named: Any) -> Any:
        if concerns(*arguments):
            raise RuntimeError("injected")
        return stage(*arguments, **named)

    return burst


def _in_module(module: Any, name: str, concerns: Callable[..., bool]) -> Callable[[Patch], None]:
    return lambda patch: patch.setattr(module, name, _bursting(getattr(module, name), concerns))


def _in_room(part: str, concerns: Callable[..., bool]) -> Callable[[Patch], None]:
    changed = copy.copy(TECHNIQUES["compression"])
    object.__setattr__(changed, part, _bursting(getattr(changed, part), concerns))  # it is frozen
    return lambda patch: patch.setitem(TECHNIQUES, "compression", changed)


def _is_bad(measurement: Measurement) -> bool:
    return measurement.specimen.campaign == "bad"


_publish = deamat.run.publish
STAGES: dict[str, tuple[Callable[[Patch], None], str, set[str]]] = {
    # where it bursts, the stage that says so, and what of the bad campaign is published all the same
    "survey": (
        _in_module(deamat.run.process, "survey", lambda folder, *_: folder.name == "bad"),
        "survey",
        set(),
    ),
    "read": (
        _in_module(deamat.run.work, "_read", lambda task, *_: task.specimen.campaign == "bad"),
        "measurement",
        {"card"},
    ),
    "reduce": (
        _in_room("reduce", lambda specimen, *_: specimen.campaign == "bad"),
        "measurement",
        {"card"},
    ),
    "summarise": (_in_room("summarise", lambda some, *_: _is_bad(some[0])), "summary", {"card"}),
    "card": (_in_module(_publish, "_card", lambda name, *_: name == _BAD), "card", {"figure"}),
    "card file": (
        _in_module(_publish, "card_file", lambda card: card.material == _BAD),
        "card",
        {"figure"},
    ),
    "figure": (
        _in_module(deamat.run.draw, "draw_one", lambda _, job: job.name.startswith("bad/")),
        "figure",
        {"card"},
    ),
    "curves": (
        _in_module(_publish, "write_curves", lambda _, some: any(map(_is_bad, some))),
        "curves",
        {"card", "figure"},
    ),
    "database": (
        _in_module(_publish, "write_database", lambda _, c, *__: _BAD in [x.material for x in c]),
        "database",
        {"card", "figure"},
    ),
}


@pytest.mark.parametrize("where", STAGES)
def test_a_failure_in_one_campaign_leaves_the_others_as_they_are(
    where: str, tmp_path: Path, monkeypatch: Patch, well: dict[str, dict[str, bytes]]
) -> None:
    inject, stage, still = STAGES[where]
    folders = _campaigns(tmp_path, ["good", "bad"])
    with monkeypatch.context() as patch:
        inject(patch)
        document = run(folders)
        assert document["exit_code"] == 3
        assert run(folders)["nothing_to_do"] is False  # it is tried again
    made = _bytes(folders)
    mine = {name for name in well["alone"] if name.startswith(("cards/", "figures/"))}
    assert {name: made[name] for name in mine} == {name: well["alone"][name] for name in mine}
    published = {f"cards/{_BAD}.json": "card", "figures/bad/moduli.svg": "figure"}
    assert {kind for name, kind in published.items() if name in made} == still
    with open_database(folders.processed) as database:
        assert database[_GOOD].to_json() == made[f"cards/{_GOOD}.json"]
        assert stage == "database" or database.failures()
        assert len(database.curves(_GOOD)["curve"]) == 3
    errors = document["internal_errors"]
    assert {error["stage"] for error in errors} == {stage}
    assert json.loads(made["audit/internal_errors.json"]) == json.loads(json.dumps(errors))
    for error in errors:
        assert error["error"] == "RuntimeError: injected"
        assert "RuntimeError: injected" in error["traceback"]
        assert str(ROOT) not in error["traceback"]
        assert error["files"]
        assert all(file.startswith("bad/") for file in error["files"])

    healed = run(folders)
    assert (healed["exit_code"], healed["internal_errors"]) == (0, [])
    assert _bytes(folders) == well["both"]


def test_all_is_said_in_one_line_and_in_full_in_the_audit(
    tmp_path: Path, monkeypatch: Patch
) -> None:
    folders = _campaigns(tmp_path, ["good", "bad"])
    inject, _, _ = STAGES["reduce"]
    inject(monkeypatch)
    document = run(folders)
    (line,) = [row for row in summary.text(document).splitlines() if "RuntimeError" in row]
    assert line.startswith("INTERNAL   measurement bad/compression/")
    assert "(RuntimeError: injected) and 2 more: internal error, all the rest is published" in line
    assert document["files"]["failed"] == 3
    told = audit(folders)
    assert told["exit_code"] == 3
    assert audit_text(told).count("    RuntimeError: injected") == 3
    assert {f["status"] for f in told["files"] if f["path"].endswith(".txt")} == {"used", "failed"}


def test_a_failure_that_comes_later_takes_back_what_was_published_of_it(
    tmp_path: Path, monkeypatch: Patch
) -> None:
    """What was good in an earlier run is not kept beside a release that lacks it."""
    folders = _campaigns(tmp_path, ["good", "bad"])
    run(folders)
    inject, _, _ = STAGES["survey"]
    with monkeypatch.context() as patch:
        inject(patch)
        (folders.raw / "bad" / "campaign.toml").touch()
        assert run(folders)["exit_code"] == 3
        assert not (folders.processed / "cards" / f"{_BAD}.json").exists()
    assert run(folders)["exit_code"] == 0
    assert (folders.processed / "cards" / f"{_BAD}.json").exists()


def test_no_modulus_and_no_reading_means_no_figure(tmp_path: Path) -> None:
    """These ended the run of every campaign: nothing to draw is nothing to fail over."""
    folders = _campaigns(tmp_path, ["good", "bad"])
    for path in curves(folders, "bad"):
        path.write_bytes(b"")
    still = folders.raw / "still"
    write_campaign(twin_rows("viscosity/specimens.csv")[:1], still, "viscosity/specimens.csv")
    for path in still.rglob("*.log"):
        path.write_bytes(re.sub(rb"RPM +[0-9]+ +[0-9.]+", b"RPM  0  0.0", path.read_bytes()))
    register(folders.raw, "bad", accept_all=True)
    register(folders.raw, "still", accept_all=True)
    document = run(folders)
    assert (document["exit_code"], document["internal_errors"]) == (1, [])
    assert {r["campaign"] for r in document["refused"]} == {"still"}
    figures = [name for name in _bytes(folders) if name.startswith("figures/")]
    assert figures
    assert all(name.startswith("figures/good/") for name in figures)
