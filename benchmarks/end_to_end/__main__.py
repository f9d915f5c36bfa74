"""`python -m benchmarks.end_to_end`: a whole campaign, cold, beside a user's own script.

Compression files of 20 materials (SYNTHETIC; half of them comma with a units row, half tab with
decimal commas) go from raw bytes to moduli with uncertainties, database and a figure a material:
by `deamat all`, by the script in `script.py`, and merely read and hashed. Each contender is a
process of its own on one core, in turn; a time is the processor time of the whole process, the
least of the rounds. `--before COMMIT` runs the package of an older commit as well; `--docs` writes
`docs/performance.md`.
"""

from __future__ import annotations

import argparse
import io
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from benchmarks.campaign import Curve, write_campaign
from benchmarks.campaign_forms import FORMS
from benchmarks.end_to_end.answers import judged, of_deamat, of_script
from benchmarks.end_to_end.page import write_page
from benchmarks.end_to_end.process import Spent, spent
from benchmarks.timing import Row, stay_on_one_core, table, write_results

PROJECT = Path(__file__).resolve().parents[2]
SCRIPT = Path(__file__).with_name("script.py")
_FORMS = tuple(form for form in FORMS if form.name in ("bluehill", "mts"))
_RUN = "import sys; from {package}.cli import main; sys.exit(main())"
_HASH = """\
import hashlib, pathlib, sys
for path in sorted(pathlib.Path(sys.argv[1]).rglob("*")):
    if path.is_file():
        hashlib.sha256(path.read_bytes()).hexdigest()
"""
TARGETS = {"script": 3.0, "before": 11.0}  # times the time of `deamat all`
TWO_WORKERS = 1.8

Contender = Callable[[Path], Spent]  # told an empty folder for its results


def contenders(raw: Path, config: Path, before: Path | None) -> dict[str, Contender]:
    """Return who works on a campaign, by name."""

    def deamat(workers: int, package: str = "deamat", path: Path | None = None) -> Contender:
        extra = {"PYTHONPATH": str(path)} if path else None
        places = [*("--raw", str(raw)), *("--config", str(path / "config" if path else config))]
        command = [sys.executable, "-P", "-c", _RUN.format(package=package), "all", *places]
        return lambda out: spent(
            [*command, "--processed", str(out), "--workers", str(workers)], extra
        )

    found: dict[str, Contender] = {
        "deamat all": deamat(1),
        "script": lambda out: spent([sys.executable, str(SCRIPT), str(raw / "speed"), str(out)]),
        "read and hash": lambda _: spent([sys.executable, "-c", _HASH, str(raw)]),
    }
    if before is not None:
        found["before"] = deamat(1, "pipeline", before)
    return found


def older(commit: str, folder: Path) -> Path:
    """Lay out the package and the configuration of an older commit.

    Raises
    ------
    subprocess.CalledProcessError : there is no such commit
    """
    told = subprocess.run(
        ["git", "archive", commit, "pipeline", "config"], cwd=PROJECT, check=True,
        capture_output=True,
    )  # fmt: skip
    with tarfile.open(fileobj=io.BytesIO(told.stdout)) as archive:
        archive.extractall(folder, filter="data")
    return folder


def measured(
    who: Mapping[str, Contender], folder: Path, rounds: int
) -> dict[str, list[tuple[Spent, Path]]]:
    """Let each contender work in turn, each time into a folder of its own."""
    found: dict[str, list[tuple[Spent, Path]]] = {name: [] for name in who}
    for turn in range(rounds):
        names = list(who)
        for name in names[turn % len(names) :] + names[: turn % len(names)]:
            place = folder / f"{name.replace(' ', '-')}-{turn}"
            found[name].append((who[name](place), place))
    return found


def rows_of(
    times: Mapping[str, Sequence[tuple[Spent, Path]]], curves: Sequence[Curve]
) -> list[Row]:
    """Set what was measured as rows, each with its ratio to `deamat all`."""
    truth = {curve.material: curve.modulus_Pa for curve in curves}
    least = {name: min(one.cpu_s for one, _ in found) for name, found in times.items()}
    rows: list[Row] = []
    for name, found in times.items():
        row: dict[str, str | float | int] = {"contender": name, "files": len(curves)}
        row["CPU [s]"] = least[name]
        row["ms per file"] = 1e3 * least[name] / len(curves)
        row["times deamat"] = least[name] / least["deamat all"]
        row["peak [MB]"] = min(one.peak_MB for one, _ in found)
        answers = of_script if name == "script" else of_deamat
        if name != "read and hash":
            how = judged(answers(found[0][1]), truth)
            row["error"], row["95 % intervals hold"] = how.error, how.inside
        rows.append({"error": "-", "95 % intervals hold": "-", **row} | row)
    return rows


def verdicts(rows: Sequence[Row], two_workers: float | None) -> list[str]:
    """Hold ratios against their targets, a line each."""
    ratios = {str(row["contender"]): float(row["times deamat"]) for row in rows}
    told = [
        (f"{name} takes {ratios[name]:.2f} times the time of deamat all", ratios[name], wanted)
        for name, wanted in TARGETS.items()
        if name in ratios
    ]
    if two_workers is not None:
        told.append((f"two workers are {two_workers:.2f} times one", two_workers, TWO_WORKERS))
    return [
        f"{'met' if ratio >= wanted else 'MISSED'}: {said}, wanted {wanted:g}"
        for said, ratio, wanted in told
    ]


def main() -> int:
    """Measure and print; the status says whether the targets were met."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.end_to_end", description=__doc__)
    parser.add_argument("--files", type=int, default=1000, help="curves (default: 1000)")
    parser.add_argument("--samples", type=int, default=2000, help="of each curve (default: 2000)")
    parser.add_argument("--rounds", type=int, default=3, help="(default: 3)")
    parser.add_argument("--before", metavar="COMMIT", help="e.g. 6c18a86: its package runs too")
    parser.add_argument("--docs", action="store_true", help="write docs/performance.md")
    asked = parser.parse_args()
    cores = os.cpu_count() or 1
    with tempfile.TemporaryDirectory(prefix="end-to-end-") as name:
        folder = Path(name)
        raw, config = folder / "raw", folder / "config"
        shutil.copytree(PROJECT / "config", config)
        curves = write_campaign(raw / "speed", asked.files, asked.samples, _FORMS)
        before = older(asked.before, folder / "older") if asked.before else None
        two = _two_workers(raw, config, folder) if cores > 1 else None
        stay_on_one_core()
        rows = rows_of(measured(contenders(raw, config, before), folder, asked.rounds), curves)
    print(table(rows))
    said = verdicts(rows, two)
    print(*said, sep="\n")
    write_results("end_to_end", rows, ("numpy", "pandas", "matplotlib"))
    if asked.docs:
        write_page(rows, said, asked.rounds)
    return int(any(line.startswith("MISSED") for line in said))


def _two_workers(raw: Path, config: Path, folder: Path) -> float:
    """Return how many times faster two processes are than one, on the clock."""
    wall = {}
    for workers in (1, 2):
        command = [
            sys.executable,
            "-P",
            "-c",
            _RUN.format(package="deamat"),
            "all",
            "--raw",
            str(raw),
        ]
        out = folder / f"workers-{workers}"
        places = ["--config", str(config), "--processed", str(out)]
        wall[workers] = spent([*command, *places, "--workers", str(workers)]).wall_s
    return wall[1] / wall[2]


if __name__ == "__main__":
    raise SystemExit(main())
