"""The uncertain numbers of a design: each with its budget, and what measures it.

Inputs that rest on one calibration or one fit move together: contributions of the same source are
one error, whichever inputs it enters. What is shared by all specimens never averages away.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from deamat.actuator.card_values import CardValues
from deamat.actuator.declared import Designs, Electrode
from deamat.actuator.ranges import Reals
from deamat.actuator.strip import Strip
from deamat.core.quantity import Contribution
from deamat.core.records import PropertyRecord
from deamat.core.units import to_si
from deamat.materials.correlation import cause_of, technique_of


@dataclass(frozen=True, slots=True)
class Input:
    """One uncertain number of a design.

    Parameters
    ----------
    name : `compressive_modulus of sylgard-182-30to1`
    drives : fields of a `strip.Strip` that it sets: the modulus of a material used twice sets two
    value, unit : in SI, above zero
    budget : standard uncertainties; one source is one error, in whichever inputs it stands;
        those that are not shared shrink with the number of specimens
    test : what measures it (`compression of sylgard-182-30to1`), None for a declared one
    n : specimens behind it, 0 for a declared one
    """

    name: str
    drives: tuple[str, ...]
    value: float
    unit: str
    budget: tuple[Contribution, ...]
    test: str | None = None
    n: int = 0

    @property
    def u(self) -> float:
        """Combined standard uncertainty `[unit]`."""
        return math.sqrt(math.fsum(c.u**2 for c in self.budget))

    @property
    def concerns_breakdown(self) -> bool:
        """It sets the breakdown of the film, not how far a voltage bends the strip."""
        return "breakdown_strength_V_m" in self.drives or "weibull_shape" in self.drives


def inputs_of(
    values: CardValues, declared: Designs, electrode: Electrode, strip: Strip
) -> tuple[Input, ...]:
    """List the uncertain numbers of a strip; one material in two layers is one input.

    Parameters
    ----------
    values, declared, electrode : what the strip was made from
    strip : with the passive layer of the answer

    Returns
    -------
    measured inputs, those of the breakdown after the others, then declared ones
    """
    spread = declared.tolerances
    if values.passive_modulus.material == values.film_modulus.material:
        inputs = [_measured(values.film_modulus, "film_modulus_Pa", "passive_modulus_Pa")]
    else:
        inputs = [
            _measured(values.film_modulus, "film_modulus_Pa"),
            _measured(values.passive_modulus, "passive_modulus_Pa"),
        ]
    inputs.append(_measured(values.permittivity, "relative_permittivity"))
    if values.strength and values.shape:
        inputs += _of_one_fit(
            _measured(values.strength, "breakdown_strength_V_m"),
            _measured(values.shape, "weibull_shape"),
            values.fit_correlation,
        )
    u_MPa = electrode.u_youngs_modulus_MPa
    thicknesses = (
        ("de layer", "film_thickness_m", strip.film_thickness_m, spread.u_de_thickness_um),
        ("passive layer", "passive_thickness_m", strip.passive_thickness_m,
         spread.u_passive_thickness_um),
        ("electrodes", "electrode_thickness_m", strip.electrode_thickness_m,
         spread.u_electrode_thickness_um),
    )  # fmt: skip
    return (
        *inputs,
        *(
            _declared(f"thickness of the {layer}", field, value, to_si(u_um, "um"))
            for layer, field, value, u_um in thicknesses
        ),
        _declared(
            "modulus of the electrodes", "electrode_modulus_Pa", strip.electrode_modulus_Pa,
            None if u_MPa is None else to_si(u_MPa, "MPa"), "Pa",
        ),
        _declared("Poisson's ratio", "poisson_ratio", strip.poisson_ratio, None, "1"),
    )  # fmt: skip


def _measured(record: PropertyRecord, *drives: str) -> Input:
    """Return a record of a card as an input that sets the fields `drives` of a strip."""
    technique = technique_of(record)
    name = f"{record.key} of {record.material}"
    test = f"{technique} of {record.material}"
    lines = record.budget or (
        Contribution("independent", record.quantity.u_independent, False),
        Contribution("shared", record.quantity.u_shared, True),
    )
    budget: list[Contribution] = []
    for c in lines:
        if c.shared:
            budget.append(replace(c, source=cause_of(c, record)))
        else:
            budget.append(replace(c, source=f"{c.source} of {name}"))
    q = record.quantity
    return Input(name, drives, q.value, q.unit, tuple(budget), test, record.n)


def _declared(name: str, drives: str, value: Reals, u: float | None, unit: str = "m") -> Input:
    """Return a declared number as an input; `u` is None where no uncertainty is declared."""
    budget = () if u is None else (Contribution(f"declared {name}", u, True),)
    return Input(name, (drives,), float(value), unit, budget)


def _of_one_fit(scale: Input, shape: Input, correlation: float) -> list[Input]:
    """Let the independent errors of scale and shape move together.

    That of the shape is split into the part that goes with the scale's, and a rest of its own.
    """
    u = math.sqrt(math.fsum(c.u**2 for c in scale.budget if not c.shared))
    if u == 0.0 or correlation == 0.0:
        return [scale, shape]
    fit = f"fit of {scale.test}"
    together = [c for c in scale.budget if c.shared]
    together.append(Contribution(fit, u, False))
    budget: list[Contribution] = []
    for c in shape.budget:
        if c.shared:
            budget.append(c)
            continue
        with_scale = c.scaled(correlation)
        budget.append(replace(with_scale, source=fit, inverse=correlation < 0.0))
        alone = c.scaled(math.sqrt(1.0 - correlation**2))
        budget.append(replace(alone, source=f"{fit}, shape alone"))
    return [replace(scale, budget=tuple(together)), replace(shape, budget=tuple(budget))]
