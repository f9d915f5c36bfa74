"""The one table of property keys and the closed list of condition keys."""

from __future__ import annotations

from dataclasses import dataclass

from deamat.core.errors import MissingProperty


@dataclass(frozen=True, slots=True)
class PropertyKey:
    """What a property is called, in which unit it is kept, and what is plausible for it.

    Parameters
    ----------
    key, symbol, unit : name in cards, symbol in figures, SI unit
    plausible : lowest and highest value of a soft elastomer `[unit]`; outside it a value is flagged
    standard : the test standard or article that defines it
    is_modulus : it is a stiffness of the material, which moduli of other tests are compared with
    """

    key: str
    symbol: str
    unit: str
    plausible: tuple[float, float]
    standard: str
    is_modulus: bool = False


_TABLE = (
    PropertyKey(
        "compressive_modulus",
        "Y_c",
        "Pa",
        (1e3, 1e8),
        "ASTM D575, slope over 0-5 %",
        is_modulus=True,
    ),
    PropertyKey(
        "compressive_modulus_toe_compensated",
        "Y_c,toe",
        "Pa",
        (1e3, 1e8),
        "ASTM D638 annex A1, tangent to zero stress",
        is_modulus=True,
    ),
    PropertyKey(
        "tensile_modulus", "Y_t", "Pa", (1e3, 1e8), "ASTM D412, slope over 0-1 %", is_modulus=True
    ),
    PropertyKey(
        "tensile_modulus_toe_compensated",
        "Y_t,toe",
        "Pa",
        (1e3, 1e8),
        "ASTM D638 annex A1, counted from where the strip is taut",
        is_modulus=True,
    ),
    PropertyKey("tensile_strength", "sigma_b", "Pa", (1e3, 1e8), "ASTM D412"),
    PropertyKey("elongation_at_break", "eps_b", "1", (0.05, 30.0), "ASTM D412"),
    PropertyKey("indentation_modulus", "Y_i", "Pa", (1e3, 1e9), "ISO 14577-1", is_modulus=True),
    PropertyKey("relative_permittivity", "eps_r", "1", (1.5, 100.0), "ASTM D150"),
    PropertyKey("loss_tangent", "tan delta", "1", (0.0, 1.0), "ASTM D150"),
    PropertyKey("breakdown_strength", "E_b", "V/m", (1e6, 1e9), "D149-style DC ramp, IEC 62539"),
    PropertyKey("breakdown_field", "E", "V/m", (1e6, 1e9), "D149-style DC ramp, one specimen"),
    PropertyKey("breakdown_B10", "E_10", "V/m", (1e5, 1e9), "field that 10 % do not survive"),
    PropertyKey("breakdown_B1", "E_1", "V/m", (1e5, 1e9), "field that 1 % do not survive"),
    PropertyKey("weibull_shape", "beta", "1", (0.5, 100.0), "IEC 62539"),
    PropertyKey("weibull_shape_unbiased", "beta_u", "1", (0.5, 100.0), "Ross 1996"),
    PropertyKey("viscosity", "mu", "Pa.s", (1e-3, 1e5), "ASTM D2196"),
    PropertyKey(
        "viscosity_against_temperature",
        "mu_T",
        "Pa.s",
        (1e-3, 1e5),
        "Arrhenius law, Andrade 1934",
    ),
    PropertyKey(
        "viscosity_at_printing_rate",
        "mu_p",
        "Pa.s",
        (1e-3, 1e5),
        "at the shear rate in the nozzle, as the configuration declares it",
    ),
    PropertyKey("viscosity_doubling_time", "t_2", "s", (60.0, 1e7), "from the viscosity law"),
    PropertyKey("time_to_viscosity_limit", "t_lim", "s", (60.0, 1e7), "from the viscosity law"),
    PropertyKey(
        "flow_consistency", "K", "Pa.s^n", (1e-3, 1e6), "power law, K rate^(n-1), nominal rate"
    ),
    PropertyKey(
        "flow_consistency_wide_cup", "K_w", "Pa.s^n", (1e-3, 1e6), "K n^n: rate 2 omega / n"
    ),
    PropertyKey("flow_index", "n", "1", (0.05, 2.0), "power law, K rate^(n-1)"),
    PropertyKey("handling_time", "t_h", "s", (60.0, 1e7), "last clean printed line"),
    PropertyKey(
        "viscosity_at_handling_time", "mu_h", "Pa.s", (1e-3, 1e5), "law of viscosity, at t_h"
    ),
    PropertyKey("mass_density", "rho", "kg/m3", (500.0, 3000.0), "ASTM D792"),
)

PROPERTIES: dict[str, PropertyKey] = {p.key: p for p in _TABLE}

# What tells two records of one material apart; the unit stands in the name.
CONDITIONS: dict[str, str] = {
    "age": "time between cure and test, as the register says it; `after cure` is the usual state",
    "cure": "cure schedule, as the register says it",
    "temperature_K": "temperature of the specimen",
    "humidity": "relative humidity of the room, 0 to 1",
    "frequency_Hz": "frequency of the test",
    "rate_per_s": "nominal strain rate or shear rate of the test",
    "time_s": "time since mixing",
    "window": "range of strain or time that was fitted: [low, high]",
    "electrode": "material of the electrode, as the register says it",
    "electrode_area_m2": "area under the electrode",
    "rate_V_per_s": "rate of rise of the test voltage, as it was set",
}

# A register that records the usual state, tested some days after cure, says so with this word.
REFERENCE_AGE = "after cure"


def property_key(key: str) -> PropertyKey:
    """Look a property up in the one table.

    Raises
    ------
    MissingProperty : there is no such key
    """
    try:
        return PROPERTIES[key]
    except KeyError:
        raise MissingProperty(
            f"no property is called {key!r}; known: {', '.join(sorted(PROPERTIES))}"
        ) from None
