"""Which channel of a recorder is which, and the ratio of its probe, as the register says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.recording import Specimen

VOLTAGE_CHANNEL, CURRENT_CHANNEL = "voltage_channel", "current_channel"
PROBE_RATIO, CURRENT_RATIO = "probe_ratio", "current_ratio_A_per_V"
CHANNEL_COLUMNS = (VOLTAGE_CHANNEL, CURRENT_CHANNEL, PROBE_RATIO, CURRENT_RATIO)


@dataclass(frozen=True, slots=True)
class Channels:
    """The roles of channels.

    Parameters
    ----------
    labels : quantity (`voltage_V`, `current_A`) to the label over its channel, as it is written
    ratios : quantity to what a reading of its channel is multiplied by `[V/V]` or `[A/V]`
    """

    labels: Mapping[str, str]
    ratios: Mapping[str, float]

    def __hash__(self) -> int:
        """Hash of what is said: files that are asked about once are keys."""
        return hash((*self.labels.items(), *self.ratios.items()))

    def __bool__(self) -> bool:
        """Say whether the register says anything."""
        return bool(self.labels or self.ratios)

    @property
    def said(self) -> dict[str, str]:
        """As metadata of a recording."""
        told = {f"channel of {name}": label for name, label in self.labels.items()}
        return told | {f"ratio of {name}": f"{ratio:g}" for name, ratio in self.ratios.items()}


NO_CHANNELS = Channels({}, {})


def channels_of(specimen: Specimen) -> Channels:
    """Read the roles that a row of a register gives to channels.

    Raises
    ------
    RawFileError : a ratio that is no number, or zero
    """
    notes = specimen.notes
    labels = {"voltage_V": VOLTAGE_CHANNEL, "current_A": CURRENT_CHANNEL}
    ratios = {"voltage_V": PROBE_RATIO, "current_A": CURRENT_RATIO}
    return Channels(
        {name: notes[column] for name, column in labels.items() if column in notes},
        {name: _ratio(specimen, column) for name, column in ratios.items() if column in notes},
    )


def _ratio(specimen: Specimen, column: str) -> float:
    text = specimen.notes[column]
    if not is_number(text) or not float(text):
        raise RawFileError(
            specimen.register, f"{column} is no ratio", specimen.line, value=text,
            hint="write the number by which a reading is multiplied: 1000 for a 1000:1 probe",
        )  # fmt: skip
    return float(text)
