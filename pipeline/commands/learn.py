"""`deamat learn FILE`: an entry of `config/exports.toml` from one sample."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deamat.commands.options import REJECTED, WELL, chosen_folders
from deamat.core.number_grammar import is_number

if TYPE_CHECKING:
    from deamat.run.learn import Answers, Question


@click.command()
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--technique", default="", help="for which it is written")
@click.option("--name", default="", help="of the form [default: made from the file's name]")
@click.option("--title", default="", help="of the instrument, for people")
@click.option(
    "--column", "columns", multiple=True, metavar="LABEL=QUANTITY:UNIT",
    help="what a column is; `#3` is the third one",
)  # fmt: skip
@click.option(
    "--factor", "factors", multiple=True, metavar="LABEL=NUMBER", help="the ratio of a probe"
)
@click.option("--decimal", type=click.Choice([".", ","]), help="the decimal mark")
@click.option(
    "--interval", type=click.FloatRange(0, min_open=True), default=None,
    help="sampling interval in s, where no column is the time",
)  # fmt: skip
@click.option("--ends-open", is_flag=True, help="its last row has no line end")
@click.option("--write", is_flag=True, help="append it to config/exports.toml")
@click.option("--config", type=click.Path(file_okay=False, path_type=Path), help="configuration")
def learn(
    file: Path,
    technique: str,
    name: str,
    title: str,
    columns: tuple[str, ...],
    factors: tuple[str, ...],
    decimal: str | None,
    interval: float | None,
    ends_open: bool,
    write: bool,
    config: Path | None,
) -> None:
    """Propose how files like FILE are read, for config/exports.toml, without any code.

    What the sample does not say is asked on a terminal; elsewhere the options that are missing are
    printed. Nothing is written without --write.
    """
    from deamat.formats.rawfile import RawFile
    from deamat.run.learn import Answers, propose
    from deamat.run.learn_write import append, name_for, tried

    answers = Answers(
        technique, decimal or "", dict(map(_column, columns)), dict(map(_factor, factors)),
        interval or 0.0, ends_open,
    )  # fmt: skip
    sample = RawFile(str(file), file.read_bytes())
    proposal = propose(sample, answers)
    while proposal.questions and sys.stdin.isatty():
        answers = _answered(answers, proposal.questions[0])
        proposal = propose(sample, answers)
    if proposal.questions:
        click.echo(f"{file}: the sample does not say")
        for question in proposal.questions:
            click.echo(f"  {question.text}\n      {question.flag}")
        sys.exit(REJECTED)
    name = name or name_for(file)
    text = proposal.toml(name, title or f"like {file.name}")
    recording = tried(sample, text, proposal.techniques[0])
    click.echo(text)
    for column, values in recording.columns.items():
        click.echo(
            f"# {column}: {values.size} values from {values.min():.6g} to {values.max():.6g}"
        )
    if recording.flags:
        click.echo("# " + "\n# ".join(map(str, recording.flags)))
    if write:
        place = append(chosen_folders(None, config, None).config, name, text)
        click.echo(f"written    {place}")
    sys.exit(WELL)


def _column(said: str) -> tuple[str, tuple[str, str]]:
    label, equals, rest = said.rpartition("=")
    if not equals or not label:
        raise click.BadParameter(f"{said!r} is not LABEL=QUANTITY:UNIT", param_hint="--column")
    quantity, _, unit = rest.partition(":")
    return label.strip(), (quantity.strip(), unit.strip())


def _factor(said: str) -> tuple[str, float]:
    label, _, number = said.rpartition("=")
    if not label or not is_number(number.strip()):
        raise click.BadParameter(f"{said!r} is not LABEL=NUMBER", param_hint="--factor")
    return label.strip(), float(number)


def _answered(answers: Answers, question: Question) -> Answers:
    """Ask on the terminal and add the answer."""
    from dataclasses import replace

    kind = click.Choice(question.choices) if question.choices else None
    said = str(click.prompt(question.text, type=kind)).strip()
    if question.kind == "technique":
        return replace(answers, technique=said)
    if question.kind == "ends":
        if said == "no":
            raise click.ClickException("export the sample again: its last number may be cut")
        return replace(answers, ends_open=True)
    if question.kind == "decimal":
        return replace(answers, decimal=said)
    if question.kind == "column":
        _, unit = answers.columns.get(said, ("", ""))
        return answers.with_column(said, question.quantity, unit)
    return answers.with_column(question.label, question.quantity, said)
