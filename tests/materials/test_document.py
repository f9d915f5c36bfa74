"""The text that is hashed: one for equal contents, and none for what JSON cannot say."""

from __future__ import annotations

import math

import pytest

from deamat.core.errors import CardError
from deamat.materials.document import canonical_json, canonical_record
from tests.materials.samples import modulus


def test_what_is_hashed_is_sorted_text_on_one_line_in_its_own_letters() -> None:
    assert canonical_json({"unit": "µm", "at": [1, 2.5]}) == '{"at":[1,2.5],"unit":"µm"}'


def test_what_json_cannot_say_is_never_written() -> None:
    for number in (math.nan, math.inf):
        with pytest.raises(ValueError, match="not JSON compliant"):
            canonical_json({"value": number})
        with pytest.raises(CardError, match="is no interval"):
            canonical_record(modulus(ci95=(number, math.inf)))
