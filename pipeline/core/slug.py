"""Names that become files and addresses: one rule, checked where a name enters.

An id (material, campaign) becomes the name of a file as it stands, so it must be a slug: a
lower-case letter or a digit, then letters, digits, `.`, `_` and `-`, at most 80 characters, no dot
at the end, no device name of Windows. Capital letters may stand inside, since units have them
(`drift-5K`); two ids that differ only in case are one file on macOS and Windows, and `Spellings`
finds them. A label (a specimen, an age, a cure) is what the laboratory wrote; it names no file as
it stands, so it must only be one printable line, and `short_slug` makes a piece of a name of it.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata

LONGEST_ID = 80
LONGEST_LABEL = 500
LONGEST_STEM = 116  # of a file name: with `.svg` 120 characters
_READABLE = 24  # characters of a short slug before its digest

_SLUG = re.compile(r"[a-z0-9][A-Za-z0-9._-]*")
_DEVICES = frozenset(
    {"con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(10))}
)
# Letters of other alphabets that look like a Latin one; what NFKD takes apart needs no entry.
_LOOK_ALIKES = str.maketrans(
    "\u0430\u0435\u043e\u0440\u0441\u0443\u0445\u0456\u03b1\u03bf\u03c1\u03bd\u03bc\u0131",
    "aeopcyxiaopvui",
)


def slug_fault(text: str) -> str | None:
    """Say what keeps a text from being an id; None if it is one."""
    if len(text) > LONGEST_ID:
        return f"an id of {len(text)} characters where {LONGEST_ID} are allowed"
    if not _SLUG.fullmatch(text):
        if not text:
            return "an empty id"
        wrong = next((c for c in text if not re.match(r"[A-Za-z0-9._-]", c)), None)
        if wrong is not None:
            return (
                f"an id consists of the letters a to z, digits, '.', '_' and '-', not "
                f"{_named(wrong)}"
            )
        return "an id starts with a lower-case letter or a digit"
    if text.endswith("."):
        return "an id must not end with a dot"
    if text.partition(".")[0].casefold() in _DEVICES:
        return "an id must not be a device name of Windows"
    return None


def nearest_slug(text: str) -> str:
    """Propose the nearest id: `EF30/1:1 10% BT` becomes `ef30-1-1-10-bt`."""
    plain = unicodedata.normalize("NFKD", text.casefold().translate(_LOOK_ALIKES))
    kept = "".join(c for c in plain if not unicodedata.combining(c))
    slug = re.sub(r"[^a-z0-9._]+", "-", kept)
    slug = re.sub(r"-*\.-+|-+\.-*", "-", slug).strip("-._")[:LONGEST_ID].rstrip("-._")
    if not slug:
        return f"id-{_digest(text)}"
    if slug_fault(slug):  # a device name
        slug = slug.replace(".", "-") if "." in slug else f"{slug}-1"
    return slug


def label_fault(text: str, longest: int = LONGEST_LABEL) -> str | None:
    """Say what keeps a text from being a label; None if it is one."""
    if len(text) > longest:
        return f"{len(text)} characters where {longest} are allowed"
    if text.isprintable():
        return None
    return f"a name is one line of printable characters, not {_named(_first_unprintable(text))}"


def nearest_label(text: str, longest: int = LONGEST_LABEL) -> str:
    """Propose the nearest label: one line without characters that nobody can see."""
    plain = " ".join(unicodedata.normalize("NFKC", text).split())
    return "".join(c for c in plain if c.isprintable())[:longest].rstrip()


def short_slug(text: str, whole: str = "") -> str:
    """Make a piece of a file name of any text: its readable beginning and a digest.

    Parameters
    ----------
    whole : what the digest is of, where the text alone does not tell it apart
    """
    readable = nearest_slug(text)[: _READABLE + 1]
    if len(readable) > _READABLE:  # cut between two words where there are some
        readable = readable.rpartition("-")[0] or readable[:_READABLE]
    return f"{readable.rstrip('-._')}-{_digest(whole or text)}"


def file_stem(*parts: str, longest: int = LONGEST_STEM) -> str:
    """Join ids to the name of a file; one that is too long ends in its digest instead."""
    stem = "-".join(part if slug_fault(part) is None else short_slug(part) for part in parts)
    if len(stem) <= longest:
        return stem
    digest = _digest(stem)
    return f"{stem[: longest - len(digest) - 1].rstrip('-._')}-{digest}"


class Spellings:
    """Remembers how each name was written first, to find it written otherwise.

    `EF 30` and `ef 30`, or one space and two, are one name to a reader and two to a program.
    """

    def __init__(self) -> None:
        """Start with no names."""
        self._first: dict[tuple[str, str], tuple[str, str]] = {}

    def other(self, kind: str, text: str, place: str) -> str | None:
        """Return the earlier spelling of a name and where it stands; None if this is its spelling.

        Parameters
        ----------
        kind : of the name (`material`): names of different kinds have nothing to do with each other
        place : where it is read, for the message about a later spelling
        """
        folded = " ".join(unicodedata.normalize("NFKC", text).casefold().split())
        first, where = self._first.setdefault((kind, folded), (text, place))
        return None if first == text else f"{first!r} in {where}"


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:8]


def _first_unprintable(text: str) -> str:
    return next(c for c in text if not c.isprintable())


def _named(character: str) -> str:
    if character.isprintable() and character.isascii():
        return repr(character)
    name = unicodedata.name(character, "a control character")
    return f"U+{ord(character):04X} ({name})"
