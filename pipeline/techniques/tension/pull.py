"""One recorded pull: its curve, how it ended, what was noticed."""

from __future__ import annotations

from dataclasses import dataclass, replace

from deamat.core.errors import FitRefused
from deamat.core.recording import Recording
from deamat.core.records import Flag
from deamat.estimators.curves.held import Held, held_load, held_position
from deamat.estimators.curves.rupture import Rupture
from deamat.estimators.curves.slack import Slack, find_slack
from deamat.techniques.shared.stress_strain import IndexArray, StressStrain
from deamat.techniques.tension.config import TensionConfig

_SLACK_LOOKED_FOR = (
    0.05  # of the elongation: width of the windows that tell slack from a taut strip
)
_SLACK_TOLD = 0.01  # of the elongation
_LOOSE = 0.1  # of the slope behind it
_LOOSE_LOAD = 0.01  # of the greatest load


@dataclass(frozen=True, slots=True)
class Pull:
    """What the values of a strip are taken from.

    Parameters
    ----------
    curve : of the whole recording
    branch : samples up to the end of the first loading
    rupture : how the pull ended
    load_held, position_held : stretch over which a channel held one value; None where none did
    flags : of the file, of the start and of held channels, which go on every value
    """

    curve: StressStrain
    recording: Recording
    branch: int
    rupture: Rupture
    load_held: Held | None
    position_held: Held | None
    flags: tuple[Flag, ...]

    @property
    def load_limited(self) -> bool:
        """Say whether the greatest load is the one that the channel held."""
        return self.load_held is not None and self.load_held.first == self.rupture.maximum

    @property
    def last(self) -> int:
        """Index of the last sample whose strain the strip bore for certain."""
        if self.load_limited and self.load_held is not None:
            return self.load_held.first  # behind it nobody knows when it broke
        return self.rupture.last

    def insist_on_channels(self, inside: IndexArray) -> None:
        """Refuse a window in which a channel held one value, measured by what changes within it.

        Raises
        ------
        FitRefused : it did
        """
        strain, stress = self.curve.nominal_strain, self.curve.nominal_stress_Pa
        last = int(inside[-1])
        held = {
            "load": held_load(strain, stress, last),
            "displacement": held_position(strain, stress, self.curve.first, last),
        }
        for channel, found in held.items():
            if found is not None and found.last >= inside[0]:
                raise FitRefused(
                    f"held-channel: the {channel} holds one value from sample {found.first + 1} to "
                    f"{found.last + 1}, within the window of the slope"
                )

    def slack(self, config: TensionConfig) -> Slack | None:
        """Look for slack in the first loading, as far as it matters to a modulus."""
        low, high = config.window
        return self._slack(high - low)

    def slack_in(self, elongation: float) -> Slack | None:
        """Look for a way without load that is more than a hundredth of an elongation.

        A rubber that stiffens much may look loose over a wide window, but carries load there.
        """
        slack = self._slack(_SLACK_LOOKED_FOR * elongation)
        if slack is None or slack.strain < _SLACK_TOLD * elongation:
            return None
        carried = slack.slope_before_Pa * slack.strain
        greatest = float(self.curve.nominal_stress_Pa[self.rupture.maximum])
        loose = carried < _LOOSE_LOAD * greatest
        return slack if loose and slack.slope_before_Pa < _LOOSE * slack.slope_after_Pa else None

    def _slack(self, window: float) -> Slack | None:
        loading = slice(self.curve.first, self.branch)
        return find_slack(
            self.curve.nominal_strain[loading], self.curve.nominal_stress_Pa[loading], window
        )


def pulled(curve: StressStrain, recording: Recording, branch: int, rupture: Rupture) -> Pull:
    """Look at a pull for channels that held one value."""
    strain, stress = curve.nominal_strain, curve.nominal_stress_Pa
    load = held_load(strain, stress, rupture.last)
    position = held_position(strain, stress, curve.first, rupture.last)
    pull = Pull(
        curve, recording, branch, rupture, load, position, recording.flags + curve.flags
    )  # fmt: skip
    return replace(pull, flags=pull.flags + _flags_of_held(pull))


def _flags_of_held(pull: Pull) -> tuple[Flag, ...]:
    strain, stress = pull.curve.nominal_strain, pull.curve.nominal_stress_Pa
    flags: tuple[Flag, ...] = ()
    if (load := pull.load_held) is not None:
        said = (
            f"the load holds {stress[load.first] / 1e3:.4g} kPa from "
            f"{100 * strain[load.first]:.4g} % to {100 * strain[load.last]:.4g} % strain while the "
            "crosshead goes on: a saturated or stuck load cell"
        )
        said += "; strength and elongation are lower limits" if pull.load_limited else ""
        flags += (Flag("held-channel", said),)
    if (held := pull.position_held) is not None:
        said = (
            f"the displacement holds {100 * strain[held.first]:.4g} % strain from sample "
            f"{held.first + 1} to {held.last + 1} while the load rises to "
            f"{stress[held.last] / 1e3:.4g} kPa: a stuck channel; elongation is a lower limit"
        )
        flags += (Flag("held-channel", said),)
    return flags
