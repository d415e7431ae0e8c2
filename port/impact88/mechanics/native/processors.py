"""Number of usable processors, and work divided among threads."""

import os
from collections.abc import Callable


def processors() -> int:
    """Return the number of processors this process may use, at least 1."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def idle_processors() -> int:
    """Return the number of processors that had nothing to do in the last minute, and this
    process's own: two threads on a busy machine take longer than one."""
    if not hasattr(os, "getloadavg"):
        return processors()
    busy = round(os.getloadavg()[0]) - 1
    return min(processors(), max(1, (os.cpu_count() or 1) - busy))


def run_in_threads(
    work: Callable[[int, int], None], count: int, block: int, threads: int | None
) -> None:
    """Call ``work(start, stop)`` for all of ``count`` scenes, an equal part on each thread.

    ``threads``: at most so many (None: as many as there are idle processors), and none with less
    than a ``block``. Raises the first exception of any of them."""
    if threads == 1 or count < 2 * block:
        work(0, count)
        return
    import threading

    number = max(1, min(threads or idle_processors(), count // block))
    size = -(-count // number)
    failures: list[BaseException] = []

    def part(start: int) -> None:
        try:
            work(start, min(start + size, count))
        except BaseException as error:
            failures.append(error)

    helpers = [threading.Thread(target=part, args=(k * size,)) for k in range(1, number)]
    for thread in helpers:
        thread.start()
    part(0)
    for thread in helpers:
        thread.join()
    if failures:
        raise failures[0]
