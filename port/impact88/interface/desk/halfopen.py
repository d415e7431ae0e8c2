"""Connections that send no whole request: closed after a time, the oldest when they are many. (All
peers are this machine, so that a limit for each address would be one for all of them.)"""

import time
from typing import Any

from waitress.channel import HTTPChannel  # type: ignore[import-untyped]

HEADER_SECONDS = 10.0
"""Longest time for a request's header; that of a page takes a millisecond."""
BODY_SECONDS = 60.0
"""Longest time for a whole request; 16 MB take a second."""
MAX_WAITING = 64
"""Connections without a whole request that are kept; a browser keeps six."""


class Channel(HTTPChannel):  # type: ignore[misc]
    """A connection with the time since which it has been sending a request."""

    since = 0.0
    served = False

    def received(self, data: bytes) -> bool:
        if self.request is None:
            self.since = time.time()
        result: bool = super().received(data)
        self.served |= bool(self.requests)
        return result

    def overdue(self, now: float) -> bool:
        if self.requests or self.total_outbufs_len:
            return False
        if self.request is None:  # nothing was sent, or nothing since the last answer
            return not self.served and now - self.creation_time > HEADER_SECONDS
        limit = BODY_SECONDS if self.request.headers_finished else HEADER_SECONDS
        return now - self.since > limit


def close_stalled(server: Any) -> None:
    """Let a waitress ``server`` close connections that send no whole request."""
    accept, maintain = server.handle_accept, server.maintenance

    def handle_accept() -> None:
        accept()
        channels = server.active_channels.values()
        waiting = [c for c in channels if not (c.requests or c.total_outbufs_len)]
        if len(waiting) > MAX_WAITING:
            # even one that was served before: a refusal is an answer too, and anybody can get one
            min(waiting, key=lambda channel: channel.last_activity).handle_close()

    def maintenance(now: float) -> None:
        maintain(now)
        for channel in list(server.active_channels.values()):
            channel.will_close |= channel.overdue(now)

    server.channel_class = Channel
    server.handle_accept, server.maintenance = handle_accept, maintenance
