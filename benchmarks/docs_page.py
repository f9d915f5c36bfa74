"""`docs/benchmarks.md` and the committed pictures, written from what a run measured."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from importlib import metadata
from io import BytesIO
from pathlib import Path

from PIL import Image
from PIL.PngImagePlugin import PngInfo

from benchmarks.families.family import Family, default_of, number
from benchmarks.timing import Row
from deamat.core.atomic import write_atomically
from deamat.report.style import MARK_MEANING

IMAGES = Path("docs/methods/img")
_COLOURS = 128
_HEAD = """\
# Benchmarks

Written by `make docs`; every number below comes from one run of `python -m benchmarks.chart --docs`
and all data in it are simulated. Times are processor time on one core and depend on the machine;
the ratios, taken in the same run on the same samples, are what to compare. An error is relative to
the known truth; which one is drawn stands on the axis of each chart. A contender is on the front
unless another is clearly faster (10 %) and as right, or clearly more right (1 %) and as fast.
Batches are measured but compete with nobody, nor does who is too slow for all samples. What is
refused, or does not converge, is counted in a column of its own and enters no error.

Speed of reading and fitting whole files: [reading-speed.md](reading-speed.md). Where methods fail:
the maps in [methods/](methods), drawn by `make stability`.
"""

_COLUMNS = (
    "| contender | time of a fit | times the default's | error | times the default's | refused | "
    "front |"
)
_SUMMARY_COLUMNS = (
    "| family | default | time | error | on the front | quickest other package | its time | its "
    "error |"
)
_LADDER = (
    "random designs at every rung; the elastica is the reference, so an error is that of the "
    "simplification. `choose` takes the lowest rung that it expects to be right enough; `within` "
    "says for how many designs it was."
)
_LIMITS = (
    "Where the error first passes one percent, for one strip and one number at a time (empty: "
    "nowhere): voltage over that of pull-in, stiffness of the electrodes over that of the film, "
    "length over the elasto-gravity length, turn of the tip in radians."
)


def copy_picture(png: Path) -> None:
    """Put a picture beside the pages on methods, in few colours: a third of its size."""
    small = BytesIO()
    with Image.open(png) as picture:
        few = picture.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
        few.save(small, "png", optimize=True, pnginfo=_marked())
    write_atomically(IMAGES / png.name, small.getvalue())


def _marked() -> PngInfo:
    about = PngInfo()
    about.add_text("Description", MARK_MEANING)
    return about


def write_page(
    found: Sequence[tuple[Family, list[Row]]],
    rungs: Sequence[Row],
    limits: Sequence[Row],
    page: Path,
) -> None:
    """Write the summary: the default of each family beside its rivals, and the actuator ladder."""
    packages = ", ".join(f"{p} {metadata.version(p)}" for p in _packages(found))
    parts = [_HEAD, f"Run with Python {platform.python_version()}, {packages}.\n"]
    parts += [_summary(found)]
    parts += [_section(family, rows) for family, rows in found]
    parts += [_ladder(rungs, limits)]
    write_atomically(page, "\n".join(parts).encode())


def _packages(found: Sequence[tuple[Family, list[Row]]]) -> list[str]:
    lmfit = any("lmfit" in str(row["contender"]) for _, rows in found for row in rows)
    return ["numpy", "scipy", *(["lmfit"] if lmfit else [])]


def _section(family: Family, rows: Sequence[Row]) -> str:
    ours = default_of(rows)
    lines = [
        f"## {family.title}",
        "",
        f"![Time against error, SYNTHETIC DATA](methods/img/chart_{family.key}.png)",
        "",
        family.why(rows),
        "",
        _COLUMNS,
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        name = f"**{row['contender']}**" if row["kind"] == "default" else str(row["contender"])
        time_us, error = number(row, "us per fit"), number(row, family.error)
        lines.append(
            f"| {name} | {_time(time_us)} | {time_us / number(ours, 'us per fit'):.2g} | "
            f"{error:.2g} | {error / number(ours, family.error):.2g} | "
            f"{float(row.get('failed %', 0.0)):.0f} % | {row['front']} |"
        )
    return "\n".join([*lines, "", f"Error: {family.axis}.", ""])


def _summary(found: Sequence[tuple[Family, list[Row]]]) -> str:
    """One line a family: the default, and the best of other packages against it."""
    lines = [
        "## Summary",
        "",
        _SUMMARY_COLUMNS,
        "|---|---|---|---|---|---|---|---|",
    ]
    for family, rows in found:
        ours = default_of(rows)
        peers = [row for row in rows if row["kind"] == "outside"]
        told = " | | "
        if peers:
            peer = min(peers, key=lambda row: number(row, "us per fit"))
            told = (
                f"{peer['contender']} | {_ratio(peer, ours, 'us per fit')} | "
                f"{_ratio(peer, ours, family.error)}"
            )
        lines.append(
            f"| {family.title} | {ours['contender']} | {_time(number(ours, 'us per fit'))} | "
            f"{number(ours, family.error):.2g} | {ours['front']} | {told} |"
        )
    return "\n".join([*lines, ""])


def _ratio(row: Row, ours: Row, column: str) -> str:
    return f"{number(row, column) / number(ours, column):.2g} times ours"


def _ladder(rungs: Sequence[Row], limits: Sequence[Row]) -> str:
    lines = [
        "## Ladder of actuator models",
        "",
        "![Time against error of the rungs, SYNTHETIC DATA](methods/img/ladder.png)",
        "",
        f"{rungs[0]['designs']} {_LADDER}",
        "",
        "| model | time | error of the tip, median | 90 % | worst | within |",
        "|---|---|---|---|---|---|",
    ]
    for row in rungs:
        within = "" if row["within"] == "" else f"{100 * number(row, 'within'):.1f} %"
        errors = " | ".join(f"{number(row, c):.2g}" for c in ("tip_median", "tip_90", "tip_worst"))
        time_us = _time(number(row, "us_per_design"))
        lines.append(f"| {row['model']} | {time_us} | {errors} | {within} |")
    lines += [
        "",
        "![Where rungs stop to hold, SYNTHETIC DATA](methods/img/ladder_validity.png)",
        "",
        _LIMITS,
        "",
        "| rung | drive | electrodes | weight | turn |",
        "|---|---|---|---|---|",
    ]
    for row in limits:
        cells = [row[key] for key in ("drive", "electrodes", "weight", "turn")]
        shown = " | ".join(f"{c:.2g}" if isinstance(c, float) else str(c) for c in cells)
        lines.append(f"| {row['rung']} | {shown} |")
    return "\n".join([*lines, ""])


def _time(us: float) -> str:
    return f"{us / 1e3:.3g} ms" if us >= 1e3 else f"{us:.3g} us"
