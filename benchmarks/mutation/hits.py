"""Note which test runs which block: called in every process that a test starts."""

from __future__ import annotations

import os

LOG, TEST = "MUTATION_HITS", "MUTATION_TEST"  # variables of the environment: processes inherit them


class _Hits:
    """What this process has noted for the present test."""

    def __init__(self) -> None:
        self.test = os.environ.get(TEST, "")
        self.seen: set[str] = set()
        self.log = os.open(os.environ[LOG], os.O_APPEND | os.O_WRONLY | os.O_CREAT)

    def note(self, block: str) -> None:
        if block not in self.seen:
            self.seen.add(block)
            os.write(self.log, f"{self.test}\t{block}\n".encode())


_hits = _Hits() if LOG in os.environ else None


def hit(block: str) -> None:
    """Write down that the present test runs this block."""
    if _hits is not None:
        _hits.note(block)


def begin(test: str) -> None:
    """From now on the blocks are run by this test."""
    os.environ[TEST] = test
    if _hits is not None:
        _hits.test = test
        _hits.seen.clear()
