"""deamat: from raw laboratory files of soft dielectric elastomers to material cards.

The public face, as `docs/api.md` explains it. Each name is imported when it is first asked for, so
that `import deamat` costs nothing.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:  # `as` says to type checkers that a name is exported
    from deamat.actuator.beam import Beam as Beam
    from deamat.actuator.beam import actuate as actuate
    from deamat.actuator.compositions import compare as compare
    from deamat.actuator.compositions import pareto as pareto
    from deamat.actuator.declared import Designs as Designs
    from deamat.actuator.declared import load_designs as load_designs
    from deamat.actuator.design import Design as Design
    from deamat.actuator.design import design as design
    from deamat.actuator.request import Request as Request
    from deamat.actuator.stack import Layer as Layer
    from deamat.actuator.stack import Stack as Stack
    from deamat.actuator.strain import pull_in_voltage as pull_in_voltage
    from deamat.core.errors import CardError as CardError
    from deamat.core.errors import ConfigError as ConfigError
    from deamat.core.errors import FitRefused as FitRefused
    from deamat.core.errors import MissingProperty as MissingProperty
    from deamat.core.errors import OutOfRange as OutOfRange
    from deamat.core.errors import PipelineError as PipelineError
    from deamat.core.errors import RawFileError as RawFileError
    from deamat.core.properties import CONDITIONS as CONDITIONS
    from deamat.core.properties import PROPERTIES as PROPERTIES
    from deamat.core.quantity import Quantity as Quantity
    from deamat.core.records import Law as Law
    from deamat.core.records import PropertyRecord as PropertyRecord
    from deamat.core.units import UnknownUnit as UnknownUnit
    from deamat.materials.card import MaterialCard as MaterialCard
    from deamat.materials.card import read_card as read_card
    from deamat.materials.correlation import correlation as correlation
    from deamat.materials.curves import CurvesError as CurvesError
    from deamat.materials.database import Database as Database
    from deamat.materials.database import DatabaseError as DatabaseError
    from deamat.materials.database import MissingMaterial as MissingMaterial
    from deamat.materials.database import open_database as open_database
    from deamat.materials.frame import to_frame as to_frame

__version__ = "0.1.0"

_HOMES = {
    "deamat.actuator.beam": ("Beam", "actuate"),
    "deamat.actuator.compositions": ("compare", "pareto"),
    "deamat.actuator.declared": ("Designs", "load_designs"),
    "deamat.actuator.design": ("Design", "design"),
    "deamat.actuator.request": ("Request",),
    "deamat.actuator.stack": ("Layer", "Stack"),
    "deamat.actuator.strain": ("pull_in_voltage",),
    "deamat.core.errors": (
        *("CardError", "ConfigError", "FitRefused", "MissingProperty", "OutOfRange"),
        *("PipelineError", "RawFileError"),
    ),
    "deamat.core.properties": ("CONDITIONS", "PROPERTIES"),
    "deamat.core.quantity": ("Quantity",),
    "deamat.core.records": ("Law", "PropertyRecord"),
    "deamat.core.units": ("UnknownUnit",),
    "deamat.materials.card": ("MaterialCard", "read_card"),
    "deamat.materials.correlation": ("correlation",),
    "deamat.materials.curves": ("CurvesError",),
    "deamat.materials.database": (
        *("Database", "DatabaseError", "MissingMaterial", "open_database"),
    ),
    "deamat.materials.frame": ("to_frame",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

if not TYPE_CHECKING:  # a type checker must go on seeing that other names do not exist
    __all__ = sorted(_HOME_OF)

    def __getattr__(name):
        """Import a public name on first use (PEP 562)."""
        if name not in _HOME_OF:
            raise AttributeError(f"module 'deamat' has no attribute {name!r}")
        from importlib import import_module

        value = getattr(import_module(_HOME_OF[name]), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOME_OF})
