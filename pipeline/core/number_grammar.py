"""How a number is written: the one grammar for registers, command lines and exports.

ASCII digits with a decimal point: `float` takes more (`1_000`, `nan`, digits of other alphabets).
The fast reader of whole tables follows JSON's grammar, which is narrower; what it refuses is read
by this one.
"""

from __future__ import annotations

import re

NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")


def is_number(text: str) -> bool:
    """Say whether a text is one number and nothing else."""
    return NUMBER.fullmatch(text) is not None
