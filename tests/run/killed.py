"""A run whose figures never come, to be killed by `test_workers.py`; prints a line a worker."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import deamat.run.draw
from deamat.run import run_all
from deamat.run.draw import FigureJob
from deamat.run.folders import Folders


def draw_for_ever(folder: Path, job: FigureJob) -> None:
    """Take the place of `draw_one`."""
    os.write(1, f"drawing {job.name}\n".encode())  # in one piece, unlike print
    time.sleep(600)


if __name__ == "__main__":
    deamat.run.draw.draw_one = draw_for_ever
    run_all(Folders(*map(Path, sys.argv[1:])), 2, lambda *_: None)
