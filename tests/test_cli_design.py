"""`deamat design`: what a designer types, and what comes back."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from deamat.core.ledger import Provenance
from deamat.materials.database import DATABASE_FILE, write_database
from tests.actuator.cards import ROOT, cards

WANTED = ("--de", "soft", "--passive", "stiff", "--electrode", "pedot-triton")
CODE = Provenance("0", "0" * 24, (), (), ())


@pytest.fixture(scope="module")
def processed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("processed")
    write_database(folder / DATABASE_FILE, list(cards(synthetic=True).values()), (), CODE)
    return folder


def deamat(processed: Path, *words: str) -> subprocess.CompletedProcess[str]:
    places = ("--config", str(ROOT / "config"), "--processed", str(processed))
    command = [sys.executable, "-m", "deamat", "design", *words, *places]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)


def test_a_design_in_words(processed: Path) -> None:
    done = deamat(processed, *WANTED, "--t-de", "500um", "--compare", "--pareto")
    assert (done.returncode, done.stderr) == (0, "")
    assert "SYNTHETIC: simulated data, not measurements (soft, stiff)" in done.stdout
    assert "set by the breakdown probability" in done.stdout
    for heading in ("What dominates", "Next best test", "All compositions", "What no other"):
        assert heading in done.stdout


def test_a_design_for_a_program_with_its_figures(processed: Path, tmp_path: Path) -> None:
    done = deamat(
        processed, *WANTED, "--t-de", "0.5 mm", "--t-passive", "200um", "--voltage", "4kV",
        "--json", "--figures", str(tmp_path / "figures"),
    )  # fmt: skip
    assert done.returncode == 0
    document = json.loads(done.stdout)
    assert (document["synthetic"], document["voltage_set_by"]) == (True, "given")
    assert document["passive_thickness_m"] == pytest.approx(200e-6)
    assert len(document["figures"]) == 8
    assert all(Path(path).is_file() for path in document["figures"])


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The cards of `cards()` as files, each behind its option."""
    folder = tmp_path_factory.mktemp("cards")
    words = []
    for material, card in cards(synthetic=True).items():
        (folder / f"{material}.json").write_bytes(card.to_json())
        words += ["--card", str(folder / f"{material}.json")]
    return words


def test_cards_alone_give_the_design_of_their_database(
    processed: Path, files: list[str], tmp_path: Path
) -> None:
    words = (*WANTED, "--t-de", "500um", "--compare")
    by_cards = deamat(tmp_path / "nothing", *words, *files)
    assert (by_cards.returncode, by_cards.stderr) == (0, "")
    assert by_cards.stdout == deamat(processed, *words).stdout


def test_a_card_that_is_not_there_or_twice_is_named(files: list[str], tmp_path: Path) -> None:
    words = (*WANTED, "--t-de", "500um")
    nowhere = tmp_path / "nothing"
    for more, said in (
        (files[:2], "none of the cards is of"),
        ([*files, *files[:2]], "two of the cards are of one material"),
        (["--card", str(nowhere)], "nothing: No such file"),
    ):
        done = deamat(nowhere, *words, *more)
        assert done.returncode == 2
        assert said in done.stderr
        assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((*WANTED, "--t-de", "500"), "--t-de is '500': a bare number is ambiguous"),
        ((*WANTED, "--t-de", "500kPa"), "--t-de is '500kPa': kPa does not fit"),
        ((*WANTED, "--t-de", "500mm"), "thickness_m of the de layer is 0.5 m; allowed is"),
        ((*WANTED, "--t-de", "0um"), "thickness_m of the de layer is 0 m; allowed is"),
        (WANTED, "a design needs --t-de, or the name of a declared one (article-1, article-2)"),
        (("artikel-1",), "declares no design 'artikel-1'; nearest: article-1"),
        (("article-1",), "has no material 'sylgard-182-10to1'"),
        ((*WANTED, "--t-de", "500um", "--where", "age"), "'age' is not KEY=VALUE"),
        ((*WANTED, "--t-de", "500um", "--de", "gel"), "the breakdown limit of gel is unknown"),
        ((*WANTED, "--t-de", "500um", "--where", "age=2 months"), "with age='2 months'; there is"),
    ],
)
def test_a_slip_ends_with_two_and_a_sentence(
    processed: Path, words: tuple[str, ...], said: str
) -> None:
    done = deamat(processed, *words)
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
