"""Names of materials that are nearly each other: one material in two spellings."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable
from itertools import combinations

from deamat.core.flags import Flag

_FEWEST = 5  # letters of a word in which one may be a slip: `mix-a` and `mix-b` are two mixtures
_LOOK_ALIKES = str.maketrans("10", "lo")


def near_names(materials: Iterable[str], declared: Collection[str]) -> dict[str, Flag]:
    """Find materials whose name differs from another by one letter, a separator or a look-alike.

    A digit makes another material (`sylgard-182`, `sylgard-184`), and so does a letter of a short
    word; of two names the rarer is flagged, and none that is declared.

    Parameters
    ----------
    materials : of every specimen
    declared : materials that the configuration knows

    Returns
    -------
    flag by material
    """
    counts = Counter(materials)
    known = [*counts, *(name for name in declared if name not in counts)]
    buckets: dict[str, list[str]] = defaultdict(list)
    for name in known:
        plain = _plain(name)
        shorter = (plain[:i] + plain[i + 1 :] for i in range(len(plain)))
        for variant in dict.fromkeys((plain, *shorter, plain.translate(_LOOK_ALIKES))):
            buckets[variant].append(name)
    flags: dict[str, Flag] = {}
    for found in buckets.values():
        for one, other in combinations(found, 2):
            if one == other or not _one_name(one, other):
                continue
            for mine, its in ((one, other), (other, one)):
                if mine in declared or (counts[mine] > counts[its] and its not in declared):
                    continue
                said = f"its material {mine!r} is nearly {its!r} ({counts[its]} specimens): one "
                said += "material in two spellings? If they are two, declare both in materials.toml"
                flags.setdefault(mine, Flag("near-name", said))
    return flags


def _plain(name: str) -> str:
    return re.sub(r"[\W_]+", "", name.casefold())


def _one_name(one: str, other: str) -> bool:
    a, b = _plain(one), _plain(other)
    if a == b or a.translate(_LOOK_ALIKES) == b.translate(_LOOK_ALIKES):
        return True
    mine, its = _words(one), _words(other)
    if len(mine) != len(its):
        return False
    unlike = [(x, y) for x, y in zip(mine, its, strict=True) if x != y]
    if len(unlike) != 1:
        return False
    x, y = unlike[0]
    return x.isalpha() and y.isalpha() and max(len(x), len(y)) >= _FEWEST and _one_slip(x, y)


def _words(name: str) -> list[str]:
    return re.findall(r"[^\W\d_]+|\d+", name.casefold())


def _one_slip(one: str, other: str) -> bool:
    """Say whether a letter was changed, left out, doubled, or exchanged with its neighbour."""
    start = 0
    while start < min(len(one), len(other)) and one[start] == other[start]:
        start += 1
    a, b = one[start:], other[start:]
    return (
        a[1:] == b[1:]
        or a[1:] == b
        or a == b[1:]
        or (len(a) > 1 and a[:2] == b[1::-1] and a[2:] == b[2:])
    )
