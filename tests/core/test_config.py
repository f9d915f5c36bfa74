"""Configuration: an unknown key is an error that names the nearest known one."""

from __future__ import annotations

from pathlib import Path

import pytest
from pydantic import Field

from deamat.core.config import load_config
from deamat.core.declared import Declared
from deamat.core.errors import ConfigError

ROOT = Path(__file__).resolve().parents[2]


class _Demo(Declared):
    min_samples: int = Field(default=10, ge=3)


def _config(folder: Path, name: str, text: str) -> None:
    (folder / name).write_text(text, "utf-8")
    load_config(folder, {"demo": _Demo})


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("methods.toml", "[demo]\nmin_sample = 5", "methods.toml: unknown key 'demo.min_sample'; did you mean 'min_samples'?"),
        ("methods.toml", "[demo]\nmin_samples = 2", "methods.toml: demo.min_samples: Input should be greater than or equal to 3 (found 2)"),
        ("methods.toml", "[dmo]", "methods.toml: no technique is called 'dmo'; nearest: demo"),
        ("methods.toml", "[demo", "methods.toml: Expected ']' at the end of a table declaration"),
        ("instruments.toml", "[gauges.height]\nu_reading_um = 5", "unknown key 'gauges.height.u_reading_um'; did you mean 'u_reading_m'?"),
        ("exclusions.toml", "[[exclude]]\npath = 'a'\nreason = ''", "exclusions.toml: exclude.0.reason: String should have at least 3 characters"),
        ("exclusions.toml", "[[exclude]]\npath = '../a'\nreason = 'bad'", "exclude.0.path: Value error, a path relative to raw/ with forward slashes and without '..' (found '../a')"),
        ("exclusions.toml", "[[exclude]]\npath = '/a'\nreason = 'bad'", "a path relative to raw/"),
        ("materials.toml", "['EF30 (1:1)']\nname = 'a'", "materials.toml: the material 'EF30 (1:1)': an id consists of the letters a to z, digits, '.', '_' and '-', not ' '; nearest valid: 'ef30-1-1'"),
        ("materials.toml", "[m-5K]\nname = 'a'\n[m-5k]\nname = 'b'", "materials.toml: the material 'm-5k' differs only in case from 'm-5K' in this file"),
    ],
)  # fmt: skip
def test_a_slip_is_named(tmp_path: Path, name: str, text: str, message: str) -> None:
    with pytest.raises(ConfigError) as caught:
        _config(tmp_path, name, text)
    assert message in str(caught.value)


def test_a_missing_folder_is_an_error_a_missing_file_declares_nothing(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no configuration folder"):
        load_config(tmp_path / "nowhere", {})
    assert load_config(tmp_path, {"demo": _Demo}).methods["demo"] == _Demo()


def test_the_shipped_configuration_holds() -> None:
    from deamat.techniques import TECHNIQUES

    config = load_config(ROOT / "config", {t.key: t.config for t in TECHNIQUES.values()})
    assert config.name_of("sylgard-182-10to1") == "Sylgard 182 (10:1)"
    assert config.name_of("never-heard-of") == "never-heard-of"
