"""Progress of long work, on a terminal only: tqdm's bar if installed (extra ``progress``), else one
line that is written over."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Protocol

from .stderr import note

SECONDS_BETWEEN_LINES = 2.0


class Meter(Protocol):
    """Where progress is reported: ``update(n)`` says that ``n`` more units are done."""

    def update(self, n: int) -> object: ...


class _Silent:
    def update(self, n: int) -> None:
        pass


class _Line:
    """One line on stderr, at most ten times a second."""

    def __init__(self, total: int | None, what: str) -> None:
        self.total = total
        self.what = what
        self.done = 0
        self._last = 0.0
        self._width = 0

    def update(self, n: int) -> None:
        self.done += n
        now = time.monotonic()
        if now - self._last >= 0.1:
            self._last = now
            self._show()

    def _show(self) -> None:
        if self.total:
            text = f"{self.what}: {min(100, 100 * self.done // self.total)} %"
        else:
            text = f"{self.what}: {self.done:,}"
        sys.stderr.write("\r" + text.ljust(self._width))
        sys.stderr.flush()
        self._width = len(text)

    def close(self) -> None:
        sys.stderr.write("\r" + " " * self._width + "\r")
        sys.stderr.flush()


class _Lines:
    """A line on stderr now and then, for a log."""

    def __init__(self, total: int | None, what: str) -> None:
        self.total = total
        self.what = what
        self.done = 0
        self._last = time.monotonic()

    def update(self, n: int) -> None:
        self.done += n
        if time.monotonic() - self._last >= SECONDS_BETWEEN_LINES:
            self._last = time.monotonic()
            note(None, f"{self.what}: {self.done:,} of {self.total:,}")


@contextmanager
def progress(total: int | None, what: str, unit: str = "", lines: bool = False) -> Iterator[Meter]:
    """A meter for work of ``total`` units (None: unknown). Where stderr is not a terminal it is
    silent, or writes plain ``lines``."""
    if not sys.stderr.isatty():
        yield _Lines(total, what) if lines else _Silent()
        return
    meter: Any
    try:
        from tqdm import tqdm  # type: ignore[import-untyped]
    except ImportError:
        meter = _Line(total, what)
    else:
        meter = tqdm(
            total=total, desc=what, unit=unit, unit_scale=True, leave=False, dynamic_ncols=True
        )
    try:
        yield meter
    finally:
        meter.close()
