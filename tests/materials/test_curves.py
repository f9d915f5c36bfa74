from __future__ import annotations

import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deamat.core.records import Measurement
from deamat.materials.curves import (
    CurvesError,
    curves_digest,
    read_curves,
    unit_of_column,
    write_curves,
)
from deamat.materials.database import MissingMaterial, open_database, write_database
from tests.materials.samples import PROVENANCE, Columns, card, measurement

A1 = measurement("A1", {"nominal_strain": [0.0, 0.1, 0.2], "nominal_stress_Pa": [0.0, 10.0, 20.5]})
A2 = measurement("A2", {"nominal_strain": [0.0, 0.3], "nominal_stress_Pa": [1.0, 30.0]}, line=3)
P1 = measurement("P1", {"frequency_Hz": [10.0, 1e3], "eps_r": [2.7, 2.6]}, technique="permittivity")
B1 = measurement(
    "B1", {"nominal_strain": [0.5], "nominal_stress_Pa": [7.0]}, "gel-b", campaign="twin-1"
)
E1 = measurement("E1", {}, technique="breakdown")
ALL = (A1, A2, P1, B1, E1)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    target = tmp_path / "curves.h5"
    write_curves(target, ALL, synthetic_campaigns={"twin-1"})
    return target


def test_the_curves_of_one_technique_lie_end_to_end(path: Path) -> None:
    data = read_curves(path, "gel-a", "compression")
    assert data["nominal_strain"].values.tolist() == [0.0, 0.1, 0.2, 0.0, 0.3]
    assert data["nominal_stress_Pa"].values.tolist() == [0.0, 10.0, 20.5, 1.0, 30.0]
    assert data["of_curve"].values.tolist() == [0, 0, 0, 1, 1]
    assert data["specimen"].values.tolist() == ["A1", "A2"]
    assert data["campaign"].values.tolist() == ["soft-2026", "soft-2026"]
    assert set(data.data_vars) == {"nominal_strain", "nominal_stress_Pa"}


def test_the_digest_is_of_values_and_not_of_their_layout(path: Path, tmp_path: Path) -> None:
    other, changed = tmp_path / "other.h5", tmp_path / "changed.h5"
    with h5py.File(path) as file, h5py.File(other, "w", libver="earliest") as copy:
        for name in sorted(file, reverse=True):
            file.copy(name, copy)
    assert other.read_bytes() != path.read_bytes()
    assert curves_digest(other) == curves_digest(path)
    for dropped in ALL[:4]:
        write_curves(changed, [m for m in ALL if m is not dropped], synthetic_campaigns={"twin-1"})
        assert curves_digest(changed) != curves_digest(path)
    for name, value in (("nominal_strain", 0.25), ("curve.synthetic", 1)):
        shutil.copy(path, changed)
        with h5py.File(changed, "r+") as file:
            file[name][1] = value
        assert curves_digest(changed) != curves_digest(path)
    shutil.copy(path, changed)
    with h5py.File(changed, "r+") as file:
        file["nominal_stress_Pa"].attrs["units"] = "kPa"
    assert curves_digest(changed) != curves_digest(path)


def test_columns_carry_their_units(path: Path) -> None:
    data = read_curves(path)
    units = {name: data[name].attrs["units"] for name in data.data_vars}
    assert units == {
        "eps_r": "1",
        "frequency_Hz": "Hz",
        "nominal_strain": "1",
        "nominal_stress_Pa": "Pa",
    }


def test_a_curve_of_another_technique_is_nan_in_columns_that_it_lacks(path: Path) -> None:
    data = read_curves(path, "gel-a")
    assert data["technique"].values.tolist() == ["compression", "compression", "permittivity"]
    assert np.isnan(data["eps_r"].values).tolist() == [True] * 5 + [False] * 2
    assert data["eps_r"].values[5:].tolist() == [2.7, 2.6]
    assert np.isnan(data["nominal_strain"].values[5:]).all()


def test_a_technique_is_read_across_materials(path: Path) -> None:
    data = read_curves(path, technique="compression")
    assert data["material"].values.tolist() == ["gel-a", "gel-a", "gel-b"]
    assert data["nominal_stress_Pa"].values.tolist() == [0.0, 10.0, 20.5, 1.0, 30.0, 7.0]


def test_a_column_of_zeros_is_a_column(tmp_path: Path) -> None:
    path = tmp_path / "zeros.h5"
    still = measurement("A1", {"nominal_strain": [0.0, 0.1], "nominal_stress_Pa": [0.0, 0.0]})
    write_curves(path, [still], synthetic_campaigns=())
    assert read_curves(path)["nominal_stress_Pa"].values.tolist() == [0.0, 0.0]


def test_whoever_holds_the_file_of_an_older_release_keeps_it(path: Path) -> None:
    kept = path.with_name("kept.h5")
    kept.hardlink_to(path)
    before = kept.read_bytes()
    write_curves(path, [A2], synthetic_campaigns=())
    assert kept.read_bytes() == before != path.read_bytes()


def test_simulated_curves_are_marked(path: Path) -> None:
    assert read_curves(path)["synthetic"].values.tolist() == [False, False, False, True]
    with h5py.File(path) as file:
        assert file["curve.synthetic"][:].tolist() == [0, 0, 0, 1]


@pytest.mark.parametrize("question", [{"material": "gel-x"}, {"technique": "breakdown"}])
def test_no_curve_gives_an_empty_dataset(path: Path, question: dict[str, str]) -> None:
    data = read_curves(path, **question)
    assert data.sizes["curve"] == 0
    assert data.sizes["sample"] == 0
    assert not data.data_vars


def test_a_file_without_any_curve_can_be_read(tmp_path: Path) -> None:
    write_curves(tmp_path / "none.h5", [E1], synthetic_campaigns=())
    assert read_curves(tmp_path / "none.h5").sizes["curve"] == 0


