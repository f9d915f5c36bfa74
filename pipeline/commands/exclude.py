"""`deamat exclude SPECIMEN --reason TEXT`: leave something out on purpose."""

from __future__ import annotations

from pathlib import Path

import click

from deamat.commands.options import chosen_folders, folders_options


@click.command()
@click.argument("specimen")
@click.option("--reason", required=True, help="why; it stands on the card and in the trace")
@folders_options
def exclude(
    specimen: str, reason: str, raw: Path | None, config: Path | None, processed: Path | None
) -> None:
    """Leave SPECIMEN (or a file below raw/) out, with the reason, in config/exclusions.toml.

    SPECIMEN is its name, or campaign/technique/specimen where several are called so.
    """
    from deamat.run.exclude import exclude as exclude_one

    left_out = exclude_one(chosen_folders(raw, config, processed), specimen, reason)
    click.echo(f"excluded   {left_out.target}: {left_out.reason}")
    click.echo("next       deamat all")
