"""The command `deamat`. Heavy modules are imported inside the commands that need them."""

from __future__ import annotations

import json
import sqlite3
import sys
from collections.abc import Callable
from pathlib import Path

import click

from deamat import __version__
from deamat.commands.add import add
from deamat.commands.check import check
from deamat.commands.exclude import exclude
from deamat.commands.init import init
from deamat.commands.learn import learn
from deamat.commands.options import (
    INTERNAL,
    REJECTED,
    STOPPED,
    WRONG,
    as_json_option,
    chosen_folders,
    folders_options,
)
from deamat.commands.register import register
from deamat.commands.watch import watch
from deamat.core.errors import PipelineError, RawFileError
from deamat.run.boundary import attempt

_EPILOG = """\b
Exit codes:
  0  all well (a refused value is reported and is well)
  1  a file was rejected or a manifest is violated, and no exclusion names it
  2  wrong usage or configuration
  3  an internal error: what it concerns is left out, all the rest is published
  4  stopped by the machine (disk full, folder that cannot be written): nothing new is published
"""


@click.group(epilog=_EPILOG, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__)
def cli() -> None:
    """From raw laboratory files of soft dielectric elastomers to material cards people trust."""


@cli.command("all")
@folders_options
@as_json_option
@click.option("--workers", type=click.IntRange(1), help="processes [default: one per core]")
@click.option("--verify", is_flag=True, help="hash every file again, whatever its time of change")
def all_(
    raw: Path | None,
    config: Path | None,
    processed: Path | None,
    as_json: bool,
    workers: int | None,
    verify: bool,
) -> None:
    """Reprocess raw/ into processed/: only what changed is done again."""
    from deamat.run import run_all, summary

    folders = chosen_folders(raw, config, processed)
    document = run_all(folders, workers, _silent if as_json else _progress(), verify)
    if as_json:
        click.echo(json.dumps(document, indent=1))
    else:
        click.echo(summary.text(document))
        done = {} if document["nothing_to_do"] else document["redone_by_stage"]
        click.echo(summary.redone(done))
    sys.exit(document["exit_code"])


@cli.command()
@folders_options
@as_json_option
def explain(raw: Path | None, config: Path | None, processed: Path | None, as_json: bool) -> None:
    """Say what a run would redo now and why, and what the last run redid."""
    from deamat.run import explain as explain_run

    said = explain_run(chosen_folders(raw, config, processed))
    if as_json:
        click.echo(json.dumps(said, indent=1))
        return
    for when, label in (("now", "would be redone now"), ("last", "was redone by the last run")):
        click.echo(f"{label}: " + ("nothing" if not said[when] else f"{len(said[when])}"))
        for line in said[when]:
            click.echo(f"  {line}")


@cli.command()
@folders_options
@as_json_option
def audit(raw: Path | None, config: Path | None, processed: Path | None, as_json: bool) -> None:
    """Hash every raw file again and account for each of them exactly once."""
    from deamat.run.audit import audit as audit_run
    from deamat.run.audit import audit_text

    document = audit_run(chosen_folders(raw, config, processed))
    click.echo(json.dumps(document, indent=1) if as_json else audit_text(document))
    sys.exit(document["exit_code"])


@cli.command()
@click.argument("material")
@folders_options
@as_json_option
def card(
    material: str, raw: Path | None, config: Path | None, processed: Path | None, as_json: bool
) -> None:
    """Show the card of MATERIAL."""
    from deamat.materials.database import open_database
    from deamat.materials.present import card_text

    with open_database(chosen_folders(raw, config, processed).processed) as database:
        found = database[material]
        document = found.to_document()
    click.echo(json.dumps(document, indent=1) if as_json else card_text(found))


@cli.command()
@click.argument("material")
@click.argument("property_key", metavar="PROPERTY")
@click.option(
    "--where", "-w", multiple=True, metavar="KEY=VALUE", help="a condition: age='2 months'"
)
@folders_options
@as_json_option
def trace(
    material: str,
    property_key: str,
    where: tuple[str, ...],
    raw: Path | None,
    config: Path | None,
    processed: Path | None,
    as_json: bool,
) -> None:
    """Show the chain from PROPERTY of MATERIAL back to the raw bytes."""
    from deamat.materials.database import open_database
    from deamat.materials.trace import trace as trace_value

    conditions = dict(_pair(w) for w in where)
    with open_database(chosen_folders(raw, config, processed).processed) as database:
        chain = trace_value(database, material, property_key, **conditions)
    click.echo(json.dumps(chain.to_document(), indent=1) if as_json else chain.text())


@cli.command()
@folders_options
@as_json_option
def paper(raw: Path | None, config: Path | None, processed: Path | None, as_json: bool) -> None:
    """Write the article's tables and figures, printed beside recomputed, into processed/paper/."""
    from deamat.report.paper.entry import to_json
    from deamat.report.paper.write import write_paper

    page, entries = write_paper(chosen_folders(raw, config, processed).processed)
    if as_json:
        click.echo(to_json(entries), nl=False)
        return
    known = sum(entry.recomputed is not None for entry in entries)
    click.echo(f"paper      {page}: {known} of {len(entries)} printed numbers recomputed")
    if any(entry.synthetic for entry in entries):
        click.echo("SYNTHETIC  material values come from simulated files, not measurements")


