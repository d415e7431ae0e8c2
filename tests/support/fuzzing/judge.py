"""Running a case in this process, and what is wrong with how it went."""

from __future__ import annotations

import ctypes
import io
import os
import re
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from impact88.collision.casescene import Scene
from impact88.errors import UserError
from impact88.interface.commands import cli
from impact88.interface.commands.cli import INTERRUPTED
from impact88.program.run import run

from .case import Case

SECONDS = 10
"""Of the processor's time a case may take: what else the machine does is not the case's fault."""
STILL = 12
"""Times as long of the clock's, for what waits without working."""
A_PRINTOUT = 2
"""Of the processor's time each printout of a page may take."""
BYTES = 1_000_000_000
STATUSES = (0, 1, 2)
CONTROL_C = b"\x03"
"""Typed at a prompt it interrupts the program."""
LONGEST_LINE = 900
MOST_LINES = 200
_CONTROL = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


class Hang(BaseException):
    """A case that took too long."""


class _WriteOnly(io.BytesIO):
    def readable(self) -> bool:
        return False


class _Stream(io.TextIOWrapper):
    """A stream of the process's kind whose text is kept."""

    def __init__(self) -> None:
        self.bytes = _WriteOnly()
        super().__init__(self.bytes, encoding="utf-8", newline="")

    def text(self) -> str:
        self.flush()
        return self.bytes.getvalue().decode("utf-8", "replace")


def faults(case: Case) -> list[str]:
    """What is wrong with how the case goes; nothing, when all is well."""
    if case.kind == "replay":
        return _replay_faults(case)
    with _folder(case) as folder, _streams(case.stdin) as (out, err), _past_python() as past:
        began, before, memory = time.process_time(), _listing(folder), _most_memory()
        seconds = max(SECONDS, A_PRINTOUT * case.printouts())
        try:
            with _no_longer_than(seconds, STILL * seconds):
                status = cli.main(case.arguments)
        except Hang as hang:
            return [f"took too long: {hang}"]
        except BaseException:
            return [f"escaped: {traceback.format_exc()}"]
        found = []
        said, shown = err.text(), out.text()
        if remarks := past():
            found.append(f"libraries wrote of themselves: {remarks[:300]!r}")
        if status not in STATUSES and not (status == INTERRUPTED and CONTROL_C in case.stdin):
            found.append(f"status {status}: {said[:500]}")
        if "Traceback" in said or "Traceback" in shown:
            found.append(f"traceback: {said[-500:]}")
        if "not enough memory" in said:
            found.append("took all the memory there is")
        lines = said.split("\n")
        if max(map(len, lines)) > LONGEST_LINE or len(lines) > MOST_LINES:
            found.append(f"{len(lines)} lines, longest {max(map(len, lines))}, on stderr")
        if _CONTROL.search(said):
            found.append(f"control characters on stderr: {said[:300]!r}")
        plain = case.arguments[:1] in (["compare"], ["verify"]) and "--json" not in case.arguments
        if plain and _CONTROL.search(shown):
            found.append(f"control characters on stdout: {_CONTROL.search(shown)}")
        if status == 2 and not said.rstrip("\n").split("\n")[-1].startswith("impact88"):
            found.append(f"status 2 with {said[-300:]!r}")
        after = _listing(folder)
        if any(name.endswith(".part") for name in after):
            found.append(f"left behind: {sorted(after)}")
        saved = set(re.findall(rb"SAVE[ ]*([^\n]+)", case.stdin))  # what the session was told to
        if any(after.get(name) != before[name] and name.encode() not in saved for name in before):
            found.append("an input was changed")
        if status == 2 and set(after) != set(before) and case.arguments[:1] != ["basic"]:
            found.append(f"status 2 and written: {sorted(set(after) - set(before))}")
        if (took := time.process_time() - began) > seconds:
            found.append(f"took {took:.1f} s")
        if (largest := _most_memory()) > max(BYTES, memory):  # which case it was, and not the next
            found.append(f"memory reached {largest / 1e6:.0f} MB")
        return found


