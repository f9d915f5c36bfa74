"""Rows of `materials.sqlite` back to what a card holds; `tables` is the other direction.

The JSON cells of many rows are read in one go: a call for each cell would cost more than all the
rest of reading a card.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Any

from deamat.core.kinds import unchanged
from deamat.core.schema import Field, entry_of, maker
from deamat.materials.card import MaterialCard
from deamat.materials.tables import listed_in, stored_fields

Rows = Sequence[tuple[Any, ...]]
Owned = dict[Any, defaultdict[int, list[Any]]]


def columns_of(cls: Any) -> str:
    """Name the columns of a class's table that are read back, for a SELECT."""
    return ", ".join(column for field in _read_back(cls) for column in field.columns)


def card_of(row: tuple[Any, ...], lists: dict[Any, tuple[Any, ...]]) -> MaterialCard:
    """Make a card of its row and its lists, by class."""
    fields, listed = _read_back(MaterialCard), listed_in(MaterialCard)
    values = [value for (value,) in _values(fields, [(cell,) for cell in row])]
    make = maker(MaterialCard, [*fields, *listed])
    return make([*values, *(lists[field.kind.rows_of] for field in listed)])


def entries_of(cls: Any, rows: Rows, owned: Owned, **of_card: Any) -> tuple[Any, ...]:
    """Make the entries of a card's list.

    Parameters
    ----------
    rows : the columns of `columns_of`, behind the id of an entry that owns others
    owned : what belongs to entries, by class and id
    of_card : what the card holds once for all of them
    """
    if not rows:
        return ()
    fields, lists = _read_back(cls), listed_in(cls)
    numbered = not entry_of(cls).identity
    columns = list(zip(*rows, strict=True))
    values = list(_values(fields, columns[numbered:]))
    for field in lists:
        groups = owned[field.kind.rows_of]
        values.append([tuple(groups[number]) for number in columns[0]])
    make = maker(cls, [*fields, *lists], **of_card)
    return tuple(map(make, zip(*values, strict=True)))


def owned_of(cls: Any, rows: Rows) -> defaultdict[int, list[Any]]:
    """Make what belongs to entries, by their ids; rows begin with id, in order of position."""
    groups: defaultdict[int, list[Any]] = defaultdict(list)
    if rows:
        fields = _read_back(cls)
        make = maker(cls, fields)
        numbers, *columns = zip(*rows, strict=True)
        for number, *row in zip(numbers, *_values(fields, columns), strict=True):
            groups[number].append(make(row))
    return groups


def _read_back(cls: Any) -> list[Field]:
    return [field for field in stored_fields(cls) if not field.derived]


def _values(fields: Sequence[Field], columns: Sequence[Sequence[Any]]) -> Iterator[list[Any]]:
    """Read the columns of each field as its values."""
    left = iter(columns)
    for field in fields:
        cells: Sequence[Any] = next(left)
        if len(field.columns) > 1:
            cells = list(zip(cells, *(next(left) for _ in field.columns[1:]), strict=True))
            if field.kind.nullable:
                cells = [None if cell[0] is None else cell for cell in cells]
        elif field.kind.nested:
            cells = json.loads(f"[{','.join('null' if c is None else c for c in cells)}]")
        read = field.kind.read
        yield list(cells) if read is unchanged else list(map(read, cells))
