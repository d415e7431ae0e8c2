"""Questions with a time limit."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from threading import BoundedSemaphore, Thread
from typing import TypeVar

from ..errors import UserError

T = TypeVar("T")
MAX_SECONDS = 20.0  # of a question; a reconstruction takes 3, a scanned page 2
MAX_QUESTIONS = 4  # computed at a time, those given up included

_places = BoundedSemaphore(MAX_QUESTIONS)


def answer_in_time(compute: Callable[[], T], seconds: float = MAX_SECONDS) -> T:
    """Return what a function returns.

    Parameters
    ----------
    compute : callable
        The function, without arguments.
    seconds : float, default 20
        Time limit.

    Raises
    ------
    UserError
        After the time limit, and if too many questions are being computed.
    """
    if not _places.acquire(timeout=seconds):
        raise UserError("other questions are still being computed; try again later")
    future: Future[T] = Future()

    def work() -> None:
        try:
            future.set_result(compute())
        except BaseException as error:  # raised again where it was asked
            future.set_exception(error)
        finally:
            _places.release()

    # a thread cannot be stopped: one that is given up ends by itself, or with the process
    Thread(target=work, daemon=True).start()
    try:
        return future.result(seconds)
    except TimeoutError:
        raise UserError(
            f"took longer than {seconds:g} s; the commands of impact88 have no time limit"
        ) from None
