"""Progress of long operations on a terminal: one line that is overwritten."""

import math
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

from ..errors import note

SECONDS_BETWEEN_LINES = 2.0  # in a log


class _Lines:
    """Progress on stderr: on a terminal a line that is overwritten; elsewhere nothing or, with
    ``lines``, a plain line at intervals, for a log."""

    def __init__(self, total: int | None, what: str, terminal: bool, lines: bool) -> None:
        self.total, self.what, self.done = total, what, 0
        self._terminal, self._width = terminal, 0
        self._wait = 0.1 if terminal else SECONDS_BETWEEN_LINES if lines else math.inf
        self._last = 0.0 if terminal else time.monotonic()

    def update(self, n: int) -> None:
        """Add ``n`` finished units and show the progress if it is time."""
        self.done += n
        now = time.monotonic()
        if now - self._last < self._wait:
            return
        self._last = now
        if not self._terminal:
            note(None, f"{self.what}: {self.done:,} of {self.total:,}")
            return
        share = f"{min(100, 100 * self.done // self.total)} %" if self.total else f"{self.done:,}"
        text = f"{self.what}: {share}"
        print(f"\r{text.ljust(self._width)}", end="", file=sys.stderr, flush=True)
        self._width = len(text)

    def close(self) -> None:
        """Clear the line on a terminal."""
        if self._width:
            print(f"\r{' ' * self._width}\r", end="", file=sys.stderr, flush=True)


@contextmanager
def progress(total: int | None, what: str, lines: bool = False) -> Iterator[_Lines]:
    """Context of a progress meter for ``total`` units (None: unknown); call its ``update(n)`` after
    ``n`` more. If stderr is not a terminal it is silent, or writes plain ``lines``."""
    meter = _Lines(total, what, sys.stderr.isatty(), lines)
    try:
        yield meter
    finally:
        meter.close()
