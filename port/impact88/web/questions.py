"""Questions with a time limit."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from ..errors import UserError

T = TypeVar("T")
MAX_SECONDS = 20.0  # of a question; a reconstruction takes 3, a scanned page 2
MAX_QUESTIONS = 4  # computed at a time, those given up included

_threads = ThreadPoolExecutor(MAX_QUESTIONS)


def answer_in_time(compute: Callable[[], T], seconds: float = MAX_SECONDS) -> T:
    """Return what a function returns.

    Parameters
    ----------
    compute : callable
        The function, without arguments.
    seconds : float, default 20
        Time limit, in which other questions may have to end first.

    Raises
    ------
    UserError
        After the time limit.
    """
    future = _threads.submit(compute)
    try:
        return future.result(seconds)
    except TimeoutError:
        future.cancel()  # one that runs ends by itself
        raise UserError(
            f"took longer than {seconds:g} s; the commands of impact88 have no time limit"
        ) from None
