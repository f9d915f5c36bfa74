"""Promises of the mutation tests: which slips are made, that a seed names them, who is blamed."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from benchmarks.mutation.__main__ import reasons_in, report
from benchmarks.mutation.blocks import block_of, instrumented
from benchmarks.mutation.copies import Copy
from benchmarks.mutation.judge import Verdict
from benchmarks.mutation.mutants import Mutant, mutants_in, mutants_of, sample_of
from benchmarks.mutation.tests_of import Hits, measured

PIPELINE = Path(__file__).resolve().parents[2] / "pipeline"


def slips(source: str) -> set[str]:
    return {mutant.applied_to(source) for mutant in mutants_in(source, "module.py")}


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("a = b < c", {"a = (b <= c)"}),
        ("a = b == c", {"a = (b != c)"}),
        ("a = b is None", {"a = (b is not None)"}),
        ("a = b + c", {"a = (b - c)"}),
        ("a = b ** c", {"a = (b * c)"}),
        ("a = -b", {"a = (b)"}),
        ("a = 3", {"a = (4)", "a = (2)"}),
        ("a = 0.975", {"a = (1.95)"}),
        ("a = True", {"a = (False)"}),
        ("a = b and c", {"a = (b or c)"}),
        ("a = not b", {"a = (b)"}),
        ("a = max(b)", {"a = (min(b))"}),
        ("a = sorted(b, key=c)", {"a = (sorted(b))"}),
        ("log(a)", {"pass"}),
        ("if a:\n    b = c", {"if (not (a)):\n    b = c"}),
        ("def f():\n    return a", {"def f():\n    return None"}),
        ("def f():\n    raise A(b)", {"def f():\n    pass"}),
        ("def f(a=1):\n    b = c", {"def f(a=(2)):\n    b = c", "def f(a=(0)):\n    b = c"}),
        ("a = 'µ', b + c", {"a = 'µ', (b - c)"}),
    ],
)
def test_each_kind_of_slip_is_made(source: str, expected: set[str]) -> None:
    assert slips(source) == expected


@pytest.mark.parametrize(
    "source",
    [
        '"""Text with 3 words."""',
        "a: int = b",
        "def f(a: B | C) -> D | None:\n    b = c",
        "A = B | C",
        "if TYPE_CHECKING:\n    a = 1",
        "@cache(size=3)\ndef f():\n    a = b",
        "a = f'{b:.3f} of {c + 1}'",
        "a = b + 'text'",
        "a = isinstance(b, C | D)",
        "a = zip(b, c, strict=True)",
        "a = Record(b=c)",
        "def f():\n    return None",
    ],
)
def test_words_types_and_decorators_are_left_as_they_are(source: str) -> None:
    assert slips(source) == set()


def test_a_seed_names_the_sample_and_an_edit_elsewhere_keeps_most_of_it() -> None:
    mutants = mutants_of(PIPELINE, "estimators")
    sample = sample_of(mutants, 50, seed=1)
    assert sample == sample_of(list(reversed(mutants)), 50, seed=1)
    assert sample != sample_of(mutants, 50, seed=2)
    fewer = [one for one in mutants if one.file != sample[0].file]
    kept = set(sample) & set(sample_of(fewer, 50, seed=1))
    assert kept == {one for one in sample if one.file != sample[0].file}


def test_every_slip_in_the_package_compiles_and_has_a_name_of_its_own() -> None:
    mutants = mutants_of(PIPELINE, "run")
    assert len({mutant.name for mutant in mutants}) == len(mutants) > 100
    for mutant in sample_of(mutants, 60, seed=3):
        source = (PIPELINE / mutant.file).read_text(encoding="utf-8")
        changed = mutant.applied_to(source)
        compile(changed, mutant.file, "exec")
        assert changed != source


SOURCE = '''"""Text."""
from __future__ import annotations

LIMIT = 3


class Thing:
    size: int = 4

    def grow(self, by: int) -> int:
        """Text."""
        if by > LIMIT:
            return 7
        return by
'''


def test_a_line_belongs_to_the_innermost_block_that_a_test_runs() -> None:
    assert block_of(SOURCE, "a.py", 4) is None
    assert block_of(SOURCE, "a.py", 8) is None
    assert block_of(SOURCE, "a.py", 12) == block_of(SOURCE, "a.py", 14) == "a.py:11"
    assert block_of(SOURCE, "a.py", 13) == "a.py:13"


def test_an_instrumented_module_notes_its_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[str] = []
    monkeypatch.setattr("benchmarks.mutation.hits.hit", seen.append)
    space: dict[str, Any] = {}
    exec(compile(instrumented(SOURCE, "a.py"), "a.py", "exec"), space)
    assert seen == []
    assert space["Thing"]().grow(1) == 1
    assert seen == ["a.py:11"]
    assert space["Thing"]().grow(5) == 7
    assert seen == ["a.py:11", "a.py:11", "a.py:13"]
    assert space["Thing"].grow.__doc__ == "Text."


def test_tests_are_chosen_by_the_block_and_its_own_file_comes_first() -> None:
    (mutant,) = [one for one in mutants_in(SOURCE, "a/b.py") if one.after == "by >= LIMIT"]
    hits = Hits(
        {"a/b.py:11": {"tests/x.py::one", "tests/a/test_b.py", "tests/y.py::slow"}},
        {
            "tests/x.py::one": 0.1, "tests/x.py::two": 0.1, "tests/y.py::slow": 1e4,
            "tests/a/test_b.py::three": 5.0, "tests/a/test_b.py::four": 5.0,
        },
    )  # fmt: skip
    assert hits.tests_for(mutant, SOURCE) == [
        "tests/a/test_b.py::four", "tests/a/test_b.py::three", "tests/x.py::one",
    ]  # fmt: skip


def test_a_survivor_without_a_reason_and_a_low_score_fail() -> None:
    mutants = list(mutants_in("a = b + c\nd = e + f", "a.py"))
    dead, alive = Verdict(mutants[0], "tests/x.py::one", 3), Verdict(mutants[1], None, 2)
    reasons = reasons_in(
        "[[survivor]]\nfile = 'a.py'\nfunction = '<module>'\nbefore = 'e + f'\nafter = 'e - f'\n"
        "reason = 'f is zero'\n"
    )
    assert report([dead, alive], {}, 50.0)[1] is False
    assert report([dead, alive], reasons, 51.0)[1] is False
    lines, good = report([dead, alive], reasons, 50.0)
    assert good
    assert lines == [
        "  killed 1 of 2 = 50.0 % (0 by the time limit)",
        "  survived 2 tests: pipeline/a.py:2 in <module>",
        "    before: e + f",
        "    after:  e - f",
        "    reason: f is zero",
    ]


def test_names_hold_where_the_slip_is() -> None:
    first, second = (one for one in mutants_in("a = b < c\nd = b < c", "a.py"))
    assert isinstance(first, Mutant)
    assert first.name != second.name
    assert (first.line, second.line) == (1, 2)


def test_a_mutant_is_killed_by_a_test_by_the_time_limit_or_by_nobody(tmp_path: Path) -> None:
    module, test = tmp_path / "three.py", tmp_path / "test_three.py"
    source = "def three():\n    return 3\n"
    module.write_text(source)
    test.write_text("import three\n\ndef test_it():\n    assert three.three() > 2\n")
    changed = {
        "killed": source.replace("3", "2"),
        "not imported": "three = 3\nraise ValueError\n",
        "endless": source.replace("return 3", "while True: pass"),
        "alive": source.replace("3", "4"),
    }
    tasks = [
        {"path": str(module), "source": text, "tests": ["test_three.py::test_it"], "cpu_s": 1.0}
        for text in changed.values()
    ]
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.mutation.worker"],
        input="".join(json.dumps(task) + "\n" for task in tasks),
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(PIPELINE.parent)},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    killers = [json.loads(line)["killer"] for line in done.stdout.splitlines()]
    assert killers == ["test_three.py::test_it", "test_three.py", "time limit", None]
    assert module.read_text() == source


def test_blocks_are_noted_for_each_test_and_for_all_where_a_fixture_runs_them(
    tmp_path: Path,
) -> None:
    for folder in ("pipeline/some", "tests", "now"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "tests/conftest.py").write_text("")
    (tmp_path / "pipeline/some/a.py").write_text(
        "def made():\n    return 1\n\n\ndef used():\n    return 2\n"
    )
    (tmp_path / "tests/test_a.py").write_text(
        "import pytest\nfrom pipeline.some.a import made, used\n\n"
        "@pytest.fixture(scope='module')\ndef one():\n    return made()\n\n"
        "def test_first(one):\n    assert one == 1\n\n"
        "def test_second(one):\n    assert used() == 2\n\n"
        "def test_third(one):\n    assert used() == 3\n"
    )
    original = (tmp_path / "pipeline/some/a.py").read_text()
    copy = Copy(tmp_path / "now", tmp_path)
    for name in ("pipeline", "tests"):
        shutil.copytree(tmp_path / name, copy.root / name)
    (copy.root / "benchmarks").symlink_to(PIPELINE.parent / "benchmarks")
    for _ in range(2):  # measured, then remembered
        hits = measured([copy], tmp_path / "pipeline", "some", ["tests"], tmp_path / "cache")
        assert hits.tests == {
            "some/a.py:2": {"tests/test_a.py"},
            "some/a.py:6": {"tests/test_a.py::test_second", "tests/test_a.py::test_third"},
        }
        assert set(hits.seconds) == {"tests/test_a.py::test_first", "tests/test_a.py::test_second"}
    assert (copy.root / "pipeline/some/a.py").read_text() == original
