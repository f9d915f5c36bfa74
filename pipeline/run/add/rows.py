"""The row that is proposed for a file: what is known stands in it, what is missing is marked."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field

from deamat.core.register_columns import split_unit, usual_column
from deamat.core.slug import nearest_label, nearest_slug
from deamat.core.technique import AnyTechnique
from deamat.core.units import from_si
from deamat.run.add.facts import Facts
from deamat.run.other_folders import techniques_said
from deamat.techniques import TECHNIQUES

MISSING = "?"
FOUND_IN = "found_in"
_COUNTER = re.compile(r"[a-z]{0,2}\d{1,3}")  # `3`, `s12`: which specimen of its kind
_DATE = re.compile(r"\d{6,8}|\d{4}-\d{2}-\d{2}")
_OF_NO_MATERIAL = frozenset(
    ("specimen", "sample", "probe", "test", "run", "data", "raw", "export", "no", "nr")
)


@dataclass
class Known:
    """What the campaign knows already.

    Parameters
    ----------
    materials : ids in its registers and in the configuration
    specimens : names that are taken, by technique, folded
    constant : text columns of which all rows of a technique's register say the same
    """

    materials: set[str] = field(default_factory=set)
    specimens: dict[str, set[str]] = field(default_factory=dict)
    constant: dict[str, dict[str, str]] = field(default_factory=dict)


def proposed_row(facts: Facts, technique: AnyTechnique, known: Known) -> dict[str, str]:
    """Return the cells of a row; dimensions come from the file's own statements alone."""
    cells: dict[str, str] = {"file": facts.path}
    sources: dict[str, str] = {}

    def tell(column: str, text: str, source: str) -> None:
        if text and column not in cells:
            cells[column] = text
            sources[column] = source

    for name in (*technique.required, *technique.optional):
        if name in facts.lengths:
            tell(usual_column(name), _written(facts.lengths[name], name), "file")
    tell("tested_on", facts.day, "file")
    tell("operator", nearest_label(facts.operator), "file")
    tell("material", *_material(facts, known.materials))
    tell("specimen", *_specimen(facts, known.specimens.setdefault(technique.key, set())))
    for column, text in known.constant.get(technique.key, {}).items():
        tell(column, text, "other rows")
    for column in asked_columns(facts, technique):
        cells.setdefault(column, MISSING)
    by_source: dict[str, list[str]] = {}
    for column, source in sources.items():
        by_source.setdefault(source, []).append(column)
    cells[FOUND_IN] = "; ".join(f"{s}: {', '.join(told)}" for s, told in by_source.items())
    return cells


def asked_columns(facts: Facts, technique: AnyTechnique) -> list[str]:
    """List the columns that must be filled in for such a file."""
    form = technique.register
    asked = () if facts.whole else form.asked
    return [
        *form.text,
        *(usual_column(name) for name in (*technique.required, *asked)
          if name != "mixed_at" or facts.clocked),
    ]  # fmt: skip


def _written(value: float, name: str) -> str:
    _, unit = split_unit(usual_column(name))
    return f"{from_si(value, unit or '1'):.10g}"


def _material(facts: Facts, materials: Collection[str]) -> tuple[str, str]:
    """Find a known material in what the file says, else in its name; else take the name's words."""
    path = facts.path.partition("#")[0]
    *folders, name = path.split("/")
    stem = name.rpartition(".")[0] or name
    for text, source in ((facts.label, "file"), (stem, "name"), *((f, "folder") for f in folders)):
        padded = f"-{nearest_slug(text)}-" if text else ""
        hits = [m for m in materials if f"-{m.casefold()}-" in padded]
        longest = [m for m in hits if len(m) == max(map(len, hits))]
        if len(longest) == 1:
            return longest[0], source
        if hits:
            return "", ""
    for folder in reversed(folders):
        if not techniques_said(folder, TECHNIQUES):
            return nearest_slug(folder), "folder"
    words = _words_of_material(stem)
    return (nearest_slug("-".join(words)), "name") if words else ("", "")


def _words_of_material(stem: str) -> Sequence[str]:
    """Leave out of a file's name what names the test, the day and the specimen."""
    words = [
        word
        for word in re.split(r"[\s_\-]+", stem.casefold())
        if word
        and not techniques_said(word, TECHNIQUES)
        and word not in _OF_NO_MATERIAL
        and not _DATE.fullmatch(word)
    ]
    if len(words) > 1 and _COUNTER.fullmatch(words[-1]):
        words = words[:-1]
    return words if any(re.search(r"[^\W\d_]", word) for word in words) else []


def _specimen(facts: Facts, taken: set[str]) -> tuple[str, str]:
    """Name the specimen as the file does, else by the file's name; never twice."""
    path, _, sheet = facts.path.partition("#")
    name = path.rpartition("/")[2]
    stem = name.rpartition(".")[0] or name
    stem = f"{stem} {sheet}" if sheet else stem
    label = facts.label if not _COUNTER.fullmatch(facts.label.casefold()) else ""
    for text, source in ((label, "file"), (stem, "name"), (path, "name")):
        plain = nearest_label(re.sub(r"[/\\]", "-", text), 100).lstrip(".-=+@ ")
        if plain and plain.casefold() not in taken:
            taken.add(plain.casefold())
            return plain, source
    return "", ""
