"""The declared tip, and the approach and loading of a test that the transducer could finish."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Specimen
from deamat.core.units import from_si
from deamat.techniques.nanoindentation.config import NanoindentationConfig
from deamat.techniques.shared.geometry import register_length

# shape -> how the load of an elastic half-space rises with depth
EXPONENTS = {"flat": 1.0, "spherical": 1.5, "berkovich": 2.0}


_TRAVEL_MARGIN = 0.02  # part of the travel before its end where the transducer is at its stop
_PEAK_MARGIN = 0.2  # a peak load missed by more than this part was not reached
_TOUCH = 2.0  # bend of the load over the approach, in its noise, below which nothing was touched


@dataclass(frozen=True, slots=True)
class Tip:
    """The tip that the register declares; `radius` is None for a Berkovich pyramid."""

    shape: str
    radius: Quantity | None


@dataclass(frozen=True, slots=True)
class Approach:
    """An indentation from its farthest retraction on.

    Parameters
    ----------
    depth_m, force_N : as recorded, from sample `start` to the end, shape (n,)
    end : samples of approach and loading, before the load nears its peak
    start : index of the first sample in the recording
    """

    depth_m: FloatArray
    force_N: FloatArray
    end: int
    start: int

    def loading(self, part: float = 1.0) -> tuple[FloatArray, FloatArray]:
        """Depth and load up to a part of the rise of the load."""
        end = self.end
        if part < 1.0:
            air = float(np.median(self.force_N[: max(end // 10, 1)]))
            over = self.force_N[:end] - air >= part * (float(self.force_N.max()) - air)
            end = int(over.argmax()) if over.any() else end
        return self.depth_m[:end], self.force_N[:end]


def declared_tip(specimen: Specimen) -> Tip:
    """Take the tip's shape and radius from the register.

    Raises
    ------
    FitRefused : no shape, an unknown one, or no radius where the shape has one
    """
    if "tip" not in specimen.notes:
        raise FitRefused(
            f"the register does not say which tip was used; fill in `tip`: {', '.join(EXPONENTS)}"
        )
    shape = specimen.notes["tip"].casefold()
    if shape not in EXPONENTS:
        raise FitRefused(
            f"the register's tip is {specimen.notes['tip']!r}; the laws are known for "
            f"{', '.join(EXPONENTS)}"
        )
    radius = None if shape == "berkovich" else register_length(specimen.numbers, "tip_radius_m")
    return Tip(shape, radius)


def approach(
    recording: Recording, specimen: Specimen, machine: Machine, config: NanoindentationConfig
) -> Approach:
    """Find the approach and loading, and refuse a test that the transducer could not finish.

    Parameters
    ----------
    machine : `max_travel_m` is where its displacement ends
    config : its `loading_end` is the part of the peak load where the loading ends

    Raises
    ------
    FitRefused : no depth or no load, nothing touched, or the load asked for was not reached
    """
    for name in ("depth_m", "force_N"):
        if name not in recording.columns:
            raise FitRefused(f"the file has no column that is {name}; export depth and load")
    depth, force = recording.columns["depth_m"], recording.columns["force_N"]
    deepest = int(depth.argmax())
    start = int(depth[: deepest + 1].argmin())
    depth, force = depth[start:], force[start:]
    down = slice(0, deepest - start + 1)
    _refuse_straight(depth[down], force[down], config.min_signal_to_noise)
    air = float(np.median(force[: max((deepest - start) // 10, 1)]))
    peak = float(force.max()) - air
    _refuse_unfinished(float(depth.max()), peak, specimen, machine)
    end = int(np.argmax(force - air >= config.loading_end * peak))
    return Approach(depth, force, min(max(end, 1), deepest - start + 1), start)


def _refuse_straight(depth: FloatArray, force: FloatArray, signal_to_noise: float) -> None:
    """Refuse a load that stays on a straight line within its noise."""
    if depth.size < 5:
        raise FitRefused(f"{depth.size} samples from the farthest retraction to the deepest point")
    x, y = depth - depth.mean(), force - force.mean()
    slope = float(x @ y) / float(x @ x) if x.any() else 0.0
    bend = float((y - slope * x).std())
    noise = noise_of(force)
    if bend >= _TOUCH * noise:
        return
    span = float(depth[-1] - depth[0])
    rise = slope * span
    details: dict[str, float | int | str] = {"bend_N": bend, "noise_N": noise, "rise_N": rise}
    if rise > signal_to_noise * noise:
        raise FitRefused(straight_from_the_first(rise, span), details)
    raise FitRefused(
        "no contact, a specimen too soft to feel, or a record that starts in contact: over "
        f"{in_um(span)} of approach the load keeps to a straight line within {in_uN(bend)}, its "
        f"noise being {in_uN(noise)}; find the surface again, or use a larger tip",
        details,
    )


def noise_of(force: FloatArray) -> float:
    """Noise of a load, from its second differences `[N]`."""
    return float(np.median(np.abs(np.diff(force, 2)))) * 1.4826 / math.sqrt(6.0)


def straight_from_the_first(rise_N: float, span_m: float) -> str:
    """Say why a straight line is no indentation, however steep."""
    return (
        "the record starts in contact, or never comes to it: from the first sample on the load "
        f"rises in a straight line, by {in_uN(rise_N)} over {in_um(span_m)}. A flat punch in "
        "contact and a transducer whose springs are not compensated look the same; start in air, "
        "above the surface"
    )


def _refuse_unfinished(deepest: float, peak: float, specimen: Specimen, machine: Machine) -> None:
    """Refuse a test that ended at the end of the travel, or below the load that it was to reach."""
    asked = specimen.numbers.get("peak_load_N")
    travel = machine.max_travel_m
    stopped = travel is not None and deepest >= (1.0 - _TRAVEL_MARGIN) * travel
    reached = asked is not None and peak >= (1.0 - _PEAK_MARGIN) * asked.value
    if reached or (asked is None and not stopped):
        return
    of = f" of the {in_uN(asked.value)} that it was to reach" if asked is not None else ""
    where = f" and {in_um(deepest)} deep" + (f" of {in_um(travel)} travel" if travel else "")
    raise FitRefused(
        f"too soft for this transducer: the test ended at {in_uN(peak)}{of}{where}; use a larger "
        "tip, a transducer of longer travel or a lower peak load",
        {"peak_load_N": peak, "deepest_m": deepest},
    )


def in_um(length_m: float) -> str:
    """Write a length in micrometres, three digits."""
    return f"{from_si(length_m, 'um'):.3g} um"


def in_uN(force_N: float) -> str:
    """Write a force in micronewtons, three digits."""
    return f"{from_si(force_N, 'uN'):.3g} uN"
