"""The contact of a tip with the specimen: its point, its stiffness, and what must be flagged."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.recording import Specimen
from deamat.core.records import Flag
from deamat.estimators.curves.contact import (
    Contact,
    StartsInContact,
    fit_contact,
    fit_in_contact,
    has_air,
    has_kink,
)
from deamat.estimators.curves.slope import FEW_INDEPENDENT
from deamat.techniques.nanoindentation.approach import (
    EXPONENTS,
    Approach,
    Tip,
    in_um,
    in_uN,
    straight_from_the_first,
)
from deamat.techniques.nanoindentation.config import NanoindentationConfig

_CLOSER = 1.5  # residuals of the declared law over those of another that make it the likelier one
_STEEP = 0.01  # rise of the line in air over that of the contact from which it may be contact


@dataclass(frozen=True, slots=True)
class Fitted:
    """The loading law of the declared tip, fitted.

    Parameters
    ----------
    flags : that the record starts in contact
    closer : why the law of another tip is the likelier one; empty where it is not
    """

    contact: Contact
    flags: tuple[Flag, ...] = ()
    closer: str = ""


def fitted_contact(made: Approach, shape: str, config: NanoindentationConfig) -> Fitted:
    """Fit the loading law of the declared tip, with air before the contact or without.

    Raises
    ------
    FitRefused : see `estimators.contact`
    """
    depth, force = made.loading()
    try:
        fits = _fits(depth, force, (shape, *(n for n in EXPONENTS if n != shape)), config)
    except StartsInContact as error:
        return _from_the_first(depth, force, shape, config, error)
    contact, closer = fits[shape], _closer(fits, shape)
    # a sphere's load is held to another tip's only where it starts in air
    if (shape != "flat" or not closer) and _may_start_in_contact(contact, depth):
        inside = _without_air(depth, force, contact, shape, config)
        if inside is not None:
            return inside
    return Fitted(contact, closer=closer)


def insist_on_contact(
    fitted: Fitted, made: Approach, config: NanoindentationConfig
) -> tuple[Flag, ...]:
    """Insist on a load that stands out of its noise, and on a stiffness that is known.

    Returns
    -------
    flags where the record starts in contact, or where the law of another tip is closer to the load

    Raises
    ------
    FitRefused : the load, or the stiffness, is too uncertain to be one
    """
    contact, closer, depth = fitted.contact, fitted.closer, made.loading()[0]
    relative = contact.u_stiffness / contact.stiffness
    if closer and relative > config.max_relative_uncertainty:
        raise FitRefused(closer, {"relative_uncertainty": relative})
    _refuse_faint(contact, depth, config)
    if relative > config.max_relative_uncertainty:
        raise FitRefused(
            f"the stiffness of the contact is known to {100 * relative:.2g} % only "
            f"({100 * config.max_relative_uncertainty:g} % is allowed), its contact point to "
            f"{in_um(contact.u_depth0)} in {in_um(float(depth.max()) - contact.depth0)} of depth"
            f"{'; the record starts in contact' if fitted.flags else ''}; "
            "indent deeper, start farther above the surface or sample longer",
            {"relative_uncertainty": relative, "u_contact_m": contact.u_depth0},
        )
    return fitted.flags + ((Flag("another-tip-fits-better", closer),) if closer else ())


def _may_start_in_contact(contact: Contact, depth: FloatArray) -> bool:
    """Tell quickly whether what was taken for a tilt in air is steep enough to be contact."""
    deepest = float(depth.max())
    rise = float(contact.load(depth).max())
    return contact.tilt * (deepest - contact.depth0) > _STEEP * rise


def _without_air(
    depth: FloatArray,
    force: FloatArray,
    contact: Contact,
    shape: str,
    config: NanoindentationConfig,
) -> Fitted | None:
    """Fit a record as one that starts in contact; None where a line in air explains it better."""
    if EXPONENTS[shape] == 1.0:
        if has_kink(contact, force, depth):
            return None
        raise FitRefused(straight_from_the_first(float(np.ptp(force)), float(np.ptp(depth))))
    try:
        inside = fit_in_contact(
            depth, force, EXPONENTS[shape], config.min_air_samples, config.min_contact_samples
        )
    except FitRefused:
        return None
    if has_air(contact, inside):
        return None
    return Fitted(inside, (_starts_in_contact(inside),))


def _from_the_first(
    depth: FloatArray,
    force: FloatArray,
    shape: str,
    config: NanoindentationConfig,
    error: FitRefused,
) -> Fitted:
    """Fit a record in which no line in air was found.

    Raises
    ------
    FitRefused : no contact from the first sample on either
    """
    try:
        inside = fit_in_contact(
            depth, force, EXPONENTS[shape], config.min_air_samples, config.min_contact_samples
        )
    except FitRefused:
        raise error from None
    return Fitted(inside, (_starts_in_contact(inside),))


def _starts_in_contact(contact: Contact) -> Flag:
    return Flag(
        "starts-in-contact",
        "the record starts in contact, or with too few samples in air: contact point (at a depth "
        f"of {in_um(contact.depth0)}) and zero of the load ({in_uN(contact.offset)}) are fitted "
        "with the modulus; a tilt of the load, which only air shows, is in the uncertainty",
    )


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


def _refuse_faint(contact: Contact, depth: FloatArray, config: NanoindentationConfig) -> None:
    rise = float(contact.load(depth).max())
    noise = contact.residual_sd
    if rise < config.min_signal_to_noise * noise:
        raise FitRefused(
            f"no contact, or a specimen too soft to feel: the load rises by {in_uN(rise)}, "
            f"{rise / noise:.2g} times its noise of {in_uN(noise)}, and "
            f"{config.min_signal_to_noise:g} times are needed; indent deeper or use a larger tip",
            {"rise_N": rise, "noise_N": noise},
        )


def contact_of_pyramid(made: Approach, part: float, config: NanoindentationConfig) -> Contact:
    """Find the contact point of a pyramid on the first part of its loading.

    Every real tip is round at its end, and how far that matters depends on the depth: of the laws
    of a sphere and of a pyramid, the one that the load follows more closely is taken.

    Raises
    ------
    FitRefused : the loading does not begin within the recording, or the load is lost in its noise
    """
    depth, force = made.loading(part)
    fits = _fits(depth, force, ("spherical", "berkovich"), config)
    shape, contact = min(fits.items(), key=lambda fit: fit[1].residual_sd)
    _refuse_faint(contact, depth, config)
    if _may_start_in_contact(contact, depth) and _without_air(depth, force, contact, shape, config):
        raise FitRefused(
            "the record starts in contact: what a pyramid's area goes by, the depth from its first "
            "touch, is not known; start in air, farther above the surface"
        )
    return contact


def _fits(
    depth: FloatArray, force: FloatArray, shapes: Sequence[str], config: NanoindentationConfig
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
    """Flag residuals that run together."""
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
    return tuple(flags)


def size_flags(
    depth_m: float, tip: Tip, specimen: Specimen, config: NanoindentationConfig
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
