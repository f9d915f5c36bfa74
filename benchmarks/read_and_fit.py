"""How fast a curve is read and fitted with its uncertainty, beside what one would do otherwise.

`python -m benchmarks.read_and_fit` generates files of three columns, of two forms by name, of plain
tables and workbooks (which pandas reads with openpyxl), and lets six contenders work on them in
turn: the project's own reader, stress-strain curve and slope ("ours", which answers what
its rivals answer, and with an uncertainty that allows for autocorrelation); the same with the hash
of the bytes, which no rival takes but every origin of a number needs; the whole technique on top
(toe, budgets, flags); pandas with the textbook formula and its naive standard error; pandas with
lmfit; and merely reading and hashing the bytes. It prints their times (undisturbed, see
`benchmarks.timing`, and of the median round) and the ratios of the undisturbed ones, the peak
memory of the project's own way, and the time of `deamat all` when there is nothing to do. `--docs`
writes `docs/reading-speed.md` as well.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib
import importlib.util
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.campaign import (
    AREA_m2,
    Curve,
    DIAMETER_m,
    HEIGHT_m,
    SPEED_m_per_s,
    find_curves,
    write_campaign,
)
from benchmarks.campaign_forms import FORMS
from benchmarks.reading_page import PAGE, write_reading_page
from benchmarks.timing import (
    Row,
    interleaved,
    own_peak_memory_MB,
    stay_on_one_core,
    table,
    undisturbed_s,
    wall_times_s,
    write_results,
)
from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Specimen
from deamat.core.technique import AnyTechnique, Context
from deamat.formats.format import Format
from deamat.formats.rawfile import RawFile, read_raw

Fit = tuple[float, float]  # modulus and its standard uncertainty [Pa]
Contender = Callable[[Curve], Fit | None]

_WINDOW = 0.05
_TOLERANCE = 0.01  # a contender that misses the truth by more has not done the work
_FILES_A_PART = 25
_REFERENCES = ("ours", "ours, hashed", "ours, whole technique", "read and hash")
_MEMORY_TARGET_MB = 250.0
_NOTHING_TO_DO_TARGET_s = 0.15
_DEAMAT = (sys.executable, "-c", "import sys; from deamat.cli import main; sys.exit(main())")


class _Unhashed(RawFile):
    """A file of which nobody asks the hash, as the rivals do not."""

    sha256 = "not taken"


def ours(form: type[RawFile] = _Unhashed) -> Contender:
    """Detect, read with all its strictness, make the curve and fit the slope of the window."""
    # By name, so that the rivals can be timed where these floors do not import.
    detect: Callable[[RawFile], Format] = importlib.import_module("deamat.formats.detect").detect
    curves = importlib.import_module("deamat.techniques.shared.stress_strain")
    geometry = importlib.import_module("deamat.techniques.shared.geometry")
    estimators = importlib.import_module("deamat.estimators.curves.stress_strain")
    fit_line = importlib.import_module("deamat.estimators.curves.slope").fit_line
    config = importlib.import_module("deamat.techniques").TECHNIQUES["compression"].config()
    machine = Machine()
    height = Quantity(HEIGHT_m, "m", 1e-5, 1e-5)
    section = geometry.circular_section({"diameter_m": Quantity(DIAMETER_m, "m", 1e-5, 1e-5)})

    def fit(curve: Curve) -> Fit:
        raw = form(curve.path.name, read_raw(curve.path.parent, curve.path.name))
        recording = detect(raw).read(raw)
        whole = curves.stress_strain(recording, section, height, "height", machine)
        loading = whole.nominal_strain[: estimators.loading_branch(whole.nominal_strain)]
        inside = estimators.window(
            loading, 0.0, _WINDOW, config.min_samples, config.unloading_tolerance
        )
        line = fit_line(loading[inside], whole.nominal_stress_Pa[inside])
        return line.slope, line.standard_error

    return fit


def ours_hashed() -> Contender:
    """Do the same, and hash the bytes for the origin of the numbers."""
    return ours(RawFile)


def ours_whole() -> Contender:
    """Detect, read and reduce with the whole technique, as a run does it."""
    # By name, so that the rivals can be timed where these floors do not import.
    detect: Callable[[RawFile], Format] = importlib.import_module("deamat.formats.detect").detect
    techniques = importlib.import_module("deamat.techniques").TECHNIQUES
    technique: AnyTechnique = techniques["compression"]
    context = Context(technique.config(), Machine(), needs={})
    specimen = _specimen()

    def fit(curve: Curve) -> Fit:
        raw = RawFile(curve.path.name, read_raw(curve.path.parent, curve.path.name))
        recording = detect(raw).read(raw)
        measurement = technique.reduce(specimen, recording, context)
        for value in measurement.values:
            if value.key == "compressive_modulus":
                return value.quantity.value, value.quantity.standard_uncertainty
        raise ValueError(f"{curve.path.name}: no modulus, {measurement.refusals}")

    return fit


def _specimen() -> Specimen:
    """Return the register's row, which a run has read before it opens a file."""
    return Specimen(
        id="any",
        material="any",
        campaign="speed",
        technique="compression",
        file="any",
        format=None,
        numbers={
            "diameter_m": Quantity(DIAMETER_m, "m", 1e-5, 1e-5),
            "height_m": Quantity(HEIGHT_m, "m", 1e-5, 1e-5),
            "speed_m_per_s": Quantity(SPEED_m_per_s, "m/s"),
        },
        conditions={},
        notes={},
        register="speed/compression/specimens.csv",
        line=2,
    )


