"""Tiny files that carry one trap each, and the way a run takes with them."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from deamat.core.errors import RawFileError
from deamat.core.instruments import Machine
from deamat.core.recording import Recording, Specimen
from deamat.core.records import MeasuredValue, PropertyRecord
from deamat.core.register import read_register
from deamat.core.technique import Context
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.run.work import Task, reduce_one
from deamat.techniques import TECHNIQUES

CAMPAIGN = "c"
HOURS = tuple(0.5 * i for i in range(1, 26))
EPS0 = 8.8541878188e-12


@dataclass(frozen=True)
class Trap:
    """One trap of `instruments.md`, a file that carries it, and what must come out.

    `said` are the words of the notes. The file is read; with a `register` (header and rows, which
    call it `f`) a worker reads and reduces it, and several rows are summarised. What must come out
    are the `columns` of the reading, the first `values` of each key (and their `shared`
    uncertainty), texts with which `flags` begin, `words` of method or budget, or the reason for which the file is `rejected` with its
    place or the value `refused`.
    """

    said: str
    carries: str
    file: str | bytes = ""
    technique: str = ""
    register: str = ""
    timezone: str = "UTC"
    columns: Mapping[str, Iterable[float]] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)
    within: float = 1e-3  # a display of four digits
    shared: Mapping[str, float] = field(default_factory=dict)
    flags: tuple[str, ...] = ()
    rejected: str = ""
    refused: str = ""
    words: str = ""
    more: Mapping[str, str] = field(default_factory=dict)  # further files of the register

    @property
    def data(self) -> bytes:
        return self.file if isinstance(self.file, bytes) else self.file.encode()

    def read(self) -> Recording:
        file = RawFile("x", self.data)
        return detect(file).read(file)

    def outcome(self, folder: Path) -> Outcome:
        """Let a worker read and reduce every row of the register, and the room summarise many."""
        technique = TECHNIQUES[self.technique]
        place = folder / CAMPAIGN / self.technique
        place.mkdir(parents=True)
        for name, text in {"f": self.data, **{k: v.encode() for k, v in self.more.items()}}.items():
            (place / name).write_bytes(text)
        path = f"{CAMPAIGN}/{self.technique}/{technique.register.file}"
        try:
            register = read_register(
                self.register.encode(), path, CAMPAIGN, self.technique, technique.required, {},
                technique.register,
            )  # fmt: skip
        except RawFileError as error:
            return Outcome([], [], [str(error)])
        context = Context(technique.config(), Machine(), {}, self.timezone)
        reduced = [reduce_one(_task(folder, row, context)) for row in register.specimens]
        errors = [error for _, error in register.errors] + [r.error for r in reduced if r.error]
        measured = [r.measurement for r in reduced if r.measurement]
        if len(measured) < 2:
            found = [v for m in measured for v in m.values]
            refusals = [r.reason for m in measured for r in m.refusals]
            return Outcome(found, refusals, list(map(str, errors)))
        summary = technique.summarise(measured, context)
        return Outcome(summary.records, [r.reason for r in summary.refusals], [])


@dataclass(frozen=True)
class Outcome:
    """What came of a register: values or records, reasons of refusal, messages of rejection."""

    values: Sequence[MeasuredValue | PropertyRecord]
    refusals: Sequence[str]
    rejected: Sequence[str]

    @property
    def flags(self) -> list[str]:
        return [str(flag) for value in self.values for flag in value.flags]

    @property
    def words(self) -> str:
        return " ".join(v.method + " ".join(line.source for line in v.budget) for v in self.values)

    def value(self, key: str) -> float:
        """The first value of a key."""
        return next(v.quantity.value for v in self.values if v.key == key)

    def shared(self, key: str) -> float:
        """The shared uncertainty of the first value of a key."""
        return next(v.quantity.u_shared for v in self.values if v.key == key)


def _task(folder: Path, row: Specimen, context: Context) -> Task:
    data = (folder / row.file).read_bytes() if row.file else b""
    return Task(
        folder, row, context, hashlib.sha256(data).hexdigest(), changed=False, registered=True,
        ends_open=False, stated_units={},
    )  # fmt: skip


def table(header: str, rows: Iterable[str], newline: str = "\n") -> str:
    return "".join(line + newline for line in (header, *rows))


def viscosity(hours: float) -> float:
    """The liquid of these files: mu(t) = 4 Pa.s + 0.19 Pa.s/h."""
    return 4.0 + 0.19 * hours


VISCOSITIES = {"viscosity": viscosity(1.0)}
ELAPSED = "specimen,material,file\nv,m,f\n"
STAMPED = "specimen,material,file,mixed_at\nv,m,f,2022-03-01T20:00:00\n"


def elapsed(
    changes: Mapping[float, str] = {},
    header: str = "time_h,viscosity_mPas",
    hours: Iterable[float] = HOURS,
) -> str:
    """A plain CSV of the run, with other cells behind the time where `changes` says so."""
    return table(header, (f"{h:g},{changes.get(h, f'{1000 * viscosity(h):.0f}')}" for h in hours))


def reading(hours: float, rotor: int = 3, rpm: str = "12", full_mPas: float = 10000.0) -> str:
    """One reading as an NDJ-8S sends it."""
    mPas = 1000 * viscosity(hours)
    return f"{rotor}#{rpm} RPM  {mPas:.0f} {100 * mPas / full_mPas:.1f}  22.0"


def stamp(hours: float, mixed_at_h: float = 20.0, jump_h: float = 0.0) -> str:
    """The time of day so long after mixing, the clock perhaps set forward since."""
    minutes = round(60 * (mixed_at_h + hours + jump_h))
    day, rest = divmod(minutes, 1440)
    return f"2022-03-{1 + day:02}T{rest // 60:02}:{rest % 60:02}:00"


def log(changes: Mapping[float, str] = {}, *, dated: bool = True) -> str:
    """The run as PC-stamped serial lines, with other readings where `changes` says so."""
    return "".join(
        f"{stamp(h) if dated else stamp(h)[11:]}\t{changes.get(h, reading(h))}\n" for h in HOURS
    )


def autumn() -> str:
    """The run through the night in which clocks fell back at 03:00, 7 h after mixing."""
    days = (("2022-03-01", "2022-10-29"), ("2022-03-02", "2022-10-30"))
    lines = [f"{stamp(h, jump_h=-1.0 if h >= 7 else 0.0)}\t{reading(h)}\n" for h in HOURS]
    for march, october in days:
        lines = [line.replace(march, october) for line in lines]
    return "".join(lines)


def line_of(hours: float) -> int:
    """Line of a reading in `log`."""
    return HOURS.index(hours) + 1


SWEPT_RPM = (0.3, 0.6, 1.5, 3.0)


def fluid(index: float, rotor: int = 4, consistency: float = 30.0) -> str:
    """Sweeps of a power-law fluid whose K and n stay, at the declared 0.09 1/s per rpm."""
    full_Pas = {2: 0.5, 4: 10.0}[rotor] * 60.0
    lines = []
    for h in HOURS:
        for i, rpm in enumerate(SWEPT_RPM):
            pas = consistency * (0.09 * rpm) ** (index - 1.0)
            lines.append(
                f"{stamp(h)[:-2]}{10 * i:02}\t{rotor}#{rpm:g} RPM  {1000 * pas:.0f} "
                f"{100 * pas * rpm / full_Pas:.1f}  22.0\n"
            )
    return "".join(lines)


FILM = (
    "specimen,material,file,thickness_um,micrometer_force_N,plate_length_mm,plate_width_mm\n"
    "p,m,f,300,0,45,45\n"
)
CAPACITANCE_F = EPS0 * 0.045**2 / 300e-6 * 2.63
FREQUENCIES = (10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000)
IDENTITY = "# *IDN? => LCR-6020,REV C1.06,GEX123456,Good Will Instrument Co., Ltd.\n"


def sweep(
    mode: str = "Cp-D",
    changes: Mapping[int, str] = {},
    tangent: float = 0.01,
    resistance_ohm: float = 0.0,
    level: str = "1.000e+00V",
    gap: float = 0.0,
) -> str:
    """Replies of an LCR-6020 for a film of 2.63, in parallel or in series capacitance.

    `gap` is the part of the thickness between the plates that is air.
    """
    film_F = CAPACITANCE_F / (1.0 - gap + 2.63 * gap)
    head = IDENTITY + (f"# FUNC? => {mode}\n" if mode else "")
    rows = []
    for f in FREQUENCIES:
        loss = tangent + 6.283185307 * f * film_F * resistance_ohm
        series = film_F * (1.0 + tangent**2)
        farad = series if mode.startswith("Cs") else series / (1.0 + loss**2)
        rows.append(changes.get(f, f"{f:.5e},{farad:+.5e},{loss:+.5e},OK"))
    return head + f"# LEV:VOLT? => {level}\n" + "".join(f"{row}\n" for row in rows)


RAMPED = "specimen,material,file,thickness_um\nb,m,f,100\n"


def ramp(
    top_V: float = 6000.0,
    *,
    start_V: float = 2500.0,
    seconds: float = 150.0,
    end: str = "break",
    dip_at: int | None = None,
    knee: float = 1.0,
) -> str:
    """A DAQ log of a ramp: monitors of 2000 V/V and 2 mA/V, 100 samples up and what ends it."""
    volts = [start_V + (top_V - start_V) * (i / 99) ** knee for i in range(100)]
    amperes = [0.0] * 100
    if dip_at is not None:
        volts[dip_at] *= 0.7
    if end == "break":
        volts += [60.0, 0.0, 0.0]
        amperes += [0.02, 0.0, 0.0]
    elif end == "held":
        volts += [top_V] * 3
        amperes += [0.0] * 3
    step = seconds / 99
    return (
        "# SYNTHETIC, made for tests\n# channel 1: voltage monitor, 2000 V/V\n"
        "# channel 2: current monitor, 2e-3 A/V\ntime_s,ch1_V,ch2_V\n"
    ) + "".join(
        f"{i * step:.3f},{v / 2000:.4f},{a / 2e-3:.4f}\n"
        for i, (v, a) in enumerate(zip(volts, amperes, strict=True))
    )


CYLINDER = "specimen,material,file,diameter_mm,height_mm\nc,m,f,20,10\n"
STRIP = "specimen,material,file,width_mm,thickness_mm,gauge_length_mm\nt,m,f,6,3,33\n"
MODULUS_PA = 1e6


def compression(sign: float = 1.0, offset_N: float = 0.0, gap_mm: float = 0.0) -> str:
    """A Bluehill export of a cylinder of 1 MPa, 20 mm by 10 mm, compressed to 6 %."""
    area_m2 = 3.141592653589793 * 0.01**2
    rows = []
    for i in range(61):
        mm = 0.01 * i
        newton = MODULUS_PA * max(0.0, mm - gap_mm) / 10 * area_m2 + offset_N
        rows.append(f'"{0.05 * i:.3f}","{sign * mm:.5f}","{sign * newton:.5f}"')
    return table(
        'Remark,"synthetic data, made for tests",',
        ["", "Time,Compressive extension,Load", "(s),(mm),(N)", *rows],
    )


def pulled() -> str:
    """A strip at 2.3 % strain per sample, torn at 0.5 MPa."""
    rows = [
        f"{0.1 * i:.1f};{0.033 * 0.023 * i * 1e3:.4f};{18 * min(0.5, 0.05 * i):.4f}"
        for i in range(14)
    ]
    return table("Time (s);Displacement (mm);Load (N)", [*rows, "1.4;10.6;0.0", "1.5;11.4;0.0"])
