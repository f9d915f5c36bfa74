"""Copies of the project in temporary folders: the tree itself is never edited."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

COPIED = (".ci", "benchmarks", "config", "docs", "pipeline", "raw", "tests")
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


@dataclass(frozen=True)
class Copy:
    """A copy of the project at `root`, whose package is imported there as `deamat`."""

    root: Path
    original: Path

    @property
    def environment(self) -> dict[str, str]:
        """What a process needs to import package and tests from this copy."""
        path = os.pathsep.join((str(self.root / ".link"), str(self.root)))
        return dict(os.environ) | ONE_THREAD | {"PYTHONPATH": path, "PYTHONHASHSEED": "0"}

    def replace(self, package: str, change: Callable[[str, str], str]) -> None:
        """Change every module of the package."""
        for path in sorted((self.root / "pipeline" / package).rglob("*.py")):
            file = str(path.relative_to(self.root / "pipeline"))
            path.write_text(change(path.read_text(encoding="utf-8"), file), encoding="utf-8")

    def restore(self, package: str) -> None:
        """Bring the package back as it is in the project."""
        there = self.root / "pipeline" / package
        shutil.rmtree(there)
        shutil.copytree(self.original / "pipeline" / package, there, ignore=_ignored)


def copy_of(project: Path, there: Path) -> Copy:
    """Copy the project and compile it, without what was made from it."""
    for name in COPIED:
        shutil.copytree(project / name, there / name, ignore=_ignored)
    for path in project.iterdir():
        if path.is_file() and path.name != ".git":  # a file in a worktree
            shutil.copy2(path, there / path.name)
    (there / ".link").mkdir()
    (there / ".link" / "deamat").symlink_to(Path("..", "pipeline"))
    (there / "processed").mkdir()
    shutil.copy2(project / "processed" / "README.md", there / "processed")
    return Copy(there, project)


def compile_tests(copy: Copy) -> None:
    """Import everything once, so that it is compiled."""
    options = ["--collect-only", "-q", "-p", "no:cacheprovider", "-p", "no:xdist"]
    subprocess.run(
        [sys.executable, "-m", "pytest", *options],
        cwd=copy.root, env=copy.environment, check=True, stdout=subprocess.DEVNULL,
    )  # fmt: skip


def digest(paths: Iterable[Path], name: str = "") -> str:
    """One digest of the contents of some files, and of a name."""
    whole = hashlib.sha256(name.encode())
    for path in paths:
        whole.update(hashlib.sha256(path.read_bytes()).digest())
    return whole.hexdigest()[:24]


def _ignored(_folder: str, names: list[str]) -> set[str]:
    return {name for name in names if name == "__pycache__"}
