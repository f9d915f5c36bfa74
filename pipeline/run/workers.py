"""The processes of a run: started when there is work for several, ended with their parent."""

from __future__ import annotations

import multiprocessing
import os
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.connection import wait
from types import TracebackType
from typing import Self, TypeVar

T = TypeVar("T")
R = TypeVar("R")


class Workers:
    """At most `count` processes, shared by all stages of a run; one works in this process.

    Use it as a context manager.
    """

    def __init__(self, count: int) -> None:
        self._count = count
        self._pool: ProcessPoolExecutor | None = None
        self._single: ProcessPoolExecutor | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for pool in (self._pool, self._single):
            if pool is not None:
                pool.shutdown(cancel_futures=True)

    def map(
        self, call: Callable[[T], R], items: Sequence[T], lost: Callable[[T], R], at_once: int = 1
    ) -> Iterator[R]:
        """Call a function with each item, in their order; both travel by pickle.

        Where a worker is killed, what it and its siblings had not finished is done again, one item
        at a time.

        Parameters
        ----------
        lost : gives the result of an item over which a worker ended once more
        at_once : items that a process takes at a time; no more than these are worked on here
        """
        chunks = [items[i : i + at_once] for i in range(0, len(items), at_once)]
        if self._count < 2 or len(chunks) < 2:
            yield from map(call, items)
            return
        if self._pool is None:
            self._pool = ProcessPoolExecutor(self._count, initializer=end_with_parent)
        futures = [self._pool.submit(_each, call, chunk) for chunk in chunks]
        for chunk, future in zip(chunks, futures, strict=True):
            try:
                results = future.result()
            except BrokenProcessPool:
                self._pool = None  # the next stage starts another
                results = [self._alone(call, item, lost) for item in chunk]
            yield from results

    def _alone(self, call: Callable[[T], R], item: T, lost: Callable[[T], R]) -> R:
        """Do one item in a process that has nothing else to lose."""
        if self._single is None:
            self._single = ProcessPoolExecutor(1, initializer=end_with_parent)
        try:
            return self._single.submit(call, item).result()
        except BrokenProcessPool:
            self._single = None
            return lost(item)


def _each(call: Callable[[T], R], items: Sequence[T]) -> list[R]:
    return [call(item) for item in items]


def end_with_parent() -> None:
    """Watch, in a worker, for the end of its parent, whatever ended it, and end then.

    An idle worker waits for work in a pipe whose other end its siblings hold open as well: the end
    of the parent alone does not wake it. The sentinel of `multiprocessing` (a pipe, on Windows a
    handle of the process) does, on every platform and with every start method.
    """
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_watch, args=(parent.sentinel,), daemon=True).start()


def _watch(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)  # not sys.exit: it would end this thread alone
