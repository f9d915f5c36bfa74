"""deamat: from raw laboratory files of soft dielectric elastomers to material cards.

The public face: `open_database`, `MaterialCard`, `Quantity`. Each is imported when it is first
asked for, so that `import deamat` costs nothing.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deamat.core.quantity import Quantity
    from deamat.materials.card import MaterialCard
    from deamat.materials.database import open_database

__version__ = "0.1.0"
__all__ = ["MaterialCard", "Quantity", "open_database"]

_HOMES = {
    "MaterialCard": "deamat.materials.card",
    "Quantity": "deamat.core.quantity",
    "open_database": "deamat.materials.database",
}

if not TYPE_CHECKING:  # a type checker must go on seeing that other names do not exist

    def __getattr__(name):
        """Import a public name on first use (PEP 562)."""
        if name not in _HOMES:
            raise AttributeError(f"module 'deamat' has no attribute {name!r}")
        from importlib import import_module

        value = getattr(import_module(_HOMES[name]), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
