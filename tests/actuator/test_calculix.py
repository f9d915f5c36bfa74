"""The composite beam against CalculiX, where `ccx` is installed (Debian: calculix-ccx).

Forces and curvature are compared, never the exit code: CalculiX ends with 0 on many a mistake.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from deamat.actuator.beam import bend
from deamat.core.arrays import FloatArray

from .stacks import strip

CCX = shutil.which("ccx")
pytestmark = pytest.mark.skipif(CCX is None, reason="CalculiX (ccx) is not installed")

STRAIN, POISSON_RATIO = 0.006, 0.49
LENGTH_mm, WIDTH_mm, ALONG = 20.0, 0.5, 20


def heights_mm() -> FloatArray:
    layers = strip().layers
    return np.concatenate(
        [[0.0], np.cumsum([1e3 * float(np.asarray(x.thickness_m)) for x in layers])]
    )


def deck(held: bool) -> str:
    """Return one row of quadratic bricks a layer; the film grows along the strip only.

    The root is a plane of symmetry, one node of it is held in height, one face across the width.
    N, mm, MPa.

    Parameters
    ----------
    held : the tip is kept from moving along the strip and from turning, as the root is
    """
    z = heights_mm()
    levels = np.empty(2 * z.size - 1)  # corner and middle nodes in turn
    levels[::2], levels[1::2] = z, 0.5 * (z[1:] + z[:-1])
    xs = np.linspace(0.0, LENGTH_mm, 2 * ALONG + 1)
    ys = np.array([0.0, 0.5 * WIDTH_mm, WIDTH_mm])

    def number(i: int, j: int, k: int) -> int:
        return 1 + i + xs.size * (j + ys.size * k)

    used: set[int] = set()
    elements: list[str] = []
    # corners, then middles of the edges, in the order of C3D20R; offsets in half elements
    bottom = ((0, 0), (2, 0), (2, 2), (0, 2))
    middle = ((1, 0), (2, 1), (1, 2), (0, 1))
    shape = [
        *((a, b, 0) for a, b in bottom), *((a, b, 2) for a, b in bottom),
        *((a, b, 0) for a, b in middle), *((a, b, 2) for a, b in middle),
        *((a, b, 1) for a, b in bottom),
    ]  # fmt: skip
    for row in range(z.size - 1):
        elements.append(f"*ELEMENT, TYPE=C3D20R, ELSET=L{row}")
        for e in range(ALONG):
            nodes = [number(2 * e + a, b, 2 * row + c) for a, b, c in shape]
            used |= set(nodes)
            listed = ", ".join(map(str, [1 + e + ALONG * row, *nodes]))
            first, rest = listed.split(", ")[:11], listed.split(", ")[11:]
            elements.append(", ".join(first) + ",\n" + ", ".join(rest))
    nodes_text = [
        f"{number(i, j, k)}, {x:.9g}, {y:.9g}, {h:.9g}"
        for k, h in enumerate(levels)
        for j, y in enumerate(ys)
        for i, x in enumerate(xs)
        if number(i, j, k) in used
    ]
    root = [number(0, j, k) for j in range(ys.size) for k in range(levels.size)]
    side = [number(i, 0, k) for i in range(xs.size) for k in range(levels.size)]
    tip = [number(xs.size - 1, j, k) for j in range(ys.size) for k in range(levels.size)]
    bottom_row = [number(i, 0, 0) for i in range(0, xs.size, 2)]

    def node_set(name: str, numbers: list[int]) -> str:
        return f"*NSET, NSET={name}\n" + "\n".join(f"{n}," for n in numbers if n in used)

    materials = []
    for i, sheet in enumerate(strip().layers):
        modulus_MPa = 1e-6 * float(np.asarray(sheet.modulus_Pa))
        grow = STRAIN if sheet.role == "de" else 0.0
        materials.append(
            f"*MATERIAL, NAME=M{i}\n*ELASTIC\n{modulus_MPa:.9g}, {POISSON_RATIO}\n"
            f"*EXPANSION, TYPE=ORTHO, ZERO=0\n{grow:.9g}, 0., 0.\n"
            f"*SOLID SECTION, ELSET=L{i}, MATERIAL=M{i}"
        )
    return "\n".join(
        [
            "*NODE, NSET=ALL", *nodes_text, *elements,
            node_set("ROOT", root), node_set("SIDE", side), node_set("BOTTOM", bottom_row), node_set("TIP", tip),
            *materials, "*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL, 0.",
            "*BOUNDARY", "ROOT, 1, 1", "SIDE, 2, 2", f"{number(0, 0, 0)}, 3, 3",
            *(["TIP, 1, 1"] if held else []),
            "*STEP", "*STATIC", "*TEMPERATURE", "ALL, 1.",
            "*NODE PRINT, NSET=BOTTOM", "U", "*NODE PRINT, NSET=ROOT", "RF", "*END STEP", "",
        ]
    )  # fmt: skip


def tables(text: str) -> dict[str, FloatArray]:
    """Read the blocks of a .dat file: rows of node and three components."""
    found: dict[str, list[list[float]]] = {}
    name = ""
    for line in text.splitlines():
        if line.strip().startswith(("displacements", "forces")):
            name = line.split()[0]
            found[name] = []
        elif line.strip() and name:
            found[name].append([float(x) for x in line.split()])
    return {name: np.array(rows) for name, rows in found.items()}


def solved(folder: Path, held: bool) -> dict[str, FloatArray]:
    (folder / "strip.inp").write_text(deck(held))
    assert CCX is not None
    subprocess.run([CCX, "strip"], cwd=folder, capture_output=True, check=False, timeout=60)
    dat = folder / "strip.dat"
    assert dat.is_file(), "CalculiX gave no result"
    return tables(dat.read_text())


def test_a_four_layer_strip_bends_as_quadratic_bricks_do(tmp_path: Path) -> None:
    moved = solved(tmp_path, held=False)["displacements"]
    rows = moved[np.argsort(moved[:, 0])]
    x_mm = np.linspace(0.0, LENGTH_mm, ALONG + 1)
    assert len(rows) == x_mm.size
    # The free end shears by itself: the parabola is fitted to the half next to the root
    near = x_mm <= 0.5 * LENGTH_mm
    curvature_per_m = -2e3 * np.polyfit(x_mm[near], rows[near, 3], 2)[0]
    expected = bend(strip(), [0, 0, STRAIN, 0]).curvature_per_m
    assert curvature_per_m == pytest.approx(expected, rel=1e-5)


def test_a_held_strip_pushes_as_quadratic_bricks_do(tmp_path: Path) -> None:
    """Without elongation and curvature the film alone pushes, with `b Y t e`."""
    forces_N = solved(tmp_path, held=True)["forces"][:, 1]
    beam = bend(strip(), [0, 0, STRAIN, 0])
    width_m = float(np.asarray(strip().layers[0].width_m))
    expected_N = float(np.asarray(beam.axial_stiffness_N * beam.elongation)) / width_m
    assert forces_N.sum() == pytest.approx(1e-3 * WIDTH_mm * expected_N, rel=1e-5)
