from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from deamat.core.errors import MissingProperty
from deamat.core.quantity import Contribution, Quantity
from deamat.materials.card import MaterialCard
from deamat.materials.database import Database, MissingMaterial, open_database, write_database
from deamat.materials.trace import percent_of_variance, trace
from tests.materials.samples import (
    CREDIT,
    FILES,
    PROVENANCE,
    TWIN,
    card,
    excluded,
    modulus,
    origin,
    viscosity_law,
)

_MADE_BY = f"""
Made by
  code                     deamat 1.2.3, digest c0dec0dec0dec0dec0dec0de
  measurement compression  fingerprint c0
  summary compression      fingerprint 5c
  card                     fingerprint ca4d
  with                     Python 3.11.2, numpy 2.4.6, platform Linux x86_64
  config                   materials.toml, sha256 {"a" * 64}
  config                   methods.toml, sha256 {"b" * 64}"""
_MADE_BY_NO_STAGE = f"""
Made by
  code    deamat 1.2.3, digest c0dec0dec0dec0dec0dec0de
  card    fingerprint ca4d
  with    Python 3.11.2, numpy 2.4.6, platform Linux x86_64
  config  materials.toml, sha256 {"a" * 64}
  config  methods.toml, sha256 {"b" * 64}"""


def database(path: Path, found: MaterialCard) -> Database:
    write_database(path / "materials.sqlite", [found], FILES, PROVENANCE)
    return open_database(path)


@pytest.fixture
def db(tmp_path: Path) -> Iterator[Database]:
    with database(tmp_path, card()) as opened:
        yield opened


def test_the_whole_chain_of_a_value(db: Database) -> None:
    text = trace(db, "gel-a", "compressive_modulus").text()
    assert text == (
        f"""\
compressive_modulus (Y_c) of Gel A 10:1 (gel-a)

  value        158.8 ± 1.0 kPa  (158812.5 Pa, u = 1000 Pa)
  95 %         156.4 to 161.2 kPa  (156412.5 Pa to 161212.5 Pa)
  n            2, sd 0.85 kPa
  conditions   age after cure, window 0 to 0.05
  campaign     soft-2026: Compression of gels, Lab One, CC BY 4.0
  method       mean of 2 specimens; slope over 0-5 %
  standard     ASTM D575, slope over 0-5 %
  diagnostics  degrees_of_freedom 5, min 158212
  flag         toe: 2 of 2 specimens, such as A1: slope: 59 kPa up to 1 %
  card         release {card().release}

Uncertainty budget
  load cell calibration      shared       0.80 kPa  64.0 % of the variance
  scatter between specimens  independent  0.60 kPa  36.0 % of the variance

Specimens
  A1  158.2 ± 1.0 kPa  (158212.5 Pa)
    file         soft-2026/compression/A1.csv
    sha256       {"1" * 64}
    lines        12 to 83, read by bluehill
    register     soft-2026/compression/specimens.csv, line 2
    technique    compression
    diagnostics  r 0.999123, samples 72
  A2  159.4 ± 1.0 kPa  (159412.5 Pa)
    file         soft-2026/compression/A2.csv
    sha256       {"2" * 64}
    lines        12 to 83, read by bluehill
    register     soft-2026/compression/specimens.csv, line 3
    technique    compression
    diagnostics  r 0.999123, samples 72
"""
        + _MADE_BY
    )


def test_conditions_lead_to_the_other_record(db: Database) -> None:
    text = trace(db, "gel-a", "compressive_modulus", age="2 months").text()
    assert "\n  value        171.0 ± 1.2 kPa  (171000.0 Pa, u = 1200 Pa)\n" in text
    assert "\n  n            1\n" in text
    assert "Uncertainty budget" not in text


def test_a_value_of_the_register_has_no_file(db: Database) -> None:
    text = trace(db, "gel-a", "handling_time").text()
    assert "  95 %        above 5.00 h  (18000.0 s to inf s)\n" in text
    assert text.endswith(
        """
Specimens
  bed-23  6.00 ± 0.28 h  (21600.0 s)
    file       none: the register holds the value
    register   soft-2026/compression/specimens.csv, line 5
    technique  handling
"""
        + _MADE_BY_NO_STAGE
    )


def test_what_was_left_out_of_a_value_stands_before_its_specimens(tmp_path: Path) -> None:
    left_out = (
        excluded("A8", path="soft-2026/compression/A8.csv"),
        excluded("A9"),
        excluded("A7", technique="tension"),
        excluded("A6", campaign="soft-2025"),
    )
    with database(tmp_path, card(excluded=left_out)) as db:
        text = trace(db, "gel-a", "compressive_modulus").text()
        refused = trace(db, "gel-a", "tensile_modulus")
    assert (
        """

Excluded
  soft-2026, A8: torn at the grip
    place  soft-2026/compression/A8.csv; soft-2026/compression/specimens.csv, line 9
  soft-2026, A9: torn at the grip
    place  soft-2026/compression/specimens.csv, line 9

Specimens
"""
        in text
    )
    assert "A7" not in text
    assert "A6" not in text
    assert [one.specimen for one in refused.excluded] == ["A7"]


def test_the_chain_of_a_law(db: Database) -> None:
    text = trace(db, "gel-a", "viscosity").text()
    assert text.startswith(
        f"""\
viscosity (mu) of Gel A 10:1 (gel-a)

  law         polynomial, 1.64 + 7.4e-05 x [Pa.s] with x = time since mixing [s], from 1 to 12 h
  c0          1.64, u = 0.01
  c1          7.4e-05, u = 1e-06
  conditions  temperature 23 C
  campaign    soft-2026: Compression of gels, Lab One, CC BY 4.0
  method      least squares
  standard    ASTM D2196
  flag        toe: told with the modulus
  card        release {card().release}

Specimens
  V1  2.00 ± 0.10 Pa.s  (2.0 Pa.s)
"""
    )


