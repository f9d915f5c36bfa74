"""One indent: modulus from the loading law of a declared tip, or from a pyramid's unloading."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from deamat.core.errors import FitRefused
from deamat.core.instruments import Machine
from deamat.core.quantity import Contribution, Quantity
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Detail, Flag, MeasuredValue, Measurement
from deamat.core.technique import Context
from deamat.core.units import from_si
from deamat.estimators.curves.contact import Contact
from deamat.estimators.curves.unloading import fit_unloading
from deamat.techniques.nanoindentation.adhesion import (
    Pull,
    adhesion_flags,
    corrected_flag,
    pull,
    without_adhesion,
)
from deamat.techniques.nanoindentation.approach import Approach, Tip, approach, declared_tip
from deamat.techniques.nanoindentation.config import (
    IDEAL_BERKOVICH,
    MODULUS,
    YIELDS,
    NanoindentationConfig,
)
from deamat.techniques.nanoindentation.contact import (
    contact_of_pyramid,
    curve_flags,
    fitted_contact,
    insist_on_contact,
    size_flags,
)
from deamat.techniques.nanoindentation.result import Indent, LoadingLaw
from deamat.techniques.shared.outcome import line_span, nothing_measured, recorded, relative_lines


def reduce(
    specimen: Specimen, recording: Recording | None, context: Context[NanoindentationConfig]
) -> Measurement[Indent]:
    r"""Reduce one indentation to $E = E^* (1 - \nu^2)$, the tip being rigid by declaration.

    - flat, radius a: $P = 2 a E^* h$, fitted to the loading with contact point and line in air;
    - spherical, radius R: $P = \tfrac{4}{3} E^* \sqrt{R}\, h^{3/2}$, fitted likewise;
    - Berkovich: $S = \beta \frac{2}{\sqrt\pi} E^* \sqrt{A(h_c)}$ with
      $h_c = h_m - \epsilon P_m / S$, from the unloading at its peak load.

    Parameters
    ----------
    specimen : with the note `tip`, `tip_radius_m` where the tip has one, `height_m` and
        `peak_load_N` where they are known
    recording : with `depth_m` and `force_N`
    context : its `machine.max_travel_m` ends the displacement

    Source: I. N. Sneddon, Int. J. Eng. Sci. 3 (1965) 47 (flat punch); H. Hertz, J. reine angew.
    Math. 92 (1882) 156; W. C. Oliver, G. M. Pharr, J. Mater. Res. 7 (1992) 1564 and 19 (2004) 3.
    """
    config = context.config
    try:
        file = recorded(recording)
        tip = declared_tip(specimen)
        made = approach(file, specimen, context.machine, config)
        if tip.radius is None:
            contact = contact_of_pyramid(made, config.first_loading, config)
            held = pull(made, contact, config)
            value = _by_unloading(made, contact, file, context, adhesion_flags(tip, held))
        else:
            fitted = fitted_contact(made, tip.shape, config)
            contact = fitted.contact
            held = pull(made, contact, config)
            loaded = Loaded(made, contact, tip, tip.radius, held)
            if held.sticks and tip.shape == "spherical":
                value = _by_way_out(loaded, file, context)
            else:
                flags = insist_on_contact(fitted, made, config) + adhesion_flags(tip, held)
                value = _by_loading(loaded, file, context, flags)
    except FitRefused as error:
        return nothing_measured(specimen, YIELDS, error, recording, _as_read(recording))
    depth = float(made.depth_m[: made.end].max()) - contact.depth0
    flags = curve_flags(made, contact) + size_flags(depth, tip, specimen, config)
    law = None if tip.radius is None else LoadingLaw(contact.stiffness, contact.exponent)
    indent = Indent(made.depth_m - contact.depth0, made.force_N - contact.air(made.depth_m), law)
    return Measurement(
        specimen, (replace(value, flags=value.flags + flags),), (), indent, file.source
    )


def _as_read(recording: Recording | None) -> Indent | None:
    """Keep depth and load of a refused indent as they were read, so that a figure shows why."""
    if recording is None or not {"depth_m", "force_N"} <= recording.columns.keys():
        return None
    return Indent(recording.columns["depth_m"], recording.columns["force_N"])


@dataclass(frozen=True, slots=True)
class Loaded:
    """A tip with a radius, how it was brought into contact, and how it was held back."""

    made: Approach
    contact: Contact
    tip: Tip
    radius: Quantity
    held: Pull

    @property
    def hertz_Pa(self) -> float:
        """Reduced modulus of a sphere's loading by Hertz' law."""
        return 0.75 * self.contact.stiffness / math.sqrt(self.radius.value)

    @property
    def unseen(self) -> float:
        """Relative standard uncertainty by a pull of a sphere that the noise would hide."""
        return self.held.unseen / math.sqrt(3.0) if self.tip.shape == "spherical" else 0.0


def _by_way_out(
    loaded: Loaded, recording: Recording, context: Context[NanoindentationConfig]
) -> MeasuredValue:
    """Modulus from the way out of a sphere that sticks."""
    config, made, contact, radius = context.config, loaded.made, loaded.contact, loaded.radius
    found, top = without_adhesion(made, contact, radius.value, loaded.hertz_Pa, loaded.held, config)
    noise = loaded.held.noise_N / found.pull_off
    budget = (
        Contribution("scatter about the way out", found.u_scatter, shared=False),
        Contribution("pull-off force", found.per_pull_off * noise, shared=False),
        Contribution("tip radius", 0.5 * radius.standard_uncertainty / radius.value, shared=True),
        *_machine_budget(context.machine, 1.5),
    )
    diagnostics: dict[str, Detail] = {
        **_contact_diagnostics(contact),
        "pull_off_N": found.pull_off,
        "work_of_adhesion_J_per_m2": found.work,
        "tabor_parameter": found.tabor,
        "reduced_modulus_by_hertz_Pa": loaded.hertz_Pa,
    }
    return _value(
        found.reduced_modulus, budget, recording, config,
        (made.start + top + found.first, made.start + top + found.last), diagnostics,
        method=f"spherical tip that sticks, {found.model} with the measured pull-off, fitted to "
        "the way out",
        flags=(corrected_flag(found, loaded.held, loaded.hertz_Pa),),
    )  # fmt: skip


def _by_loading(
    loaded: Loaded,
    recording: Recording,
    context: Context[NanoindentationConfig],
    flags: tuple[Flag, ...],
) -> MeasuredValue:
    """Modulus from the stiffness K of a loading law, `P = K h^m`."""
    config, made, contact, radius = context.config, loaded.made, loaded.contact, loaded.radius
    if loaded.tip.shape == "flat":
        reduced, power, law = contact.stiffness / (2.0 * radius.value), 1.0, "P = 2 a E* h"
    else:
        reduced = loaded.hertz_Pa
        power, law = 0.5, "P = 4/3 E* sqrt(R) h^1.5"
    alone = contact.u_stiffness_alone
    point = math.sqrt(max(contact.u_stiffness**2 - alone**2, 0.0))
    budget = (
        Contribution("scatter about the loading law", alone / contact.stiffness, shared=False),
        Contribution("contact point", point / contact.stiffness, shared=False),
        Contribution(
            "tilt of the load, without air", contact.per_tilt * config.u_tilt_N_per_m, shared=True
        ),
        Contribution("adhesion that noise hides", loaded.unseen, shared=True),
        # one tip made all indents, so whatever its radius is wrong by is wrong in all of them
        Contribution("tip radius", power * radius.standard_uncertainty / radius.value, shared=True),
        *_machine_budget(context.machine, contact.exponent),
    )
    depth, _ = made.loading()
    span = (made.start, made.start + made.end - 1)
    diagnostics: dict[str, Detail] = {
        **_contact_diagnostics(contact),
        "exponent": contact.exponent,
        "stiffness": contact.stiffness,
        "signal_to_noise": float(contact.load(depth).max()) / contact.residual_sd
        if contact.residual_sd > 0.0
        else math.inf,
    }
    return _value(
        reduced, budget, recording, config, span, diagnostics,
        method=f"{loaded.tip.shape} tip, {law}, fitted to the loading together with the contact "
        f"point and the {'zero of the load' if contact.per_tilt else 'line in air'}",
        flags=flags,
    )  # fmt: skip


def _by_unloading(
    made: Approach,
    contact: Contact,
    recording: Recording,
    context: Context[NanoindentationConfig],
    flags: tuple[Flag, ...],
) -> MeasuredValue:
    """Modulus from the stiffness at peak load of a pyramid's unloading."""
    config = context.config
    unloading = fit_unloading(
        made.depth_m - contact.depth0,
        made.force_N - contact.air(made.depth_m),
        config.unloading,
        config.min_contact_samples,
    )
    sunk = config.epsilon * unloading.peak_load / unloading.stiffness
    depth = unloading.peak_depth - sunk
    if not depth > 0.0:
        raise FitRefused(
            f"the depth of contact comes out as {from_si(depth, 'nm'):.3g} nm: the unloading is "
            "not that of a pyramid; check the tip in the register"
        )
    area, order = _area(config.area_function, depth)
    reduced = unloading.stiffness * math.sqrt(math.pi / area) / (2.0 * config.beta)
    # the stiffness also moves the depth of contact, and the area goes with that to a power
    own = abs(1.0 - 0.5 * order * sunk / depth) * unloading.u_stiffness / unloading.stiffness
    budget = (
        Contribution("scatter about the unloading curve", own, shared=False),
        Contribution("contact point", 0.5 * order * contact.u_depth0 / depth, shared=False),
        Contribution("area function of the tip", 0.5 * config.u_area, shared=True),
        Contribution("pyramid against cone (beta)", config.u_beta, shared=True),
        *_machine_budget(context.machine, 1.0 + 0.5 * order),
    )
    if config.area_function == IDEAL_BERKOVICH:
        flags += (
            Flag(
                "ideal-tip-area",
                f"the area function is that of an ideal pyramid, {IDEAL_BERKOVICH[0]} h_c^2; a "
                "worn tip is blunter and the modulus then too large; declare the calibrated one",
            ),
        )
    diagnostics: dict[str, Detail] = {
        **_contact_diagnostics(contact),
        "unloading_stiffness_N_per_m": unloading.stiffness,
        "unloading_exponent": unloading.exponent,
        "peak_load_N": unloading.peak_load,
        "contact_depth_m": depth,
        "contact_area_m2": area,
    }
    span = (made.start + unloading.first, made.start + unloading.last)
    return _value(
        reduced, budget, recording, config, span, diagnostics,
        method="Berkovich tip, stiffness at peak load of the power law fitted to "
        f"{100 * config.unloading[0]:g}-{100 * config.unloading[1]:g} % of the unloading "
        "(Oliver and Pharr)",
        flags=flags,
    )  # fmt: skip


