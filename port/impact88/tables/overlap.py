"""Reading the next block and writing the last one while a block is solved.

pyarrow and numpy let go of the interpreter's lock while they work, so two processors are of use.
"""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

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
    """A function that has ``write`` done in order, later (more than one call that waits gains
    nothing); what it raises is raised by the next call, or at the end."""
    with ThreadPoolExecutor(1, "write") as pool:
        waiting: Future[object] = pool.submit(bool)

        def later(*arguments: Any) -> None:
            nonlocal waiting
            waiting.result()
            waiting = pool.submit(write, *arguments)

        yield later
        waiting.result()
