"""All indents of one material: means."""

from __future__ import annotations

from collections.abc import Sequence

from deamat.core.records import Measurement, Summary
from deamat.core.technique import Context
from deamat.techniques.nanoindentation.config import YIELDS, NanoindentationConfig
from deamat.techniques.nanoindentation.result import Indent
from deamat.techniques.shared.mean import summarise_by_mean


def summarise(
    measurements: Sequence[Measurement[Indent]], _context: Context[NanoindentationConfig]
) -> Summary:
    """Average the indentations of one material under one set of conditions."""
    return summarise_by_mean(measurements, "nanoindentation", YIELDS)
