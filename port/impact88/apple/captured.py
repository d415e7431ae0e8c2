"""Read the captures of the real machine, and repeat their calculations here in the same form.

A folder of captures is laid out as golden/. Captures do not define everything, such as the mantissa
bytes of a zero; the forms here leave that out.
"""

import gzip
import json
from collections.abc import Callable, Iterator, Mapping
from importlib import resources
from typing import Any

from .applesoft import decimaltext, functions, real
from .applesoft.errorcodes import ApplesoftError
from .emulator.emulator import Applesoft
from .emulator.expressions import NUMERIC, TAKING_INT

MAX_STATEMENTS = 3_000_000  # more than any captured program executes

# kinds of captures
SCENES = "scenes"
PROGRAMS = "programs"
FUZZ = "fuzz"
ARITHMETIC = "arithmetic"

ENDINGS = ("bas", "in", "out", "scr")
"""Endings of a program's files: its text, the replies, the output, the screen at the end."""

_ROUTINES: Mapping[str, Callable[..., real.Number]] = {
    **NUMERIC,
    "ADD": real.add,
    "SUB": real.subtract,
    "MUL": real.multiply,
    "DIV": real.divide,
    "NEG": real.negate,
}
_TAKING_INT: Mapping[str, Callable[..., functions.IntAndByte]] = {
    **TAKING_INT,
    "POW": functions.power,
}


def golden() -> Any:
    """Return the packaged folder of captures."""
    return resources.files("impact88.golden")


def rows(folder: Any, name: str) -> list[dict[str, Any]]:
    """Return the captured scenes, or fuzz programs."""
    return list(map(json.loads, _lines(folder.joinpath(f"{name}.jsonl.gz"))))


def calls(folder: Any) -> dict[str, list[list[str]]]:
    """Return the captured calls of the arithmetic by file: operation, operands, extension,
    result."""
    files = [file for file in _files(folder, ARITHMETIC) if file.name.endswith(".tsv.gz")]
    return {f.name.partition(".")[0]: [row.split("\t") for row in _lines(f)] for f in files}


def programs(folder: Any) -> Iterator[tuple[str, str, dict[str, str]]]:
    """Yield the captured programs, then the fuzz programs: kind, name, texts by ending."""
    files: dict[str, dict[str, str]] = {}
    for file in _files(folder, PROGRAMS):
        name, _, ending = file.name.rpartition(".")
        if ending in ENDINGS:
            files.setdefault(name, {})[ending] = file.read_bytes().decode("latin-1")
    yield from ((PROGRAMS, name, texts) for name, texts in files.items() if "bas" in texts)
    for row in rows(folder, FUZZ):
        texts = zip(ENDINGS, (row["program"], row["keyboard"], row["output"]), strict=False)
        yield FUZZ, row["name"], dict(texts)


def _files(folder: Any, name: str) -> list[Any]:
    return sorted(folder.joinpath(name).iterdir(), key=lambda file: file.name)


def _lines(file: Any) -> list[str]:
    return gzip.decompress(file.read_bytes()).decode().splitlines()


def call(operation: str, first: str, second: str, extension: str) -> str:
    """Repeat a captured call of the ROM's arithmetic here; return its result in `result`'s form.

    The arguments are the row's columns: operands as stored bytes in hexadecimal (decimal text for
    ``fin``), and the accumulator's extension.
    """
    low = int(extension or "0", 16)
    try:
        if operation == "fin":
            return _format_number(decimaltext.read(first)[0])
        x = real.from_stored(first, 0 if second else low)
        if operation == "fout":
            return decimaltext.write(x)
        if operation == "cmp":
            order = real.compare(x, real.from_stored(second, low))
            return {1: "01", 0: "00", -1: "ff"}[order]
        operands = [x, real.from_stored(second, low)] if second else [x]
        word = operation.upper()
        if word in _TAKING_INT:
            return _format_number(_TAKING_INT[word](*operands)[0])
        return _format_number(_ROUTINES[word](*operands))
    except ApplesoftError as error:
        return f"E{error.code}"


def _format_number(x: real.Number) -> str:
    """Return a number as ``stored:raw:extension``, in hexadecimal."""
    e, m, s = x
    if not e:
        return "zero"
    return f"{real.to_stored(x).hex()}:{e:02x}{m >> 8:08x}{s}:{m & 0xFF:02x}"


def result(text: str) -> str:
    """Return a captured call's result in the form that compares: all zeros are equal, and only the
    top bit of the sign byte counts."""
    if text.count(":") != 2:
        return text
    stored_bytes, raw, extension = text.split(":")
    if raw.startswith("00"):
        return "zero"
    return f"{stored_bytes}:{raw[:10]}{int(raw[10:], 16) >> 7}:{extension}"


def normalize_zero(stored: str) -> str:
    """Return stored bytes in hexadecimal, with all bytes of a zero 0: the ROM leaves mantissas in
    zeros."""
    return "00" * 5 if stored.startswith("00") else stored


def memory_contents(reals: Mapping[str, str], a: Mapping[str, Any] | None) -> dict[str, str]:
    """Return a run's variables and the elements of its array A by name, in a form that compares."""
    contents = {name: normalize_zero(text) for name, text in sorted(reals.items())}
    if a:
        row_count, contents["DIM A"] = a["dims"][0], str(list(a["dims"]))
        cells = enumerate(map(normalize_zero, a["data"]))
        contents |= {f"A({at % row_count},{at // row_count})": text for at, text in cells}
    return contents


def session(program: str, keys: str = "", *, blanks: bool = True) -> tuple[Applesoft, str]:
    """Type a program into the emulator and RUN it, then type the keys until they are used up.

    The keys answer INPUT, GET or the prompt. Returns the machine and the output between the echo of
    RUN and the final prompt, without the prompts' NULs. ``blanks``: write skipped columns as
    blanks.
    """

    def type_lines() -> Iterator[str]:
        yield from filter(None, program.split("\n"))
        machine.take_output()
        machine.machine.statements_left = MAX_STATEMENTS
        machine.feed_keys(keys)
        yield "RUN"

    lines = type_lines()
    machine = Applesoft(lambda: next(lines, None), blanks=blanks)
    machine.prompt()
    output = machine.take_output().removeprefix("RUN\n").removesuffix("\n]")
    return machine, output.replace("\0", "")
