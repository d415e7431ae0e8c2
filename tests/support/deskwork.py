"""What a bench of the desk is asked in tests: a question that ends only when it is ended."""

import os
import time
from pathlib import Path


def warm() -> None:
    """Nothing to load."""


def own_process() -> int:
    """Return the ID of the process that answers."""
    return os.getpid()


def endless(begun: str) -> None:
    """Write the process's ID to a file, then answer never."""
    written = Path(begun).with_suffix(".part")
    written.write_text(str(os.getpid()))
    written.rename(begun)
    time.sleep(3600)


def repeated(text: str) -> str:
    return text
