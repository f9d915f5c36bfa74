"""Handling time: how long after mixing a silicone still prints clean lines.

Lines are printed one after another, and each is looked at. The truth lies between the last clean
line and the first defective one, or beyond the last line where the test or the equipment ended
first: the value is the time of the last clean line, which an operator can rely on, and its record
says whether it is the lower end of an interval or only a lower bound.

Which viscosity the silicone has then stands beside it, with what it does not mean: see
`_handling_viscosity`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from operator import attrgetter
from typing import Any

from pydantic import Field

from deamat.core.instruments import Declared
from deamat.core.properties import property_key
from deamat.core.quantity import Quantity
from deamat.core.records import (
    Detail,
    Flag,
    Measurement,
    Origin,
    PropertyRecord,
    Recording,
    Refusal,
    Specimen,
    Summary,
)
from deamat.core.register import RegisterForm
from deamat.core.technique import Context, Technique
from deamat.core.units import from_si
from deamat.techniques._handling_viscosity import KEY as VISCOSITY_THEN
from deamat.techniques._handling_viscosity import VISCOSITY, viscosity_then
from deamat.techniques._printed_lines import RUN_COLUMNS, Line, Run, line_of, runs_of

KEY = "handling_time"
VERSION = 2


class HandlingConfig(Declared):
    """`[handling]` in `config/methods.toml`."""

    clean: tuple[str, ...] = Field(
        default=("none",),
        description="words in the columns `defect` and `limit` that say that there was none",
    )
    defects: tuple[str, ...] = Field(
        default=("dripping", "gap", "under-extrusion", "over-extrusion", "bulging", "no flow"),
        description="words that call it defective; any other word is refused",
    )
    max_gap_s: float = Field(
        default=7200.0,
        gt=0.0,
        description="time between the last clean and the first defective line that is flagged",
    )
    max_temperature_difference_K: float = Field(
        default=3.0,
        gt=0.0,
        description="by which the bed may differ from the viscometer's cup for the viscosity at "
        "the handling time to be told",
    )


def reduce(specimen: Specimen, _recording: Recording | None, context: Context) -> Measurement:
    """Check that one printed line is called clean or defective in words that are known.

    Parameters
    ----------
    specimen : a line, with `time_s` since mixing and the notes `defect`, `limit` and `line`
    context : with a `HandlingConfig`
    """
    config: HandlingConfig = context.config
    word = specimen.notes["defect"].casefold()
    if word in config.clean or word in config.defects:
        line = Line(
            specimen,
            specimen.numbers["time_s"].value,
            word not in config.clean,
            "limit" in specimen.notes and specimen.notes["limit"].casefold() not in config.clean,
        )
        return Measurement(specimen, (), (), line.columns())
    reason = (
        f"{specimen.register}, line {specimen.line}: the defect {word!r} is neither clean "
        f"({', '.join(config.clean)}) nor known ({', '.join(config.defects)}); correct it, or "
        "add it to [handling] in config/methods.toml"
    )
    refusal = Refusal(
        KEY, reason, specimen.material, specimen.campaign, specimen.id, specimen.conditions
    )
    return Measurement(specimen, (), (refusal,))


def summarise(measurements: Sequence[Measurement], context: Context) -> Summary:
    r"""Say up to when every line of every run was clean, and by when the first one was not.

    With a last clean line at $L_i$ and a first defective one at $U_i$ in run i ($U_i = \infty$
    where none was seen) the first failure of any run lies in $(\min L_i, \min U_i]$, whatever the
    runs differ by. The value is $\min L_i$.

    Source: interval and right censoring as in W. Q. Meeker, L. A. Escobar, Statistical Methods for
    Reliability Data, Wiley 1998, section 2.4; Sikulskyi et al. 2022, Table 3, for the test.
    """
    refusals = tuple(r for m in measurements for r in m.refusals)
    first = measurements[0].specimen
    if refusals:
        reason = (
            f"{len(refusals)} of {len(measurements)} lines cannot be told clean from defective, "
            "and any of them may be the first defective one"
        )
        return Summary((), refusals=(*refusals, _refused(first, reason)))
    runs = runs_of(map(line_of, measurements))
    for run in runs:
        if math.isinf(run.clean_until_s):
            reason = (
                f"the first line{_in(run)}, at {_hours(run.lines[0].time_s)}, is not clean; what "
                "was before is not known: print the first line earlier"
            )
            return Summary((), refusals=(_refused(first, reason),))
    record = _record(runs, context.config)
    config: HandlingConfig = context.config
    then = viscosity_then(record, context.laws, config.max_temperature_difference_K)
    if isinstance(then, Refusal):
        return Summary((record,), refusals=(then,))
    return Summary((record, then))


def _refused(specimen: Specimen, reason: str) -> Refusal:
    return Refusal(
        KEY, reason, specimen.material, specimen.campaign, conditions=specimen.conditions
    )


def _record(runs: Sequence[Run], config: HandlingConfig) -> PropertyRecord:
    specimen = runs[0].lines[0].specimen
    low = min(run.clean_until_s for run in runs)
    high = min(run.defective_from_s for run in runs)
    return PropertyRecord(
        key=KEY,
        material=specimen.material,
        campaign=specimen.campaign,
        quantity=Quantity(low, "s"),
        n=len(runs),
        sd=None,
        ci95=(low, high),
        conditions=specimen.conditions,
        method="time since mixing of the last line before which every line was clean"
        + (f", the shortest of {len(runs)} runs" if len(runs) > 1 else ""),
        budget=(),
        origins=tuple(_origin(line) for run in runs for line in run.lines),
        flags=(*_flags_of_runs(runs, config), *_flags_of_value(runs, low, high)),
        diagnostics=_diagnostics(runs),
        bound="lower" if math.isinf(high) else "interval",
    )


def _origin(line: Line) -> Origin:
    row = line.specimen
    return Origin(
        specimen=row.id,
        value=line.time_s,
        u_independent=0.0,
        u_shared=0.0,
        register=row.register,
        register_line=row.line,
        path=None,
        sha256=None,
        first_line=None,
        last_line=None,
        reader=None,
        technique=f"handling@{VERSION}",
        diagnostics={k: row.notes[k] for k in ("defect", "limit") if k in row.notes},
    )


def _flags_of_runs(runs: Sequence[Run], config: HandlingConfig) -> Iterator[Flag]:
    for run in runs:
        if run.ended_by is None:
            yield Flag("right-censored", f"no defect was seen{_in(run)}; the printing just stopped")
        elif math.isinf(run.defective_from_s):
            limit = run.ended_by.specimen.notes["limit"]
            yield Flag("right-censored", f"no defect was seen{_in(run)} before a limit: {limit}")
        again = run.clean_again
        if again and run.ended_by is not None:
            yield Flag(
                "clean-again",
                f"{len(again)} lines{_in(run)} are clean after the one at "
                f"{_hours(run.ended_by.time_s)} that ended it, the first at "
                f"{_hours(again[0].time_s)}; they are not believed",
            )
        gap = run.defective_from_s - run.clean_until_s
        if config.max_gap_s < gap < math.inf:
            yield Flag(
                "wide-interval",
                f"{_hours(gap)} lie between the last clean and the first defective line{_in(run)}; "
                "print more often",
            )


def _flags_of_value(runs: Sequence[Run], low: float, high: float) -> Iterator[Flag]:
    if len(runs) == 1:
        yield Flag("single-run", "one run: how far batches differ is unknown")
    longest = max(run.clean_until_s for run in runs)
    shortest = min(runs, key=attrgetter("clean_until_s"))
    if longest >= high:
        yield Flag(
            "runs-differ",
            f"one run was clean until {_hours(longest)}, another defective from {_hours(high)} on; "
            "the value is what every run reached",
        )
    elif math.isinf(shortest.defective_from_s) and longest > low:
        yield Flag(
            "stopped-early",
            f"{shortest.name or 'the run'} that sets the value ended at {_hours(low)} without a "
            f"defect, another was clean until {_hours(longest)}",
        )
    least, most = property_key(KEY).plausible
    if not least <= low <= most:
        yield Flag("implausible", f"{_hours(low)}; a silicone prints for {least:g} to {most:g} s")


def _diagnostics(runs: Sequence[Run]) -> dict[str, Detail]:
    details: dict[str, Detail] = {"lines": sum(len(run.lines) for run in runs)}
    for run in runs:
        name = f" ({run.name})" if run.name else ""
        details[f"clean_until_s{name}"] = run.clean_until_s
        if run.ended_by is None:
            details[f"ended_by{name}"] = "the last line"
        elif math.isinf(run.defective_from_s):
            details[f"ended_by{name}"] = f"equipment limit: {run.ended_by.specimen.notes['limit']}"
        else:
            details[f"ended_by{name}"] = f"defect: {run.ended_by.specimen.notes['defect']}"
            details[f"defective_from_s{name}"] = run.defective_from_s
    return details


def _in(run: Run) -> str:
    return f" in {run.name}" if run.name else ""


def _hours(time_s: float) -> str:
    return f"{from_si(time_s, 'h'):.4g} h"


def figure(axes: Any, measurements: Sequence[Measurement], summary: Summary) -> None:
    """Draw every printed line at its time, run by run, and where the first defect began."""
    runs = runs_of(line_of(m) for m in measurements if not m.refusals)
    for mark, said, chosen in (
        ("o", "clean", lambda line: not line.defective),
        ("x", "defective", lambda line: line.defective),
        ("|", "equipment limit", lambda line: line.limited),
    ):
        points = [
            (from_si(line.time_s, "h"), at)
            for at, run in enumerate(runs)
            for line in run.lines
            if chosen(line)
        ]
        if points:
            axes.plot(*zip(*points, strict=True), linestyle="none", marker=mark, label=said)
    for record in (r for r in summary.records if r.key == KEY):
        low, high = (from_si(end, "h") for end in record.ci95)
        if math.isfinite(high):
            axes.axvspan(low, high, alpha=0.15, color="0.5", linewidth=0)
    axes.set_yticks(range(len(runs)), [run.name or "lines" for run in runs])
    axes.set_xlabel("time since mixing [h]")
    axes.set_ylabel("run")


TECHNIQUE = Technique(
    key="handling",
    version=VERSION,
    yields=(KEY, VISCOSITY_THEN),
    needs=(VISCOSITY,),
    config=HandlingConfig,
    required=("time_s",),
    optional=("bed_temperature_K",),
    reduce=reduce,
    summarise=summarise,
    figure=figure,
    register=RegisterForm(
        file="observations.csv",
        text=("material", "defect"),
        identity=("material", *RUN_COLUMNS, "bed_temperature_K", "time_s", "line"),
        conditions={"bed_temperature_K": "temperature_K"},
        whole=True,
    ),
)
