"""A synthetic campaign of compression curves with known moduli, to be timed."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.campaign_forms import FORMS, Form

# The cylinder of ASTM D575 at 12 mm/min, sampled at 100 Hz.
DIAMETER_m = 28.6e-3
HEIGHT_m = 12.5e-3
AREA_m2 = np.pi * DIAMETER_m**2 / 4
SPEED_m_per_s = 0.2e-3
_SAMPLES_PER_s = 100.0
_FORCE_NOISE_N = 0.01
_MATERIALS = 20

CAMPAIGN = """\
title = "Generated compression curves for timing"
laboratory = "none: the curves are simulated"
licence = "CC0 1.0"
synthetic = true
"""


@dataclass(frozen=True, slots=True)
class Curve:
    """One generated file and its true modulus."""

    path: Path
    material: str
    form: Form
    modulus_Pa: float


def write_campaign(
    folder: Path, files: int, rows: int, forms: Sequence[Form] = FORMS
) -> list[Curve]:
    """Write a campaign of linear compression curves, in each of some forms in turn.

    Parameters
    ----------
    folder : of the campaign; made if it is not there
    files, rows : how many curves, and how many samples in each
    """
    generator = np.random.default_rng(20220301)
    time_s = np.arange(rows) / _SAMPLES_PER_s
    strain = SPEED_m_per_s * time_s / HEIGHT_m
    curves = []
    for i in range(files):
        form = forms[i % len(forms)]
        material = f"silicone-{i % _MATERIALS:02d}"
        modulus_Pa = 5e4 * (1 + i % _MATERIALS)
        load_N = modulus_Pa * AREA_m2 * strain + generator.normal(0.0, _FORCE_NOISE_N, rows)
        path = folder / "compression" / material / f"{i:04d}.{form.ending}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(form.render(time_s, 1e3 * SPEED_m_per_s * time_s, load_N))
        curves.append(Curve(path, material, form, modulus_Pa))
    _write_registers(folder, curves)
    return curves


def find_curves(folder: Path) -> list[Curve]:
    """Find the curves of a campaign that `write_campaign` has written; their moduli are unknown."""
    forms = {f".{form.ending}": form for form in FORMS}
    return [
        Curve(path, path.parent.name, forms[path.suffix], math.nan)
        for path in sorted(folder.glob("compression/*/*"))
    ]


def _write_registers(folder: Path, curves: list[Curve]) -> None:
    (folder / "campaign.toml").write_text(CAMPAIGN)
    lines = ["specimen,material,file,diameter_mm,height_mm,speed_mm_per_min"]
    for curve in curves:
        file = curve.path.relative_to(folder / "compression").as_posix()
        lines.append(f"{curve.path.stem},{curve.material},{file},28.6,12.5,12")
    (folder / "compression" / "specimens.csv").write_text("\n".join(lines) + "\n")
    paths = sorted(path for path in folder.rglob("*") if path.is_file())
    hashes = [
        (hashlib.sha256(path.read_bytes()).hexdigest(), path.relative_to(folder)) for path in paths
    ]
    manifest = "".join(f"{digest}  {path.as_posix()}\n" for digest, path in hashes)
    (folder / "MANIFEST.sha256").write_text(manifest)
