"""What every room promises, and the one list of them."""

from __future__ import annotations

import ast
import inspect
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

import pytest

import deamat.techniques
from deamat.core.properties import property_key
from deamat.core.technique import AnyTechnique
from deamat.techniques import TECHNIQUES

ROOMS = Path(deamat.techniques.__file__).parent
each_technique = pytest.mark.parametrize("technique", TECHNIQUES.values(), ids=TECHNIQUES)


def test_every_room_is_listed_under_its_own_key() -> None:
    folders = {p.parent.name for p in ROOMS.glob("*/__init__.py")} - {"shared"}
    assert set(TECHNIQUES) == folders
    assert all(technique.key == key for key, technique in TECHNIQUES.items())


@each_technique
def test_every_room_has_the_same_files_and_yields_known_properties(technique: AnyTechnique) -> None:
    files = {path.stem for path in (ROOMS / technique.key).glob("*.py")}
    assert {"__init__", "config", "reduce", "summarise", "figure"} <= files
    assert [property_key(name).key for name in technique.yields] == list(technique.yields)
    if technique.figure is not None:
        assert technique.figure.__module__.endswith(f".{technique.key}.figure")
    assert technique.reduce.__module__.endswith(f".{technique.key}.reduce")
    assert technique.summarise.__module__.endswith(f".{technique.key}.summarise")


@each_technique
def test_every_default_stands_in_its_class_with_a_description(technique: AnyTechnique) -> None:
    technique.config()
    for name, field in technique.config.model_fields.items():
        assert field.description, f"{technique.key}.{name}"


@each_technique
def test_reduce_and_summarise_are_of_the_rooms_own_config_and_result(
    technique: AnyTechnique,
) -> None:
    reduce = inspect.get_annotations(technique.reduce, eval_str=True)
    summarise = inspect.get_annotations(technique.summarise, eval_str=True)
    (made,) = get_args(reduce["return"])
    (taken,) = get_args(get_args(summarise["measurements"])[0])
    assert made == taken
    contexts = [hint for name, hint in (reduce | summarise).items() if name.endswith("context")]
    assert {get_args(context) for context in contexts} == {(technique.config,)}


def _decisions(tree: ast.AST) -> Iterator[int]:
    """Lines at which something is looked up in `diagnostics`."""
    for node in ast.walk(tree):
        looked_in: list[ast.expr] = []
        if isinstance(node, ast.Subscript | ast.Attribute):
            looked_in = [node.value]
        elif isinstance(node, ast.Compare):
            looked_in = node.comparators
        yield from (
            e.lineno for e in looked_in if isinstance(e, ast.Attribute) and e.attr == "diagnostics"
        )


def test_no_room_decides_by_diagnostics() -> None:
    assert list(_decisions(ast.parse("a = b.diagnostics['c']"))) == [1]
    found = {
        f"{path.relative_to(ROOMS)}:{line}"
        for path in ROOMS.rglob("*.py")
        for line in _decisions(ast.parse(path.read_text(encoding="utf-8")))
    }
    assert found == set()


def test_rooms_name_axes_without_importing_matplotlib() -> None:
    code = "import sys, deamat.techniques; raise SystemExit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
