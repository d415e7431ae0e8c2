"""Commands as a user gives them: called in this process, or in one of their own."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import NamedTuple

from impact88.cli.main import main

TIMEOUT = 120  # seconds


class Outcome(NamedTuple):
    """Exit status, standard output and standard error of a command."""

    status: int
    out: str
    err: str


def command(*words: str, input: str = "", folder: str | Path = ".") -> Outcome:
    """Return what ``impact88 WORDS`` does, called in this process."""
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8") for _ in range(2))
    keyboard = sys.stdin
    sys.stdin = io.TextIOWrapper(io.BytesIO(input.encode()), "utf-8")
    try:
        with chdir(folder), redirect_stdout(out), redirect_stderr(err):
            status = main(words)
    finally:
        sys.stdin = keyboard
    return Outcome(status, _text(out), _text(err))


def _text(stream: io.TextIOWrapper) -> str:
    stream.flush()
    stream.seek(0)
    return stream.read()


def shell(line: str, folder: str | Path = ".") -> Outcome:
    """Return what a line of bash does in which ``impact88`` is this package's command."""
    function = f'impact88() {{ "{sys.executable}" -m impact88 "$@"; }}; '
    done = subprocess.run(
        ["bash", "-c", function + line],
        cwd=folder,
        env={**os.environ, "IMPACT88_DEBUG": ""},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding="utf-8",
        timeout=TIMEOUT,
        check=False,
    )
    return Outcome(done.returncode, done.stdout, done.stderr)
