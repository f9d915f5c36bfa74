"""The page that ends a run shows the flags, the worst first."""

from __future__ import annotations

from deamat.core.flags import Flag
from deamat.run.flags import listed
from deamat.run.summary import flag_lines
from tests.materials.samples import modulus


def test_flags_are_listed_once_for_each_material_and_the_worst_first() -> None:
    record = modulus(flags=(Flag("single-specimen", "one"), Flag("slip", "at 20 %")))
    told = listed([record, record], [])
    assert [(f["severity"], f["name"], f["values"]) for f in told] == [
        ("serious", "slip", ["compressive_modulus"]),
        ("info", "single-specimen", ["compressive_modulus"]),
    ]
    lines = flag_lines(told)
    assert lines[0].startswith("flags      1 serious, 1 info")
    assert lines[1].endswith("compressive_modulus: slip: at 20 %")
    assert lines[2] == "info       single-specimen (1)"
