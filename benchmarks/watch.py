"""How soon `deamat watch` has a file on its card, and what thousands of arrivals cost in memory.

Run: `python -m benchmarks.watch [ARRIVALS [FOLLOWED]]`. The committed twin campaign (SYNTHETIC) is
followed by a process of its own; a file of one specimen is taken away and written again, at once
and by a writer that pauses, and the time from the last byte to a card that counts it is taken.
"""

from __future__ import annotations

import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parents[1]
CAMPAIGN = "sylgard-2022-twin"
KEYS = {
    "compression": "compressive_modulus",
    "tension": "tensile_modulus",
    "permittivity": "relative_permittivity",
    "breakdown": "breakdown_strength",
}
_PATIENCE_s = 60.0
_LOOK_s = 0.005


class Followed:
    """A copy of the campaign, followed by `deamat watch`."""

    def __init__(self, home: Path) -> None:
        """Copy, and start the process."""
        self.home = home
        shutil.copytree(ROOT / "raw", home / "raw")
        shutil.copytree(ROOT / "config", home / "config")
        for path in (home / "raw").rglob("*"):
            os.utime(path, (0, 0))
        self.campaign = home / "raw" / CAMPAIGN
        where = [f"--{name}={home / name}" for name in ("raw", "config", "processed")]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "deamat", "watch", *where], stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        while not self.process.stdout.readline().startswith("watching"):
            pass

    def row(self, technique: str) -> dict[str, str]:
        """Return the first row of a register."""
        with (self.campaign / technique / "specimens.csv").open(newline="") as file:
            return next(csv.DictReader(file))

    def holds(self, row: Mapping[str, str], technique: str) -> bool:
        """Say whether a value on a card rests on a specimen."""
        card = self.home / "processed" / "cards" / f"{row['material']}.json"
        return any(
            origin["specimen"] == row["specimen"]
            for entry in json.loads(card.read_bytes())["properties"]
            if entry["key"] == KEYS[technique]
            for origin in entry["origins"]
        )

    def until(self, row: Mapping[str, str], technique: str, *, there: bool) -> float:
        """Wait until a specimen is on its card, or is not; returns the time."""
        end = time.monotonic() + _PATIENCE_s
        while self.holds(row, technique) is not there:
            if time.monotonic() > end:
                raise TimeoutError(f"{row['specimen']} did not come or go")
            time.sleep(_LOOK_s)
        return time.monotonic()

    def cpu_s(self) -> float:
        """Return the processor time of the process so far."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().split()
        return (int(fields[13]) + int(fields[14])) / os.sysconf("SC_CLK_TCK")

    def memory_MB(self) -> float:
        """Return the resident memory of the process."""
        pages = Path(f"/proc/{self.process.pid}/statm").read_text().split()[1]
        return int(pages) * os.sysconf("SC_PAGE_SIZE") / 1e6

    def close(self) -> None:
        """End the process."""
        self.process.terminate()
        self.process.wait()


def latencies(followed: Followed, technique: str, rounds: int) -> list[tuple[float, float]]:
    """Take a file away and write it again.

    Returns
    -------
    seconds from its last byte to its card, and those of the processor
    """
    row = followed.row(technique)
    file = followed.campaign / technique / row["file"]
    data = file.read_bytes()
    taken = []
    for at in range(rounds):
        file.unlink()
        followed.until(row, technique, there=False)
        with file.open("wb") as writer:
            writer.write(data[:-1])
            if at == 0:  # a writer that pauses
                writer.flush()
                time.sleep(3.0)
                if followed.holds(row, technique):
                    raise AssertionError("a half-written file is on a card")
            writer.write(data[-1:])
        last, worked = time.monotonic(), followed.cpu_s()
        on_card = followed.until(row, technique, there=True)
        taken.append((on_card - last, followed.cpu_s() - worked))
    return taken


def arrivals(followed: Followed, count: int) -> tuple[float, float]:
    """Let files arrive that no register names, and go again; returns memory before and after."""
    place = followed.campaign / "compression" / "arrivals"
    place.mkdir()
    before = after = 0.0
    for at in range(count):
        part = place / ".part"
        part.write_bytes(b"%d\n" % at * 100)
        part.replace(place / f"{at % 50}.txt")
        if at == count // 10:
            time.sleep(3.0)
            before = followed.memory_MB()
        time.sleep(0.01)
    time.sleep(3.0)
    after = followed.memory_MB()
    return before, after


def main() -> None:
    """Print a table."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 5000
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    with tempfile.TemporaryDirectory() as home:
        followed = Followed(Path(home))
        try:
            print("| technique | median s | longest s | of the processor s |\n|---|---:|---:|---:|")
            for technique in KEYS:
                waited, worked = zip(*latencies(followed, technique, rounds), strict=True)
                told = f"{median(waited):.2f} | {max(waited):.2f} | {median(worked):.2f}"
                print(f"| {technique} | {told} |", flush=True)
            before, after = arrivals(followed, count)
            said = f"after {count // 10} arrivals {before:.0f} MB, after {count} {after:.0f} MB"
            print(f"\nmemory {said}")
        finally:
            followed.close()


if __name__ == "__main__":
    main()