def test_the_same_curves_give_the_same_bytes_in_any_order(path: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.h5"
    turned = [
        Measurement(m.specimen, (), result=Columns(dict(reversed(list(m.curve.items())))))
        for m in ALL[::-1]
    ]
    write_curves(again, turned, synthetic_campaigns=["twin-1"])
    assert again.read_bytes() == path.read_bytes()
    write_curves(again, ALL[:2], synthetic_campaigns=["twin-1"])
    assert again.read_bytes() != path.read_bytes()


curves = st.dictionaries(
    st.sampled_from(["strain", "stress_Pa", "time_s"]), st.just(0), min_size=1
).flatmap(
    lambda names: st.integers(1, 4).flatmap(
        lambda n: st.fixed_dictionaries(
            {name: st.lists(st.floats(allow_nan=False), min_size=n, max_size=n) for name in names}
        )
    )
)
measurements = st.lists(
    st.tuples(st.sampled_from(["gel-a", "µ-gel"]), st.sampled_from(["tension", "x"]), curves),
    max_size=6,
)


@given(measurements)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=40)
def test_every_curve_comes_back_exactly(
    tmp_path: Path, drawn: list[tuple[str, str, dict[str, list[float]]]]
) -> None:
    given_curves = {
        f"S{i}": measurement(f"S{i}", curve, material, technique, line=i + 2)
        for i, (material, technique, curve) in enumerate(drawn)
    }
    path = tmp_path / "any.h5"
    write_curves(path, list(given_curves.values()), synthetic_campaigns=())
    for material in (None, "gel-a", "µ-gel"):
        data = read_curves(path, material)
        wanted = [
            name for name, m in given_curves.items() if material in (None, m.specimen.material)
        ]
        assert sorted(data["specimen"].values.tolist()) == sorted(wanted)
        for index, name in enumerate(data["specimen"].values.tolist()):
            mine = data["of_curve"].values == index
            for column in data.data_vars:
                found = data[column].values[mine]
                if column in given_curves[name].curve:
                    assert found.tolist() == given_curves[name].curve[str(column)].tolist()
                else:
                    assert np.isnan(found).all()


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("nominal_strain", "1"),
        ("nominal_stress_Pa", "Pa"),
        ("field_V_per_s", "V/s"),
        ("rate_per_s", "1/s"),
        ("time_s", "s"),
        ("viscosity_Pas", "Pa.s"),
        ("m", "1"),
    ],
)
def test_a_unit_is_read_from_the_longest_ending(name: str, unit: str) -> None:
    assert unit_of_column(name) == unit


@pytest.mark.parametrize("name", ["height_mm", "field_V_per_um", "field_V_per_m", "bed_degC"])
def test_a_column_that_is_not_in_si_is_an_error(tmp_path: Path, name: str) -> None:
    with pytest.raises(CurvesError) as caught:
        write_curves(tmp_path / "x.h5", [measurement("A1", {name: [0.0]})], synthetic_campaigns=())
    assert str(caught.value) == f"the column {name} is not in an SI unit of the closed table"


def test_columns_of_different_length_are_an_error(tmp_path: Path) -> None:
    bad = measurement("A1", {"nominal_strain": [0.0, 0.1], "nominal_stress_Pa": [0.0]})
    with pytest.raises(CurvesError, match=r"soft-2026, A1: the columns of a curve must have one"):
        write_curves(tmp_path / "x.h5", [bad], synthetic_campaigns=())


@pytest.mark.parametrize("name", ["stress/Pa", "nominal stress", "specimen", "of_curve"])
def test_a_column_name_that_cannot_be_kept_is_an_error(tmp_path: Path, name: str) -> None:
    bad = measurement("A1", {name: [0.0]})
    with pytest.raises(CurvesError) as caught:
        write_curves(tmp_path / "x.h5", [bad], synthetic_campaigns=())
    assert str(caught.value) == f"soft-2026, A1: a column of a curve cannot be called {name!r}"


def test_what_is_no_file_of_curves_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "curves.h5"
    with pytest.raises(CurvesError, match=r"no curves .*curves\.h5; `make all` writes them"):
        read_curves(path)
    path.write_text("strain,stress\n")
    with pytest.raises(CurvesError, match="is not a file of curves"):
        read_curves(path)
    with h5py.File(path, "w") as file:
        file["x"] = [1.0]
    with pytest.raises(CurvesError, match="does not hold curves of version 1"):
        read_curves(path)


def test_the_database_reads_the_curves_beside_it(path: Path) -> None:
    write_database(path.with_name("materials.sqlite"), [card()], (), PROVENANCE)
    with open_database(path.parent) as db:
        data = db.curves("gel-a", "permittivity")
        assert data["specimen"].values.tolist() == ["P1"]
        assert data.attrs["synthetic"] == 0
        with pytest.raises(MissingMaterial, match="has no material 'gel-b'"):
            db.curves("gel-b")


def test_curves_stay_those_of_the_release_that_was_opened(path: Path, tmp_path: Path) -> None:
    write_database(path.with_name("materials.sqlite"), [card()], (), PROVENANCE)
    old, new = tmp_path / "old", tmp_path / "new"
    old.mkdir()
    new.mkdir()
    for name in ("curves.h5", "materials.sqlite"):
        shutil.move(tmp_path / name, old / name)
    write_curves(new / "curves.h5", [E1], synthetic_campaigns=())
    current = tmp_path / "current"
    current.symlink_to(old, target_is_directory=True)
    with open_database(current) as db:
        current.unlink()
        current.symlink_to(new, target_is_directory=True)
        assert db.curves("gel-a").sizes["curve"] == 3