def _area(coefficients: Sequence[float], depth: float) -> tuple[float, float]:
    """Area of contact at a depth `[m^2]`, and the power with which it goes at that depth."""
    powers = [2.0, *(2.0**-i for i in range(len(coefficients) - 1))]
    terms = [c * depth**p for c, p in zip(coefficients, powers, strict=True)]
    area = math.fsum(terms)
    if not area > 0.0:
        raise FitRefused(
            f"the area function gives {area:.3g} m2 at a depth of {from_si(depth, 'nm'):.3g} nm; "
            "it was calibrated for other depths"
        )
    return area, math.fsum(p * t for p, t in zip(powers, terms, strict=True)) / area


def _machine_budget(machine: Machine, depth_power: float) -> tuple[Contribution, ...]:
    return (
        machine.shared_error("load calibration", "force", machine.u_force_calibration),
        machine.shared_error(
            "depth calibration", "displacement", depth_power * machine.u_displacement_calibration
        ).inverted(),
    )


def _contact_diagnostics(contact: Contact) -> dict[str, Detail]:
    return {
        "contact_depth_reading_m": contact.depth0,
        "u_contact_depth_m": contact.u_depth0,
        "tilt_in_air_N_per_m": contact.tilt,
        "noise_N": contact.residual_sd,
        "samples_in_air": contact.in_air,
        "samples_in_contact": contact.in_contact,
        "independent_samples": contact.independent_samples,
    }


