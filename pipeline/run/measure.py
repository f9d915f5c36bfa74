"""The measuring half of a run: specimens to measurements, groups of them to summaries."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from graphlib import TopologicalSorter
from typing import TypeVar

from deamat.consistency.calibrations import calibrations_of, instrument_of
from deamat.consistency.notes import noted, with_circumstances
from deamat.consistency.states import states, under
from deamat.core.config import Config, Pooling
from deamat.core.config import digest as config_digest
from deamat.core.flags import Flag
from deamat.core.instruments import Instruments, Machine
from deamat.core.ledger import Failure
from deamat.core.properties import REFERENCE_AGE
from deamat.core.quantity import Quantity
from deamat.core.recording import Specimen
from deamat.core.records import Condition, Law, Measurement, PropertyRecord, Summary
from deamat.core.technique import AnyTechnique, Context
from deamat.formats.exports import Export
from deamat.run.boundary import FAILED, attempt
from deamat.run.build_cache import STALE, BuildCache, digest, key_of
from deamat.run.folders import Folders
from deamat.run.stages import Stages
from deamat.run.survey import Survey
from deamat.run.work import FILES_PER_TASK, Reduced, Task, attempt_one, lost, source_of
from deamat.run.workers import Workers

E = TypeVar("E", PropertyRecord, Law)
_AS_WARM_K = 5.0  # two techniques are used on two days
Progress = Callable[[str, int, int], None]


@dataclass(frozen=True, slots=True)
class Measured:
    """One specimen, the key of what it was made from, and what came of it.

    Parameters
    ----------
    reduced : None where a dry run does not know it yet, or where it failed
    flags : what comparing it with its row and with others showed
    """

    specimen: Specimen
    key: str
    reduced: Reduced | None
    failure: Failure | None = None
    flags: tuple[Flag, ...] = ()

    def noticed(self, *flags: Flag) -> Measured:
        """Add flags; the key changes with them."""
        told = tuple(dict.fromkeys((*self.flags, *flags)))
        if told == self.flags:
            return self
        key = STALE if self.key == STALE else key_of({"key": self.key, "flags": digest(told)})
        return replace(self, key=key, flags=told)


@dataclass(frozen=True, slots=True)
class Group:
    """The specimens of one material under one set of conditions in one campaign."""

    campaign: str
    material: str
    technique: str
    conditions: tuple[tuple[str, Condition], ...]
    key: str
    measurements: tuple[Measurement, ...]
    summary: Summary | None

    @property
    def subject(self) -> str:
        """How messages and the state name it; different conditions never read alike."""
        said = ",".join(f"{k}={v!r}" for k, v in self.conditions)
        return f"{self.campaign}/{self.technique}/{self.material}" + (f"[{said}]" if said else "")

    @property
    def files(self) -> tuple[str, ...]:
        """The raw files that it rests on."""
        return tuple(dict.fromkeys(source_of(m.specimen) for m in self.measurements))


@dataclass
class RunContext:
    """What measuring needs at hand.

    Parameters
    ----------
    records, laws : by campaign and material, of the techniques that came before
    stale : those among them that a dry run only knows from an earlier run
    unmade : campaign, material and key of what there will be, and a dry run knows nothing of
    failures : internal errors so far
    exports : forms that the laboratory declared in `config/exports.toml`
    """

    folders: Folders
    config: Config
    stages: Stages
    surveys: Sequence[Survey]
    cache: BuildCache
    workers: Workers
    progress: Progress
    dry: bool
    records: dict[tuple[str, str], list[PropertyRecord]] = field(default_factory=dict)
    laws: dict[tuple[str, str], list[Law]] = field(default_factory=dict)
    stale: list[PropertyRecord | Law] = field(default_factory=list)
    unmade: set[tuple[str, str, str]] = field(default_factory=set)
    failures: list[Failure] = field(default_factory=list)
    exports: tuple[Export, ...] = ()

    def fail(self, failure: Failure) -> str:
        """Note an internal error; returns what stands for the key of the thing not made."""
        self.failures.append(failure)
        self.cache.drop(failure.stage, failure.subject)
        return FAILED

    def sure(self, entries: Iterable[E]) -> list[E]:
        """Keep the records or laws that a dry run knows to be as they will be."""
        return [entry for entry in entries if all(entry is not one for one in self.stale)]

    def awaits(self, place: tuple[str, str], technique: AnyTechnique) -> bool:
        """Say whether a dry run knows nothing yet of something that a technique needs."""
        return any((*place, key) in self.unmade for key in technique.needs)


def in_order(techniques: Mapping[str, AnyTechnique]) -> list[AnyTechnique]:
    """Order the techniques so that each comes after those whose properties it needs."""
    giver = {key: t.key for t in techniques.values() for key in t.yields}
    graph = {t.key: {giver[n] for n in t.needs} for t in techniques.values()}
    return [techniques[key] for key in TopologicalSorter(graph).static_order()]


def measure(technique: AnyTechnique, run: RunContext) -> list[Measured]:
    """Measure every specimen of one technique; only what is stale is read again."""
    tasks = list(_tasks(technique, run))
    fresh = [run.cache.fresh("measurement", s, parts) for s, parts, _ in tasks]
    stale = [task for (_, _, task), good in zip(tasks, fresh, strict=True) if not good]
    made = iter(() if run.dry else _run(technique, stale, run))
    measured = []
    for (subject, parts, task), good in zip(tasks, fresh, strict=True):
        if good:
            reduced = run.cache.result("measurement", subject)
            measured.append(Measured(task.specimen, key_of(parts), reduced))
        elif run.dry:
            measured.append(Measured(task.specimen, STALE, None))
        else:
            reduced = next(made)
            if isinstance(reduced, Failure):
                measured.append(Measured(task.specimen, run.fail(reduced), None, reduced))
                continue
            key = run.cache.keep("measurement", subject, parts, reduced)
            measured.append(Measured(task.specimen, key, reduced))
    return measured


def summarise(
    technique: AnyTechnique, measured: Sequence[Measured], run: RunContext
) -> list[Group]:
    """Summarise each group of specimens; only what is stale is computed again."""
    groups = _groups(measured, run.config.conditions)
    result = []
    config = run.config.methods[technique.key]
    for described in sorted(groups, key=repr):
        campaign, material, conditions = described
        members = groups[described]
        good = tuple(
            under(m.reduced.measurement, conditions)
            for m in members
            if m.reduced and m.reduced.measurement
        )
        bare = Group(campaign, material, technique.key, conditions, "", good, None)
        parts = {
            **run.stages.parts(f"summary {technique.key}"),
            "config": config_digest(config),
            **{f"specimen {m.specimen.id}": m.key for m in members},
        }
        place = (campaign, material)
        given = run.laws.get(place, [])
        laws = _laws(technique, given)
        if run.awaits(place, technique) or _laws(technique, run.sure(given)) != laws:
            parts["laws"] = STALE
        elif laws:
            parts["laws"] = digest(sorted(laws.items()))
        if run.cache.fresh("summary", bare.subject, parts):
            summary = run.cache.result("summary", bare.subject)
            key = key_of(parts)
        elif run.dry:
            summary, key = run.cache.earlier("summary", bare.subject, parts), STALE
            if summary:
                run.stale += [*summary.records, *summary.laws]
            else:
                run.unmade |= {(*place, property_) for property_ in technique.yields}
        else:
            context = Context(config, Machine(), {}, laws=laws)
            made = (
                _summary(technique, bare, context, members, run.config.instruments)
                if good
                else None
            )
            if isinstance(made, Failure):
                summary, key = None, run.fail(made)
            else:
                summary, key = made, run.cache.keep("summary", bare.subject, parts, made)
        result.append(Group(campaign, material, technique.key, conditions, key, good, summary))
        if summary:
            run.records.setdefault(place, []).extend(summary.records)
            run.laws.setdefault(place, []).extend(summary.laws)
    return result


def _groups(
    measured: Sequence[Measured], pooling: Pooling
) -> dict[tuple[str, str, tuple[tuple[str, Condition], ...]], list[Measured]]:
    """Group specimens by campaign, material and conditions; temperatures far apart stay apart."""
    alike: dict[tuple[object, ...], list[Measured]] = {}
    for one in measured:
        s = one.specimen
        place = (s.campaign, s.material, *sorted(s.conditions.items()))
        alike.setdefault(place, []).append(one)
    groups = {}
    for members in alike.values():
        by_id = {m.specimen.id: m for m in members}
        for state in states([m.specimen for m in members], pooling):
            mine = {s.id: by_id[s.id] for s in state.specimens}
            for who, flag in state.unrecorded:
                mine[who] = mine[who].noticed(flag)
            first = members[0].specimen
            groups[first.campaign, first.material, state.conditions] = list(mine.values())
    return groups


def _summary(
    technique: AnyTechnique,
    group: Group,
    context: Context,
    members: Sequence[Measured],
    instruments: Instruments,
) -> Summary | Failure:
    rows = {m.specimen.id: m.specimen for m in members}
    held = {who: calibrations_of(row, instruments, technique.measures) for who, row in rows.items()}

    def make() -> Summary:
        made = noted(
            technique.summarise(group.measurements, context),
            {m.specimen.id: m.flags for m in members},
        )
        return with_circumstances(made, rows, held)

    return attempt("summary", group.subject, group.files, make)


def _laws(technique: AnyTechnique, laws: Sequence[Law]) -> dict[str, Law]:
    """Find the laws that a technique needs; of two of one property neither is taken."""
    found = {key: [law for law in laws if law.key == key] for key in technique.needs}
    return {key: mine[0] for key, mine in found.items() if len(mine) == 1}


def _tasks(technique: AnyTechnique, run: RunContext) -> Iterator[tuple[str, dict[str, str], Task]]:
    """Every specimen of a technique with the components its measurement depends on."""
    config = run.config.methods[technique.key]
    for survey in run.surveys:
        for specimen in survey.specimens:
            if specimen.technique != technique.key or survey.campaign is None:
                continue
            entry = survey.entries[specimen.file] if specimen.file else None
            machine = instrument_of(specimen, run.config.instruments)
            place = (specimen.campaign, specimen.material)
            given = run.records.get(place, [])
            found = needs_met(technique, specimen, given)
            sure = needs_met(technique, specimen, run.sure(given))
            awaited = run.awaits(place, technique) or sure != found
            info = survey.campaign.info
            exports = _exports_for(specimen, run.exports)
            task = Task(
                run.folders.raw, specimen, Context(config, machine, found, info.timezone),
                entry.sha256 if entry else None,
                changed=entry is not None and entry.manifest == "changed",
                registered=entry is None or entry.manifest != "extra",
                ends_open=info.ends_open, stated_units=survey.stated_units, exports=exports,
            )  # fmt: skip
            subject = task.subject
            parts = {
                "register row": digest(specimen),
                "config": config_digest(config),
                "instrument": f"{machine.entry or 'default'}:{config_digest(machine)}",
                "campaign": digest((info.ends_open, info.timezone, survey.stated_units)),
                "needs": STALE if awaited else digest(sorted(found.items())),
                **run.stages.parts(f"measurement {technique.key}"),
            }  # fmt: skip
            if exports:
                versions = {export.name: export.version for export in exports}
                parts["config/exports.toml"] = digest(versions)
            if entry:
                parts["file"] = entry.sha256
                parts["manifest"] = entry.manifest
            yield subject, parts, task


def _exports_for(specimen: Specimen, exports: Sequence[Export]) -> tuple[Export, ...]:
    """Return the declared forms that may read a specimen's file: the one named, or all that fit."""
    if specimen.format is not None:
        return tuple(export for export in exports if export.name == specimen.format)
    return tuple(e for e in exports if specimen.file and specimen.technique in e.form.techniques)


