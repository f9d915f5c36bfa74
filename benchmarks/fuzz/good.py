"""Good campaigns of every reader: the committed twin's, and the same tests in other forms."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from benchmarks.fuzz import forms
from benchmarks.fuzz.runner import Files
from benchmarks.fuzz.sheet import Register, Sheet
from deamat.core.properties import REFERENCE_AGE
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.techniques import TECHNIQUES

ROOT = Path(__file__).resolve().parents[2]
TWIN = ROOT / "raw" / "sylgard-2022-twin"
SPECIMENS = 5  # the one that is spoilt, and its siblings
STIFF, SOFT = "sylgard-184-10to1", "sylgard-182-40to1"


@dataclass(frozen=True)
class Good:
    """Specimens of one material with sound files in one form.

    Parameters
    ----------
    name : reader and material; technique and material where the register holds the values
    files : as the register's rows name them; the first row's is the one that is spoilt
    """

    name: str
    technique: str
    material: str
    register: Register
    files: Mapping[str, bytes]

    @property
    def group(self) -> Files:
        """All specimens."""
        return Files(self.technique, self.register.data, self.files)

    @property
    def alone(self) -> Files:
        """The first specimen without its siblings."""
        first = self.file
        files = {} if first is None else {first: self.files[first]}
        rows = self.register.rows[:1] if self.files else self.register.rows
        return Files(self.technique, replace(self.register, rows=rows).data, files)

    @property
    def file(self) -> str | None:
        """The file that is spoilt."""
        return next(iter(self.files), None)

    @cached_property
    def sheets(self) -> tuple[Sheet, Sheet]:
        """The file that is spoilt and that of a sibling, taken apart."""
        mine, sibling, *_ = (
            _taken_apart(path, data, self.technique) for path, data in self.files.items()
        )
        return mine, sibling


def _taken_apart(path: str, data: bytes, technique: str) -> Sheet:
    raw = RawFile(path, data, technique=technique)
    source = detect(raw).read(raw).source
    rows = (source.first_line - 1, source.last_line)
    return Sheet.of(data, source.reader, source.encoding, rows)


def good_campaigns() -> dict[str, Good]:
    """Every good campaign by its name."""
    return {good.name: good for good in (*_of_the_twin(), *_in_other_forms(), *_flow_curves())}


def of_twin(technique: str, material: str) -> Good:
    """Take a material of the committed campaign, with as many specimens as are wanted here."""
    register = Register.of((TWIN / technique / TECHNIQUES[technique].register.file).read_text())
    rows = [dict(zip(register.header, row, strict=True)) for row in register.rows]
    mine = [
        row for row in rows
        if row["material"] == material and row.get("age", REFERENCE_AGE) == REFERENCE_AGE
    ]  # fmt: skip
    if TECHNIQUES[technique].register.file == "specimens.csv":
        mine = mine[:SPECIMENS]
    kept = Register(register.header, tuple(tuple(row.values()) for row in mine))
    named = [row["file"] for row in mine if row.get("file")]
    files = {name: (TWIN / technique / name).read_bytes() for name in named}
    return Good(f"{technique}/{material}", technique, material, kept, files)


def _of_the_twin() -> Iterator[Good]:
    for technique, reader, material in (
        ("compression", "mark10", STIFF),
        ("compression", "mark10", SOFT),
        ("tension", "bluehill", STIFF),
        ("tension", "bluehill", SOFT),
        ("permittivity", "lcr6000", STIFF),
        ("permittivity", "lcr6000", "sylgard-182-20to1"),  # Cs-D
        ("permittivity", "lcr6000", "sylgard-182-30to1"),  # R-X
        ("permittivity", "lcr_csv", "sylgard-186-10to1"),
        ("nanoindentation", "hysitron", STIFF),
        ("nanoindentation", "hysitron", "sylgard-182-10to1"),
        ("breakdown", "hv_ramp", "sylgard-182-10to1"),
        ("breakdown", "hv_ramp", "sylgard-182-30to1"),
        ("breakdown", "", SOFT),
        ("viscosity", "ndj8s", STIFF),
        ("viscosity", "viscometer_csv", SOFT),
        ("handling", "", STIFF),
    ):
        good = of_twin(technique, material)
        yield replace(good, name=f"{reader}/{material}") if reader else good


def _in_other_forms() -> Iterator[Good]:
    pressed, pulled = of_twin("compression", STIFF), of_twin("tension", STIFF)
    film, ramp = of_twin("permittivity", STIFF), of_twin("breakdown", "sylgard-182-10to1")
    dent, cure = of_twin("nanoindentation", STIFF), of_twin("viscosity", SOFT)
    for reader, good, write in (
        ("phantom", pressed, lambda c, n: forms.phantom(c, n("diameter_mm"), n("height_mm"))),
        ("nexygen", pressed, lambda c, _: forms.nexygen(c)),
        ("mts", pressed, lambda c, _: forms.mts(c)),
        ("zwick", pulled, lambda c, _: forms.zwick(c)),
        (
            "soro", pulled,
            lambda c, n: forms.soro(c, n("width_mm"), n("thickness_um"), n("gauge_length_mm")),
        ),
        ("plain-german", pressed, lambda c, _: forms.plain_german(c)),
        ("plain-bars", pulled, lambda c, _: forms.plain_bars(c)),
        ("plain-counted", pulled, lambda c, _: forms.plain_counted(c)),
        ("plain-quoted", pressed, lambda c, _: forms.plain_quoted(c)),
        ("plain-depth", dent, lambda c, _: forms.plain_depth(c)),
        ("plain-impedance", film, lambda c, _: forms.plain_impedance(c)),
        ("plain-cure", cure, lambda c, _: forms.plain_cure(c)),
        ("rigol", ramp, lambda c, _: forms.rigol(c)),
        ("tektronix", ramp, lambda c, _: forms.tektronix(c)),
        ("lvm", ramp, lambda c, _: forms.lvm(c)),
        ("e4990a", film, lambda c, _: forms.e4990a(c)),
        ("e4980a", film, lambda c, _: forms.e4980a(c)),
    ):  # fmt: skip
        yield _rewritten(good, reader, write)


_SI = {"mm": 1e-3, "um": 1e-6}
Write = Callable[[forms.Columns, Callable[[str], float]], bytes]


def _rewritten(good: Good, reader: str, write: Write) -> Good:
    """Write the recordings of some good files in another form."""
    files = {}
    for row in good.register.rows:
        cells = dict(zip(good.register.header, row, strict=True))

        def number(name: str, cells: Mapping[str, str] = cells) -> float:
            return float(cells[name]) * _SI[name.rpartition("_")[2]]

        raw = RawFile(cells["file"], good.files[cells["file"]])
        files[cells["file"]] = write(detect(raw).read(raw).columns, number)
    return replace(good, name=f"{reader}/{good.material}", files=files)


def _flow_curves() -> Iterator[Good]:
    header = ("specimen", "material", "file", "temperature_C", "comment")
    rows = [(f"f-{i}", "liquid", f"{i}.txt", "22", forms.REMARK) for i in range(1, SPECIMENS + 1)]
    for reader, write in forms.FLOW.items():
        files = {row[2]: write(forms.liquid(i)) for i, row in enumerate(rows)}
        yield Good(f"{reader}/liquid", "viscosity", "liquid", Register(header, tuple(rows)), files)
