"""What every tip needs: its declared shape, the approach, the contact, and what must be flagged."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from pydantic import Field

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.instruments import Declared, Machine
from deamat.core.quantity import Quantity
from deamat.core.records import Flag, Recording, Specimen
from deamat.core.stress_strain import register_length
from deamat.core.units import from_si
from deamat.estimators.curves.contact import Contact, fit_contact
from deamat.estimators.curves.slope import FEW_INDEPENDENT

# shape -> how the load of an elastic half-space rises with depth
EXPONENTS = {"flat": 1.0, "spherical": 1.5, "berkovich": 2.0}
_TRAVEL_MARGIN = 0.02  # part of the travel before its end where the transducer is at its stop
_PEAK_MARGIN = 0.2  # a peak load missed by more than this part was not reached
_TOUCH = 2.0  # bend of the load over the approach, in its noise, below which nothing was touched
_CLOSER = 1.5  # residuals of the declared law over those of another that make it the likelier one
_PULL = 0.02  # part of the peak load from which a pull on the way out is called adhesion


class ContactConfig(Declared):
    """What the tips decide alike."""

    poisson_ratio: float = Field(
        default=0.49, ge=0.0, le=0.5, description="of the specimen, to come from E* to E"
    )
    u_poisson_ratio: float = Field(
        default=0.005, ge=0.0, description="standard uncertainty, shared by all specimens"
    )
    loading_end: float = Field(
        default=0.95, gt=0.0, le=1.0, description="part of the peak load where the loading ends"
    )
    min_air_samples: int = Field(
        default=10, ge=3, description="fewest samples before the contact point"
    )
    min_contact_samples: int = Field(
        default=20, ge=5, description="fewest samples of the loading, and of the unloading"
    )
    min_signal_to_noise: float = Field(
        default=20.0, gt=0.0, description="least rise of the load over its noise"
    )
    max_relative_uncertainty: float = Field(
        default=0.1, gt=0.0, description="of the fitted stiffness; beyond it there is no value"
    )
    max_part_of_height: float = Field(
        default=0.1, gt=0.0, description="depth or contact radius over height that is flagged"
    )
    max_part_of_radius: float = Field(
        default=0.1, gt=0.0, description="depth over radius of a sphere that is flagged"
    )
    tip_modulus_Pa: float = Field(
        default=1.141e12, gt=0.0, description="of diamond; only to say when a tip is not rigid"
    )
    tip_poisson_ratio: float = Field(default=0.07, ge=0.0, le=0.5, description="of diamond")
    max_tip_compliance: float = Field(
        default=0.01, gt=0.0, description="part of the modulus due to the tip that is flagged"
    )


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


def approach(recording: Recording, specimen: Specimen, machine: Machine, part: float) -> Approach:
    """Find the approach and loading, and refuse a test that the transducer could not finish.

    Parameters
    ----------
    machine : `max_travel_m` is where its displacement ends
    part : of the peak load where the loading ends

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
    _refuse_air(depth[: deepest - start + 1], force[: deepest - start + 1])
    air = float(np.median(force[: max((deepest - start) // 10, 1)]))
    peak = float(force.max()) - air
    _refuse_unfinished(float(depth.max()), peak, specimen, machine)
    end = int(np.argmax(force - air >= part * peak))
    return Approach(depth, force, min(max(end, 1), deepest - start + 1), start)


def _refuse_air(depth: FloatArray, force: FloatArray) -> None:
    """Refuse a load that stays on a straight line within its noise."""
    if depth.size < 5:
        raise FitRefused(f"{depth.size} samples from the farthest retraction to the deepest point")
    x, y = depth - depth.mean(), force - force.mean()
    bend = float((y - x * float(x @ y) / float(x @ x)).std()) if x.any() else 0.0
    noise = float(np.median(np.abs(np.diff(force, 2)))) * 1.4826 / math.sqrt(6.0)
    if bend < _TOUCH * noise:
        raise FitRefused(
            f"no contact, or a specimen too soft to feel: over {in_um(depth[-1] - depth[0])} of "
            f"approach the load keeps to a straight line within {in_uN(bend)}, its noise being "
            f"{in_uN(noise)}; find the surface again, or use a larger tip",
            {"bend_N": bend, "noise_N": noise},
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


def fitted_contact(
    made: Approach, shape: str, config: ContactConfig
) -> tuple[Contact, tuple[Flag, ...]]:
    """Fit the loading law of the declared tip, and insist on a load that stands out of its noise.

    Returns
    -------
    the contact, and a flag where the law of another tip is closer to the load

    Raises
    ------
    FitRefused : see `estimators.contact.fit_contact`; or the load, or the stiffness, is too
        uncertain to be one
    """
    depth, force = made.loading()
    fits = _fits(depth, force, (shape, *(name for name in EXPONENTS if name != shape)), config)
    contact = fits[shape]
    closer = _closer(fits, shape)
    relative = contact.u_stiffness / contact.stiffness
    if closer and relative > config.max_relative_uncertainty:
        raise FitRefused(closer, {"relative_uncertainty": relative})
    _refuse_faint(contact, depth, config)
    if relative > config.max_relative_uncertainty:
        raise FitRefused(
            f"the stiffness of the contact is known to {100 * relative:.2g} % only "
            f"({100 * config.max_relative_uncertainty:g} % is allowed), its contact point to "
            f"{in_um(contact.u_depth0)} in {in_um(float(depth.max()) - contact.depth0)} of depth; "
            "indent deeper, start farther above the surface or sample longer",
            {"relative_uncertainty": relative, "u_contact_m": contact.u_depth0},
        )
    return contact, (Flag("another-tip-fits-better", closer),) if closer else ()


def _closer(fits: Mapping[str, Contact], shape: str) -> str:
    """Say which tip's law the load follows more closely than the declared one's, if one is."""
    best = min(fits, key=lambda name: fits[name].residual_sd)
    if best == shape or fits[best].residual_sd * _CLOSER > fits[shape].residual_sd:
        return ""
    return (
        f"the load follows the law of a {best} tip within {in_uN(fits[best].residual_sd)}, that of "
        f"the declared {shape} one within {in_uN(fits[shape].residual_sd)}; check the tip in the "
        "register"
    )


def _refuse_faint(contact: Contact, depth: FloatArray, config: ContactConfig) -> None:
    rise = float(contact.load(depth).max())
    noise = contact.residual_sd
    if rise < config.min_signal_to_noise * noise:
        raise FitRefused(
            f"no contact, or a specimen too soft to feel: the load rises by {in_uN(rise)}, "
            f"{rise / noise:.2g} times its noise of {in_uN(noise)}, and "
            f"{config.min_signal_to_noise:g} times are needed; indent deeper or use a larger tip",
            {"rise_N": rise, "noise_N": noise},
        )


def contact_of_pyramid(made: Approach, part: float, config: ContactConfig) -> Contact:
    """Find the contact point of a pyramid on the first part of its loading.

    Every real tip is round at its end, and how far that matters depends on the depth: of the laws
    of a sphere and of a pyramid, the one that the load follows more closely is taken.

    Raises
    ------
    FitRefused : the loading does not begin within the recording, or the load is lost in its noise
    """
    depth, force = made.loading(part)
    fits = _fits(depth, force, ("spherical", "berkovich"), config)
    contact = min(fits.values(), key=lambda fit: fit.residual_sd)
    _refuse_faint(contact, depth, config)
    return contact


def _fits(
    depth: FloatArray, force: FloatArray, shapes: Sequence[str], config: ContactConfig
) -> dict[str, Contact]:
    """Fit the laws of several tips; all but the first are left out where they cannot be fitted."""
    fits: dict[str, Contact] = {}
    for shape in shapes:
        try:
            fits[shape] = fit_contact(
                depth, force, EXPONENTS[shape], config.min_air_samples, config.min_contact_samples
            )
        except FitRefused:
            if shape == shapes[0]:
                raise
    return fits


def curve_flags(made: Approach, contact: Contact) -> tuple[Flag, ...]:
    """Flag residuals that run together, and a tip that was held back on its way out."""
    flags = []
    if contact.independent_samples < FEW_INDEPENDENT:
        flags.append(
            Flag(
                "few-independent-samples",
                f"{made.end} samples of the loading count as {contact.independent_samples:.1f}: "
                "the curve departs from its law or the load drifts, and the standard error of the "
                "stiffness is rough",
            )
        )
    held = -float((made.force_N - contact.air(made.depth_m))[made.end :].min(initial=0.0))
    peak = float(contact.load(made.depth_m[: made.end]).max())
    if held > max(_PULL * peak, 5.0 * contact.residual_sd):
        flags.append(
            Flag(
                "adhesion",
                f"the tip was held back by {in_uN(held)} on its way out, {100 * held / peak:.2g} "
                "% of the peak load; a law without adhesion takes the contact for smaller than "
                "it was and the modulus for larger",
            )
        )
    return tuple(flags)


def size_flags(
    depth_m: float, tip: Tip, specimen: Specimen, config: ContactConfig
) -> tuple[Flag, ...]:
    """Flag a contact that is not small beside the sphere or beside the specimen."""
    flags = []
    radius = 0.0 if tip.radius is None else tip.radius.value
    if tip.shape == "spherical" and depth_m > config.max_part_of_radius * radius:
        flags.append(
            Flag(
                "deep-indentation",
                f"{in_um(depth_m)} are {100 * depth_m / radius:.3g} % of the tip's radius; Hertz's "
                f"law holds for small depths ({100 * config.max_part_of_radius:g} %)",
            )
        )
    if "height_m" not in specimen.numbers:
        flags.append(
            Flag("height-unknown", "the register gives no height: what lies below may be felt")
        )
        return tuple(flags)
    height = specimen.numbers["height_m"].value
    contact_radius = radius if tip.shape == "flat" else math.sqrt(radius * depth_m)
    felt = max(depth_m, contact_radius)
    if felt > config.max_part_of_height * height:
        flags.append(
            Flag(
                "finite-height",
                f"a depth of {in_um(depth_m)} and a contact radius of {in_um(contact_radius)} on a "
                f"specimen {in_um(height)} high: what lies below is felt and the modulus comes out "
                f"too large ({100 * config.max_part_of_height:g} % are allowed)",
            )
        )
    return tuple(flags)


def in_um(length_m: float) -> str:
    """Write a length in micrometres, three digits."""
    return f"{from_si(length_m, 'um'):.3g} um"


def in_uN(force_N: float) -> str:
    """Write a force in micronewtons, three digits."""
    return f"{from_si(force_N, 'uN'):.3g} uN"
