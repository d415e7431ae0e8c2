"""What commands print: JSON with the version of its form, progress, remarks."""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from ..errors import note
from ..version import __version__

FORMS = {
    "run": 1,
    "answer": 1,
    "verify": 4,
    "compare": 2,
    "oracle": 1,
    "selfcheck": 2,
    "chapter": 1,
    "bench": 1,
}
"""Version of each form of JSON. It rises where a field is removed, renamed or changes meaning."""
PROGRESS_INTERVAL = 0.2  # seconds between updates on a terminal


def print_json(form: str, record: Mapping[str, Any], indent: int | None = None) -> None:
    """Print one object with the name and version of its form; numbers that are not finite become
    null, and characters that do not print are escaped."""
    head = {"schema": f"impact88/{form}/{FORMS[form]}", "version": __version__}
    text = json.dumps(plain({**head, **record}), ensure_ascii=False, indent=indent)
    print(_escaped(text), flush=True)


def _escaped(text: str) -> str:
    """Return JSON text with escapes for characters that do not print."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c == "\n" else json.dumps(c)[1:-1] for c in text)


def plain(value: Any) -> Any:
    """Return a value for JSON: numpy's numbers and arrays as Python's, non-finite ones as None."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


class Progress:
    """Progress on a terminal: one line of stderr that is overwritten; elsewhere nothing."""

    def __init__(self, what: str) -> None:
        self.what, self._last, self._width = what, time.monotonic(), 0
        self._is_shown = sys.stderr.isatty()

    def update(self, done: int, fraction: float | None = None) -> None:
        """Show the number of steps done, or the fraction, if it is time."""
        now = time.monotonic()
        if not self._is_shown or now - self._last < PROGRESS_INTERVAL:
            return
        self._last = now
        self.show(f"{self.what}: {done:,}" if fraction is None else f"{self.what}: {fraction:.0%}")

    def show(self, text: str) -> None:
        """Overwrite the line."""
        print(f"\r{text:<{self._width}}", end="\r" if not text else "", file=sys.stderr, flush=True)
        self._width = len(text)


@contextmanager
def progress(what: str) -> Iterator[Progress]:
    """Context of a progress meter."""
    meter = Progress(what)
    try:
        yield meter
    finally:
        if meter._width:
            meter.show("")


def say(command: str, remarks: Iterable[str]) -> None:
    """Print remarks on stderr."""
    for remark in remarks:
        note(command, remark)