def pandas_with_formula() -> Contender:
    """Read with pandas and fit with the textbook formula and its naive standard error."""
    window = _pandas_window()

    def fit(curve: Curve) -> Fit:
        x, y = window(curve)
        dx = x - x.mean()
        sxx = dx @ dx
        slope = dx @ y / sxx
        residuals = y - y.mean() - slope * dx
        return float(slope), float(np.sqrt(residuals @ residuals / (len(x) - 2) / sxx))

    return fit


def pandas_with_lmfit() -> Contender:
    """Read with pandas and fit with lmfit's linear model."""
    from lmfit.models import LinearModel

    window = _pandas_window()
    model = LinearModel()

    def fit(curve: Curve) -> Fit:
        x, y = window(curve)
        slope = model.fit(y, model.guess(y, x=x), x=x).params["slope"]
        return float(slope.value), float(slope.stderr)

    return fit


def _pandas_window() -> Callable[[Curve], tuple[FloatArray, FloatArray]]:
    import pandas as pd

    def window(curve: Curve) -> tuple[FloatArray, FloatArray]:
        form = curve.form
        if form.separator:
            frame = pd.read_csv(
                curve.path,
                sep=form.separator,
                decimal=form.decimal,
                encoding=form.encoding,
                skiprows=form.skip,
                header=None,
                names=form.columns,
            )
        else:
            frame = pd.read_excel(
                curve.path, engine="openpyxl", skiprows=form.skip, header=None, names=form.columns
            )
        strain = frame["travel"].to_numpy() * 1e-3 / HEIGHT_m
        stress_Pa = frame["load"].to_numpy() / AREA_m2
        inside = strain <= _WINDOW
        return strain[inside], stress_Pa[inside]

    return window


def reading_and_hashing() -> Contender:
    """Read the bytes and hash them: what nobody who keeps the origin of a number can save."""

    def read(curve: Curve) -> None:
        hashlib.sha256(curve.path.read_bytes()).hexdigest()

    return read


CONTENDERS: Mapping[str, Callable[[], Contender]] = {
    "ours": ours,
    "ours, hashed": ours_hashed,
    "ours, whole technique": ours_whole,
    "pandas + OLS": pandas_with_formula,
    "pandas + lmfit": pandas_with_lmfit,
    "read and hash": reading_and_hashing,
}


def worst_error(contender: Contender, curves: Sequence[Curve]) -> float:
    """Return the largest relative distance from the true modulus.

    Raises
    ------
    ValueError : it exceeds the tolerance: the contender does not do the work
    """
    fits = [(fit, curve.modulus_Pa) for curve in curves if (fit := contender(curve)) is not None]
    worst = max((abs(fit[0] / truth - 1) for fit, truth in fits), default=0.0)
    if worst > _TOLERANCE:
        raise ValueError(f"a modulus is off by {100 * worst:.1f} %")
    return worst


def compare(curves: Sequence[Curve], names: Sequence[str], rounds: int) -> list[Row]:
    """Time the contenders on the curves of each form; ratios are of undisturbed times."""
    contenders = {name: CONTENDERS[name]() for name in names}
    rows: list[Row] = []
    for form in FORMS:
        mine = [curve for curve in curves if curve.form is form]
        errors = {name: worst_error(fit, mine[:_FILES_A_PART]) for name, fit in contenders.items()}
        parts = [mine[i : i + _FILES_A_PART] for i in range(0, len(mine), _FILES_A_PART)]
        seconds = interleaved(contenders, parts, rounds)
        undisturbed = {name: undisturbed_s(times) for name, times in seconds.items()}
        for name in names:
            row: dict[str, str | float | int] = {"form": form.name, "contender": name}
            row["files"], row["rounds"] = len(mine), rounds
            row["ms per file"] = 1e3 * undisturbed[name] / len(mine)
            row["median round"] = 1e3 * float(np.median(seconds[name].mean(axis=1)))
            for other in _REFERENCES:
                known = other in seconds
                row[f"times {other}"] = undisturbed[name] / undisturbed[other] if known else "-"
            row["target"] = form.targets.get(name, "-")
            row["worst error"] = errors[name]
            rows.append(row)
    return rows


