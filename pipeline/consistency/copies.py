"""Files that hold the rows of another one."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

from deamat.estimators.rows import Sketch, holders_of, shared_fraction

_SUSPICIOUS = 0.05  # of the rows of the shorter file
_MOST, _WHOLE = 0.4, 0.95
_UNLIKE = 0.02  # shared fraction of files that have nothing to do with each other
_TELLING = 10  # runs of rows that show whether files of a kind agree
_ASKED = 8  # siblings at most
_COMMON = 40  # files that share a run of rows: it tells no two of them apart


@dataclass(frozen=True, slots=True)
class File:
    """One recording of a campaign and technique.

    Parameters
    ----------
    specimen : its id
    path : relative to `raw/`
    """

    specimen: str
    path: str
    sha256: str
    sketch: Sketch


@dataclass(frozen=True, slots=True)
class Copy:
    """Two files that share rows.

    Parameters
    ----------
    fraction : of the rows of the shorter one
    certain : they hold noise, or their siblings have nothing in common: no two tests agree so
    """

    one: File
    other: File
    fraction: float
    certain: bool

    @property
    def whole(self) -> bool:
        """Say whether all of a file is in the other."""
        return self.fraction >= _WHOLE


def find_copies(files: Sequence[File], noisy: Callable[[File], bool]) -> list[Copy]:
    """Find the files that share rows; equal bytes of files without noise are no certain copies.

    Parameters
    ----------
    files : of one campaign and technique
    noisy : reads a file again and says whether it holds noise; asked of suspicious ones alone
    """
    shared = _candidates(files)
    copies = []
    for (i, j), fraction in sorted(shared.items()):
        one, other = files[i], files[j]
        certain = _siblings_differ(files, one, other) or noisy(one)
        if certain or one.sha256 == other.sha256:
            copies.append(Copy(one, other, fraction, certain))
    return copies


def _candidates(files: Sequence[File]) -> dict[tuple[int, int], float]:
    by_bytes: dict[str, list[int]] = defaultdict(list)
    for at, file in enumerate(files):
        by_bytes[file.sha256].append(at)
    counts = Counter(
        pair
        for found in holders_of([file.sketch for file in files])
        if len(found) <= _COMMON
        for pair in combinations(found, 2)
    )
    shared = {(i, j): shared_fraction(files[i].sketch, files[j].sketch) for i, j in counts}
    shared = {
        (i, j): part
        for (i, j), part in shared.items()
        if part >= _SUSPICIOUS
        and (part >= _MOST or part * min(files[i].sketch.count, files[j].sketch.count) >= _TELLING)
    }
    equal = (pair for found in by_bytes.values() for pair in combinations(found, 2))
    return {**shared, **dict.fromkeys(equal, 1.0)}


def _siblings_differ(files: Sequence[File], one: File, other: File) -> bool:
    """Say whether the other files of the kind share nothing, though they might."""
    if min(one.sketch.count, other.sketch.count) < _TELLING:
        return False
    telling = [
        file.sketch
        for file in files
        if file.sha256 not in (one.sha256, other.sha256) and file.sketch.count >= _TELLING
    ][:_ASKED]
    return bool(telling) and all(
        shared_fraction(file.sketch, sketch) < _UNLIKE
        for sketch in telling
        for file in (one, other)
    )
