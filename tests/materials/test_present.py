from __future__ import annotations

import re
from typing import Any

import pytest

from deamat.core.records import Flag
from deamat.materials.card import MaterialCard
from deamat.materials.present import card_text, law_text
from tests.materials.samples import (
    CREDIT,
    TWIN,
    card,
    excluded,
    modulus,
    refusal,
    viscosity_law,
)


def test_a_card_is_one_screen() -> None:
    assert card_text(card()) == (
        f"""\
Gel A 10:1 (gel-a), card {card().release}
soft-2026: Compression of gels, Lab One, CC BY 4.0

property             symbol  value            95 % interval       n  conditions                        flags
compressive_modulus  Y_c     158.8 ± 1.0 kPa  156.4 to 161.2 kPa  2  age after cure, window 0 to 0.05  [1]
compressive_modulus  Y_c     171.0 ± 1.2 kPa  168.6 to 173.4 kPa  1  age 2 months, window 0 to 0.05
handling_time        t_h     6.00 ± 0.50 h    above 5.00 h        1  temperature 23 C

Laws
  viscosity (mu): polynomial, 1.64 + 7.4e-05 x [Pa.s] with x = time since mixing [s], from 1 to 12 h;
      temperature 23 C [1]

Flags
  [1] toe: 2 of 2 specimens, such as A1: slope: 59 kPa up to 1 %

Refused
  tensile_modulus: 2 samples in the window, 10 are needed (A1, A2)"""
    )


def test_what_was_left_out_ends_the_card_with_its_reason() -> None:
    text = card_text(card(excluded=(excluded("A9"), excluded("A3", "bubbles"))))
    assert text.endswith(
        """

Excluded
  soft-2026/compression/A3: bubbles
  soft-2026/compression/A9: torn at the grip"""
    )


def test_a_simulated_card_says_so_on_its_second_line() -> None:
    lines = card_text(card(synthetic=True, campaigns=(TWIN,))).splitlines()
    assert lines[1] == "SYNTHETIC: simulated data, not measurements"
    assert lines[2] == "twin-1: Simulated gels, nobody, CC BY 4.0, synthetic"


def test_a_card_that_is_simulated_in_part_names_the_part() -> None:
    lines = card_text(card(synthetic=True, campaigns=(CREDIT, TWIN))).splitlines()
    assert lines[1] == "SYNTHETIC in part: twin-1 is simulated, not measured"


def test_what_all_values_share_is_told_once() -> None:
    shared = {"cure": "2 h at 90 C", "age": "after cure"}
    text = card_text(
        MaterialCard(
            *("gel-a", "gel-a", False),
            records=(
                modulus(conditions=shared, flags=()),
                modulus(key="tensile_strength", conditions=shared, campaign="soft-2027", flags=()),
            ),
        )
    )
    assert text.splitlines()[2:] == [
        "property             symbol   value            95 % interval       n  conditions  flags",
        "compressive_modulus  Y_c      158.8 ± 1.0 kPa  156.4 to 161.2 kPa  2  soft-2026",
        "tensile_strength     sigma_b  158.8 ± 1.0 kPa  156.4 to 161.2 kPa  2  soft-2027",
        "All values: age after cure, cure 2 h at 90 C",
    ]
    assert text.startswith("gel-a, card ")


def test_values_stand_in_the_order_of_their_times() -> None:
    values = tuple(modulus(conditions={"time_s": 3600.0 * hours}) for hours in (12, 6, 1))
    text = card_text(card(records=values, laws=()))
    assert re.findall(r"time since mixing (\d+ h)", text) == ["1 h", "6 h", "12 h"]


def test_flags_are_numbered_by_name() -> None:
    records = (
        modulus(flags=(Flag("toe", "first"), Flag("odd", "one"))),
        modulus(key="tensile_strength", flags=(Flag("toe", "second"),)),
    )
    text = card_text(card(records=records, laws=(), refusals=()))
    assert text.endswith("\nFlags\n  [1] odd: one\n  [2] toe: first")
    assert [line[-7:].strip() for line in text.splitlines()[4:6]] == ["[1] [2]", "[2]"]


def test_a_card_of_refusals_alone() -> None:
    text = card_text(card(records=(), laws=(), refusals=(refusal(None, "no force at all"),)))
    assert text.splitlines()[2:] == ["", "Refused", "  tensile_modulus: no force at all"]


def test_a_falling_law_reads_as_people_write_it() -> None:
    law = viscosity_law(coefficients=(4.36, -0.13, 2.0), covariance=((0.0,) * 3,) * 3, flags=())
    assert "polynomial, 4.36 - 0.13 x + 2 x^2 [Pa.s]" in card_text(card(laws=(law,)))
    cubic = viscosity_law(coefficients=(1.0, 2.0, 0.0, -3.0), covariance=((0.0,) * 4,) * 4)
    assert "polynomial, 1 + 2 x + 0 x^2 - 3 x^3 [Pa.s]" in card_text(card(laws=(cubic,)))


@pytest.mark.parametrize(
    ("kind", "coefficients", "more", "text"),
    [
        ("exponential", (2.0, 1e-4), {}, "exponential, 2 exp(0.0001 x) [Pa.s]"),
        (
            "power-law-to-gel", (2.0, 5e4, 1.2), {},
            "power-law-to-gel, 2 (1 - x / 5e+04)^-1.2 [Pa.s]",
        ),
        (
            "power-law-fluid", (100.0, 0.5, 0.4), {"parts": (2, 1), "rates": (0.027, 0.27)},
            "power-law-fluid, K q^(n - 1), K = 100 + 0.5 x, n = 0.4 [Pa.s]",
        ),
        (
            "arrhenius", (3e-4, 24000.0), {},
            "arrhenius, 0.0003 exp(E / (R x)), E = 2.4e+04 J/mol [Pa.s]",
        ),
    ],
)  # fmt: skip
def test_every_form_of_a_law_is_written_as_it_is(
    kind: str, coefficients: tuple[float, ...], more: dict[str, Any], text: str
) -> None:
    size = len(coefficients)
    law = viscosity_law(
        kind=kind, coefficients=coefficients, covariance=((0.0,) * size,) * size, flags=(), **more
    )
    written = law_text(law)
    assert written.startswith(text)
    assert written.endswith("at nominal shear rates q from 0.027 to 0.27 1/s") == bool(more)
