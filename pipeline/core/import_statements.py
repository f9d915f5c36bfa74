"""What a module imports, read off its text: to parse all sources took half a second of a run.

The sources are those of one package in one style (a formatter sees to it): statements begin lines,
texts of several lines stand in three double quotes. A test holds what is found here against
Python's own grammar for every module of the package.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

_TEXTS = re.compile(r'""".*?"""', re.DOTALL)
# What stands under `if TYPE_CHECKING:` never runs.
_FOR_CHECKERS = re.compile(
    r"^([ \t]*)if (?:\w+\.)?TYPE_CHECKING:[^\n]*\n(?:\1[ \t]+[^\n]*\n|[ \t]*\n)*", re.MULTILINE
)
_STATEMENT = re.compile(
    r"^[ \t]*(?:import[ \t]+(?P<modules>[^\n#;]+)"
    r"|from[ \t]+(?P<module>[\w.]+)[ \t]+import[ \t]+(?:\((?P<many>[^)]*)\)|(?P<names>[^\n#;(]+)))",
    re.MULTILINE,
)
_CALL = re.compile(r"\b(?:import_module|__import__)\(\s*(?:[\"\'](?P<module>[\w.]+)[\"\'])?")
_COMMENT = re.compile(r"#[^\n]*")


@dataclass(frozen=True, slots=True)
class Import:
    """One statement or call that imports.

    Parameters
    ----------
    module : as it is written, with the dots of a relative one; None for a computed name
    names : what is taken from the module; none of them for `import module`
    """

    module: str | None
    names: tuple[str, ...] = ()


def imports_in(source: str) -> Iterator[Import]:
    """List what a module imports when it runs, inside functions too, in the order of its text."""
    code = _FOR_CHECKERS.sub("", _TEXTS.sub('""', source))
    for found in _STATEMENT.finditer(code):
        if found["modules"] is not None:
            yield from (Import(name) for name in _first_words(found["modules"]))
        else:
            yield Import(found["module"], _first_words(found["many"] or found["names"]))
    yield from (Import(found["module"]) for found in _CALL.finditer(code))


def _first_words(listed: str) -> tuple[str, ...]:
    """Take `a` of `a as b` from each part of a list."""
    parts = (part.split() for part in _COMMENT.sub("", listed).split(","))
    return tuple(part[0] for part in parts if part)
