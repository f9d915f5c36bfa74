"""One printed line: clean or defective, in words that are known."""

from __future__ import annotations

from deamat.core.records import Measurement, Recording, Refusal, Specimen
from deamat.core.technique import Context
from deamat.techniques.handling.config import KEY, HandlingConfig
from deamat.techniques.handling.runs import Line


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
