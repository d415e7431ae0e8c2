"""What is said on standard error beside the result: one line at a time, who says it in front."""

import sys
from contextlib import suppress

from .errors import shown


def note(command: str | None, text: str) -> None:
    """A line on stderr, where there is one that takes it: "impact88 COMMAND: text"."""
    name = f"impact88 {command}" if command else "impact88"
    with suppress(OSError, ValueError):  # closed, or full
        print(f"{name}: {shown(text)}", file=sys.stderr, flush=True)
