"""Whether the Weibull form holds for the films of a sample, and what they could not have shown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.records import Detail, Flag
from deamat.core.units import from_si
from deamat.estimators.weibull.coverage import Coverage, coverage
from deamat.estimators.weibull.fit import WeibullFit
from deamat.estimators.weibull.goodness import (
    Curved,
    GoodnessOfFit,
    LowOutlier,
    curved,
    goodness_of_fit,
    low_outlier,
)
from deamat.estimators.weibull.intervals import Inference, infer
from deamat.estimators.weibull.trend import Trend, trend, trend_p_value
from deamat.estimators.weibull.unseen import Unseen, unseen
from deamat.techniques.breakdown.config import BreakdownConfig
from deamat.techniques.breakdown.sample import Sample

_SUSPECT = 0.05  # p-value from which intervals hold what the thickness would explain
_SPREAD = 3.0  # of the thickness over what it was read to: less tells nothing of a trend


@dataclass(frozen=True, slots=True)
class Form:
    """What the tests of one sample say.

    Parameters
    ----------
    fits, lowest, curved : of the Weibull form, of the weakest film, of a straight Weibull plot
    thickness_p : of a strength that does not follow the thickness; None where that was not tested
    thickness : how it follows it, where the p-value is below 0.05
    follows : whether that is said
    coverage : of the intervals, where the censoring makes them approximate
    """

    fits: GoodnessOfFit
    lowest: LowOutlier
    curved: Curved
    thickness_p: float | None
    thickness: Trend | None
    follows: bool
    coverage: Coverage | None


def judge(sample: Sample, fit: WeibullFit, config: BreakdownConfig) -> Form:
    """Test the form of one sample.

    Raises
    ------
    FitRefused : as `weibull.fit`
    """
    x, censored = sample.field_V_per_m, sample.censored
    thickness_m = _thickness(sample)
    thickness_p = None if thickness_m is None else trend_p_value(x, censored, thickness_m)
    suspect = thickness_p is not None and thickness_p < max(_SUSPECT, config.thickness_level)
    return Form(
        goodness_of_fit(x, censored),
        low_outlier(x, censored, config.low_outlier_level),
        curved(x, censored),
        thickness_p,
        trend(x, censored, thickness_m) if suspect and thickness_m is not None else None,
        thickness_p is not None and thickness_p < config.thickness_level,
        _coverage(sample) if fit.censoring == "type I or random" else None,
    )


def _coverage(sample: Sample) -> Coverage | None:
    try:
        return coverage(sample.field_V_per_m, sample.censored)
    except FitRefused:  # so few failures that hardly a simulated sample has three
        return None


def _thickness(sample: Sample) -> FloatArray | None:
    """Thicknesses of the films, where they differ by more than they were read to."""
    found = [film.thickness_m for film in sample.films if film.thickness_m is not None]
    if len(found) < max(len(sample.films), 5):
        return None
    thickness_m = np.array(found)
    read = [m.specimen.numbers["thickness_m"].u_independent for m, _ in sample.pairs]
    spread = float(thickness_m.std())
    return thickness_m if spread > _SPREAD * float(np.mean(read)) and spread > 0.0 else None


def freed_of_thickness(sample: Sample, form: Form) -> Inference | None:
    """Fit the fields at the mean thickness, where they seem to follow it.

    Raises
    ------
    FitRefused : as `weibull.fit`
    """
    thickness_m = _thickness(sample)
    if form.thickness is None or thickness_m is None:
        return None
    ratio = thickness_m / form.thickness.centre
    return infer(sample.field_V_per_m * ratio**form.thickness.exponent, sample.censored)


def form_details(sample: Sample, form: Form) -> dict[str, Detail]:
    """List what the tests gave, as numbers and names."""
    lowest = form.lowest
    details: dict[str, Detail] = {
        "anderson_darling": form.fits.statistic,
        "goodness_p": form.fits.p_value,
        "curvature_score": form.curved.score,
        "curvature_p": form.curved.p_value,
        "low_outlier_p": lowest.p_value,
        "low_outlier": sample.pairs[lowest.index][0].specimen.id if lowest.found else "none",
    }
    if form.thickness_p is not None:
        details["thickness_p"] = form.thickness_p
    if form.thickness is not None:
        details |= {
            "thickness_exponent": form.thickness.exponent,
            "thickness_exponent_low": form.thickness.low,
            "thickness_exponent_high": form.thickness.high,
            "thickness_centre_m": form.thickness.centre,
            "strength_at_centre_V_per_m": form.thickness.at_centre.scale,
            "shape_at_centre": form.thickness.at_centre.shape,
        }
    if form.coverage is not None:
        details |= {
            "coverage_least": form.coverage.least,
            "coverage_greatest": form.coverage.greatest,
            "coverage_draws": form.coverage.draws,
        }
    return details


def form_flags(
    sample: Sample, fit: WeibullFit, form: Form, config: BreakdownConfig
) -> tuple[Flag, ...]:
    """Say where the form does not hold, and where the intervals are approximate."""
    flags = []
    if fit.censoring == "type I or random":
        flags.append(_approximate(fit, form.coverage))
    if form.fits.p_value < config.goodness_level:
        flags.append(
            Flag(
                "poor-fit",
                f"only {100 * form.fits.p_value:.2g} % of Weibull samples lie as far from their "
                f"fit (Anderson-Darling {form.fits.statistic:.3g}): low quantiles cannot be "
                f"trusted; {_direction(form.curved)}",
            )
        )
    if form.curved.p_value < config.curvature_level:
        flags.append(
            Flag(
                "form-curved",
                f"only {100 * form.curved.p_value:.2g} % of Weibull samples give as curved a "
                f"Weibull plot: {_direction(form.curved)}",
            )
        )
    if form.lowest.found:
        who = sample.pairs[form.lowest.index][0].specimen.id
        flags.append(
            Flag(
                "low-outlier",
                f"{who} broke at {from_si(form.lowest.value, 'V/um'):.4g} V/um; only "
                f"{100 * form.lowest.p_value:.2g} % of Weibull samples hold one as weak; it is in "
                "the fit all the same",
            )
        )
    if form.follows and form.thickness is not None:
        flags.append(_follows_thickness(sample, form.thickness))
    return tuple(flags)


def _direction(found: Curved) -> str:
    if found.score < 0.0:
        return (
            "there are more weak films than a Weibull distribution has, as two populations or "
            "competing modes leave: B1 and B10 may be lower"
        )
    return (
        "there are fewer weak films than a Weibull distribution has, as a threshold "
        "(three-parameter Weibull) or a lognormal strength leaves: B1 and B10 may be higher"
    )


def _approximate(fit: WeibullFit, found: Coverage | None) -> Flag:
    how = (
        "how often they hold the truth could not be simulated, so few broke"
        if found is None
        else f"intervals of 95 % hold the truth in {100 * found.least:.0f} to "
        f"{100 * found.greatest:.0f} % of {found.draws} simulated samples of this censoring"
    )
    return Flag(
        "approximate-interval",
        f"{fit.n - fit.failures} of {fit.n} specimens did not break, each at a limit of its own: "
        f"{how}",
    )


def _follows_thickness(sample: Sample, found: Trend) -> Flag:
    thickness_m = [film.thickness_m or 0.0 for film in sample.films]
    least, greatest, centre = (
        from_si(t, "um") for t in (min(thickness_m), max(thickness_m), found.centre)
    )
    return Flag(
        "thickness-dependence",
        f"the field at breakdown follows the thickness as t^{-found.exponent:.2g} (exponent "
        f"{-found.high:.2g} to {-found.low:.2g}, p = {found.p_value:.1g}) from {least:.4g} to "
        f"{greatest:.4g} um: the values are those of the mixture; at {centre:.4g} um the strength "
        f"is {from_si(found.at_centre.scale, 'V/um'):.4g} V/um and the shape "
        f"{found.at_centre.shape:.3g}",
    )


def could_not_see(sample: Sample, p: float, config: BreakdownConfig) -> Unseen:
    """Say how large a departure from the form these films could not have shown."""
    return unseen(
        sample.field_V_per_m, sample.censored, p,
        power=config.form_power, form_level=config.goodness_level,
        curvature_level=config.curvature_level,
    )  # fmt: skip


def unseen_details(found: Unseen) -> dict[str, Detail]:
    """List what could not be seen, as numbers."""
    return {
        "form_unseen_lower": found.lower,
        "form_unseen_higher": found.higher,
        "form_power_lower": found.power_lower,
        "form_power_higher": found.power_higher,
        "weak_fraction_unseen": found.weak_fraction,
    }


def unseen_flags(n: int, p: float, found: Unseen, config: BreakdownConfig) -> tuple[Flag, ...]:
    """Qualify a quantile whose form was not tested well enough."""
    said = []
    if found.lower > config.form_tolerance:
        seen = f"{100 * found.power_lower:.0f} %"
        said.append(
            f"a tail of weak films that lowers this value by {100 * found.lower:.0f} % is found in "
            f"{seen} of such samples only, less still rarer"
        )
    if found.higher > config.form_tolerance:
        seen = f"{100 * found.power_higher:.0f} %"
        said.append(f"a threshold that raises it by {100 * found.higher:.0f} % in {seen} of them")
    if found.weak_fraction > p:
        said.append(
            f"of a second, weaker population of up to {100 * found.weak_fraction:.2g} % of all "
            "films they may hold none"
        )
    if not said:
        return ()
    return (
        Flag("form-untested", f"{n} specimens do not test the Weibull form: {'; '.join(said)}"),
    )
