"""The end of a connection of the desk: after a refusal, with the answer read by who asked.

A server that closes a socket with unread bytes sends a reset, which can overtake its own answer: a
body that is too long is therefore read to its end, or for a while, and thrown away.
"""

import json
import socket
import time
from contextlib import suppress
from typing import Any

from waitress.channel import HTTPChannel  # type: ignore[import-untyped]
from waitress.task import ErrorTask, WSGITask  # type: ignore[import-untyped]

from .guard import HEADERS, REFUSALS, TOO_LONG

LINGERING = 3.0
"""Seconds for which what is still sent to a refused connection is thrown away."""


class Task(WSGITask):  # type: ignore[misc]
    """A request that, once refused, is the last one of its connection."""

    def build_response_header(self) -> Any:
        """Return the header, saying that the connection closes."""
        if int(self.status.partition(" ")[0]) in REFUSALS:
            self.request.headers["CONNECTION"] = "close"
        return super().build_response_header()


class Refusal(ErrorTask):  # type: ignore[misc]
    """A request that cannot be read; one that is too long is answered as the desk answers."""

    def execute(self) -> None:
        """Write the answer."""
        if self.request.error.code != 413:
            super().execute()
            return
        body = json.dumps({"problem": TOO_LONG}).encode()
        self.status = "413 Request Entity Too Large"
        self.response_headers.extend([*HEADERS.items(), ("Content-Type", "application/json")])
        self.set_close_on_finish()
        self.content_length = len(body)
        self.write(body)


class Channel(HTTPChannel):  # type: ignore[misc]
    """A connection that is read for a while after its last answer."""

    task_class = Task
    error_task_class = Refusal
    deadline = 0.0
    """Time at which it closes, 0 before its last answer."""

    def readable(self) -> bool:
        """Return whether bytes are taken from the socket."""
        return bool(self.deadline or super().readable())

    def writable(self) -> bool:
        """Return whether there is something to send, or to close."""
        if self.deadline:
            return time.monotonic() > self.deadline
        return bool(super().writable())

    def handle_write(self) -> None:
        """Send what is to be sent; after the last answer end the sending alone."""
        if self.deadline:
            self.handle_close()
        elif self.close_when_flushed and not self.will_close:
            self._flush_exception(self._flush_some)
            if not self.total_outbufs_len and not self.will_close:
                self.deadline = time.monotonic() + LINGERING
                with suppress(OSError):
                    self.socket.shutdown(socket.SHUT_WR)
        else:
            super().handle_write()

    def handle_read(self) -> None:
        """Read; after the last answer throw away what comes."""
        if not self.deadline:
            super().handle_read()
            return
        try:
            data = self.recv(self.adj.recv_bytes)
        except OSError:
            data = b""
        if not data or time.monotonic() > self.deadline:
            self.handle_close()
