"""A run from raw files to a release: survey, measure, summarise, publish."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from deamat import __version__
from deamat.core.campaign import find_campaigns
from deamat.core.config import Config, load_config
from deamat.core.errors import ConfigError
from deamat.core.ledger import Failure, FileEntry, Provenance
from deamat.core.slug import Spellings
from deamat.run.book import Book, key_of
from deamat.run.boundary import attempt
from deamat.run.contents import contents_id
from deamat.run.describe import describe
from deamat.run.folders import Folders, Stat, locate
from deamat.run.measure import Bench, Group, Measured, Progress, in_order, measure, summarise
from deamat.run.publish import publish
from deamat.run.published import listing
from deamat.run.release import Release
from deamat.run.stages import Stages, find_stages
from deamat.run.state import State
from deamat.run.survey import Survey, failed, survey, without_survey
from deamat.run.work import source_of
from deamat.run.workers import Workers
from deamat.techniques import TECHNIQUES


def hash_inputs(
    seen: Mapping[str, Stat], folders: Folders, state: State, verify: bool
) -> dict[str, str]:
    """Hash every input whose size or time of change is new; all of them to verify."""
    known = {} if verify else state.inputs()
    return {
        path: known[path][1]
        if path in known and known[path][0] == stat
        else hashlib.sha256(locate(path, folders).read_bytes()).hexdigest()
        for path, stat in seen.items()
    }


def process(
    folders: Folders,
    state: State,
    seen: Mapping[str, Stat],
    *,
    workers: int,
    progress: Progress,
    verify: bool = False,
    dry: bool = False,
) -> dict[str, Any]:
    """Bring `processed/` up to date with what was seen and say what came of it.

    Parameters
    ----------
    seen : every input, as `look` lists it
    workers : processes at most; 1 works in this one
    verify : hash every input again, whatever its time of change
    dry : only find out what is stale and why; no file is read, nothing made or published

    Raises
    ------
    ConfigError : the configuration does not hold
    """
    hashes = hash_inputs(seen, folders, state, verify)
    config = load_config(folders.config, {t.key: t.config for t in TECHNIQUES.values()})
    surveys, broken, ignored = look_at_raw(folders, seen, hashes, config)
    book = Book(state)
    stages = find_stages(TECHNIQUES, hashes, state)
    with Workers(workers) as pool:
        bench = Bench(folders, config, stages, surveys, book, pool, progress, dry, failures=broken)
        groups: list[Group] = []
        measured: list[Measured] = []
        for technique in in_order(TECHNIQUES):
            mine = measure(technique, bench)
            measured += mine
            groups += summarise(technique, mine, bench)
        files = _account(surveys, measured)
        provenance = _provenance(config, stages, hashes)
        if dry:
            publish(groups, files, provenance, bench, None)
            book.close()
            return {"redone": [str(r) for r in book.redone]}
        state.db.commit()  # measurements hold whatever becomes of the release
        release = Release(folders.processed, state.read_note("published"))
        publish(groups, files, provenance, bench, release)
        book.close()
        name = contents_id(release.building)
        place = release.publish(name)
    document = describe(bench, groups, files, ignored, name)
    state.remember_inputs(seen, hashes)
    state.note("published", listing(place))
    return document


def look_at_raw(
    folders: Folders, seen: Mapping[str, Stat], hashes: Mapping[str, str], config: Config
) -> tuple[list[Survey], list[Failure], list[str]]:
    """Survey every campaign; name what is no campaign."""
    if not folders.raw.is_dir():
        raise ConfigError(f"no folder {folders.raw}; give one with --raw")
    found, ignored = find_campaigns(folders.raw)
    spellings = Spellings()
    for material in config.materials:
        spellings.other("material", material, "config/materials.toml")
    surveys: list[Survey] = []
    broken: list[Failure] = []
    for folder in found:
        prefix = f"raw/{folder.name}/"
        mine = [path for path in seen if path.startswith(prefix)]
        sizes = {path[4:]: seen[path].size for path in mine}
        sums = {path[4:]: hashes[path] for path in mine}
        done = attempt(
            "survey", folder.name, sorted(sizes),
            partial(survey, folder, sizes, sums, TECHNIQUES, config, spellings),
        )  # fmt: skip
        if isinstance(done, Failure):
            broken.append(done)
            done = without_survey(done, sizes, sums, TECHNIQUES)
        surveys.append(done)
    return surveys, broken, ignored


def _account(surveys: list[Survey], measured: list[Measured]) -> list[FileEntry]:
    """Close the account of files with what became of each recording."""
    entries = {path: e for survey in surveys for path, e in survey.entries.items()}
    for one in measured:
        path, reduced = one.specimen.file, one.reduced
        if one.failure is not None:
            path = source_of(one.specimen)
            entries[path] = failed(entries[path], one.failure)
        if reduced is None:
            continue
        if reduced.error is not None:
            error = reduced.error
            path = path or error.path
            entries[path] = entries[path].rejected(error)
        elif path and reduced.measurement and not reduced.measurement.values:
            why = "; ".join(f"{r.key}: {r.reason}" for r in reduced.measurement.refusals)
            entries[path] = replace(entries[path], status="refused", reason=why)
    return [entries[path] for path in sorted(entries)]


def _provenance(config: Config, stages: Stages, hashes: Mapping[str, str]) -> Provenance:
    code = {path: sha for path, sha in hashes.items() if path.startswith("code/")}
    environment = {
        "Python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
        **stages.libraries(),
    }
    return Provenance(
        version=__version__,
        code=key_of(code),
        stages=tuple(sorted((s, one.code) for s, one in stages.fingerprints.items())),
        environment=tuple(environment.items()),
        config=tuple(sorted(config.files.items())),
    )