def test_a_chain_tells_what_only_some_laws_state(tmp_path: Path) -> None:
    path = tmp_path / "one.sqlite"
    write_database(path, [card(laws=(viscosity_law(temperature_K=296.15),))], FILES, PROVENANCE)
    with open_database(path) as db:
        lines = trace(db, "gel-a", "viscosity").text().splitlines()
    assert "  temperature_K  296.15" in lines
    assert not any("rate_per_rpm_per_s" in line for line in lines)


def test_a_refused_value_tells_reasons_and_places(tmp_path: Path) -> None:
    # The specimen gave a strength in the same test, so its file and row are known.
    pulled = {
        "register": "soft-2026/tension/specimens.csv",
        "path": "soft-2026/tension/A1.csv",
        "technique": "tension",
    }
    strength = modulus(
        key="tensile_strength",
        quantity=Quantity(2e6, "Pa"),
        origins=(origin("A1", 2e6, 7, **pulled),),
    )
    with database(tmp_path, card(records=(modulus(), strength))) as db:
        text = trace(db, "gel-a", "tensile_modulus").text()
        document = trace(db, "gel-a", "tensile_modulus").to_document()
    assert text == (
        """\
tensile_modulus (Y_t) of Gel A 10:1 (gel-a)

No value: it was refused.

Refused
  soft-2026, A1: 2 samples in the window, 10 are needed
    conditions   window 0 to 0.01
    place        soft-2026/tension/A1.csv; soft-2026/tension/specimens.csv, line 7
    diagnostics  samples 2
  soft-2026, A2: 2 samples in the window, 10 are needed
    conditions   window 0 to 0.01
    diagnostics  samples 2
"""
        + _MADE_BY_NO_STAGE
    )
    assert document["property"] is None
    assert document["refused"][0]["places"] == [
        "soft-2026/tension/A1.csv; soft-2026/tension/specimens.csv, line 7"
    ]


def test_a_value_and_what_was_refused_beside_it(tmp_path: Path) -> None:
    tensile = modulus(key="tensile_modulus")
    with database(tmp_path, card(records=(tensile,))) as db:
        text = trace(db, "gel-a", "tensile_modulus").text()
    assert "  value        158.8 ± 1.0 kPa" in text
    assert "\nRefused\n  soft-2026, A1: 2 samples" in text


def test_a_simulated_value_says_so_and_a_measured_one_beside_it_does_not(tmp_path: Path) -> None:
    mixed = card(
        synthetic=True,
        records=(modulus(), modulus(key="tensile_strength", campaign="twin-1")),
        campaigns=(CREDIT, TWIN),
    )
    with database(tmp_path, mixed) as db:
        simulated = trace(db, "gel-a", "tensile_strength")
        measured = trace(db, "gel-a", "compressive_modulus")
    assert simulated.text().splitlines()[1] == "SYNTHETIC: simulated data, not measurements"
    assert simulated.to_document()["synthetic"] is True
    assert "SYNTHETIC" not in measured.text()
    assert measured.to_document()["synthetic"] is False


def test_the_json_form_holds_the_record_and_more(db: Database) -> None:
    document = json.loads(json.dumps(trace(db, "gel-a", "compressive_modulus").to_document()))
    on_the_card = card().to_document()["properties"][1]
    budget = [
        {"source": "load cell calibration", "u": 800.0, "shared": True},
        {"source": "scatter between specimens", "u": 600.0, "shared": False},
    ]
    shares = [line.pop("percent_of_variance") for line in document["property"]["budget"]]
    assert shares == pytest.approx([64.0, 36.0])
    assert document["property"] == {**on_the_card, "budget": budget}
    assert document["code"] == {"version": "1.2.3", "digest": "c0de" * 6}
    assert document["stages"] == dict(PROVENANCE.stages)
    assert document["config"] == dict(PROVENANCE.config)
    assert document["release"] == card().release
    assert trace(db, "gel-a", "viscosity").to_document()["law"] == card().to_document()["laws"][0]


def test_percent_of_variance_adds_up() -> None:
    budget = [Contribution("a", 3.0, False), Contribution("b", 4.0, True)]
    assert percent_of_variance(budget) == pytest.approx([36.0, 64.0])
    assert percent_of_variance([Contribution("a", 0.0, False)]) == [0.0]


def test_a_question_without_an_answer_says_what_there_is(db: Database) -> None:
    with pytest.raises(MissingMaterial, match="has no material 'gel-x'; nearest: gel-a"):
        trace(db, "gel-x", "viscosity")
    with pytest.raises(MissingProperty, match="gel-a has no loss_tangent; there is compressive"):
        trace(db, "gel-a", "loss_tangent")
    with pytest.raises(MissingProperty, match="no compressive_modulus of gel-a with age='fresh'"):
        trace(db, "gel-a", "compressive_modulus", age="fresh")


def test_the_choice_between_laws_is_refused_too(tmp_path: Path) -> None:
    two = (viscosity_law(), viscosity_law(conditions={"temperature_K": 323.15}))
    with (
        database(tmp_path, card(laws=two)) as db,
        pytest.raises(MissingProperty, match="2 records of law of viscosity"),
    ):
        trace(db, "gel-a", "viscosity")
