"""Reading the next block and writing the last one while a block is solved.

pyarrow and numpy let go of the interpreter's lock while they work, so two processors are of use.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

BEHIND = 2
"""Blocks that may wait to be written."""
_END = object()


def may_wait(path: str) -> bool:
    """Whether reading or writing ``path`` can take for ever: standard input or output, a pipe. A
    thread that waits there would keep a terminated command from ending."""
    return path == "-" or (os.path.exists(path) and not os.path.isfile(path))


@contextmanager
def ahead(blocks: Iterable[Any]) -> Iterator[Iterator[Any]]:
    """The blocks, each read while the one before it is in use; what reading raises, they raise."""
    iterator = iter(blocks)
    with ThreadPoolExecutor(1, "read") as pool:

        def taken() -> Iterator[Any]:
            waiting = pool.submit(next, iterator, _END)
            while (block := waiting.result()) is not _END:
                waiting = pool.submit(next, iterator, _END)
                yield block

        yield taken()


@contextmanager
def behind(write: Callable[..., object]) -> Iterator[Callable[..., None]]:
    """A function that has ``write`` done in order, later; what it raises is raised by the next
    call, or at the end."""
    waiting: list[Future[object]] = []
    with ThreadPoolExecutor(1, "write") as pool:

        def later(*arguments: Any) -> None:
            if len(waiting) >= BEHIND:
                waiting.pop(0).result()
            waiting.append(pool.submit(write, *arguments))

        yield later
        for task in waiting:
            task.result()
