"""A run from raw files to a release: survey, measure, summarise, publish."""

from __future__ import annotations

import hashlib
import os
import platform
from collections.abc import Collection, Mapping
from copy import deepcopy
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from deamat import __version__
from deamat.core.campaign import is_campaign_file
from deamat.core.config import Config, load_config
from deamat.core.errors import ConfigError
from deamat.core.ledger import Failure, FileEntry, Provenance
from deamat.core.slug import Spellings
from deamat.core.technique import AnyTechnique
from deamat.formats.detect import KNOWN_FORMS
from deamat.formats.exports import EXPORTS_FILE, load_exports
from deamat.run.boundary import attempt
from deamat.run.build_cache import BuildCache, key_of
from deamat.run.compare import compare
from deamat.run.contents import contents_id
from deamat.run.describe import describe
from deamat.run.exclusions import insist_on_targets
from deamat.run.folders import Folders, Input, Stat, locate, name_as_text
from deamat.run.measure import Group, Measured, Progress, RunContext, in_order, measure, summarise
from deamat.run.publish import publish
from deamat.run.published import listing
from deamat.run.release import Release
from deamat.run.stages import Stages, find_stages
from deamat.run.state import State
from deamat.run.survey import Survey, failed, survey, survey_strays, without_survey
from deamat.run.vanished import published
from deamat.run.work import source_of
from deamat.run.workers import Workers
from deamat.techniques import TECHNIQUES


def hash_inputs(
    seen: Mapping[str, Stat], folders: Folders, state: State, verify: bool
) -> dict[str, Input]:
    """Hash every input whose size or time of change is new; all of them to verify."""
    known = {} if verify else state.inputs()
    return {
        path: Input(stat.size, known[path][1])
        if path in known and known[path] == (stat, known[path][1])
        else _hashed(path, stat, folders)
        for path, stat in seen.items()
    }


def _hashed(path: str, stat: Stat, folders: Folders) -> Input:
    if stat.odd:
        return Input(0, "", stat.odd)
    try:
        data = locate(path, folders).read_bytes()
    except FileNotFoundError:
        return Input(0, "", "it vanished while the run was at work; run again")
    except OSError as error:
        return Input(0, "", f"it cannot be read: {error.strerror}")
    return Input(len(data), hashlib.sha256(data).hexdigest())


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
    inputs = hash_inputs(seen, folders, state, verify)
    hashes = {path: one.sha256 for path, one in inputs.items()}
    config = load_config(folders.config, {t.key: t.config for t in TECHNIQUES.values()})
    exports = load_exports(folders.config, KNOWN_FORMS)
    if declared := hashes.get(f"config/{EXPORTS_FILE}"):
        config = replace(config, files={**config.files, EXPORTS_FILE: declared})
    surveys, broken, ignored = look_at_raw(folders, inputs, config)
    insist_on_targets(config.exclusions.exclude, surveys, [failure.subject for failure in broken])
    cache = BuildCache(state)
    stages = find_stages(TECHNIQUES, hashes, state)
    with Workers(workers) as pool:
        run = RunContext(
            folders,
            config,
            stages,
            surveys,
            cache,
            pool,
            progress,
            dry,
            failures=broken,
            exports=exports,
        )
        measured, groups = measure_all(TECHNIQUES, run)
        files = _account(surveys, measured)
        provenance = _provenance(config, stages, hashes)
        if dry:
            publish(groups, files, provenance, run, None)
            cache.close()
            return {"redone": [str(r) for r in cache.redone]}
        state.commit()  # measurements hold whatever becomes of the release
        release = Release(folders.processed, state.read_note("published"))
        before = published(release.releases / release.before if release.before else None)
        publish(groups, files, provenance, run, release)
        cache.close()
        name = contents_id(release.building)
        place = release.publish(name)
        state.aside += release.aside
    document = describe(run, groups, files, ignored, name, before)
    state.remember_inputs(seen, inputs)
    state.note("published", listing(place))
    return document


def measure_all(
    techniques: Mapping[str, AnyTechnique], run: RunContext
) -> tuple[list[Measured], list[Group]]:
    """Measure, compare and summarise all specimens, technique by technique in order of need."""
    measured: list[Measured] = []
    groups: list[Group] = []
    for technique in in_order(techniques):
        mine = compare(measure(technique, run), run)
        measured += mine
        groups += summarise(technique, mine, run)
    return measured, groups


def look_at_raw(
    folders: Folders, inputs: Mapping[str, Input], config: Config
) -> tuple[list[Survey], list[Failure], list[str]]:
    """Survey every campaign; name what is no campaign."""
    if not folders.raw.is_dir():
        raise ConfigError(f"no folder {folders.raw}; give one with --raw")
    raw = {path.removeprefix("raw/"): one for path, one in inputs.items() if path[:4] == "raw/"}
    names = sorted({path.partition("/")[0] for path in raw if is_campaign_file(path)})
    spellings = Spellings()
    for material in config.materials:
        spellings.other("material", material, "config/materials.toml")
    surveys: list[Survey] = [survey_strays(raw, config)]
    broken: list[Failure] = []
    for name in names:
        mine = {path: one for path, one in raw.items() if path.startswith(f"{name}/")}
        trial = deepcopy(spellings)
        done = attempt(
            "survey", name, sorted(mine),
            partial(survey, folders.raw / name, mine, TECHNIQUES, config, trial),
        )  # fmt: skip
        if isinstance(done, Failure):
            broken.append(done)
            done = without_survey(done, mine, TECHNIQUES)
        else:
            spellings = trial
        surveys.append(done)
    return surveys, broken, _ignored(folders.raw, {*names, *surveys[0].entries})


def _ignored(raw: Path, known: Collection[str]) -> list[str]:
    """Name what stands in `raw/` and is neither a campaign nor accounted for."""
    with os.scandir(raw) as entries:
        names = {name_as_text(e.name): Path(e).is_dir() for e in entries if e.name[0] != "."}
    return sorted(
        name + ("/" if folder else "") for name, folder in names.items() if name not in known
    )


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
