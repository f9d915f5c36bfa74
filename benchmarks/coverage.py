"""How often the stated 95 % intervals hold the truth: whole campaigns, simulated and read again.

`python -m benchmarks.coverage --campaigns 200` simulates campaigns with the twin, reads their files
as a run would (registers, detection, readers, rooms, needs) and counts, for every property, how
often the interval on the card holds the value that was simulated. `--docs` writes the table into
`docs/coverage.md`. A property on a card whose truth nobody states stops the study.
"""

from __future__ import annotations

import argparse
import math
import statistics
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from benchmarks.coverage_truth import NOT_ON_CARDS, LIMIT_Pas, liquid_at, table_of, truth_of
from benchmarks.in_memory import Campaign, summaries
from benchmarks.timing import write_results
from deamat.core.config import Config, load_config
from deamat.core.records import Law, PropertyRecord
from deamat.run.measure import in_order
from deamat.techniques import TECHNIQUES
from deamat.twin.campaign import NAME, PARTS
from deamat.twin.truth import true_viscosities

ROOT = Path(__file__).resolve().parents[1]
FIRST_SEED = 100_000  # far from the committed campaign's
_TIMES_OF_LAW = 12
_BY_CONSTRUCTION = "by construction"
_LAW = " (law)"

# A part is made in the module that bears its technique's name.
_MAKERS = {make.__module__.rpartition(".")[2]: make for make in PARTS}
SIMULATED = tuple(key for key in TECHNIQUES if key in _MAKERS)


@dataclass(frozen=True, slots=True)
class Answer:
    """One value of one simulated campaign: what the card says and what is true.

    Parameters
    ----------
    estimate : False where the interval is between a last good and a first bad observation, or is
        open: it holds the truth because of how it was made
    """

    seed: int
    key: str
    low: float
    high: float
    truth: float
    estimate: bool = True

    @property
    def law(self) -> bool:
        """Say whether it is an answer of a fitted law, not a value of its own."""
        return self.key.endswith(_LAW)

    @property
    def holds(self) -> bool:
        """Say whether the interval holds the truth, as far as the arithmetic can tell."""
        slack = 1e-12 * abs(self.truth)
        return self.low - slack <= self.truth <= self.high + slack

    @property
    def off(self) -> float:
        """How far the middle of the interval is from the truth, in its half widths."""
        return (0.5 * (self.low + self.high) - self.truth) / (0.5 * (self.high - self.low))


@cache
def _config() -> Config:
    """Read the configuration of the repository, and ask for the time to a viscosity too.

    The twin's liquids are power laws at all shear rates: n is as certain beyond those measured.
    """
    config = load_config(ROOT / "config", {t.key: t.config for t in TECHNIQUES.values()})
    asked = {
        "limit_viscosity_Pas": LIMIT_Pas,
        "extrapolation_decades": 4.0,
        "u_index_beyond": 0.0,
    }
    liquids = config.methods["viscosity"].model_copy(update=asked)
    return replace(config, methods={**config.methods, "viscosity": liquids})


def answers(
    seed: int,
    techniques: Collection[str] = SIMULATED,
    materials: Collection[str] | None = None,
) -> list[Answer]:
    """Simulate one campaign, read it and hold every record and law against the truth.

    Parameters
    ----------
    seed : of the campaign
    techniques : which of them, with those that they need
    materials : which of them; None for all

    Raises
    ------
    MissingProperty : a card holds something of which no truth is stated
    """
    parts = [make(seed) for technique, make in _MAKERS.items() if technique in techniques]
    files = {path: data for part in parts for path, data in part.files.items()}
    truth = table_of(parts)
    records: dict[str, list[PropertyRecord]] = defaultdict(list)
    laws: dict[str, dict[str, Law]] = defaultdict(dict)
    campaign = Campaign(NAME, files, records, laws)
    found: list[Answer] = []
    for technique in in_order({key: t for key, t in TECHNIQUES.items() if key in techniques}):
        for summary in summaries(technique, campaign, _config(), materials):
            for record in summary.records:
                records[record.material].append(record)
                exact = record.bound == "exact"
                true = truth_of(record, truth)
                found.append(Answer(seed, record.key, *record.ci95, true, exact))
            for law in summary.laws:
                laws[law.material][law.key] = law
                found += _along(law, seed)
    return found


def _along(law: Law, seed: int) -> Iterator[Answer]:
    """Hold a law against the truth at times over its whole range, at both ends of its rates."""
    liquid = true_viscosities()[law.material]
    for rate in law.rates or (None,):
        for time_s in np.linspace(*law.valid, _TIMES_OF_LAW).tolist():
            true = liquid_at(liquid, law.key, time_s, rate or 1.0)
            yield Answer(seed, f"{law.key}{_LAW}", *law.ci95(time_s, rate), true)


def by_key(found: Iterable[Answer]) -> dict[str, list[Answer]]:
    """Sort answers by property, properties by name."""
    groups: dict[str, list[Answer]] = defaultdict(list)
    for answer in found:
        groups[answer.key].append(answer)
    return dict(sorted(groups.items()))


