"""One recorded pull: its curve, how it ended, what was noticed."""

from __future__ import annotations

from dataclasses import dataclass

from deamat.core.recording import Recording
from deamat.core.records import Flag
from deamat.estimators.curves.rupture import Rupture
from deamat.estimators.curves.slack import Slack, find_slack
from deamat.techniques.shared.stress_strain import StressStrain
from deamat.techniques.tension.config import TensionConfig


@dataclass(frozen=True, slots=True)
class Pull:
    """What the values of a strip are taken from.

    Parameters
    ----------
    curve : of the whole recording
    branch : samples up to the end of the first loading
    rupture : how the pull ended
    flags : of the file and of the start, which go on every value
    """

    curve: StressStrain
    recording: Recording
    branch: int
    rupture: Rupture
    flags: tuple[Flag, ...]

    def slack(self, config: TensionConfig) -> Slack | None:
        """Look for slack in the first loading."""
        loading = slice(self.curve.first, self.branch)
        low, high = config.window
        return find_slack(
            self.curve.nominal_strain[loading], self.curve.nominal_stress_Pa[loading], high - low
        )
