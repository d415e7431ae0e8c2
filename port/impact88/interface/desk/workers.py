"""Processes for what takes long, so that the page stays quick and a newer question ends an older.

A process can be ended from outside, a thread cannot. Each kind of work has one: pebble starts it in
advance, keeps it between questions, ends it with its question and starts another.
"""

import multiprocessing
import threading
from concurrent.futures import CancelledError
from concurrent.futures.process import BrokenProcessPool
from importlib import import_module
from typing import Any

from pebble import ProcessExpired, ProcessFuture, ProcessPool

from ...errors import UserError
from .guard import MAX_QUESTIONS

ANSWERED_WITHIN = 60.0
"""Seconds, after which the process is ended; the slowest scans at hand take ten when idle."""


_places = threading.Semaphore(MAX_QUESTIONS)
"""One for each question that waits for an answer, whatever its kind."""


PAGES_REMEMBERED = 1000
"""Pages of which a bench knows the newest request."""


class SupersededError(Exception):
    """The question was ended: its page has asked a newer one, or wants to wait no longer."""


class BrokenError(Exception):
    """The process ended by itself, or a fault of this project stopped it."""


class Bench:
    """One process that answers one question at a time by the functions of a ``module``, each within
    ``seconds``. Questions of one ``page`` replace each other; those of different pages wait.

    Requests arrive in any order, so each has its ``turn``, which a page counts: one that comes
    after a newer one, a question or a Stop, is superseded when it comes."""

    def __init__(self, module: str, seconds: float = ANSWERED_WITHIN) -> None:
        self._module = module
        self._seconds = seconds
        self._pool = self._new_pool()
        self._lock = threading.Lock()
        self._asked: dict[str, ProcessFuture[Any]] = {}
        self._turns: dict[str, int] = {}

    def _new_pool(self) -> ProcessPool:
        spawn: Any = multiprocessing.get_context("spawn")
        return ProcessPool(1, 0, _warm, (self._module,), spawn)

    def warm(self) -> None:
        """Start the process, so that the first question need not wait for it."""
        with self._lock:
            self._ensure_active()

    def _ensure_active(self) -> None:
        """Start a process, also where the one before could not be kept: pebble gives a pool up when
        its process is killed while it waits for work."""
        if not self._pool.active:
            self._pool = self._new_pool()
            assert self._pool.active

    def ask(self, page: str, turn: int, function: str, /, **arguments: Any) -> Any:
        """Return what a function of the module returns. Raises UserError with what is wrong with
        the question, or where too many wait; SupersededError; and BrokenError."""
        if not _places.acquire(blocking=False):
            raise UserError(f"{MAX_QUESTIONS} questions wait for an answer; expected fewer pages")
        try:
            try:
                return self._wait(page, turn, function, arguments)
            except BrokenProcessPool:  # it was killed while it waited, so not by this question
                return self._wait(page, turn, function, arguments)
        finally:
            _places.release()

    def _wait(self, page: str, turn: int, function: str, arguments: dict[str, Any]) -> Any:
        with self._lock:
            if not self._begin_turn(page, turn):
                raise SupersededError
            self._ensure_active()
            question = self._module, function, arguments
            asked = self._asked[page] = self._pool.schedule(_answer, question, {}, self._seconds)
        try:
            return asked.result()
        except (UserError, BrokenProcessPool):
            raise
        except CancelledError:
            raise SupersededError from None
        except TimeoutError:
            raise UserError(f"is not answered within {self._seconds:.0f} seconds") from None
        except ProcessExpired:
            raise BrokenError("the process that computes ended unexpectedly") from None
        except Exception as error:
            raise BrokenError(f"{type(error).__name__}: {error}") from error
        finally:
            with self._lock:
                if self._asked.get(page) is asked:
                    del self._asked[page]

    def _begin_turn(self, page: str, turn: int) -> bool:
        """End what the page asked before this turn; False where a newer turn came first."""
        newest = self._turns.pop(page, turn)
        self._turns[page] = max(newest, turn)  # at the end: the oldest is forgotten
        if len(self._turns) > PAGES_REMEMBERED:
            del self._turns[next(iter(self._turns))]
        if turn < newest:
            return False
        self._cancel(page)
        return True

    def _cancel(self, page: str) -> None:
        if page in self._asked:
            self._asked.pop(page).cancel()  # type: ignore[no-untyped-call]

    def stop(self, page: str, turn: int) -> None:
        """End what the page asked before this turn, also what has not arrived yet."""
        with self._lock:
            self._begin_turn(page, turn)

    def close(self) -> None:
        """End the process; nothing is answered any more."""
        with self._lock:
            for page in list(self._asked):
                self._cancel(page)
            self._pool.stop()  # type: ignore[no-untyped-call]
        self._pool.join()


def _warm(module: str) -> None:
    import_module(module).warm()


def _answer(module: str, function: str, arguments: dict[str, Any]) -> Any:
    return getattr(import_module(module), function)(**arguments)
