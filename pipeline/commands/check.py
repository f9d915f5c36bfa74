"""`deamat check FILE...`: what files are, before they are registered."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from deamat.commands.options import INTERNAL, REJECTED, WELL, as_json_option, chosen_folders

F = TypeVar("F", bound=Callable[..., Any])

# register columns with an option of their own
_COLUMNS = (
    "diameter_mm", "height_mm", "width_mm", "thickness_mm", "thickness_um", "gauge_length_mm",
    "plate_length_mm", "plate_width_mm", "micrometer_force_N", "electrode_area_mm2", "tip",
    "tip_radius_um", "mixed_at", "instrument",
)  # fmt: skip


def _column_options(command: F) -> F:
    for column in reversed(_COLUMNS):
        option = "--" + column.replace("_", "-").lower()
        command = click.option(option, column.lower(), metavar="VALUE", help=f"as {column}")(
            command
        )
    return command


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("--technique", default="", help="as one of its files [default: those that fit]")
@click.option("--format", "form", default="", help="the reader [default: the one that fits]")
@_column_options
@click.option(
    "--set", "columns", multiple=True, metavar="COLUMN=VALUE", help="any column of the register"
)
@click.option(
    "--png",
    type=click.Path(file_okay=False, path_type=Path),
    help="draw the curves into this folder",
)
@click.option("--config", type=click.Path(file_okay=False, path_type=Path), help="configuration")
@as_json_option
def check(
    files: tuple[str, ...],
    technique: str,
    form: str,
    columns: tuple[str, ...],
    png: Path | None,
    config: Path | None,
    as_json: bool,
    **cells: str | None,
) -> None:
    """Say what each FILE is, what was understood, and what it would give; register nothing.

    A file that is not read comes with all that is wrong and the form it comes nearest to.
    """
    from deamat.run.check import Asked, check_files
    from deamat.run.check.text import text

    said = {name: cells[name.lower()] for name in _COLUMNS}
    given = {name: cell for name, cell in said.items() if cell is not None}
    for pair in columns:
        name, equals, cell = pair.partition("=")
        if not equals:
            raise click.BadParameter(f"{pair!r} is not COLUMN=VALUE", param_hint="--set")
        given[name.strip()] = cell.strip()
    folder = chosen_folders(None, config, None).config
    documents, code = [], WELL
    for checked in check_files(
        [Path(file) for file in files], Asked(technique, form, given, folder)
    ):
        code = max(code, INTERNAL if checked.failed else WELL if checked.read else REJECTED)
        documents.append(checked.to_document())
        if not as_json:
            click.echo(text(checked) + "\n")
        if png is not None:
            from deamat.run.check.picture import draw

            for path in draw(checked, png):
                click.echo(f"drawn      {path}", err=as_json)
    if as_json:
        click.echo(json.dumps(documents, indent=1))
    sys.exit(code)
