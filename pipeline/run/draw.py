"""Which figures a release has, and drawing them in parallel."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from deamat.core.chart import Chart
from deamat.core.ledger import Failure
from deamat.core.present import readable_conditions
from deamat.core.records import Condition, Measurement, Summary
from deamat.core.slug import file_stem, short_slug
from deamat.report.chart.page import picture
from deamat.report.moduli import is_modulus, modulus_bars
from deamat.report.moduli_chart import moduli_chart
from deamat.run.boundary import attempt, killed
from deamat.run.build_cache import STALE
from deamat.run.measure import Group, RunContext
from deamat.run.work import source_of
from deamat.techniques import TECHNIQUES


@dataclass(frozen=True, slots=True)
class FigureJob:
    """One figure to draw: a group's curves, or (without a technique) a campaign's moduli.

    Parameters
    ----------
    name : path below `figures/`, without its ending
    """

    name: str
    title: str
    synthetic: bool
    technique: str | None
    measurements: tuple[Measurement, ...]
    summaries: tuple[Summary, ...]
    labels: tuple[tuple[str, str], ...]

    @property
    def files(self) -> list[str]:
        """What it publishes."""
        return [f"figures/{self.name}.svg"]

    @property
    def rests_on(self) -> tuple[str, ...]:
        """The raw files behind what it shows."""
        origins = [o for s in self.summaries for r in s.records for o in r.origins]
        files = [source_of(m.specimen) for m in self.measurements]
        return tuple(dict.fromkeys([*files, *(o.path or o.register for o in origins)]))


def figure_jobs(
    groups: Sequence[Group], run: RunContext
) -> Iterator[tuple[FigureJob, dict[str, str]]]:
    """List every figure with the components it depends on."""
    synthetic = {s.campaign.name: s.campaign.info.synthetic for s in run.surveys if s.campaign}
    for g in groups:
        if TECHNIQUES[g.technique].figure is None or not _has_something_to_draw(g):
            continue
        said = readable_conditions(dict(g.conditions), typeset=True) if g.conditions else ""
        name = run.config.name_of(g.material)
        title = f"{name}, {g.technique}" + (f", {said}" if said else "")
        job = FigureJob(
            f"{g.campaign}/{_stem(g)}", title, synthetic[g.campaign], g.technique,
            g.measurements, (g.summary,) if g.summary else (), (),
        )  # fmt: skip
        yield job, {g.subject: g.key, "about": f"{title} {synthetic[g.campaign]}"}
    for campaign in sorted({g.campaign for g in groups}):
        mine = [g for g in groups if g.campaign == campaign and _gives_moduli(g)]
        if any(map(_has_moduli, mine)):
            names = {g.material: run.config.name_of(g.material) for g in mine}
            job = FigureJob(
                f"{campaign}/moduli", f"Moduli, {campaign}", synthetic[campaign], None, (),
                tuple(g.summary for g in mine if g.summary), tuple(names.items()),
            )  # fmt: skip
            about = f"{synthetic[campaign]} {sorted(names.items())}"
            yield job, {**{g.subject: g.key for g in mine}, "about": about}


def _stem(group: Group) -> str:
    """Name the figure of a group by ids and by its conditions in short."""
    if not group.conditions:
        return file_stem(group.material, group.technique)
    values = " ".join(_short(key, value) for key, value in group.conditions)
    return file_stem(
        group.material, group.technique, short_slug(values, repr(sorted(group.conditions)))
    )


def _short(key: str, value: Condition) -> str:
    """Write `323.15K`: the unit stands in the key."""
    return f"{value:.6g}{key.rpartition('_')[2]}" if isinstance(value, float) else str(value)


def _gives_moduli(group: Group) -> bool:
    return any(is_modulus(key) for key in TECHNIQUES[group.technique].yields)


def _has_something_to_draw(group: Group) -> bool:
    """Say whether a group was summarised from a value or a curve; may be."""
    return group.key == STALE or (
        group.summary is not None
        and any(m.values or any(map(len, m.curve.values())) for m in group.measurements)
    )


def _has_moduli(group: Group) -> bool:
    """Say whether a group has a modulus to draw, or to say of that it was refused; may have."""
    s = group.summary
    return group.key == STALE or (
        s is not None
        and any(map(is_modulus, [*(r.key for r in s.records), *(r.key for r in s.refusals)]))
    )


def draw_all(jobs: Sequence[FigureJob], folder: Path, run: RunContext) -> Iterator[Failure]:
    """Draw figures into a folder; give what went wrong."""
    drawn = run.workers.map(partial(_attempt, folder), jobs, _lost)
    for done, failure in enumerate(drawn, start=1):
        run.progress("figures", done, len(jobs))
        if failure is not None:
            yield failure


def _attempt(folder: Path, job: FigureJob) -> Failure | None:
    return attempt("figure", job.name, job.rests_on, partial(draw_one, folder, job))


def _lost(job: FigureJob) -> Failure:
    return killed("figure", job.name, job.rests_on)


def draw_one(folder: Path, job: FigureJob) -> None:
    """Draw one figure as SVG."""
    place = folder / f"{job.name}.svg"
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_bytes(picture(chart_of(job), job.title, job.synthetic))


def chart_of(job: FigureJob) -> Chart:
    """Return what a figure shows.

    Raises
    ------
    ValueError : there is nothing to show
    """
    if job.technique is not None:
        figure = TECHNIQUES[job.technique].figure
        if figure is None:
            raise ValueError(f"{job.technique} has no figure")
        return figure(job.measurements, job.summaries[0])
    records = [r for s in job.summaries for r in s.records]
    refusals = [r for s in job.summaries for r in s.refusals]
    names = dict(job.labels)
    bars = [replace(b, material=names[b.material]) for b in modulus_bars(records, refusals)]
    return moduli_chart(bars)