def _most_memory() -> int:
    """The most this process ever took, in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _listing(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@contextmanager
def _folder(case: Case) -> Iterator[Path]:
    home = os.getcwd()
    shared = "/dev/shm"
    folder = Path(tempfile.mkdtemp(dir=shared if os.path.isdir(shared) else None))
    try:
        for name, data in case.files.items():
            (folder / name).write_bytes(data)
        os.chdir(folder)
        yield folder
    finally:
        os.chdir(home)
        shutil.rmtree(folder)


@contextmanager
def _streams(stdin: bytes) -> Iterator[tuple[_Stream, _Stream]]:
    before = sys.stdin, sys.stdout, sys.stderr, sys.warnoptions
    out, err = _Stream(), _Stream()
    sys.stdin, sys.stdout, sys.stderr = io.TextIOWrapper(io.BytesIO(stdin), "utf-8"), out, err
    sys.warnoptions = ["error"]  # so that the command line leaves the filters alone
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.simplefilter("error", RuntimeWarning)
            yield out, err
    finally:
        sys.stdin, sys.stdout, sys.stderr, sys.warnoptions = before


@contextmanager
def _past_python() -> Iterator[Callable[[], bytes]]:
    """What libraries of other languages write on the process's own stdout and stderr, LAPACK's
    remarks above all."""
    flush = ctypes.CDLL(None).fflush
    with tempfile.TemporaryFile() as file:
        kept = [os.dup(number) for number in (1, 2)]

        def so_far() -> bytes:
            flush(None)
            return os.pread(file.fileno(), 10_000, 0)

        flush(None)
        for number in (1, 2):
            os.dup2(file.fileno(), number)
        try:
            yield so_far
        finally:
            flush(None)
            for number, own in zip((1, 2), kept, strict=True):
                os.dup2(own, number)
                os.close(own)


@contextmanager
def _no_longer_than(seconds: float, still_seconds: float) -> Iterator[None]:
    def ring(number: int, frame: FrameType | None) -> None:
        raise Hang("".join(traceback.format_stack(frame)[-4:]))

    timers = {
        signal.ITIMER_PROF: (signal.SIGPROF, seconds),
        signal.ITIMER_REAL: (signal.SIGALRM, still_seconds),
    }
    before = {number: signal.signal(number, ring) for number, _ in timers.values()}
    for timer, (_, limit) in timers.items():
        signal.setitimer(timer, limit)
    try:
        yield
    finally:
        for timer in timers:
            signal.setitimer(timer, 0)
        for number, handler in before.items():
            signal.signal(number, handler)


# --- replay against run --------------------------------------------------------------------------


def _replay_faults(case: Case) -> list[str]:
    """Where `impact88.replay` over all scenes of a case differs from `impact88.run` on each."""
    from impact88.program.replay import replay

    rows = [line.split(",") for line in case.stdin.decode().splitlines()]
    names, scenes = rows[0], [dict(zip(rows[0], row, strict=True)) for row in rows[1:]]
    try:
        found = replay({name: [scene[name] for scene in scenes] for name in names})
    except Exception:
        return [f"replay: {traceback.format_exc()}"]
    wrong = []
    for index, scene in enumerate(scenes):
        try:
            done = run(Scene(scene))
        except UserError:  # it cannot be typed into the program's lines; replay takes it as INPUT
            continue
        error = str(found.error[index])
        if (error or None) != done.error or bool(found.zero_determinant[index]) != (
            done.zero_determinant
        ):
            wrong.append(f"row {index + 1}: replay {error!r}, run {done.error!r}")
        for name, known in done.reals.items():
            final = name + "F" if name in ("XA", "YA", "XB", "YB") else name
            # lines 700 and 710 put what is final in the place of what was before
            mine = final if final in found.names and found.present(final)[index] else name
            mine = "MUP" if name == "MU" else mine
            if mine in found.names and found.present(mine)[index]:
                stored = f"{int(found.reals(mine)[index]):010x}"
                if stored != ("0" * 10 if known.startswith("00") else known):
                    wrong.append(f"row {index + 1}: {name} {stored}, run {known}")
    return wrong[:5]
