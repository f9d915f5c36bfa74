"""Which figures a release has, and drawing them in parallel."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from deamat.core.present import readable_conditions
from deamat.core.records import Measurement, Summary
from deamat.core.slug import file_stem, short_slug
from deamat.run.book import STALE
from deamat.run.measure import Bench, Group
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
        return [f"figures/{self.name}.svg", f"figures/{self.name}.png"]


def figure_jobs(
    groups: Sequence[Group], bench: Bench
) -> Iterator[tuple[FigureJob, dict[str, str]]]:
    """List every figure with the components it depends on."""
    synthetic = {s.campaign.name: s.campaign.info.synthetic for s in bench.surveys if s.campaign}
    for g in groups:
        if TECHNIQUES[g.technique].figure is None or (g.summary is None and g.key != STALE):
            continue
        said = readable_conditions(dict(g.conditions)) if g.conditions else ""
        name = bench.config.name_of(g.material)
        title = f"{name}, {g.technique}" + (f", {said}" if said else "")
        job = FigureJob(
            f"{g.campaign}/{_stem(g)}", title, synthetic[g.campaign], g.technique,
            g.measurements, (g.summary,) if g.summary else (), (),
        )  # fmt: skip
        yield job, {g.subject: g.key, "about": f"{title} {synthetic[g.campaign]}"}
    for campaign in sorted({g.campaign for g in groups}):
        mine = [g for g in groups if g.campaign == campaign and _gives_moduli(g)]
        if mine:
            names = {g.material: bench.config.name_of(g.material) for g in mine}
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
    values = " ".join(str(value) for _, value in group.conditions)
    return file_stem(
        group.material, group.technique, short_slug(values, repr(sorted(group.conditions)))
    )


def _gives_moduli(group: Group) -> bool:
    return any(_is_modulus(key) for key in TECHNIQUES[group.technique].yields)


def _is_modulus(key: str) -> bool:
    return key.endswith("_modulus")


def draw_all(jobs: Sequence[FigureJob], folder: Path, bench: Bench) -> None:
    """Draw figures into a folder."""
    drawn = bench.workers.map(partial(draw_one, folder), jobs)
    for done, _ in enumerate(drawn, start=1):
        bench.progress("figures", done, len(jobs))


def draw_one(folder: Path, job: FigureJob) -> None:
    """Draw one figure as SVG and PNG."""
    from deamat.report.figures import moduli_figure, technique_figure  # matplotlib
    from deamat.report.moduli import modulus_bars

    place = folder / job.name
    place.parent.mkdir(parents=True, exist_ok=True)
    if job.technique is None:
        records = [r for s in job.summaries for r in s.records]
        refusals = [r for s in job.summaries for r in s.refusals]
        names = dict(job.labels)
        bars = [replace(b, material=names[b.material]) for b in modulus_bars(records, refusals)]
        moduli_figure(place.parent, place.name, job.title, bars, job.synthetic)
        return
    figure = TECHNIQUES[job.technique].figure
    if figure is not None:
        technique_figure(
            place.parent, place.name, job.title,
            lambda axes: figure(axes, job.measurements, job.summaries[0]), job.synthetic,
        )  # fmt: skip
