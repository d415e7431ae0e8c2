"""Processes for what takes long, so that the page stays quick and a newer question ends an older.

A process can be ended from outside, a thread cannot. Each kind of work has one, started in advance,
kept between questions and replaced after it was ended.
"""

import multiprocessing
import os
import signal
import threading
from importlib import import_module
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from typing import Any

from ..errors import UserError

ANSWERED_WITHIN = 60.0
"""Seconds for an answer, after which its process is ended. The slowest pages and scans at hand take
ten on an idle machine."""


class SupersededError(Exception):
    """The question was ended: its page has asked a newer one, or wants to wait no longer."""


class BrokenError(Exception):
    """The process ended by itself, or said that a fault of this project stopped it."""


class Bench:
    """One process that answers one question at a time.

    ``module``: the module of this room whose functions answer, loaded before the first question.
    Questions of one ``page`` replace each other; those of different pages wait for their turn.
    """

    def __init__(self, module: str) -> None:
        self._module = module
        self._turn = threading.Condition()
        self._worker: tuple[SpawnProcess, Connection] | None = None
        self._asking: str | None = None
        self._latest: dict[str, int] = {}
        self._closed = False

    def warm(self) -> None:
        """Start the process, so that the first question need not wait for it."""
        with self._turn:
            if not self._closed:
                self._ready()

    def ask(self, page: str, function: str, /, **arguments: Any) -> Any:
        """What a function of the bench's module returns.

        Raises UserError with what is wrong with the question, SupersededError, and BrokenError.
        """
        with self._turn:
            mine = self._latest[page] = self._latest.get(page, 0) + 1
            if self._asking == page:
                self._end()
            self._turn.notify_all()
            while self._asking is not None and self._latest[page] == mine:
                self._turn.wait()
            if self._latest[page] != mine or self._closed:
                raise SupersededError
            self._asking = page
            worker = self._ready()
        kind, answer = "ended", None
        try:
            worker[1].send((function, arguments))
            kind = "late"
            if worker[1].poll(ANSWERED_WITHIN):
                kind, answer = worker[1].recv()
        except (OSError, EOFError):
            kind = "ended"
        finally:
            with self._turn:
                superseded = self._latest[page] != mine or self._worker is not worker
                if not superseded:
                    del self._latest[page]
                if kind in ("ended", "late") and self._worker is worker:
                    self._end()  # the next question starts another
                self._asking = None
                self._turn.notify_all()
        if superseded:
            raise SupersededError
        if kind == "late":
            raise UserError(f"is not answered within {ANSWERED_WITHIN:.0f} seconds")
        if kind == "ended":
            raise BrokenError("the process that computes ended unexpectedly")
        if kind == "problem":
            raise UserError(str(answer))
        if kind == "fault":
            raise BrokenError(answer)
        return answer

    def stop(self, page: str) -> None:
        """End what ``page`` is waiting for, if anything."""
        with self._turn:
            if page in self._latest:
                self._latest[page] += 1
                if self._asking == page:
                    self._end()
                self._turn.notify_all()

    def close(self) -> None:
        """End the process; nothing is answered any more."""
        with self._turn:
            self._closed = True
            self._end()
            self._turn.notify_all()

    def _ready(self) -> tuple[SpawnProcess, Connection]:
        if self._worker is None or not self._worker[0].is_alive():
            context = multiprocessing.get_context("spawn")
            ours, theirs = context.Pipe()
            process = context.Process(target=_work, args=(self._module, theirs), daemon=True)
            process.start()
            theirs.close()
            self._worker = process, ours
        return self._worker

    def _end(self) -> None:
        if self._worker is not None:
            process, _ = self._worker
            self._worker = None
            process.kill()
            process.join()


def _work(name: str, line: Connection) -> None:
    """What runs in the process: answer until the line is closed. Control-C is for the parent, which
    ends this process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    module = import_module(f"{__package__}.{name}")
    module.warm()
    while True:
        try:
            function, arguments = line.recv()
        except EOFError:
            return
        try:
            reply = "answer", getattr(module, function)(**arguments)
        except UserError as error:
            reply = "problem", str(error)
        except Exception as error:
            if os.environ.get("IMPACT88_DEBUG"):
                raise
            reply = "fault", f"{type(error).__name__}: {error}"
        line.send(reply)
