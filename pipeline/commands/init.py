"""`deamat init`: begin a project or a campaign."""

from __future__ import annotations

import sys
from pathlib import Path

import click


@click.command()
@click.argument(
    "folder", metavar="[DIR]", default=".", type=click.Path(file_okay=False, path_type=Path)
)
@click.option("--campaign", help="name of its folder in raw/ [default: that of DIR]")
@click.option("--title", help="what was tested")
@click.option("--laboratory", help="who tested it")
@click.option("--licence", help="under which others may use the data, or `none`")
@click.option("--synthetic/--measured", default=None, help="whether the data are simulated")
@click.option("--source", default="", help="where the data come from, such as a DOI")
@click.option("--timezone", default="", help="of stamps without an offset [default: UTC]")
@click.option(
    "--technique", "techniques", multiple=True, metavar="NAME",
    help="make its folder and register; repeatable [default: all]",
)  # fmt: skip
def init(
    folder: Path,
    campaign: str | None,
    title: str | None,
    laboratory: str | None,
    licence: str | None,
    synthetic: bool | None,
    source: str,
    timezone: str,
    techniques: tuple[str, ...],
) -> None:
    """Make an empty DIR a project, or begin a campaign in one; asks for what no option says."""
    from deamat.core.slug import nearest_slug
    from deamat.run.folders import Folders
    from deamat.run.init import Declared, init
    from deamat.techniques import TECHNIQUES

    folders = Folders(folder / "raw", folder / "config", folder / "processed")
    declared = Declared(
        name=campaign or nearest_slug(folder.resolve().name),
        title=_answer("title", title),
        laboratory=_answer("laboratory", laboratory),
        licence=_answer("licence", licence),
        synthetic=_is_synthetic(synthetic),
        source=source,
        timezone=timezone,
    )
    for path in init(folders, declared, techniques or tuple(TECHNIQUES)):
        click.echo(f"made       {path}")
    click.echo(f"next       deamat add FOLDER --campaign {declared.name}: your files into it")


def _answer(option: str, said: str | None) -> str:
    if said is not None:
        return said
    if not sys.stdin.isatty():
        raise click.UsageError(f"say --{option}: nobody can be asked here")
    answer: str = click.prompt(option)
    return answer


def _is_synthetic(said: bool | None) -> bool:
    if said is not None:
        return said
    if not sys.stdin.isatty():
        raise click.UsageError("say --measured or --synthetic: nobody can be asked here")
    return click.confirm("are the data simulated?", default=False)
