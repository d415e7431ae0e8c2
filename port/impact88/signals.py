"""How a command may be ended from outside: control-C, SIGTERM and SIGHUP.

These would end Python on the spot, with half-written files left beside their names. Here they
become exceptions, so that unfinished work is undone; a second control-C then changes nothing.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager

TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import FrameType
    from typing import Any

INTERRUPTED = 128 + signal.SIGINT
BROKEN_PIPE = 141


class Terminated(BaseException):
    """The process was asked to leave; ``status`` is the shell's usual 128 + signal."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.status = 128 + number


def _leave(number: int, frame: FrameType | None) -> None:
    signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt if number == signal.SIGINT else Terminated(number)


@contextmanager
def orderly() -> Iterator[None]:
    """Within, control-C is a KeyboardInterrupt once, SIGTERM and SIGHUP are `Terminated`. A signal
    that the caller ignores (nohup, a shell's background job) or handles stays as it is. Outside the
    main thread, where Python takes no handlers, nothing changes."""
    usual: dict[int, Any] = {
        signal.SIGINT: signal.default_int_handler,
        signal.SIGTERM: signal.SIG_DFL,
    }
    if sys.platform != "win32":
        usual[signal.SIGHUP] = signal.SIG_DFL
    before = {}
    try:
        for number, handler in usual.items():
            if signal.getsignal(number) == handler:
                before[number] = signal.signal(number, _leave)
    except ValueError:  # not the main thread
        pass
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
