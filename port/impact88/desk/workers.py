"""Processes for what takes long, so that the page stays quick and a newer question ends an older.

A thread cannot be ended from outside; a process can. Each kind of work has one, started before it
is needed, kept between questions and replaced when it had to be ended. Questions and answers are
lines of JSON over its standard input and output (`worker`).
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time
from typing import Any

from ..errors import UserError

_INSTALLED_IN = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
_START = (
    f"import sys; sys.path.append(sys.argv.pop()); from {__package__}.worker import main; main()"
)
"""The process finds the package where this one did, even where it is not installed."""


class SupersededError(Exception):
    """The question was ended: its page has asked a newer one, or wants to wait no longer."""


ANSWERED_WITHIN = 60.0
"""Seconds for an answer, after which its process is ended. The slowest pages and scans at hand take
ten on an idle machine."""


class BrokenError(Exception):
    """The process ended by itself, or said that a fault of this project stopped it."""


class Bench:
    """One process that answers one question at a time.

    ``module``: the module of this room that answers, loaded before the first question.

    Questions of one ``page`` replace each other; those of different pages wait for their turn.
    """

    def __init__(self, module: str) -> None:
        self._module = module
        self._turn = threading.Condition()
        self._process: subprocess.Popen[str] | None = None
        self._asking: str | None = None
        self._latest: dict[str, int] = {}
        self._closed = False

    def warm(self) -> None:
        """Start the process, so that the first question need not wait for it."""
        with self._turn:
            if not self._closed:
                self._ready()

    def ask(self, page: str, question: dict[str, Any]) -> Any:
        """The answer to ``question`` (`worker.answer` tells what can be asked).

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
            process = self._ready()
        began = time.monotonic()
        budget = threading.Timer(ANSWERED_WITHIN, process.kill)
        budget.daemon = True
        budget.start()
        try:
            line = _exchanged(process, question)
            if not line:  # it is ending; the next question starts another
                process.wait()
        finally:
            expired = time.monotonic() - began >= ANSWERED_WITHIN
            budget.cancel()
            with self._turn:
                ended = self._process is not process
                if not ended and process.poll() is not None:
                    self._process = None
                self._asking = None
                superseded = self._latest[page] != mine
                if not superseded:
                    del self._latest[page]
                self._turn.notify_all()
        if superseded or (ended and not line):
            raise SupersededError
        if not line and expired:
            raise UserError(f"is not answered within {ANSWERED_WITHIN:.0f} seconds")
        if not line:
            raise BrokenError("the process that computes ended unexpectedly")
        reply = json.loads(line)
        if "problem" in reply:
            raise UserError(reply["problem"])
        if "fault" in reply:
            raise BrokenError(reply["fault"])
        return reply["answer"]

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

    def _ready(self) -> subprocess.Popen[str]:
        if self._process is None or self._process.poll() is not None:
            self._process = subprocess.Popen(
                # -P: a file of the user's in the current folder is no module of ours
                [sys.executable, "-P", "-c", _START, self._module, _INSTALLED_IN],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                encoding="utf-8",
                bufsize=1,
            )
        return self._process

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()


def _exchanged(process: subprocess.Popen[str], question: dict[str, Any]) -> str:
    """The line that comes back; empty when the process has ended."""
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        process.stdin.write(json.dumps(question) + "\n")
        process.stdin.flush()
        return process.stdout.readline()
    except (OSError, ValueError):  # it was ended while the question was on its way
        return ""
