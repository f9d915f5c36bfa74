"""A campaign in memory, read and summarised as a run would, without a disk."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

from deamat.core.config import Config
from deamat.core.recording import Specimen
from deamat.core.records import Law, Measurement, PropertyRecord, Summary
from deamat.core.register import read_register
from deamat.core.technique import AnyTechnique, Context
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.run.measure import needs_met


@dataclass(frozen=True, slots=True)
class Campaign:
    """Files of one campaign, and what earlier techniques gave.

    Parameters
    ----------
    files : path relative to the campaign's folder to content
    records, laws : by material, of the techniques that came before
    """

    name: str
    files: Mapping[str, bytes]
    records: Mapping[str, list[PropertyRecord]] = field(default_factory=dict)
    laws: Mapping[str, dict[str, Law]] = field(default_factory=dict)


def summaries(
    technique: AnyTechnique,
    campaign: Campaign,
    config: Config,
    materials: Collection[str] | None = None,
) -> Iterator[Summary]:
    """Read the register of a technique, measure its specimens and summarise its materials.

    Parameters
    ----------
    materials : which of them; None for all

    Raises
    ------
    RawFileError : a file or register that cannot be read
    """
    path = f"{technique.key}/{technique.register.file}"
    register = read_register(
        campaign.files[path], f"{campaign.name}/{path}", campaign.name, technique.key,
        technique.required, config.instruments.gauges, technique.register,
    )  # fmt: skip
    for _, error in register.errors:
        raise error
    groups: dict[tuple[object, ...], list[Measurement]] = defaultdict(list)
    for specimen in register.specimens:
        if materials is not None and specimen.material not in materials:
            continue
        group = (specimen.material, *sorted(specimen.conditions.items()))
        groups[group].append(_measure(technique, specimen, campaign, config))
    machine = config.instruments.machine("")
    for measurements in groups.values():
        known = campaign.laws.get(measurements[0].specimen.material, {})
        context = Context(config.methods[technique.key], machine, {}, laws=known)
        yield technique.summarise(measurements, context)


def _measure(
    technique: AnyTechnique, specimen: Specimen, campaign: Campaign, config: Config
) -> Measurement:
    machine = config.instruments.machine(specimen.notes.get("instrument", ""))
    found = needs_met(technique, specimen, campaign.records.get(specimen.material, []))
    recording = None
    if specimen.file is not None:
        raw = RawFile(specimen.file, campaign.files[specimen.file.partition("/")[2]])
        recording = detect(raw).read(raw)
    context = Context(config.methods[technique.key], machine, found)
    return technique.reduce(specimen, recording, context)
