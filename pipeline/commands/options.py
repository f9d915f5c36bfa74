"""What the commands share: exit codes, the options of the three folders, `--json`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from deamat.run.folders import Folders

WELL, REJECTED, WRONG, INTERNAL, STOPPED = 0, 1, 2, 3, 4

F = TypeVar("F", bound=Callable[..., Any])

as_json_option = click.option("--json", "as_json", is_flag=True, help="print JSON for a program")


def folders_options(command: F) -> F:
    """Return a command the options --raw, --config and --processed."""
    for name, what in (
        ("processed", "results"),
        ("config", "configuration"),
        ("raw", "raw data"),
    ):
        command = click.option(
            f"--{name}",
            type=click.Path(file_okay=False, path_type=Path),
            help=f"{what} [default: {name}/ beside the Makefile]",
        )(command)
    return command


def chosen_folders(raw: Path | None, config: Path | None, processed: Path | None) -> Folders:
    """Return the three folders, those beside the Makefile where an option does not say."""
    home = _home()
    return Folders(raw or home / "raw", config or home / "config", processed or home / "processed")


def _home() -> Path:
    """The folder with the Makefile: the nearest one upwards that has `raw/` and `config/`."""
    here = Path.cwd()
    for folder in (here, *here.parents):
        if (folder / "raw").is_dir() and (folder / "config").is_dir():
            return folder
    return here
