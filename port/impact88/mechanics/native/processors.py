"""How many processors there are to use, and work shared out among threads."""

import os
import threading
from collections.abc import Callable


def processors() -> int:
    """The processors this process may use, at least 1."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def workers(count: int, threads: int | None, share: int) -> int:
    """How many threads, each with at least ``share`` scenes to do."""
    return max(1, min(threads or processors(), count // share))


def shared_out(work: Callable[[int, int], None], count: int, workers: int) -> None:
    """Do ``work(start, stop)`` of all scenes, an equal part by each of some threads."""
    size = -(-count // workers)
    failures: list[BaseException] = []

    def part(start: int) -> None:
        try:
            work(start, min(start + size, count))
        except BaseException as error:
            failures.append(error)

    others = [threading.Thread(target=part, args=(k * size,)) for k in range(1, workers)]
    for thread in others:
        thread.start()
    part(0)
    for thread in others:
        thread.join()
    if failures:
        raise failures[0]
