"""deamat: from raw laboratory files of soft dielectric elastomers to material cards.

The public face: `open_database`, `MaterialCard`, `Quantity`. Each is imported when it is first
asked for, so that `import pipeline` costs nothing.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pipeline.core.quantity import Quantity
    from pipeline.materials.card import MaterialCard
    from pipeline.materials.database import open_database

__version__ = "0.1.0"
__all__ = ["MaterialCard", "Quantity", "open_database"]

_HOMES = {
    "MaterialCard": "pipeline.materials.card",
    "Quantity": "pipeline.core.quantity",
    "open_database": "pipeline.materials.database",
}

if not TYPE_CHECKING:  # a type checker must go on seeing that other names do not exist

    def __getattr__(name):
        """Import a public name on first use (PEP 562)."""
        if name not in _HOMES:
            raise AttributeError(f"module 'pipeline' has no attribute {name!r}")
        from importlib import import_module

        value = getattr(import_module(_HOMES[name]), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
