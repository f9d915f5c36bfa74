from __future__ import annotations

import subprocess
import sys

import pytest

import deamat


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
    assert sorted(deamat.__all__) == ["MaterialCard", "Quantity", "open_database"]
    for name in deamat.__all__:
        assert name in dir(deamat)
        assert getattr(deamat, name).__name__ == name


def test_reading_a_card_needs_no_heavy_library() -> None:
    code = (
        "import sys; import deamat; deamat.open_database, deamat.MaterialCard; "
        "heavy = {'pandas', 'xarray', 'h5py', 'scipy', 'lmfit', 'matplotlib', 'pydantic'}; "
        "print(sorted(heavy & set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"


def test_another_name_does_not_exist() -> None:
    misspelt = "open_databse"
    with pytest.raises(AttributeError, match="module 'deamat' has no attribute 'open_databse'"):
        getattr(deamat, misspelt)
