"""The modulus of a strip: plain, and counted from where the strip is taut."""

from __future__ import annotations

from collections.abc import Mapping

from deamat.core.quantity import Contribution
from deamat.core.records import Condition, Flag, MeasuredValue
from deamat.estimators.curves.rupture import count_loadings
from deamat.estimators.curves.slack import Slack, steepest_behind
from deamat.estimators.curves.slope import curvature
from deamat.estimators.curves.stress_strain import window
from deamat.techniques.shared.modulus import WindowLine, modulus, percent, rising_line
from deamat.techniques.shared.stress_strain import disagreement
from deamat.techniques.tension.config import MODULI, TensionConfig
from deamat.techniques.tension.pull import Pull

_CERTAIN = 3.0  # standard errors by which a later slope is steeper, ...
_NOTICED = 0.02  # ... and the fraction that is worth a word


def plain_modulus(
    pull: Pull, slack: Slack | None, config: TensionConfig, conditions: Mapping[str, Condition]
) -> tuple[MeasuredValue, WindowLine]:
    """Slope over the window of strain as recorded.

    Raises
    ------
    FitRefused : too few samples, or a slope that cannot be told from zero
    """
    low, high = config.window
    curve = pull.curve
    strain, stress = (
        curve.nominal_strain[: pull.branch],
        curve.nominal_stress_Pa[: pull.branch],
    )
    inside = window(strain, low, high, config.min_samples, config.unloading_tolerance)
    pull.insist_on_channels(inside)
    line = rising_line(strain[inside], stress[inside], config.min_samples)
    flags = pull.flags + disagreement(curve, inside, config.own_columns_tolerance)
    if slack is not None:
        flags += (
            Flag(
                "slack",
                f"the strip is taut only from {100 * slack.strain:.2g} % strain on: slope "
                f"{slack.slope_before_Pa / 1e3:.4g} kPa before, {slack.slope_after_Pa / 1e3:.4g} "
                f"kPa behind; {MODULI[1]} counts from there",
            ),
        )
    value = modulus(
        MODULI[0],
        line,
        curve,
        inside,
        pull.recording,
        method=f"OLS slope with intercept over {percent(config.window)} nominal strain",
        conditions=conditions,
        flags=flags + several_loadings(pull, "first"),
        diagnostics={},
    )
    return value, WindowLine(config.window, line.slope, line.intercept)


def taut_modulus(
    pull: Pull, slack: Slack, config: TensionConfig, conditions: Mapping[str, Condition]
) -> MeasuredValue:
    """Slope over the same width of strain, counted from where the strip is taut.

    Raises
    ------
    FitRefused : as in `plain_modulus`
    """
    low, high = config.window
    curve = pull.curve
    strain, stress = (
        curve.nominal_strain[: pull.branch],
        curve.nominal_stress_Pa[: pull.branch],
    )
    inside = window(
        strain,
        slack.strain + low,
        slack.strain + high,
        config.min_samples,
        config.unloading_tolerance,
    )
    pull.insist_on_channels(inside)
    x, y = strain[inside], stress[inside]
    line = rising_line(x, y, config.min_samples)
    bend = abs(curvature(x, y))  # where the curve bends, the slope goes with the zero of strain
    steeper = steepest_behind(strain, stress, slack.strain, high - low) - line.slope
    flags: tuple[Flag, ...] = ()
    if steeper > max(_CERTAIN * line.standard_error, _NOTICED * line.slope):
        said = (
            f"the curve goes on to a slope of {(line.slope + steeper) / 1e3:.4g} kPa behind the "
            f"window, from {line.slope / 1e3:.4g} kPa in it: a round toe; the difference is in the "
            "uncertainty"
        )
        flags = (Flag("toe", said),)
    return modulus(
        MODULI[1],
        line,
        curve,
        inside,
        pull.recording,
        method=f"OLS slope over {percent(config.window)} of nominal strain counted from where the "
        "strip is taut, the hinge of the loading curve",
        conditions=conditions,
        flags=pull.flags
        + disagreement(curve, inside, config.own_columns_tolerance)
        + several_loadings(pull, "first")
        + flags,
        diagnostics={"slack_strain": slack.strain},
        further=(
            Contribution("where the strip is taut", bend * slack.u_strain, shared=False),
            # one-sided, and much the same for all strips of a mould and a pair of grips
            Contribution("steeper behind the window", max(steeper, 0.0), shared=True),
        ),
    )


def several_loadings(pull: Pull, used: str) -> tuple[Flag, ...]:
    """Flag a strip that was loaded more than once."""
    loadings = count_loadings(pull.curve.nominal_strain, pull.rupture.last)
    if loadings == 1:
        return ()
    return (Flag("several-loadings", f"{loadings} loadings; this value is of the {used} one"),)
