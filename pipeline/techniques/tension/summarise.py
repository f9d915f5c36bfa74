"""All strips of one material: means."""

from __future__ import annotations

from collections.abc import Sequence

from deamat.core.records import (
    Measurement,
    Summary,
)
from deamat.core.technique import Context
from deamat.techniques.shared.mean import summarise_by_mean
from deamat.techniques.shared.modulus import LoadingCurve
from deamat.techniques.tension.config import YIELDS, TensionConfig


def summarise(
    measurements: Sequence[Measurement[LoadingCurve]], _context: Context[TensionConfig]
) -> Summary:
    """Average the specimens of one material under one set of conditions."""
    return summarise_by_mean(measurements, "tension", YIELDS)
