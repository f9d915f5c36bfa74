"""The publishing half of a run: cards, database, curves, figures and audit into one release."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TypeVar

from deamat.core.calibration import Calibration
from deamat.core.card_lists import CalibrationRecord
from deamat.core.json_text import indented
from deamat.core.ledger import Failure, FileEntry, Provenance
from deamat.materials.card import Credit, MaterialCard
from deamat.materials.correlation import correlations_of
from deamat.materials.curves import write_curves
from deamat.materials.database import write_database
from deamat.run.boundary import FAILED, attempt
from deamat.run.build_cache import STALE, Redo, digest, key_of
from deamat.run.draw import FigureJob, draw_all, figure_jobs
from deamat.run.measure import Group, RunContext
from deamat.run.release import Release

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Publisher:
    """Makes one output at a time, or takes it over from the release before."""

    run: RunContext
    release: Release | None  # None in a dry run

    def make(
        self,
        stage: str,
        subject: str,
        parts: Mapping[str, str],
        names: Sequence[str],
        write: Callable[[Release], Sequence[Failure]],
        rests_on: Sequence[str] = (),
        runs: str = "",
    ) -> str:
        """Make the files `names` unless they are there already; return their key.

        Parameters
        ----------
        parts : what the files are made from, beside the code of the stage
        write : makes them, and says what failed on the way; what it raises is a failure as well
        rests_on : raw files, to be named if it fails
        runs : the stage's name among `run.stages` where it is not `stage`
        """
        parts = {**parts, **self.run.stages.parts(runs or stage)}
        fresh = self.run.cache.fresh(stage, subject, parts)
        if self.release is None:
            return key_of(parts) if fresh else STALE
        if fresh:
            if self.release.keep(*names):
                return key_of(parts)
            self.run.cache.redone.append(Redo(stage, subject, "its output was changed"))
        failures = attempt(stage, subject, rests_on, partial(write, self.release))
        if isinstance(failures, Failure):
            self.release.drop(*names)
            failures = [failures]
        for failure in failures:
            self.run.fail(failure)
        if failures:
            self.run.cache.drop(stage, subject)
            return FAILED
        return self.run.cache.keep(stage, subject, parts, None)


def publish(
    groups: Sequence[Group],
    files: Sequence[FileEntry],
    provenance: Provenance,
    run: RunContext,
    release: Release | None,
) -> None:
    """Write everything that is published; what did not change is kept from the release before."""
    publisher = Publisher(run, release)
    cards, keys = _cards(groups, publisher)
    _figures(groups, publisher)
    simulated = {s.campaign.name for s in run.surveys if s.campaign and s.campaign.info.synthetic}
    publisher.make(
        "curves", "curves.h5",
        {**{g.subject: g.key for g in groups}, "synthetic": ", ".join(sorted(simulated))},
        ["curves.h5"],
        lambda r: all_but_culprits(
            "curves", {g.subject: (g, g.files) for g in groups},
            lambda some: write_curves(
                r.path("curves.h5"), [m for g in some for m in g.measurements],
                synthetic_campaigns=simulated,
            ),
        ),
    )  # fmt: skip
    publisher.make(
        "database", "materials.sqlite",
        {
            **keys, "files": digest(tuple(files)), "provenance": digest(provenance),
            "failures": digest(tuple(run.failures)),
        },
        ["materials.sqlite"],
        lambda r: all_but_culprits(
            "database", {card.material: (card, _files_of(card)) for card in cards},
            lambda some: write_database(
                r.path("materials.sqlite"), some, files, provenance, run.failures
            ),
        ),
    )  # fmt: skip
    publisher.make(
        "audit", "files.json", {"files": digest(tuple(files))}, ["audit/files.json"],
        lambda r: _write(r.path("audit/files.json"), _as_json(files)),
    )  # fmt: skip
    if run.failures:  # last: it tells of all the others
        publisher.make(
            "audit", "internal_errors.json", {"failures": digest(tuple(run.failures))},
            ["audit/internal_errors.json"],
            lambda r: _write(r.path("audit/internal_errors.json"), _as_json(run.failures)),
        )  # fmt: skip


def all_but_culprits(
    stage: str,
    items: Mapping[str, tuple[T, Sequence[str]]],
    write: Callable[[Sequence[T]], None],
) -> list[Failure]:
    """Write a file of many items; where that fails, find those that do alone, and leave them out.

    Parameters
    ----------
    items : subject to the item and the raw files that it rests on
    write : makes the whole file of some items
    """
    every = [item for item, _ in items.values()]
    whole = attempt(stage, "of all", (), partial(write, every))
    if not isinstance(whole, Failure):
        return []
    alone = {
        subject: attempt(stage, subject, files, partial(write, [item]))
        for subject, (item, files) in items.items()
    }
    failures = [f for f in alone.values() if isinstance(f, Failure)]
    write([item for subject, (item, _) in items.items() if alone[subject] is None])
    return failures


def _cards(
    groups: Sequence[Group], publisher: Publisher
) -> tuple[list[MaterialCard], dict[str, str]]:
    """Make the card of each material; returns those that could be made, and the key of each."""
    by_material: dict[str, list[Group]] = {}
    for group in groups:
        by_material.setdefault(group.material, []).append(group)
    cards: list[MaterialCard] = []
    keys: dict[str, str] = {}
    for done, (material, mine) in enumerate(sorted(by_material.items()), start=1):
        files = tuple(dict.fromkeys(file for g in mine for file in g.files))
        card = attempt("card", material, files, partial(_card, material, mine, publisher.run))
        if isinstance(card, Failure):
            key = publisher.run.fail(card)
        else:
            key = publisher.make(
                "card",
                material,
                _card_parts(card, mine),
                [f"cards/{material}.json"],
                _writes(card),
                files,
            )
            if key != FAILED:
                cards.append(card)
        keys[f"card {material}"] = key
        publisher.run.progress("cards", done, len(by_material))
    return cards, keys


def _files_of(card: MaterialCard) -> tuple[str, ...]:
    origins = [o for r in card.records for o in r.origins]
    origins += [o for law in card.laws for o in law.origins]
    return tuple(dict.fromkeys(o.path or o.register for o in origins))


def _card(material: str, groups: Sequence[Group], run: RunContext) -> MaterialCard:
    infos = {s.campaign.name: s.campaign.info for s in run.surveys if s.campaign}
    campaigns = sorted({g.campaign for g in groups if g.summary} or {g.campaign for g in groups})
    credits_ = tuple(
        Credit(c, i.title, i.laboratory, i.licence, i.source, i.synthetic)
        for c, i in ((c, infos[c]) for c in campaigns)
    )
    summaries = [g.summary for g in groups if g.summary]
    records = tuple(r for s in summaries for r in s.records)
    origins = [o for r in records for o in r.origins]
    origins += [o for s in summaries for law in s.laws for o in law.origins]
    named = {name for origin in origins for name in origin.calibrations}
    known = run.config.instruments.calibrations
    return MaterialCard(
        material=material,
        name=run.config.name_of(material),
        synthetic=any(c.synthetic for c in credits_),
        records=records,
        laws=tuple(law for s in summaries for law in s.laws),
        refusals=tuple(r for s in summaries for r in s.refusals),
        campaigns=credits_,
        excluded=tuple(e for s in run.surveys for e in s.excluded if e.material == material),
        calibrations=tuple(_calibration(name, known[name]) for name in sorted(named)),
        correlations=correlations_of(records, [fit for s in summaries for fit in s.fits]),
    )


def _calibration(name: str, declared: Calibration) -> CalibrationRecord:
    return CalibrationRecord(
        name,
        declared.date.isoformat(),
        declared.last_day.isoformat(),
        declared.covers,
        declared.certificate,
        declared.u_relative,
    )


def _card_parts(card: MaterialCard, groups: Sequence[Group]) -> dict[str, str]:
    about = digest((card.name, card.synthetic, card.campaigns, card.excluded, card.calibrations))
    return {**{g.subject: g.key for g in groups}, "about": about}


def _writes(card: MaterialCard) -> Callable[[Release], Sequence[Failure]]:
    return lambda r: _write(r.path(f"cards/{card.material}.json"), card_file(card))


def card_file(card: MaterialCard) -> bytes:
    """Return the content of a card's file."""
    return card.to_json()


def _as_json(entries: Sequence[FileEntry] | Sequence[Failure]) -> bytes:
    return indented([asdict(entry) for entry in entries], 1)


def _write(path: Path, data: bytes) -> Sequence[Failure]:
    path.write_bytes(data)
    return ()


def _figures(groups: Sequence[Group], publisher: Publisher) -> None:
    """Draw the figures that are stale, in parallel where there are many."""
    stale: list[FigureJob] = []
    for job, parts in figure_jobs(groups, publisher.run):
        runs = "figure" if job.technique is None else f"figure {job.technique}"
        publisher.make("figure", job.name, parts, job.files, partial(_later, stale, job), runs=runs)
    if publisher.release is not None and stale:
        files = {job.name: job.files for job in stale}
        for failure in draw_all(stale, publisher.release.path("figures"), publisher.run):
            publisher.run.fail(failure)
            publisher.release.drop(*files[failure.subject])


def _later(stale: list[FigureJob], job: FigureJob, release: Release) -> Sequence[Failure]:
    """Put a figure on the list: they are drawn together."""
    del release
    stale.append(job)
    return ()