def needs_met(
    technique: AnyTechnique, specimen: Specimen, records: Sequence[PropertyRecord]
) -> dict[str, Quantity]:
    """Find what a technique needs among the records of its material and campaign."""
    needs = {key: _needed(key, specimen, records) for key in technique.needs}
    return {key: quantity for key, quantity in needs.items() if quantity is not None}


def _needed(key: str, specimen: Specimen, records: Sequence[PropertyRecord]) -> Quantity | None:
    """Find what a technique needs of its material: at the same age, else at the usual one.

    Of several at that age, the one at the temperature of the specimen.
    """
    age = REFERENCE_AGE
    if "age" in specimen.conditions:
        age = str(specimen.conditions["age"])
    found = [r for r in records if r.key == key]
    same = [r for r in found if "age" in r.conditions and r.conditions["age"] == age] or found
    if len(same) > 1:
        same = [r for r in same if _as_warm(r, specimen)]
    return same[0].quantity if len(same) == 1 else None


def _as_warm(record: PropertyRecord, specimen: Specimen) -> bool:
    own, its = specimen.numbers.get("temperature_K"), record.conditions.get("temperature_K")
    return own is not None and isinstance(its, float) and abs(own.value - its) <= _AS_WARM_K


def _run(
    technique: AnyTechnique, tasks: Sequence[Task], run: RunContext
) -> Iterator[Reduced | Failure]:
    """Work through the tasks, in this process where they are few."""
    run.progress(technique.key, 0, len(tasks))
    results = run.workers.map(attempt_one, tasks, lost, FILES_PER_TASK)
    for done, reduced in enumerate(results, start=1):
        run.progress(technique.key, done, len(tasks))
        yield reduced
