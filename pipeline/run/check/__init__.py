"""What a file is, before it is registered: form, columns, values, curve, and all that is wrong."""

from __future__ import annotations

from deamat.run.check.files import check_files
from deamat.run.check.found import Checked
from deamat.run.check.reading import Asked

__all__ = ["Asked", "Checked", "check_files"]
