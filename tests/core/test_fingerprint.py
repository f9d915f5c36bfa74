"""The closure of imports, found without running a module, and the libraries behind it."""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import deamat
from deamat.core.fingerprint import Sources, libraries
from deamat.core.import_statements import Import, imports_in

_FILES = {
    "__init__.py": "from toy.rooms import LIST\n",
    "base.py": "import json\nimport numpy as np\n",
    "units.toml": "m = 1\n",
    "rooms/__init__.py": "from toy.rooms import one, two\nLIST = (one, two)\n",
    "rooms/one.py": "from toy.base import np\nfrom ..deep.leaf import x\n",
    "rooms/two.py": "def f():\n    import toy.late\n    from xml import dom\n",
    "rooms/two.j2": "{{ page }}",
    "late.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import only_for_types\n",
    "deep/__init__.py": "import toy.late\n",
    "deep/leaf.py": "x = 1\n",
    "forms/__init__.py": "from importlib import import_module\nimport_module(f'{__name__}.a')\n",
    "forms/a.py": "",
    "forms/more/b.py": "import absent_library\n",
    "asks.py": "from toy import forms\nimport importlib\nimportlib.import_module('toy.base')\n",
    "names_the_list.py": "from toy.rooms import LIST\n",
}


@pytest.fixture
def toy(tmp_path: Path) -> Sources:
    for name, text in _FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return _sources(tmp_path)


def _sources(root: Path) -> Sources:
    hashes = {
        p.relative_to(root).as_posix(): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in root.rglob("*")
        if p.is_file()
    }
    return Sources("toy", root, hashes)


_ROOMS = {"__init__.py", "rooms/__init__.py", "rooms/two.j2"}
_FORMS = {"forms/__init__.py", "forms/a.py", "forms/more/b.py"}


@pytest.mark.parametrize(
    ("start", "files", "foreign"),
    [
        ("base", {"__init__.py", "base.py", "units.toml"}, {"numpy"}),
        (
            "rooms.one",  # a relative import; what the parents import is not followed
            {*_ROOMS, "rooms/one.py", "base.py", "units.toml", "deep/__init__.py", "deep/leaf.py"},
            {"numpy"},
        ),
        ("late", {"__init__.py", "late.py", "units.toml"}, set()),  # types are no code
        ("rooms.two", {*_ROOMS, "rooms/two.py", "late.py", "units.toml"}, set()),
        (
            "asks",  # by a computed name: all of the folder; by a written one: that module
            {"__init__.py", "asks.py", "base.py", "units.toml", *_FORMS},
            {"numpy", "absent_library"},
        ),
    ],
)
def test_closure(start: str, files: set[str], foreign: set[str], toy: Sources) -> None:
    found = toy.closure([f"toy.{start}"])
    assert found.files == files
    assert found.foreign == foreign


def test_what_is_left_out_brings_nothing_in(toy: Sources) -> None:
    whole = toy.closure(["toy.names_the_list"]).files
    assert {"rooms/one.py", "rooms/two.py", "deep/leaf.py"} <= whole
    assert toy.closure(["toy.names_the_list"], ["toy.rooms"]).files == {
        *("__init__.py", "names_the_list.py", "units.toml")
    }


def test_a_start_that_is_not_there(toy: Sources) -> None:
    with pytest.raises(ModuleNotFoundError, match=r"no module toy\.room in "):
        toy.closure(["toy.room"])


@pytest.mark.parametrize(
    ("edited", "changes"),
    [
        ("rooms/one.py", True),
        ("base.py", True),
        ("units.toml", True),
        ("rooms/__init__.py", True),
        ("rooms/two.py", False),
        ("late.py", False),
        ("forms/a.py", False),
    ],
)
def test_a_fingerprint_is_of_contents(edited: str, changes: bool, toy: Sources) -> None:
    before = toy.fingerprint(["toy.rooms.one"])
    path = toy.root / edited
    path.write_text(path.read_text() + "\n")
    after = _sources(toy.root).fingerprint(["toy.rooms.one"])
    assert (after.code != before.code) == changes
    assert after.libraries == before.libraries == (("numpy", np.__version__),)


def test_libraries_stand_on_others() -> None:
    found = dict(libraries(frozenset({"matplotlib", "simdjson", "absent_library"})))
    assert {"matplotlib", "numpy", "pillow", "pysimdjson"} <= set(found)
    assert found["absent_library"] == "absent"
    assert "pytest" not in found  # an extra of some of them


def test_what_the_text_shows_is_what_the_grammar_finds_in_every_module() -> None:
    for path in sorted(Path(deamat.__file__).parent.rglob("*.py")):
        source = path.read_text("utf-8")
        assert set(imports_in(source)) == set(_by_grammar(source)), path


def _by_grammar(source: str) -> Iterator[Import]:
    waiting: list[ast.AST] = [ast.parse(source)]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import):
            yield from (Import(alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            names = tuple(alias.name for alias in node.names)
            yield Import("." * node.level + (node.module or ""), names)
        elif isinstance(node, ast.Call) and _last(node.func) in ("import_module", "__import__"):
            named = node.args[0]
            yield Import(str(named.value) if isinstance(named, ast.Constant) else None)
        if isinstance(node, ast.If) and _last(node.test) == "TYPE_CHECKING":
            waiting += node.orelse
        else:
            waiting += ast.iter_child_nodes(node)


def _last(node: ast.expr) -> str:
    return ast.unparse(node).rpartition(".")[2]
