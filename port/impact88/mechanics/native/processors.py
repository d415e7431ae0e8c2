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


def workers(count: int, threads: int | None, share: int) -> int:
    """Return the number of threads for ``count`` scenes, at least ``share`` for each thread."""
    if threads == 1 or count < 2 * share:
        return 1
    return max(1, min(threads or idle_processors(), count // share))


def run_in_threads(work: Callable[[int, int], None], count: int, workers: int) -> None:
    """Call ``work(start, stop)`` for all of ``count`` scenes, an equal part on each thread. Raises
    the first exception of any of them."""
    if workers == 1:
        work(0, count)
        return
    import threading

    size = -(-count // workers)
    failures: list[BaseException] = []

    def part(start: int) -> None:
        try:
            work(start, min(start + size, count))
        except BaseException as error:
            failures.append(error)

    helpers = [threading.Thread(target=part, args=(k * size,)) for k in range(1, workers)]
    for thread in helpers:
        thread.start()
    part(0)
    for thread in helpers:
        thread.join()
    if failures:
        raise failures[0]
