"""Every flag has a severity in the one table, and each is said once of several specimens."""

from __future__ import annotations

import ast
from pathlib import Path

from deamat.core.flags import SEVERITY_OF, Flag, merged

PACKAGE = Path(__file__).parents[2] / "pipeline"


def test_every_flag_in_the_sources_has_a_severity() -> None:
    names = {
        node.args[0].value
        for path in PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == "Flag"
        and node.args
        and isinstance(node.args[0], ast.Constant)
    }
    assert len(names) > 50
    assert names - SEVERITY_OF.keys() == set()


def test_a_flag_of_an_unknown_name_is_a_warning() -> None:
    assert Flag("never-heard-of", "x").severity == "warning"
    assert Flag("slip", "x").severity == "serious"
    assert Flag("single-specimen", "x").severity == "info"


def test_a_flag_of_several_specimens_is_said_once_with_their_number() -> None:
    noticed = [("a", Flag("toe", "1")), ("b", Flag("toe", "2")), ("b", Flag("slip", "3"))]
    assert merged(noticed, 3) == (
        Flag("toe", "2 of 3 specimens, such as a: 1"),
        Flag("slip", "1 of 3 specimens, such as b: 3"),
    )
    assert merged([("a", Flag("toe", "1")), ("a", Flag("toe", "1"))], 1) == (Flag("toe", "1"),)
