"""`deamat watch`: follow raw/ and keep the cards up to date."""

from __future__ import annotations

from pathlib import Path

import click

from deamat.commands.options import chosen_folders, folders_options


@click.command()
@click.option(
    "--settle", type=click.FloatRange(0.0), default=0.2, show_default=True, metavar="SECONDS",
    help="how long a file stays as it is after its writer closed it",
)  # fmt: skip
@click.option(
    "--unclosed", type=click.FloatRange(0.0), default=60.0, show_default=True, metavar="SECONDS",
    help="how long, if nobody was seen to close it: longer than writers pause",
)  # fmt: skip
@click.option("--poll", is_flag=True, help="for network drives, of which the system tells nothing")
@click.option("--workers", type=click.IntRange(1), help="processes [default: one per core]")
@folders_options
def watch(
    settle: float,
    unclosed: float,
    poll: bool,
    workers: int | None,
    raw: Path | None,
    config: Path | None,
    processed: Path | None,
) -> None:
    """Follow raw/ and config/: whatever is complete is on its card within a second.

    A file that is still being written is not opened; one that grows after it was read is taken back
    and read again when it is complete.
    """
    from deamat.run.watch import Patience, Watching, follow

    watching = Watching(Patience(settle, unclosed), poll, workers)
    try:
        follow(chosen_folders(raw, config, processed), watching, click.echo)
    except KeyboardInterrupt:
        click.echo("stopped")
