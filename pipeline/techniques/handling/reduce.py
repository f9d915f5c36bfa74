"""One printed line: clean or defective, in words that are known."""

from __future__ import annotations

from deamat.core.recording import Recording, Specimen
from deamat.core.records import Measurement, Refusal
from deamat.core.technique import Context
from deamat.techniques.handling.config import KEY, HandlingConfig
from deamat.techniques.handling.runs import RUN_COLUMNS, Line


def reduce(
    specimen: Specimen, _recording: Recording | None, context: Context[HandlingConfig]
) -> Measurement[Line]:
    """Check that one printed line is called clean or defective in words that are known.

    Parameters
    ----------
    specimen : a line, with `time_s` since mixing and the notes `defect`, `limit` and `line`
    """
    config, notes = context.config, specimen.notes
    word = notes["defect"].casefold()
    if word in config.clean or word in config.defects:
        limit = notes.get("limit")
        line = Line(
            specimen,
            run=next((notes[column] for column in RUN_COLUMNS if column in notes), ""),
            time_s=specimen.numbers["time_s"].value,
            defect=notes["defect"],
            limit=limit,
            defective=word not in config.clean,
            limited=limit is not None and limit.casefold() not in config.clean,
        )
        return Measurement(specimen, (), (), line)
    reason = (
        f"{specimen.register}, line {specimen.line}: the defect {word!r} is neither clean "
        f"({', '.join(config.clean)}) nor known ({', '.join(config.defects)}); correct it, or "
        "add it to [handling] in config/methods.toml"
    )
    refusal = Refusal(
        KEY, reason, specimen.material, specimen.campaign, specimen.id, specimen.conditions
    )
    return Measurement(specimen, (), (refusal,))
