"""All cylinders of one material: means."""

from __future__ import annotations

from collections.abc import Sequence

from deamat.core.records import Measurement, Summary
from deamat.core.technique import Context
from deamat.techniques.compression.config import VERSION, YIELDS
from deamat.techniques.shared.mean import summarise_by_mean


def summarise(measurements: Sequence[Measurement], _context: Context) -> Summary:
    """Average the specimens of one material under one set of conditions."""
    return summarise_by_mean(measurements, f"compression@{VERSION}", YIELDS)
