from __future__ import annotations

import gc
import sqlite3
import warnings
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings

from deamat.core.errors import CardError
from deamat.core.ledger import FileEntry
from deamat.core.properties import PROPERTIES
from deamat.core.quantity import Quantity
from deamat.core.records import PropertyRecord
from deamat.materials.card import MaterialCard
from deamat.materials.database import (
    DatabaseError,
    MissingMaterial,
    open_database,
    write_database,
)
from deamat.materials.tables import VERSION
from tests.materials import samples
from tests.materials.samples import FILES, PROVENANCE, card, modulus


def gel_b() -> MaterialCard:
    return MaterialCard(
        *("gel-b", "Gel B", True),
        records=(modulus(material="gel-b", campaign="twin-1"),),
        campaigns=(samples.TWIN,),
    )


@pytest.fixture
def path(tmp_path: Path) -> Path:
    target = tmp_path / "materials.sqlite"
    write_database(target, [card(), gel_b()], FILES, PROVENANCE)
    return target


def test_one_number_by_material_and_key(path: Path) -> None:
    with open_database(path) as db:
        assert db["gel-a"]["compressive_modulus"] == Quantity(158812.5, "Pa", 600.0, 800.0)


def test_a_folder_stands_for_the_database_in_it(path: Path) -> None:
    with open_database(str(path.parent)) as db:
        assert db.path == path


def test_a_database_is_a_mapping(path: Path) -> None:
    with open_database(path) as db:
        assert len(db) == 2
        assert list(db) == ["gel-a", "gel-b"]
        assert "gel-a" in db
        assert "gel-c" not in db
        assert dict(db) == {"gel-a": card().canonical(), "gel-b": gel_b().canonical()}
        assert db.get("gel-c") is None


@given(samples.cards)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=50)
def test_every_card_comes_back_exactly(tmp_path: Path, any_card: MaterialCard) -> None:
    target = tmp_path / "any.sqlite"
    write_database(target, [any_card], (), PROVENANCE)
    with open_database(target) as db:
        assert db["gel-a"] == any_card.canonical()
        assert db["gel-a"].to_json() == any_card.to_json()


def test_the_ledger_and_the_provenance_come_back(path: Path) -> None:
    with open_database(path) as db:
        assert db.files() == FILES
        assert db.provenance() == PROVENANCE


