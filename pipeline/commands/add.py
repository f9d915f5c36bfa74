"""`deamat add FOLDER`: files into a campaign."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from deamat.commands.options import REJECTED, WELL, chosen_folders, folders_options


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option("--campaign", default="", help="where they belong [default: the only one]")
@click.option("--technique", default="", help="of every new file [default: by its content]")
@click.option("--material", default="", metavar="ID", help="of every new file")
@click.option("--move", is_flag=True, help="move the files into place [default: copy]")
@click.option("--xlsx", is_flag=True, help="write the tables to fill in as workbooks")
@folders_options
def add(
    folder: Path,
    campaign: str,
    technique: str,
    material: str,
    move: bool,
    xlsx: bool,
    raw: Path | None,
    config: Path | None,
    processed: Path | None,
) -> None:
    """Propose register rows for the files of FOLDER; call it again to take over filled-in rows.

    The tables to fill in stand in to-fill-in/ beside raw/, one for each technique. A `?` marks what
    the files do not say; replace it, or empty the cell where it does not apply.
    """
    from deamat.run.add import add as add_folder
    from deamat.run.add.folder import Wish

    wish = Wish(campaign, technique, material, move, xlsx)
    added = add_folder(chosen_folders(raw, config, processed), folder, wish)
    click.echo("\n".join(added.lines))
    sys.exit(REJECTED if added.faulty else WELL)
