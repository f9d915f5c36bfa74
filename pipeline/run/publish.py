"""The publishing half of a run: cards, database, curves, figures and audit into one release."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

from deamat.core.ledger import FileEntry, Provenance
from deamat.materials.card import Credit, MaterialCard
from deamat.materials.curves import write_curves
from deamat.materials.database import write_database
from deamat.run.book import STALE, Redo, digest, key_of
from deamat.run.draw import FigureJob, draw_all, figure_jobs
from deamat.run.measure import Bench, Group
from deamat.run.release import Release


@dataclass(frozen=True, slots=True)
class Press:
    """Makes one output at a time, or takes it over from the release before."""

    bench: Bench
    release: Release | None  # None in a dry run

    def make(
        self,
        stage: str,
        subject: str,
        parts: Mapping[str, str],
        names: Sequence[str],
        write: Callable[[Release], None],
        runs: str = "",
    ) -> str:
        """Make the files `names` unless they are there already; return their key.

        Parameters
        ----------
        parts : what the files are made from, beside the code of the stage
        runs : the stage's name among `bench.stages` where it is not `stage`
        """
        parts = {**parts, **self.bench.stages.parts(runs or stage)}
        fresh = self.bench.book.fresh(stage, subject, parts)
        if self.release is None:
            return key_of(parts) if fresh else STALE
        if fresh:
            if self.release.keep(*names):
                return key_of(parts)
            self.bench.book.redone.append(Redo(stage, subject, "its output is not as it was"))
        write(self.release)
        return self.bench.book.keep(stage, subject, parts, None)


def publish(
    groups: Sequence[Group],
    files: Sequence[FileEntry],
    provenance: Provenance,
    bench: Bench,
    release: Release | None,
) -> None:
    """Write everything that is published; what did not change is kept from the release before."""
    press = Press(bench, release)
    by_material: dict[str, list[Group]] = {}
    for group in groups:
        by_material.setdefault(group.material, []).append(group)
    cards: list[MaterialCard] = []
    keys: dict[str, str] = {}
    for material, mine in sorted(by_material.items()):
        card = _card(material, mine, bench)
        cards.append(card)
        keys[f"card {material}"] = press.make(
            "card", material, _card_parts(card, mine), [f"cards/{material}.json"], _writes(card)
        )
        bench.progress("cards", len(cards), len(by_material))
    simulated = {s.campaign.name for s in bench.surveys if s.campaign and s.campaign.info.synthetic}
    press.make(
        "database", "materials.sqlite",
        {**keys, "files": digest(tuple(files)), "provenance": digest(provenance)},
        ["materials.sqlite"],
        lambda r: write_database(r.path("materials.sqlite"), cards, files, provenance),
    )  # fmt: skip
    press.make(
        "curves", "curves.h5",
        {**{g.subject: g.key for g in groups}, "synthetic": ", ".join(sorted(simulated))},
        ["curves.h5"],
        lambda r: write_curves(
            r.path("curves.h5"), [m for g in groups for m in g.measurements],
            synthetic_campaigns=simulated,
        ),
    )  # fmt: skip
    press.make(
        "audit", "files.json", {"files": digest(tuple(files))}, ["audit/files.json"],
        lambda r: _write(r.path("audit/files.json"), _ledger(files)),
    )  # fmt: skip
    _figures(groups, press)


def _card(material: str, groups: Sequence[Group], bench: Bench) -> MaterialCard:
    infos = {s.campaign.name: s.campaign.info for s in bench.surveys if s.campaign}
    campaigns = sorted({g.campaign for g in groups})
    credits_ = tuple(
        Credit(c, i.title, i.laboratory, i.licence, i.source, i.synthetic)
        for c, i in ((c, infos[c]) for c in campaigns)
    )
    summaries = [g.summary for g in groups if g.summary]
    return MaterialCard(
        material=material,
        name=bench.config.name_of(material),
        synthetic=any(c.synthetic for c in credits_),
        records=tuple(r for s in summaries for r in s.records),
        laws=tuple(law for s in summaries for law in s.laws),
        refusals=tuple(r for s in summaries for r in s.refusals),
        campaigns=credits_,
    )


def _card_parts(card: MaterialCard, groups: Sequence[Group]) -> dict[str, str]:
    about = digest((card.name, card.synthetic, card.campaigns))
    return {**{g.subject: g.key for g in groups}, "about": about}


def _writes(card: MaterialCard) -> Callable[[Release], None]:
    return lambda r: _write(r.path(f"cards/{card.material}.json"), card.to_json())


def _ledger(files: Sequence[FileEntry]) -> bytes:
    return (json.dumps([asdict(f) for f in files], indent=1) + "\n").encode()


def _write(path: Path, data: bytes) -> None:
    path.write_bytes(data)


def _figures(groups: Sequence[Group], press: Press) -> None:
    """Draw the figures that are stale, in parallel where there are many."""
    stale: list[FigureJob] = []
    for job, parts in figure_jobs(groups, press.bench):
        runs = "figure" if job.technique is None else f"figure {job.technique}"
        press.make("figure", job.name, parts, job.files, partial(_later, stale, job), runs)
    if press.release is not None and stale:
        draw_all(stale, press.release.path("figures"), press.bench)


def _later(stale: list[FigureJob], job: FigureJob, release: Release) -> None:
    """Put a figure on the list: they are drawn together."""
    del release
    stale.append(job)
