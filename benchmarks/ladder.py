"""What each rung of the actuator ladder costs and misses, and where it stops to hold.

`python -m benchmarks.ladder [--designs 2000]`; `make chart` does it too.

Random designs (SYNTHETIC: drawn, nobody made them) are put to every rung; the top one, the
elastica, is the reference, so errors are those of the simplification and not those against a
laboratory. The chart, the map and their numbers go to processed/benchmarks/.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from benchmarks.timing import (
    RESULTS,
    Row,
    interleaved,
    stay_on_one_core,
    table,
    undisturbed_s,
    write_results,
)
from deamat.actuator.beam import Beam, actuate, weight
from deamat.actuator.ladder import NEGLECTS, Actuator, Aim, Answer, Rung, choose, evaluate
from deamat.actuator.ranges import Reals
from deamat.actuator.stack import FIRST_LAYER_DOWN, ON_EDGE, Layer, Orientation, Role, Stack
from deamat.actuator.strain import pull_in_voltage
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.report.style import (
    COLOURS,
    PAGE_WIDTH_in,
    figure_style,
    new_figure,
    place_legend,
    save_figure,
    set_title,
)

POISSON_RATIO, WIDTH_m, DENSITY_kg_m3 = 0.49, 0.01, 1030.0
TOLERANCES = (3e-1, 1e-1, 3e-2, 1e-2, 1e-3, 1e-4)
TIMED = 200
DESIGNS = 2000
_BATCH = 40
_APART = 0.05  # of the logarithm of time, so that no bar hides another
_GOOD = 0.01  # the line of the map: one percent


@dataclass(frozen=True, slots=True)
class Draw:
    """One random design and where its elastica ends."""

    actuator: Actuator
    reference: Answer


def stack(
    passive: tuple[float, float], film: tuple[float, float], electrode: tuple[float, float]
) -> Stack:
    """Return a strip from (thickness, modulus) of its three materials."""

    def layer(role: Role, made: tuple[float, float]) -> Layer:
        return Layer(role, *made, WIDTH_m, DENSITY_kg_m3, 2.6, POISSON_RATIO)

    below = layer("electrode", electrode)
    return Stack((layer("passive", passive), below, layer("de", film), below))


def draw(count: int, seed: int = 0) -> tuple[list[Draw], int]:
    """Draw designs like those of the literature; give those that rest, and how many do not.

    Thicknesses and moduli over a decade and more, 5 to 95 % of the pull-in voltage, strips of 2 to
    30 mm in any orientation.
    """
    rng = np.random.default_rng(seed)
    found: list[Draw] = []
    lost = 0

    def decade(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(math.log(low), math.log(high))))

    for _ in range(count):
        film = decade(100e-6, 1e-3), decade(5e4, 2e6)
        passive = film[0] * decade(0.1, 2.0), film[1] * decade(0.5, 50.0)
        electrode = decade(1e-6, 30e-6), decade(1e5, 1e7)
        limit = float(np.asarray(pull_in_voltage(*film, 2.6)))
        voltage = limit * float(rng.uniform(0.05, 0.95))
        orientation = Orientation(float(rng.uniform(-math.pi, math.pi)))
        made = Actuator(
            stack(passive, film, electrode), decade(2e-3, 30e-3), voltage, "poisson", orientation
        )
        try:
            found.append(Draw(made, evaluate(made, "elastica")))
        except (FitRefused, OutOfRange):
            lost += 1  # it buckles, snaps or coils up: no rung is right about it
    return found, lost


def tip_error(answer: Answer, reference: Answer, length_m: float) -> float:
    """Return the distance of two tips in lengths."""
    apart = math.hypot(answer.tip_x_m - reference.tip_x_m, answer.tip_y_m - reference.tip_y_m)
    return apart / length_m


def costs_us(draws: Sequence[Draw]) -> dict[str, float]:
    """Return the processor time of every model for one design, undisturbed `[us]`."""
    some = [d.actuator for d in draws[:TIMED]]

    # In batches: what one model leaves in the caches shall not be the price of the next
    batches = [some[i : i + _BATCH] for i in range(0, len(some), _BATCH)]

    def evaluating(rung: Rung) -> Callable[[list[Actuator]], object]:
        return lambda batch: [evaluate(actuator, rung) for actuator in batch]

    def choosing(tolerance: float) -> Callable[[list[Actuator]], object]:
        return lambda batch: [choose(actuator, tolerance) for actuator in batch]

    contenders: dict[str, Callable[[list[Actuator]], object]] = {r: evaluating(r) for r in NEGLECTS}
    contenders |= {f"choose to {t:g}": choosing(t) for t in TOLERANCES}
    seconds = interleaved(contenders, [[batch] for batch in batches], rounds=5)
    return {name: 1e6 * undisturbed_s(times) / len(some) for name, times in seconds.items()}


def row(name: str, cost_us: float, apart: FloatArray, bent: FloatArray) -> Row:
    """Return quantiles of the errors of tip (in lengths) and curvature (relative)."""
    return {
        "model": name,
        "us_per_design": cost_us,
        "tip_median": float(np.median(apart)),
        "tip_90": float(np.quantile(apart, 0.9)),
        "tip_worst": float(apart.max()),
        "curvature_median": float(np.median(bent)),
        "curvature_90": float(np.quantile(bent, 0.9)),
        "designs": apart.size,
    }


def rungs(draws: Sequence[Draw]) -> list[Row]:
    """Measure every rung, and `choose` at several tolerances."""
    costs = costs_us(draws)
    rows: list[Row] = []
    for rung in NEGLECTS:
        answers = [evaluate(d.actuator, rung) for d in draws]
        rows.append({**_errors(rung, costs[rung], answers, draws), "within": ""})
    for tolerance in TOLERANCES:
        name = f"choose to {tolerance:g}"
        answers = [choose(d.actuator, tolerance).answer for d in draws]
        apart = [
            tip_error(a, d.reference, d.actuator.length_m)
            for a, d in zip(answers, draws, strict=True)
        ]
        kept = float(np.mean(np.array(apart) <= tolerance))
        rows.append({**_errors(name, costs[name], answers, draws), "within": kept})
    return rows


def _errors(name: str, cost: float, answers: Sequence[Answer], draws: Sequence[Draw]) -> Row:
    pairs = list(zip(answers, draws, strict=True))
    apart = np.array([tip_error(a, d.reference, d.actuator.length_m) for a, d in pairs])
    bent = np.array([abs(a.curvature_per_m / d.reference.curvature_per_m - 1.0) for a, d in pairs])
    return row(name, cost, apart, bent)


BASE = ((304e-6, 0.957e6), (446e-6, 0.957e6), (10e-6, 3.5e6))
PULL_IN_V = float(np.asarray(pull_in_voltage(*BASE[1], 2.6)))


def by_drive(x: float) -> Actuator:
    """V over the pull-in voltage; short, so that only the films matter."""
    return Actuator(stack(*BASE), 2e-3, x * PULL_IN_V, "poisson", ON_EDGE)


def by_electrode(x: float) -> Actuator:
    """Stiffness of both electrodes over that of the film, by their modulus."""
    passive, film, (thickness, _) = BASE
    modulus = x * film[0] * film[1] / (2 * thickness)
    made = stack(passive, film, (thickness, modulus))
    return Actuator(made, 2e-3, 0.2 * PULL_IN_V, "poisson", ON_EDGE)


def by_weight(x: float) -> Actuator:
    """Length over the elasto-gravity length; the films turn the tip by a tenth of a radian."""
    beam = actuate(stack(*BASE), 1.0, "poisson")
    length = x * gravity_length_m(beam)
    return Actuator(stack(*BASE), length, _turning(0.1 / length), "poisson", FIRST_LAYER_DOWN)


def by_turn(x: float) -> Actuator:
    """Angle by which the films turn the tip; on edge, so that weight plays no part."""
    length = 20e-3
    return Actuator(stack(*BASE), length, _turning(x / length), "poisson", ON_EDGE)


def gravity_length_m(beam: Beam) -> float:
    """Return the elasto-gravity length `(B / w)^(1/3)` `[m]`."""
    return float(np.cbrt(beam.bending_stiffness_N_m2 / weight(beam, FIRST_LAYER_DOWN)))


def _turning(curvature_per_m: float) -> float:
    low, high = 0.0, PULL_IN_V
    for _ in range(50):
        middle = 0.5 * (low + high)
        bent: Reals = actuate(stack(*BASE), middle, "poisson").curvature_per_m
        low, high = (middle, high) if bent < curvature_per_m else (low, middle)
    return low


SWEEPS: dict[str, tuple[str, Callable[[float], Actuator], FloatArray, Aim]] = {
    "drive": ("voltage over that of pull-in", by_drive, np.linspace(0.03, 0.99, 33), "curvature"),
    "electrodes": (
        "stiffness of electrodes over film",
        by_electrode,
        np.geomspace(1e-3, 30, 33),
        "curvature",
    ),
    "weight": ("length over elasto-gravity length", by_weight, np.geomspace(0.1, 1.9, 33), "tip"),
    "turn": ("turn of the tip [rad]", by_turn, np.geomspace(0.03, 1.3, 33), "tip"),
}


def sweep(
    make: Callable[[float], Actuator], points: FloatArray, aim: Aim
) -> dict[Rung, FloatArray]:
    """Return the error along a sweep: of the tip in lengths, or of the curvature, relative."""
    found: dict[Rung, list[float]] = {rung: [] for rung in NEGLECTS}
    for x in points.tolist():
        actuator = make(x)
        top = evaluate(actuator, "elastica")
        for rung in NEGLECTS:
            answer = evaluate(actuator, rung)
            bent = abs(answer.curvature_per_m / top.curvature_per_m - 1.0)
            found[rung].append(tip_error(answer, top, actuator.length_m) if aim == "tip" else bent)
    return {rung: np.array(errors) for rung, errors in found.items()}


def chart(rows: Sequence[Row], designs: int) -> tuple[Path, Path]:
    """Draw time against error: rungs with their spread, and what `choose` makes of them."""
    title = f"Rungs of the actuator ladder: {designs} random designs"
    with figure_style("ladder"):
        figure, axes = new_figure(4.6)
        simpler = [r for r in rows if not str(r["model"]).startswith(("choose", "elastica"))]
        taken: list[float] = []
        for r, colour in zip(simpler, COLOURS, strict=False):
            time_us = float(r["us_per_design"])
            while any(abs(math.log(time_us / t)) < _APART for t in taken):
                time_us *= math.exp(_APART)  # side by side where equally fast
            taken.append(time_us)
            axes.plot([time_us] * 2, [r["tip_median"], r["tip_90"]], "-", color=colour, lw=2)
            axes.plot(time_us, r["tip_median"], "o", color=colour, label=str(r["model"]))
        chosen = [r for r in rows if str(r["model"]).startswith("choose")]
        times = [float(r["us_per_design"]) for r in chosen]
        told = f"choose to {TOLERANCES[0]:g} ... {TOLERANCES[-1]:g} (90 % of designs)"
        axes.plot(times, [r["tip_90"] for r in chosen], "k--", marker="s", ms=3.5, label=told)
        top = next(float(r["us_per_design"]) for r in rows if r["model"] == "elastica")
        axes.axvline(top, color="#777777", lw=0.9, ls=":", label="elastica (the reference)")
        axes.set(xscale="log", yscale="log", xlabel="processor time for one design [µs]")
        axes.set_ylabel("error of the tip [lengths]: median to 90 %")
        set_title(figure, title)
        place_legend(figure, axes)
        return save_figure(figure, axes, RESULTS, "ladder", title, synthetic=True)


def validity_map(errors: dict[str, dict[Rung, FloatArray]]) -> tuple[Path, Path]:
    """Draw for each cause of trouble where each rung crosses one percent."""
    title = (
        "Where rungs stop to hold: one strip (304 µm on 446 µm, 0.957 MPa), one number at a time; "
        "a rung without a line is as right as the elastica"
    )
    with figure_style("ladder"):
        figure = Figure(figsize=(PAGE_WIDTH_in, 6.2), layout="constrained")
        FigureCanvasAgg(figure)
        panels = np.ravel(figure.subplots(2, 2, sharey=True))
        for axes, (key, (label, _, points, aim)) in zip(panels, SWEEPS.items(), strict=True):
            _panel(axes, points, errors[key])
            axes.set_xlabel(label, fontsize=8.5)
            words = "tip [lengths]" if aim == "tip" else "curvature [relative]"
            axes.set_ylabel(f"error of the {words}", fontsize=8.5)
            if key != "drive":
                axes.set_xscale("log")
        set_title(figure, title)
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=4)
        return save_figure(figure, panels[0], RESULTS, "ladder_validity", title, synthetic=True)


def _panel(axes: Axes, points: FloatArray, errors: dict[Rung, FloatArray]) -> None:
    for i, (rung, error) in enumerate(errors.items()):
        if rung != "elastica":
            axes.plot(points, np.maximum(error, 1e-9), color=COLOURS[i], label=rung)
    axes.axhline(_GOOD, color="black", lw=0.7, label="one percent")
    axes.set(yscale="log", ylim=(1e-4, 3))


def first_beyond(points: FloatArray, error: FloatArray) -> float | str:
    """Return where an error first passes one percent; empty if it never does."""
    over = np.flatnonzero(error > _GOOD)
    return float(points[over[0]]) if over.size else ""


def measure_and_draw(designs: int) -> tuple[list[Row], list[Row], list[Path]]:
    """Measure, print, write numbers and pictures.

    Returns
    -------
    rows of the rungs, where each stops to hold, and the PNG files
    """
    draws, lost = draw(designs)
    rows = rungs(draws)
    print(f"SYNTHETIC: {len(draws)} random designs; {lost} more buckle, snap or coil: no answer")
    print(table(rows))
    write_results("ladder", rows, ("numpy", "scipy"))
    errors = {key: sweep(make, points, aim) for key, (_, make, points, aim) in SWEEPS.items()}
    limits: list[Row] = [
        {"rung": rung, **{key: first_beyond(SWEEPS[key][2], errors[key][rung]) for key in SWEEPS}}
        for rung in NEGLECTS
    ]
    print("\nwhere the error first passes one percent")
    print(table(limits))
    write_results("ladder_validity", limits, ("numpy", "scipy"))
    return rows, limits, [chart(rows, len(draws))[1], validity_map(errors)[1]]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    parser.add_argument("--designs", type=int, default=DESIGNS)
    stay_on_one_core()
    measure_and_draw(parser.parse_args().designs)
