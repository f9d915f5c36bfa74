"""What a technique declares about itself; the driver knows nothing else of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic

from pydantic import BaseModel
from typing_extensions import TypeVar  # with a default, which typing has from Python 3.13 on

from deamat.core.calibration import Covered
from deamat.core.chart import Chart
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Law, Measurement, Result, Summary
from deamat.core.register import SPECIMENS, RegisterForm

C = TypeVar("C", bound=BaseModel, default=BaseModel)
R = TypeVar("R", bound=Result, default=Result)


@dataclass(frozen=True, slots=True)
class Context(Generic[C]):
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

    config: C
    machine: Machine
    needs: Mapping[str, Quantity]
    timezone: str = "UTC"
    laws: Mapping[str, Law] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Technique(Generic[C, R]):
    """One technique: a room under `techniques/` exports exactly one of these.

    C is its config class, R what `reduce` makes of a specimen.

    Parameters
    ----------
    key : the folder in a campaign and the section in `config/methods.toml`
    yields, needs : property keys it gives, and those of other techniques it asks for
    config : pydantic class of its section
    required, optional : register columns by SI name (`diameter_m`) that it reads
    reduce : one specimen's recording to a measurement; a refused value is a `Refusal` in it
    summarise : all measurements of one material under one set of conditions to a summary
    figure : shows a material's measurements as a chart; None for a technique without one
    register : which register it reads and what a row of it is; one row per specimen by default
    measures : what of the machine its values rest on
    """

    key: str
    yields: tuple[str, ...]
    needs: tuple[str, ...]
    config: type[C]
    required: tuple[str, ...]
    optional: tuple[str, ...]
    reduce: Callable[[Specimen, Recording | None, Context[C]], Measurement[R]]
    summarise: Callable[[Sequence[Measurement[R]], Context[C]], Summary]
    figure: Callable[[Sequence[Measurement[R]], Summary], Chart] | None = None
    register: RegisterForm = SPECIMENS
    measures: tuple[Covered, ...] = ()


# Of whichever config and result: what the one list holds and the driver works through.
AnyTechnique = Technique[Any, Any]
