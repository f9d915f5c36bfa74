"""All cylinders of one material: means."""

from __future__ import annotations

from collections.abc import Sequence

from deamat.core.records import Measurement, Summary
from deamat.core.technique import Context
from deamat.techniques.compression.config import YIELDS, CompressionConfig
from deamat.techniques.shared.mean import summarise_by_mean
from deamat.techniques.shared.modulus import LoadingCurve


def summarise(
    measurements: Sequence[Measurement[LoadingCurve]], _context: Context[CompressionConfig]
) -> Summary:
    """Average the specimens of one material under one set of conditions."""
    return summarise_by_mean(measurements, "compression", YIELDS)