def _value(
    reduced_Pa: float,
    budget: tuple[Contribution, ...],
    recording: Recording,
    config: NanoindentationConfig,
    span: tuple[int, int],
    diagnostics: Mapping[str, Detail],
    *,
    method: str,
    flags: tuple[Flag, ...],
) -> MeasuredValue:
    """Come from E* to E, for a rigid tip; say where the tip would not be rigid."""
    nu = config.poisson_ratio
    modulus = reduced_Pa * (1.0 - nu**2)
    poisson = 2.0 * nu * config.u_poisson_ratio / (1.0 - nu**2)
    lines = relative_lines(
        modulus, (*budget, Contribution("Poisson's ratio", poisson, shared=True))
    )
    tip = reduced_Pa * (1.0 - config.tip_poisson_ratio**2) / config.tip_modulus_Pa
    if tip > config.max_tip_compliance:
        flags += (
            Flag(
                "tip-not-rigid",
                f"diamond itself would give way: {100 * tip:.3g} % of 1/E* is the tip's, so that "
                f"the modulus would be {100 * tip / (1.0 - tip):.3g} % larger",
            ),
        )
    rows = recording.columns["force_N"].size
    return MeasuredValue(
        key=MODULUS,
        quantity=Quantity.from_budget(modulus, "Pa", lines),
        budget=lines,
        method=f"{method}; E = E* (1 - nu^2) with nu = {nu:g} declared and a rigid tip",
        lines=line_span(recording.source, rows, *span),
        diagnostics={**diagnostics, "reduced_modulus_Pa": reduced_Pa, "tip_compliance": tip},
        flags=flags,
    )
