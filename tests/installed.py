"""Running the installed command, as a user does: a process of its own."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

COMMAND = str(Path(sys.executable).with_name("impact88"))
"""The command that belongs to the Python running the tests."""


def impact88(*arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run ``impact88 ARGUMENTS``, text in and out as UTF-8; no input unless given."""
    options.setdefault("input", "")
    return subprocess.run(
        [COMMAND, *arguments],
        capture_output=True,
        encoding="utf-8",
        timeout=120,
        check=False,
        **options,
    )