def test_the_same_content_gives_the_same_bytes_in_any_order(path: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.sqlite"
    turned = replace(card(), records=card().records[::-1], refusals=card().refusals[::-1])
    backwards = replace(PROVENANCE, stages=PROVENANCE.stages[::-1], config=PROVENANCE.config[::-1])
    write_database(again, [gel_b(), turned], FILES[::-1], backwards)
    assert again.read_bytes() == path.read_bytes()
    write_database(again, [card(), gel_b()], FILES, PROVENANCE)
    assert again.read_bytes() == path.read_bytes()


def test_other_content_gives_other_bytes(path: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.sqlite"
    write_database(other, [card(), gel_b()], FILES[:2], PROVENANCE)
    assert other.read_bytes() != path.read_bytes()


def test_an_auditor_finds_everything_by_plain_sql(path: Path) -> None:
    connection = sqlite3.connect(path)
    rows = connection.execute(
        "SELECT p.material, p.key, p.value, p.unit, p.standard_uncertainty, p.ci95_low, p.n, "
        "p.conditions ->> '$.age', o.specimen, o.value, o.path, o.sha256, o.first_line, "
        "o.last_line, o.reader, o.register, o.register_line, o.technique "
        "FROM properties p JOIN origins o USING (id) "
        "WHERE p.material = 'gel-a' AND p.n = 2 ORDER BY o.position"
    ).fetchall()
    budget = connection.execute(
        "SELECT source, u, shared FROM budgets JOIN properties USING (id) "
        "WHERE material = 'gel-a' ORDER BY position"
    ).fetchall()
    flags = connection.execute("SELECT name FROM flags JOIN laws USING (id)").fetchall()
    limits = connection.execute(
        "SELECT ci95_low, ci95_high FROM properties WHERE key = 'handling_time'"
    ).fetchall()
    releases = connection.execute(
        "SELECT version, code, stages ->> '$.measurement compression', environment ->> '$.numpy' FROM release"
    )
    assert releases.fetchall() == [("1.2.3", "c0de" * 6, "c0", "2.4.6")]
    connection.close()
    assert rows[0] == (
        *("gel-a", "compressive_modulus", 158812.5, "Pa", 1000.0, 156412.5, 2, "after cure"),
        *("A1", 158212.5, "soft-2026/compression/A1.csv", "1" * 64, 12, 83, "bluehill"),
        *("soft-2026/compression/specimens.csv", 2, "compression"),
    )
    assert len(rows) == 2
    assert budget == [("load cell calibration", 800.0, 1), ("scatter between specimens", 600.0, 0)]
    assert flags == [("toe",)]
    assert limits == [(18000.0, None)]


def test_every_reference_leads_somewhere(path: Path) -> None:
    connection = sqlite3.connect(path)
    assert connection.execute("PRAGMA foreign_key_check").fetchall() == []
    assert connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
    lost = connection.execute(
        "SELECT count(*) FROM (SELECT id FROM origins UNION SELECT id FROM flags) "
        "WHERE id NOT IN (SELECT id FROM properties UNION ALL SELECT id FROM laws)"
    ).fetchone()
    connection.close()
    assert lost == (0,)


def test_a_database_is_read_only(path: Path) -> None:
    with open_database(path) as db, pytest.raises(DatabaseError, match="readonly database"):
        db._rows("DELETE FROM materials")
    with open_database(path) as db:
        assert len(db) == 2


def test_a_reader_keeps_its_release_while_the_next_one_takes_the_name(path: Path) -> None:
    with open_database(path) as db:
        beside = path.with_name("next.sqlite")
        write_database(beside, [gel_b()], (), PROVENANCE)
        beside.replace(path)
        assert list(db) == ["gel-a", "gel-b"]
        assert db["gel-a"] == card().canonical()
    with open_database(path) as db:
        assert list(db) == ["gel-b"]


def test_writing_over_a_database_leaves_its_readers_alone(path: Path) -> None:
    with open_database(path) as db:
        write_database(path, [gel_b()], (), PROVENANCE)
        assert list(db) == ["gel-a", "gel-b"]


def test_both_files_are_of_the_release_that_was_opened(path: Path, tmp_path: Path) -> None:
    link = tmp_path / "current"
    link.symlink_to(path.parent, target_is_directory=True)
    with open_database(link) as db:
        assert db.path == path


def test_an_unknown_material_names_the_nearest(path: Path) -> None:
    with open_database(path) as db:
        with pytest.raises(MissingMaterial) as caught:
            db["gel-aa"]
        assert str(caught.value) == f"{path} has no material 'gel-aa'; nearest: gel-a, gel-b"
        with pytest.raises(
            MissingMaterial, match=r"has no material 'steel'; it holds gel-a, gel-b$"
        ):
            db["steel"]


@pytest.mark.parametrize(("held", "more"), [(8, ""), (9, " and 1 more")])
def test_eight_materials_are_named_and_the_rest_counted(
    tmp_path: Path, held: int, more: str
) -> None:
    names = [f"gel-{number}" for number in range(held)]
    cards = [MaterialCard(name, name, False, records=()) for name in names]
    write_database(tmp_path / "materials.sqlite", cards, (), PROVENANCE)
    with (
        open_database(tmp_path) as db,
        pytest.raises(MissingMaterial, match=rf"it holds {', '.join(names[:8])}{more}$"),
    ):
        db["steel"]


def test_a_database_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(DatabaseError) as caught:
        open_database(tmp_path)
    assert str(caught.value) == f"no database {tmp_path}/materials.sqlite; `make all` writes it"


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "materials.sqlite"
    path.write_text("time_s,force_N\n" * 100)
    with pytest.raises(DatabaseError, match="is not a database of materials: file is not a data"):
        open_database(path)
    path.write_bytes(b"")
    with pytest.raises(DatabaseError, match="is SQLite, but not a database of materials"):
        open_database(path)


def test_a_database_cut_short_is_refused(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:8192])
    with pytest.raises(DatabaseError, match="malformed"):
        open_database(path)


def test_a_database_with_other_tables_is_refused(path: Path) -> None:
    connection = sqlite3.connect(path)
    ((version,),) = connection.execute("PRAGMA user_version").fetchall()
    assert version == VERSION
    connection.execute(f"PRAGMA user_version = {version + 1}")
    connection.close()
    with pytest.raises(DatabaseError) as caught:
        open_database(path)
    assert str(caught.value) == (
        f"{path} has other tables than those of this deamat; write it again with `make all`, "
        "or read it with the deamat that wrote it"
    )


def test_a_closed_database_says_so(path: Path) -> None:
    db = open_database(path)
    db.close()
    db.close()
    with pytest.raises(DatabaseError, match="closed database"):
        len(db)


def test_a_forgotten_database_closes_itself(path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        connection = open_database(path)._connection
        gc.collect()
    with pytest.raises(sqlite3.ProgrammingError, match="closed database"):
        connection.execute("SELECT 1")


def test_two_cards_of_one_material_are_an_error(tmp_path: Path) -> None:
    with pytest.raises(CardError, match="two cards of gel-b"):
        write_database(tmp_path / "x.sqlite", [card(), gel_b(), gel_b()], (), PROVENANCE)


def test_a_database_that_cannot_be_finished_leaves_nothing(tmp_path: Path) -> None:
    odd = replace(gel_b(), records=(modulus(material="gel-b", conditions={"weather": "fair"}),))
    with pytest.raises(CardError, match="unknown condition weather"):
        write_database(tmp_path / "x.sqlite", [card(), odd], (), PROVENANCE)
    assert list(tmp_path.iterdir()) == []


def _large_card(material: str) -> MaterialCard:
    """Thirty records: every key, at two or three ages."""
    keys = (list(PROPERTIES) * 3)[:30]
    records: list[PropertyRecord] = []
    for number, key in enumerate(keys):
        unit = PROPERTIES[key].unit
        value = float(len(material) + number + 1)
        age = f"{number // len(PROPERTIES)} months"
        line = samples.origin("A1", value, 2, diagnostics={})
        records.append(
            modulus(
                key=key, material=material, quantity=Quantity(value, unit, 0.1),
                conditions={"age": age}, origins=(line,), diagnostics={},
            )
        )  # fmt: skip
    return MaterialCard(material, material, False, records=tuple(records))


def test_a_thousand_materials_of_thirty_properties(tmp_path: Path) -> None:
    path = tmp_path / "materials.sqlite"
    cards = [_large_card(f"m{number:04d}") for number in range(1000)]
    files = [FileEntry(f"f{number}", "0" * 64, 1, "recording", "used") for number in range(1000)]
    write_database(path, cards, files, PROVENANCE)
    with open_database(path) as db:
        assert len(db) == 1000
        assert len(db["m0500"].records) == 30
        assert db["m0500"] == cards[500].canonical()
        expected = 6.0 + list(PROPERTIES).index("viscosity")
        assert db["m0999"].record("viscosity", age="0 months").quantity.value == expected