def peak_memory_MB(folder: Path) -> float:
    """Return the peak memory of a process that reads and fits every file of a campaign `[MB]`."""
    command = [sys.executable, "-m", "benchmarks.read_and_fit", "--peak-memory-of", str(folder)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def nothing_to_do_s(raw: Path, processed: Path, times: int = 9) -> list[float]:
    """Run `deamat all` once in earnest and then time it where nothing is left to do `[s]`."""
    command = [*_DEAMAT, "all", "--raw", str(raw), "--processed", str(processed)]
    first = subprocess.run(command, check=False, capture_output=True, text=True)
    if first.returncode:
        raise RuntimeError(f"deamat all ended with {first.returncode}: {first.stderr[-2000:]}")
    return wall_times_s(command, times)


def judged(rows: Sequence[Row], whole: Sequence[tuple[str, float, float]]) -> list[str]:
    """Hold what was measured against its targets, one line each.

    Parameters
    ----------
    rows : of `compare`; a rival's time shall reach its target as a multiple of ours. The hash,
        which no rival takes, is told and not judged
    whole : name, value and upper limit of what is measured of a whole process
    """
    lines = []
    for row in rows:
        bare, hashed, target = row["times ours"], row["times ours, hashed"], row["target"]
        if isinstance(bare, float) and isinstance(target, float):
            verdict = "met" if bare >= target else "MISSED"
            what = f"{row['form']}: ours is {bare:.1f} times faster than {row['contender']}"
            also = f" ({hashed:.1f} with the hash)" if isinstance(hashed, float) else ""
            lines.append(f"{verdict}: {what}, wanted {target:g}{also}")
    for what, value, limit in whole:
        verdict = "met" if value < limit else "MISSED"
        lines.append(f"{verdict}: {what} {value:.3g}, wanted less than {limit:g}")
    return lines


def main() -> int:
    """Measure, print, write CSV and JSON; the status says whether every target was met."""
    options = _options()
    stay_on_one_core()
    if options.peak_memory_of is not None:
        contender = ours_whole()
        for curve in find_curves(options.peak_memory_of):
            contender(curve)
        print(own_peak_memory_MB())
        return 0
    whole = []
    with tempfile.TemporaryDirectory() as folder:
        raw = Path(folder, "raw")
        curves = write_campaign(raw / "speed", options.files, options.rows)
        # First of all, while this process is small: see own_peak_memory_MB.
        if "ours" in options.only:
            memory = peak_memory_MB(raw / "speed")
            whole.append(("peak memory [MB]", memory, _MEMORY_TARGET_MB))
        rows = compare(curves, options.only, options.rounds)
        print(table(rows))
        write_results("read_and_fit", rows, ("numpy", "pandas", "lmfit"))
        if importlib.util.find_spec("deamat.cli") is not None and "ours" in options.only:
            times = nothing_to_do_s(raw, Path(folder, "processed"))
            what = "deamat all with nothing to do, median [s]"
            whole.append((what, statistics.median(times), _NOTHING_TO_DO_TARGET_s))
    lines = judged(rows, whole)
    print(*lines, sep="\n")
    if options.docs:
        write_reading_page(rows, lines)
    if whole:
        names = ("measured", "value", "less than")
        write_results(
            "read_and_fit_whole", [dict(zip(names, row, strict=True)) for row in whole], ("numpy",)
        )
    return int(any(line.startswith("MISSED") for line in lines))


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.read_and_fit")
    parser.add_argument("--files", type=int, default=1000)
    parser.add_argument("--rows", type=int, default=2000, help="samples in each file")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--only", nargs="+", choices=list(CONTENDERS), default=list(CONTENDERS))
    parser.add_argument("--docs", action="store_true", help=f"write {PAGE} as well")
    parser.add_argument("--peak-memory-of", type=Path, metavar="CAMPAIGN", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.docs and set(options.only) != set(CONTENDERS):
        parser.error("--docs tells of every contender; leave --only out")
    return options


if __name__ == "__main__":
    sys.exit(main())
