"""How many processors there are to use: what the number of threads goes by."""

import os


def processors() -> int:
    """The processors this process may use, at least 1."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
