from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import deamat
from tests.conftest import ROOT


def test_importing_the_package_imports_nothing_else() -> None:
    code = (
        "import sys; before = set(sys.modules); import deamat; "
        "extra = {m.partition('.')[0] for m in set(sys.modules) - before}; "
        "heavy = extra - set(sys.stdlib_module_names) - {'deamat'}; "
        "inner = {m for m in sys.modules if m.startswith('deamat.')}; "
        "print(sorted(heavy), sorted(inner))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[] []\n"


def test_the_public_names_are_there() -> None:
    stated = Path(deamat.__file__).read_text(encoding="utf-8")
    for_type_checkers = re.findall(r"^    from \S+ import (\w+) as \1$", stated, re.MULTILINE)
    names = deamat.__dict__["__all__"]
    assert sorted(for_type_checkers) == names
    for name in names:
        assert name in dir(deamat)
        assert getattr(getattr(deamat, name), "__name__", name) == name


def test_reading_a_card_needs_no_heavy_library() -> None:
    code = (
        "import sys; from deamat import MaterialCard, RawFileError, open_database, read_card; "
        "heavy = {'pandas', 'xarray', 'h5py', 'scipy', 'lmfit', 'matplotlib', 'pydantic'}; "
        "print(sorted(heavy & set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"


def test_another_name_does_not_exist() -> None:
    misspelt = "open_databse"
    with pytest.raises(AttributeError, match="module 'deamat' has no attribute 'open_databse'"):
        getattr(deamat, misspelt)


def test_it_works_beside_somebody_elses_pipeline(tmp_path: Path) -> None:
    (tmp_path / "pipeline.py").write_text('name = "somebody else\'s"\n')
    (tmp_path / "script.py").write_text(
        "import pipeline, deamat\n"
        "print(pipeline.name, deamat.Quantity(1.0, 'Pa').unit, deamat.open_database.__name__)\n"
    )
    run = subprocess.run(
        [sys.executable, "script.py"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert run.stdout == "somebody else's Pa open_database\n"


def test_the_citation_names_this_version_and_licence() -> None:
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    said = dict(re.findall(r"^(version|license): (.+)$", citation, re.MULTILINE))
    assert said == {"version": deamat.__version__, "license": "MIT"}
    assert (ROOT / "LICENSE").read_text(encoding="utf-8").startswith("MIT License\n")