def table(found: Sequence[Answer]) -> list[dict[str, str | float]]:
    """Coverage by property, its standard error, on which side it misses, and how far it is off."""
    return [_row(key, mine) for key, mine in by_key(found).items()]


def _row(key: str, mine: Sequence[Answer]) -> dict[str, str | float]:
    share = sum(a.holds for a in mine) / len(mine)
    counted: dict[str, str | float] = {"property": key, "intervals": len(mine)}
    if share == 1.0 and not any(a.estimate for a in mine):
        return {**counted, "coverage %": _BY_CONSTRUCTION, **dict.fromkeys(_FURTHER, "")}
    numbers = (
        100 * share,
        100 * _standard_error(mine),
        100 * sum(a.truth < a.low for a in mine) / len(mine),
        100 * sum(a.truth > a.high for a in mine) / len(mine),
    )
    shown = [f"{number:.1f}" for number in numbers]
    # a limit has no middle
    off = f"{statistics.fmean(a.off for a in mine):+.2f}" if any(a.estimate for a in mine) else ""
    values = ("coverage %", *_FURTHER), (*shown, off)
    return {**counted, **dict(zip(*values, strict=True))}


_FURTHER = ("standard error %", "truth below %", "truth above %", "middle off, half widths")


def _standard_error(mine: Sequence[Answer]) -> float:
    """Of the share that holds, from campaign to campaign: those of one campaign share its errors.

    The ratio estimator of cluster sampling: campaigns do not all give as many values.
    """
    share = sum(a.holds for a in mine) / len(mine)
    excess: dict[int, float] = defaultdict(float)
    for a in mine:
        excess[a.seed] += a.holds - share
    m = len(excess)
    if m < 2:
        return math.nan
    return math.sqrt(m / (m - 1) * sum(e * e for e in excess.values())) / len(mine)


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--campaigns", type=int, default=200)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--docs", action="store_true", help="write docs/coverage.md")
    options = parser.parse_args()
    seeds = range(FIRST_SEED, FIRST_SEED + options.campaigns)
    with ProcessPoolExecutor(options.workers) as pool:
        found = [a for many in pool.map(answers, seeds, chunksize=5) for a in many]
    rows = table(found)
    text = _markdown(rows)
    print(text)
    write_results("coverage", rows, ("numpy", "scipy"))
    if options.docs:
        absent = "\n".join(f"- `{key}`: {why}." for key, why in NOT_ON_CARDS.items())
        page = _PAGE.format(
            campaigns=options.campaigns,
            first=FIRST_SEED,
            limit=LIMIT_Pas,
            table=text,
            absent=absent,
        )
        (ROOT / "docs" / "coverage.md").write_text(page, "utf-8")


_PAGE = """\
# How often the 95 % intervals hold the truth
{campaigns} SYNTHETIC campaigns (seeds from {first}) were simulated by the twin with every error
that it knows, shared ones drawn anew for each campaign, written in the instruments' forms, read
again and summarised. Made by `python -m benchmarks.coverage --docs`; the test suite does the same
with fewer campaigns, and stops if a card carries a property of which the twin tells no truth.

{table}

How to read it:
- The standard error is that of campaigns, not of intervals: the intervals of one campaign share its
  calibrations. Where one error rules all of them (`loss_tangent`: the meter's), a campaign counts
  as little more than one interval.
- "truth below" and "truth above" are the misses on either side, 2.5 % each if all is well. "middle
  off" is the mean distance of the interval's middle from the truth, in half widths of the interval;
  intervals of a shape or a low quantile are lopsided, and so are their middles.
- "(law)" is a fitted law at twelve times over its range, at both ends of its shear rates.
  `time_to_viscosity_limit` is asked for {limit:g} Pa.s.
- `viscosity_at_printing_rate` is extrapolated, and the twin's liquids are power laws at every shear
  rate: what n may be off by beyond those measured (`u_index_beyond`) is left out of its intervals,
  and it is asked 3.2 powers of ten beyond, where a card refuses it (`extrapolation_decades`).
- `handling_time` lies between the last clean and the first defective line, or is a lower bound:
  such an interval holds the truth because of how it is made, which shows nothing. That of
  `viscosity_at_handling_time` starts at the law's lower 95 % limit there: the twin's truth is the
  viscosity at the last clean line, so that all misses are below, 2.5 % if all is well.

Known and left as they are, as no value on a card suffers:
- `compressive_modulus` is low by 0.1 % (0.03 half widths): the last sample of the window lies half
  a sampling step below 5 % on average, and with a toe a shorter window has a lesser slope.
- `compressive_modulus_toe_compensated` of the softest mixture (40:1) is low by 0.6 % (0.2 half
  widths), 0.5 % of it by 10-60 mN of load that nobody zeroed: that stands in its budget as shared.
- `tensile_strength` of the softest mixture (40:1) is high by 0.5 % (0.05 half widths): 0.2 mN that
  nobody tared, of 63 mN at break.

Not on any card of the twin:
{absent}
"""


def _markdown(rows: Sequence[Mapping[str, str | float]]) -> str:
    names = list(rows[0])
    lines = ["| " + " | ".join(names) + " |", "|" + "---|" * len(names)]
    lines += ["| " + " | ".join(str(row[n]) for n in names) + " |" for row in rows]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
