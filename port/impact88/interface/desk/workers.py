"""Processes for what takes long, so that the page stays quick and a newer question ends an older.

A process can be ended from outside, a thread cannot. Each kind of work has one: it is started in
advance and kept between questions; where a question is ended the process is, too, and another is
started for the next.
"""

import multiprocessing
import signal
import threading
from importlib import import_module
from multiprocessing.connection import Connection
from types import ModuleType
from typing import Any

from ...errors import UserError
from .guard import MAX_QUESTIONS

ANSWERED_WITHIN = 60.0
"""Seconds, after which the process is ended; the slowest scans at hand take ten when idle."""


STARTED_WITHIN = 60.0
"""Seconds, in which a process imports what it needs and takes its question."""


_places = threading.Semaphore(MAX_QUESTIONS)
"""One for each question that waits for an answer, whatever its kind."""


PAGES_REMEMBERED = 1000
"""Pages of which a bench knows the newest request."""


class SupersededError(Exception):
    """The question was ended: its page has asked a newer one, or wants to wait no longer."""


class BrokenError(Exception):
    """The process ended by itself, or a fault of this project stopped it."""


class _NotTakenError(Exception):
    """The process ended before it took a question: not by this one."""


class _Question:
    """A question of a page, until it is answered or ``ended``."""

    ended = False


class _Worker:
    """A process that takes questions one at a time, by a pipe that tells when it ends."""

    def __init__(self, module: str) -> None:
        spawn = multiprocessing.get_context("spawn")
        self._connection, theirs = spawn.Pipe()
        self._process = spawn.Process(target=_work, args=(theirs, module), daemon=True)
        self._process.start()
        theirs.close()  # so that the end of the process is the end of the pipe

    def answer(self, function: str, arguments: dict[str, Any], seconds: float) -> Any:
        """Return or raise what the function does. Raises _NotTakenError; BrokenError where the
        process ends, and UserError where it does not answer within the seconds: it is no more."""
        try:
            self._connection.send((function, arguments))
            if not self._connection.poll(STARTED_WITHIN):
                raise EOFError
            self._connection.recv()
        except (EOFError, OSError):
            self.close()
            raise _NotTakenError from None
        try:
            if not self._connection.poll(seconds):
                self.close()
                raise UserError(f"is not answered within {seconds:.0f} seconds")
            value, error = self._connection.recv()
        except (EOFError, OSError):
            self.close()
            raise BrokenError("the process that computes ended unexpectedly") from None
        if error is not None:
            raise error
        return value

    def alive(self) -> bool:
        return self._process.is_alive()

    def kill(self) -> None:
        """End the process, whatever it does; who waits for its answer is told."""
        self._process.kill()

    def close(self) -> None:
        self._process.kill()
        self._process.join()
        self._connection.close()


class Bench:
    """One process that answers one question at a time by the functions of a ``module``, each within
    ``seconds``. Questions of one ``page`` replace each other; those of different pages wait.

    Requests arrive in any order, so each has its ``turn``, which a page counts: one that comes
    after a newer one, a question or a Stop, is superseded when it comes."""

    def __init__(self, module: str, seconds: float = ANSWERED_WITHIN) -> None:
        self._module = module
        self._seconds = seconds
        self._changed = threading.Condition()
        self._worker: _Worker | None = None
        self._answering: _Question | None = None
        self._asked: dict[str, _Question] = {}
        self._turns: dict[str, int] = {}
        self._closed = False

    def warm(self) -> None:
        """Start the process, so that the first question need not wait for it."""
        with self._changed:
            self._ready_worker()

    def _ready_worker(self) -> _Worker:
        """The process that is kept, or another where that one has ended."""
        if self._worker is not None and not self._worker.alive():
            self._worker.close()
            self._worker = None
        if self._worker is None:
            self._worker = _Worker(self._module)
        return self._worker

    def ask(self, page: str, turn: int, function: str, /, **arguments: Any) -> Any:
        """Return what a function of the module returns. Raises UserError with what is wrong with
        the question, or where too many wait; SupersededError; and BrokenError."""
        if not _places.acquire(blocking=False):
            raise UserError(f"{MAX_QUESTIONS} questions wait for an answer; expected fewer pages")
        question = _Question()
        try:
            self._wait(question, page, turn)
            return self._answer(question, function, arguments)
        finally:
            with self._changed:
                if self._asked.get(page) is question:
                    del self._asked[page]
                if self._answering is question:
                    self._answering = None
                self._changed.notify_all()
            _places.release()

    def _wait(self, question: _Question, page: str, turn: int) -> None:
        """Wait until no other question is answered. Raises SupersededError."""
        with self._changed:
            if self._closed or not self._begin_turn(page, turn):
                raise SupersededError
            self._asked[page] = question
            self._changed.wait_for(lambda: question.ended or self._answering is None)
            if question.ended:
                raise SupersededError
            self._answering = question

    def _answer(self, question: _Question, function: str, arguments: dict[str, Any]) -> Any:
        try:
            try:
                return self._worker_of(question).answer(function, arguments, self._seconds)
            except _NotTakenError:  # it ended while it waited, so not by this question
                return self._worker_of(question).answer(function, arguments, self._seconds)
        except _NotTakenError:
            if not question.ended:
                raise BrokenError("the process that computes does not start") from None
            raise SupersededError from None
        except BrokenError:
            if question.ended:
                raise SupersededError from None
            raise

    def _worker_of(self, question: _Question) -> _Worker:
        with self._changed:
            if question.ended:
                raise SupersededError
            return self._ready_worker()

    def _begin_turn(self, page: str, turn: int) -> bool:
        """End what the page asked before this turn; False where a newer turn came first."""
        newest = self._turns.pop(page, turn)
        self._turns[page] = max(newest, turn)  # at the end: the oldest is forgotten
        if len(self._turns) > PAGES_REMEMBERED:
            del self._turns[next(iter(self._turns))]
        if turn < newest:
            return False
        self._end(page)
        return True

    def _end(self, page: str) -> None:
        if (question := self._asked.pop(page, None)) is None:
            return
        question.ended = True
        if self._answering is question and self._worker is not None:
            self._worker.kill()
        self._changed.notify_all()

    def stop(self, page: str, turn: int) -> None:
        """End what the page asked before this turn, also what has not arrived yet."""
        with self._changed:
            self._begin_turn(page, turn)

    def close(self) -> None:
        """End the process; nothing is answered any more."""
        with self._changed:
            self._closed = True
            for page in list(self._asked):
                self._end(page)
            self._changed.wait_for(lambda: self._answering is None)  # its thread lets go of it
            if self._worker is not None:
                self._worker.close()


def _work(connection: Connection, module: str) -> None:
    """Take questions, say so of each, and answer it, until the pipe ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # control-C is the desk's, which then closes it
    functions = import_module(module)
    functions.warm()
    while True:
        try:
            function, arguments = connection.recv()
            connection.send(None)
            connection.send(_outcome(functions, function, arguments))
        except (EOFError, OSError):
            return


def _outcome(functions: ModuleType, function: str, arguments: dict[str, Any]) -> tuple[Any, Any]:
    """Return the function's result, or the error to raise where the question was asked."""
    try:
        return getattr(functions, function)(**arguments), None
    except UserError as error:
        return None, error
    except Exception as error:
        return None, BrokenError(f"{type(error).__name__}: {error}")
