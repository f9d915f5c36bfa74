"""How often the stated 95 % intervals hold the truth: whole campaigns, simulated and read again.

`python -m benchmarks.coverage --campaigns 200` simulates campaigns with the twin, reads their files
as a run would (registers, detection, readers, rooms, needs) and counts, for every property, how
often the interval on the card holds the value that was simulated. `--docs` writes the table into
`docs/coverage.md`.
"""

from __future__ import annotations

import argparse
import json
import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from benchmarks.timing import write_results
from pipeline.core.config import Config, load_config
from pipeline.core.properties import REFERENCE_AGE
from pipeline.core.records import Condition, Measurement, PropertyRecord, Specimen
from pipeline.core.register import read_register
from pipeline.core.technique import Context, Technique
from pipeline.formats.detect import detect
from pipeline.formats.rawfile import RawFile
from pipeline.run.measure import in_order, needed
from pipeline.techniques import TECHNIQUES
from pipeline.twin.campaign import NAME, campaign_files, truth_json

ROOT = Path(__file__).resolve().parents[1]
# The twin states viscosities 1 h after mixing, at the article's shear rate for 3 rpm.
_STATED_TIME_s, _RATE_per_s = 3600.0, 0.27
FIRST_SEED = 100_000  # far from the committed campaign's


@dataclass(frozen=True, slots=True)
class Answer:
    """One value of one simulated campaign: what the card says and what is true."""

    key: str
    material: str
    low: float
    high: float
    truth: float

    @property
    def holds(self) -> bool:
        """Say whether the interval holds the truth, as far as the arithmetic can tell."""
        slack = 1e-12 * abs(self.truth)
        return self.low - slack <= self.truth <= self.high + slack


def answers(seed: int) -> list[Answer]:
    """Simulate one campaign, read it and hold every record against the truth."""
    config = load_config(ROOT / "config", {t.key: t.config for t in TECHNIQUES.values()})
    files = campaign_files(seed)
    records: dict[tuple[str, str], list[PropertyRecord]] = {}
    for technique in in_order(TECHNIQUES):
        for record in _records(technique, files, config, records):
            records.setdefault((NAME, record.material), []).append(record)
    truth = json.loads(truth_json(seed))["values"]
    return list(_compare(truth, records))


def _compare(
    truth: Sequence[dict[str, float | str]],
    records: dict[tuple[str, str], list[PropertyRecord]],
) -> Iterator[Answer]:
    """Pair each true value with the one record that states it."""
    for value in truth:
        place = (NAME, str(value["material"]))
        for r in records.get(place, []):
            if r.key == value["key"] and _same_conditions(r.conditions, value):
                yield Answer(r.key, r.material, *r.ci95, float(value["value"]))


def _same_conditions(
    said: Mapping[str, Condition], value: Mapping[str, float | str | None]
) -> bool:
    """Hold age, bed temperature and time since mixing against each other, where both state them."""
    age = value.get("age", REFERENCE_AGE)
    bed = value.get("temperature_K")
    return (
        said.get("age", age) == age
        and (bed is None or said.get("temperature_K") == bed)
        and said.get("time_s", _STATED_TIME_s) == _STATED_TIME_s
        and (value["key"] != "viscosity" or said.get("rate_per_s", _RATE_per_s) == _RATE_per_s)
    )


def _records(
    technique: Technique,
    files: dict[str, bytes],
    config: Config,
    records: dict[tuple[str, str], list[PropertyRecord]],
) -> Iterator[PropertyRecord]:
    path = f"{technique.key}/{technique.register.file}"
    if path not in files:
        return
    register = read_register(
        files[path], f"{NAME}/{path}", NAME, technique.key, technique.required,
        config.instruments.gauges, technique.register,
    )  # fmt: skip
    groups: dict[tuple[object, ...], list[Measurement]] = defaultdict(list)
    for specimen in register.specimens:
        group = (specimen.material, *sorted(specimen.conditions.items()))
        groups[group].append(_measure(technique, specimen, files, config, records))
    settings = config.methods[technique.key]
    for measurements in groups.values():
        _, machine = config.instruments.machine("")
        yield from technique.summarise(measurements, Context(settings, machine, {})).records


def _measure(
    technique: Technique,
    specimen: Specimen,
    files: dict[str, bytes],
    config: Config,
    records: dict[tuple[str, str], list[PropertyRecord]],
) -> Measurement:
    _, machine = config.instruments.machine(specimen.notes.get("instrument", ""))
    needs = {key: needed(key, specimen, records) for key in technique.needs}
    found = {key: quantity for key, quantity in needs.items() if quantity is not None}
    recording = None
    if specimen.file is not None:
        raw = RawFile(specimen.file, files[specimen.file.partition("/")[2]])
        recording = detect(raw).read(raw)
    context = Context(config.methods[technique.key], machine, found)
    return technique.reduce(specimen, recording, context)


def table(found: Sequence[Answer]) -> list[dict[str, str | float]]:
    """Coverage by property: share of intervals that hold the truth, and its standard error."""
    keys = sorted({a.key for a in found})
    rows: list[dict[str, str | float]] = []
    for key in keys:
        mine = [a for a in found if a.key == key]
        share = sum(a.holds for a in mine) / len(mine)
        bias = sum((a.low + a.high) / 2 / a.truth - 1 for a in mine) / len(mine)
        rows.append(
            {
                "property": key,
                "intervals": len(mine),
                "coverage %": round(100 * share, 2),
                "standard error %": round(100 * math.sqrt(share * (1 - share) / len(mine)), 2),
                "middle of the interval, off by %": round(100 * bias, 2),
            }
        )
    return rows


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--campaigns", type=int, default=200)
    parser.add_argument("--docs", action="store_true", help="write docs/coverage.md")
    options = parser.parse_args()
    seeds = range(FIRST_SEED, FIRST_SEED + options.campaigns)
    with ProcessPoolExecutor(2) as pool:
        found = [a for many in pool.map(answers, seeds, chunksize=5) for a in many]
    rows = table(found)
    text = _markdown(rows)
    print(text)
    write_results("coverage", rows, ("numpy", "scipy"))
    if options.docs:
        page = _PAGE.format(campaigns=options.campaigns, first=FIRST_SEED, table=text)
        (ROOT / "docs" / "coverage.md").write_text(page, "utf-8")


_PAGE = """\
# How often the 95 % intervals hold the truth
{campaigns} SYNTHETIC campaigns (seeds from {first}) were simulated by the twin with every error
that it knows, shared ones drawn anew for each campaign, written in the instruments' forms, read
again and summarised. Intervals of one campaign share its calibrations, so the standard error is a
little larger than stated. Made by `python -m benchmarks.coverage --docs`.

{table}
"""


def _markdown(rows: Sequence[dict[str, str | float]]) -> str:
    names = list(rows[0])
    lines = ["| " + " | ".join(names) + " |", "|" + "---|" * len(names)]
    lines += ["| " + " | ".join(str(row[n]) for n in names) + " |" for row in rows]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
