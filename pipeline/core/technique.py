"""What a technique declares about itself; the driver knows nothing else of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel

from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.records import Law, Measurement, Recording, Specimen, Summary
from deamat.core.register import SPECIMENS, RegisterForm


@dataclass(frozen=True, slots=True)
class Context:
    """What a technique is handed beside the specimen and its recording.

    Parameters
    ----------
    config : an instance of the technique's own config class
    machine : the limits of the instrument that the register names
    needs : the properties of other techniques that it declared, for the same material
    timezone : of stamps without an offset, as the campaign declares it
    laws : when a group is summarised, those laws among the properties needed of which its material
        has exactly one in its campaign
    """

    config: Any
    machine: Machine
    needs: Mapping[str, Quantity]
    timezone: str = "UTC"
    laws: Mapping[str, Law] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Technique:
    """One technique: a room under `techniques/` exports exactly one of these.

    Parameters
    ----------
    key : the folder in a campaign and the section in `config/methods.toml`
    version : raise it when `reduce` or `summarise` may give another answer
    yields, needs : property keys it gives, and those of other techniques it asks for
    config : pydantic class of its section
    required, optional : register columns by SI name (`diameter_m`) that it reads
    reduce : one specimen's recording to a measurement; a refused value is a `Refusal` in it
    summarise : all measurements of one material under one set of conditions to a summary
    figure : draws a material's measurements into the given axes; None for a technique without one
    register : which register it reads and what a row of it is; one row per specimen by default
    """

    key: str
    version: int
    yields: tuple[str, ...]
    needs: tuple[str, ...]
    config: type[BaseModel]
    required: tuple[str, ...]
    optional: tuple[str, ...]
    reduce: Callable[[Specimen, Recording | None, Context], Measurement]
    summarise: Callable[[Sequence[Measurement], Context], Summary]
    figure: Callable[[Any, Sequence[Measurement], Summary], None] | None = None
    register: RegisterForm = SPECIMENS
