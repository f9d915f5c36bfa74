"""All lines of one material: up to when every run was clean, and by when one was not."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from operator import attrgetter

from deamat.core.properties import property_key
from deamat.core.quantity import Quantity
from deamat.core.recording import Specimen
from deamat.core.records import Detail, Flag, Measurement, Origin, PropertyRecord, Refusal, Summary
from deamat.core.technique import Context
from deamat.core.units import from_si
from deamat.techniques.handling.config import KEY, HandlingConfig
from deamat.techniques.handling.runs import Line, Run, runs_of
from deamat.techniques.handling.viscosity_then import viscosity_then


def summarise(
    measurements: Sequence[Measurement[Line]], context: Context[HandlingConfig]
) -> Summary:
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
    runs = runs_of(m.result for m in measurements if m.result is not None)
    for run in runs:
        if math.isinf(run.clean_until_s):
            reason = (
                f"the first line{_in(run)}, at {_hours(run.lines[0].time_s)}, is not clean; what "
                "was before is not known: print the first line earlier"
            )
            return Summary((), refusals=(_refused(first, reason),))
    record = _record(runs, context.config)
    then = viscosity_then(record, context.laws, context.config.max_temperature_difference_K)
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
        technique="handling",
        diagnostics={
            "defect": line.defect,
            **({} if line.limit is None else {"limit": line.limit}),
        },
    )


def _flags_of_runs(runs: Sequence[Run], config: HandlingConfig) -> Iterator[Flag]:
    for run in runs:
        if run.ended_by is None:
            yield Flag("right-censored", f"no defect was seen{_in(run)}; the printing just stopped")
        elif math.isinf(run.defective_from_s):
            yield Flag(
                "right-censored",
                f"no defect was seen{_in(run)} before a limit: {run.ended_by.limit}",
            )
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
            details[f"ended_by{name}"] = f"equipment limit: {run.ended_by.limit}"
        else:
            details[f"ended_by{name}"] = f"defect: {run.ended_by.defect}"
            details[f"defective_from_s{name}"] = run.defective_from_s
    return details


def _in(run: Run) -> str:
    return f" in {run.name}" if run.name else ""


def _hours(time_s: float) -> str:
    return f"{from_si(time_s, 'h'):.4g} h"
