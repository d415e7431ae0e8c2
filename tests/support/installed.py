"""The command, as a user gives it: called in this process, or in one of its own."""

from __future__ import annotations

import io
import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

from impact88.interface.commands.cli import main

COMMAND = str(Path(sys.executable).with_name("impact88"))
"""The command that belongs to the Python running the tests."""


def impact88(
    *arguments: str, input: str = "", cwd: str | Path = ".", **options: Any
) -> subprocess.CompletedProcess[str]:
    """What ``impact88 ARGUMENTS`` does, without the start of a process unless it has ``options``;
    text in and out as UTF-8; no input unless given."""
    if options:
        return process(*arguments, input=input, cwd=cwd, **options)
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8") for _ in range(2))
    keyboard = sys.stdin
    sys.stdin = io.TextIOWrapper(io.BytesIO(input.encode()), "utf-8")
    try:
        with chdir(cwd), redirect_stdout(out), redirect_stderr(err):
            status = main(arguments)
    finally:
        sys.stdin = keyboard
    return subprocess.CompletedProcess(arguments, status, _text(out), _text(err))


def _text(stream: io.TextIOWrapper) -> str:
    """What was written, with the ends of lines that subprocess makes of them."""
    stream.flush()
    stream.seek(0)
    return io.TextIOWrapper(stream.detach(), "utf-8").read()


def process(*arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run ``impact88 ARGUMENTS`` as a process of its own, text in and out as UTF-8."""
    if "stdin" not in options:
        options.setdefault("input", "")
    return subprocess.run(
        [COMMAND, *arguments],
        capture_output=True,
        encoding="utf-8",
        timeout=120,
        check=False,
        **options,
    )
