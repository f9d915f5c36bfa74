"""`config/`: TOML files, validated; defaults stand once, in the classes of `core` and the rooms."""

from __future__ import annotations

import difflib
import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self, TypeVar

from pydantic import BaseModel, Field, RootModel, ValidationError, field_validator, model_validator

from deamat.core.declared import Declared
from deamat.core.errors import ConfigError
from deamat.core.instruments import Instruments
from deamat.core.slug import Spellings, nearest_slug, slug_fault
from deamat.core.toml import parse_toml

M = TypeVar("M", bound=BaseModel)

_POOLING = "conditions"  # the section of methods.toml that is of no technique


class Material(Declared):
    """One material of `config/materials.toml`: the name people read."""

    name: str


class Exclusion(Declared):
    """One file or one specimen that is deliberately left out, and why."""

    path: str | None = Field(
        default=None, description="of a file, relative to raw/, with forward slashes"
    )
    specimen: str | None = Field(
        default=None, description="`campaign/technique/specimen`, with a file or without"
    )
    reason: str = Field(min_length=3)

    @property
    def target(self) -> str:
        """What it leaves out: the path or the specimen."""
        return self.path or self.specimen or ""

    @model_validator(mode="after")
    def _names_one(self) -> Self:
        if (self.path is None) == (self.specimen is None):
            raise ValueError("an exclusion names either a path or a specimen")
        return self

    @field_validator("path")
    @classmethod
    def _below_raw(cls, path: str | None) -> str | None:
        if path is None:
            return None
        if path.startswith("/") or "\\" in path or {"..", ".", ""} & set(path.split("/")):
            raise ValueError("a path relative to raw/ with forward slashes and without '..'")
        return path

    @field_validator("specimen")
    @classmethod
    def _in_three_parts(cls, specimen: str | None) -> str | None:
        if specimen is not None and not all([*specimen.split("/"), specimen.count("/") == 2]):
            raise ValueError("a specimen is named as campaign/technique/specimen")
        return specimen


class Exclusions(Declared):
    """`config/exclusions.toml`."""

    exclude: tuple[Exclusion, ...] = ()


class Pooling(Declared):
    """`[conditions]` in `config/methods.toml`: which specimens are of one state."""

    temperature_tolerance_K: float = Field(
        default=3.0, ge=0, description="specimens whose temperatures differ by more are not pooled"
    )
    humidity_tolerance: float = Field(
        default=0.2, ge=0, description="specimens whose humidities differ by more are not pooled"
    )


_USUAL_POOLING = Pooling()


class _Materials(RootModel[Mapping[str, Material]]):
    """`config/materials.toml`: material id to what is known of it."""

    @field_validator("root")
    @classmethod
    def _ids(cls, root: Mapping[str, Material]) -> Mapping[str, Material]:
        spellings = Spellings()
        for material in root:
            if fault := slug_fault(material):
                raise ValueError(
                    f"the material {material!r}: {fault}; nearest valid: {nearest_slug(material)!r}"
                )
            if other := spellings.other("material", material, "this file"):
                raise ValueError(f"the material {material!r} differs only in case from {other}")
        return root


@dataclass(frozen=True, slots=True)
class Config:
    """Everything the lab has declared.

    Parameters
    ----------
    methods : technique key to an instance of its config class
    files : file name to sha256, for provenance
    """

    materials: Mapping[str, Material]
    instruments: Instruments
    exclusions: Exclusions
    methods: Mapping[str, BaseModel]
    files: Mapping[str, str]
    conditions: Pooling = _USUAL_POOLING

    def name_of(self, material: str) -> str:
        """Return the name people read; the id itself where none is declared."""
        known = self.materials
        return known[material].name if material in known else material


def digest(model: BaseModel) -> str:
    """Hash what a section says, whatever its layout and comments."""
    text = json.dumps(model.model_dump(mode="json"), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def load_config(folder: Path, techniques: Mapping[str, type[BaseModel]]) -> Config:
    """Read and validate a configuration folder.

    Parameters
    ----------
    folder : holds materials.toml, methods.toml, instruments.toml, exclusions.toml; a file that is
        not there declares nothing
    techniques : section of methods.toml to its class

    Raises
    ------
    ConfigError : no such folder, TOML that does not parse, an unknown key (with the nearest known
        one), a value out of range
    """
    if not folder.is_dir():
        raise ConfigError(f"no configuration folder {folder}; give one with --config")
    files: dict[str, str] = {}

    def read(name: str) -> dict[str, Any]:
        path = folder / name
        if not os.path.lexists(path):
            return {}
        if not path.is_file():
            raise ConfigError(f"{path} is no regular file, or a link that leads nowhere")
        data = path.read_bytes()
        files[name] = hashlib.sha256(data).hexdigest()
        try:
            return parse_toml(data)
        except ValueError as error:
            raise ConfigError(f"{path}: {error}") from error

    sections = read("methods.toml")
    pooling = sections.pop(_POOLING, {})
    for section in sections:
        if section not in techniques:
            known = [*techniques, _POOLING]
            near = difflib.get_close_matches(section, known, n=1) or sorted(known)
            raise ConfigError(
                f"{folder / 'methods.toml'}: no technique is called {section!r}; "
                f"nearest: {', '.join(near)}"
            )
    return Config(
        materials=validate(_Materials, read("materials.toml"), folder / "materials.toml").root,
        instruments=validate(Instruments, read("instruments.toml"), folder / "instruments.toml"),
        exclusions=validate(Exclusions, read("exclusions.toml"), folder / "exclusions.toml"),
        methods={
            key: validate(cls, sections.get(key, {}), folder / "methods.toml", key)
            for key, cls in techniques.items()
        },
        files=files,
        conditions=validate(Pooling, pooling, folder / "methods.toml", _POOLING),
    )


def validate(cls: type[M], data: Mapping[str, Any], path: Path, section: str = "") -> M:
    """Validate one file or section, turning pydantic's complaints into sentences."""
    try:
        return cls.model_validate(data)
    except ValidationError as error:
        said = []
        for e in error.errors():
            where = ".".join([*([section] if section else []), *map(str, e["loc"])])
            if e["type"] == "extra_forbidden":
                key = str(e["loc"][-1])
                near = difflib.get_close_matches(key, _field_names(cls), n=1)
                hint = f"; did you mean {near[0]!r}?" if near else ""
                said.append(f"unknown key {where!r}{hint}")
            elif e["type"] == "value_error" and not where:  # of the file as a whole
                said.append(str(e["ctx"]["error"]))
            else:
                said.append(f"{where}: {e['msg']} (found {e['input']!r})")
        raise ConfigError(f"{path}: " + "; ".join(said)) from error


def _field_names(cls: type[BaseModel]) -> set[str]:
    """All field names of a model and of the models inside it."""
    names: set[str] = set()
    for name, field in cls.model_fields.items():
        names.add(name)
        inner = [field.annotation, *getattr(field.annotation, "__args__", ())]
        for t in inner:
            if isinstance(t, type) and issubclass(t, BaseModel):
                names |= _field_names(t)
    return names
