"""`deamat register`: write or extend the manifest of a campaign."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from deamat.commands.options import REJECTED, WELL, chosen_folders, folders_options


@click.command()
@click.argument("campaign")
@folders_options
@click.option("--accept", multiple=True, metavar="PATH", help="accept this change; repeatable")
@click.option("--accept-all", is_flag=True, help="accept every changed and missing file")
def register(
    campaign: str,
    raw: Path | None,
    config: Path | None,
    processed: Path | None,
    accept: tuple[str, ...],
    accept_all: bool,
) -> None:
    """Write or extend the manifest of CAMPAIGN; new files and appended rows need no --accept."""
    from deamat.run.register import register as register_campaign

    where = chosen_folders(raw, config, processed)
    result = register_campaign(where.raw, campaign, accept, accept_all=accept_all)
    click.echo(result.text)
    sys.exit(REJECTED if result.pending else WELL)