@cli.command()
@click.argument("name", required=False)
@click.option("--de", help="material of the film")
@click.option("--passive", help="material of the passive layer")
@click.option("--electrode", help="electrode of config/designs.toml")
@click.option("--t-de", metavar="LENGTH", help="thickness of the film, with its unit: 500um")
@click.option("--t-passive", metavar="LENGTH", help="[default: the one that bends most]")
@click.option(
    "--voltage", metavar="VOLTAGE", help="drive voltage, e.g. 6.4kV [default: highest allowed]"
)
@click.option(
    "--probability", type=float, help="accepted fraction of films that break down, 0 to 1"
)
@click.option(
    "--where", "-w", multiple=True, metavar="KEY=VALUE", help="a condition: age='2 months'"
)
@click.option(
    "--card",
    "cards",
    multiple=True,
    type=click.Path(dir_okay=False, path_type=Path),
    help="a card's file; with any, the database is not asked",
)
@click.option("--compare", is_flag=True, help="also compare all compositions")
@click.option("--pareto", is_flag=True, help="list non-dominated designs (Pareto front) as well")
@click.option(
    "--figures", type=click.Path(file_okay=False, path_type=Path), help="draw into this folder"
)
@folders_options
@as_json_option
def design(
    name: str | None,
    de: str | None,
    passive: str | None,
    electrode: str | None,
    t_de: str | None,
    t_passive: str | None,
    voltage: str | None,
    probability: float | None,
    where: tuple[str, ...],
    cards: tuple[Path, ...],
    compare: bool,
    pareto: bool,
    figures: Path | None,
    raw: Path | None,
    config: Path | None,
    processed: Path | None,
    as_json: bool,
) -> None:
    """Design an actuator: NAME of config/designs.toml, or options; options win."""
    from deamat.run.design import Asked, run_design

    asked = Asked(
        name, de, passive, electrode, t_de, t_passive, voltage, probability,
        dict(_pair(w) for w in where), cards,
    )  # fmt: skip
    document, text = run_design(
        chosen_folders(raw, config, processed),
        asked,
        compare=compare,
        pareto=pareto,
        figures=figures,
    )
    click.echo(json.dumps(document, indent=1) if as_json else text, nl=as_json)


@cli.command()
@click.option("--seed", type=int, help="same seed, same bytes")
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), help="folder for --raw")
@click.option("--situation", metavar="NAME", help="a fault that laboratories have [default: none]")
@click.option("--severity", type=float, help="of the situation, 0: no fault [default: middle one]")
@click.option("--list", "list_", is_flag=True, help="list the situations and their severities")
def simulate(
    seed: int | None, out: Path | None, situation: str | None, severity: float | None, list_: bool
) -> None:
    """Write a SYNTHETIC campaign into --out, a folder for --raw; its truth into OUT.truth.json."""
    if list_:
        from deamat.twin.situations.written import listed

        click.echo(listed())
        return
    if seed is None or out is None:
        raise click.UsageError("--seed and --out are needed (or --list)")
    out = out.resolve()
    truth = out.with_name(f"{out.name}.truth.json")
    if situation is None:
        from deamat.twin.campaign import simulate as simulate_campaign

        if severity is not None:
            raise click.UsageError("--severity is that of a --situation")
        written = simulate_campaign(out, seed, truth)
    else:
        from deamat.twin.situations.written import situation_named, write_situation

        found = situation_named(situation)
        if severity is None:
            severity = found.severities[len(found.severities) // 2]
        truth = out.with_name(f"{out.name}.{situation}.truth.json")
        written = write_situation(out, found, severity, seed, truth)
    click.echo(f"SYNTHETIC campaign {written}, its truth {truth}")


for command in (add, check, exclude, init, learn, register, watch):
    cli.add_command(command)


def _pair(text: str) -> tuple[str, str]:
    key, equals, value = text.partition("=")
    if not equals:
        raise click.BadParameter(f"{text!r} is not KEY=VALUE", param_hint="--where")
    return key, value


def _progress() -> Callable[[str, int, int], None]:
    """Show a bar on a terminal, one line a stage elsewhere."""
    if not sys.stderr.isatty():

        def line(stage: str, done: int, total: int) -> None:
            if done == total:
                click.echo(f"{stage}: {total}", err=True)

        return line

    def bar(stage: str, done: int, total: int) -> None:
        filled = 30 * done // total if total else 30
        click.echo(f"\r{stage:<14}[{'#' * filled:<30}] {done}/{total}", err=True, nl=done == total)

    return bar


def _silent(stage: str, done: int, total: int) -> None:
    """Tell nobody."""
    del stage, done, total


def main() -> None:
    """Run the command; whatever ends it early ends it with a sentence and its exit code."""
    command = " ".join(sys.argv[1:2])
    try:
        failure = attempt("command", command, (), _run)
    except (OSError, sqlite3.Error) as error:  # of the machine, not of the command
        click.echo(f"deamat: {_sentence(error)}; nothing new is published", err=True)
        sys.exit(STOPPED)
    if failure is not None:
        click.echo(failure.traceback, err=True, nl=False)
        click.echo(f"deamat: internal error in {failure}; nothing new is published", err=True)
        sys.exit(INTERNAL)


def _run() -> None:
    """Run the command; an error of the project ends it with a sentence."""
    try:
        cli()
    except PipelineError as error:
        click.echo(f"deamat: {error}", err=True)
        sys.exit(REJECTED if isinstance(error, RawFileError) else WRONG)


def _sentence(error: OSError | sqlite3.Error) -> str:
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return str(error)
