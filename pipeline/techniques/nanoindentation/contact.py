"""The contact of a tip with the specimen: its point, its stiffness, and what must be flagged."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.records import Flag, Specimen
from deamat.estimators.curves.contact import Contact, fit_contact
from deamat.estimators.curves.slope import FEW_INDEPENDENT
from deamat.techniques.nanoindentation.approach import EXPONENTS, Approach, Tip, in_um, in_uN
from deamat.techniques.nanoindentation.config import NanoindentationConfig

_CLOSER = 1.5  # residuals of the declared law over those of another that make it the likelier one
_PULL = 0.02  # part of the peak load from which a pull on the way out is called adhesion


def fitted_contact(
    made: Approach, shape: str, config: NanoindentationConfig
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
    contact = min(fits.values(), key=lambda fit: fit.residual_sd)
    _refuse_faint(contact, depth, config)
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
