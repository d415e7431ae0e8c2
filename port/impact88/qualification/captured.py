"""The captures of the real machine: read, and their own form of what is done again here.

A folder is laid out as golden/. Captures leave some things open, such as what bytes stand in a
zero."""

import gzip
import json
from collections.abc import Callable, Iterator, Mapping
from importlib import resources
from typing import TYPE_CHECKING, Any

from ..applesoft import decimaltext, functions, real
from ..applesoft.errorcodes import ApplesoftError
from ..files import files_of

if TYPE_CHECKING:
    from ..emulator.emulator import Applesoft

PLENTY = 3_000_000
"""Statements that no captured program needs."""
SCENES, PROGRAMS, FUZZ, ARITHMETIC = "scenes", "programs", "fuzz", "arithmetic"
ENDINGS = ("bas", "in", "out", "scr")
"""Of a program's files: itself, the replies, what is displayed, the screen at the end."""

_ROUTINES: Mapping[str, Callable[..., real.Number]] = {
    **{"add": real.add, "sub": real.subtract, "mul": real.multiply, "div": real.divide},
    **{"pow": functions.power, "neg": real.negate, "abs": real.absolute, "sgn": functions.sign},
    **{"int": real.floor, "sqr": functions.square_root, "exp": functions.exponential},
    **{"log": functions.logarithm, "sin": functions.sine, "cos": functions.cosine},
    **{"tan": functions.tangent, "atn": functions.arc_tangent},
}


def golden() -> Any:
    """The packaged folder of captures."""
    return resources.files("impact88.golden")


def rows(folder: Any, name: str) -> list[dict[str, Any]]:
    """The captured scenes, or fuzz."""
    return list(map(json.loads, _lines(folder.joinpath(f"{name}.jsonl.gz"))))


def calls(folder: Any) -> dict[str, list[list[str]]]:
    """The captured calls of the arithmetic, by file: operation, operands, extension, result."""
    files = [file for file in files_of(folder, ARITHMETIC) if file.name.endswith(".tsv.gz")]
    return {f.name.partition(".")[0]: [row.split("\t") for row in _lines(f)] for f in files}


def programs(folder: Any) -> Iterator[tuple[str, str, dict[str, str]]]:
    """The captured programs, then the fuzz: kind, name, texts by ending."""
    found: dict[str, dict[str, str]] = {}
    for file in files_of(folder, PROGRAMS):
        name, _, ending = file.name.rpartition(".")
        if ending in ENDINGS:
            found.setdefault(name, {})[ending] = file.read_bytes().decode("latin-1")
    yield from ((PROGRAMS, name, texts) for name, texts in found.items() if "bas" in texts)
    for row in rows(folder, FUZZ):
        texts = zip(ENDINGS, (row["program"], row["keyboard"], row["output"]), strict=False)
        yield FUZZ, row["name"], dict(texts)


def _lines(file: Any) -> list[str]:
    return gzip.decompress(file.read_bytes()).decode().splitlines()


def call(operation: str, first: str, second: str, extension: str) -> str:
    """The result of a captured call of the ROM's arithmetic, made again here, in `result`'s form.
    The arguments are the row's columns: operands as stored bytes in hexadecimal (decimal text for
    ``fin``), and the accumulator's extension."""
    low = int(extension or "0", 16)
    try:
        if operation == "fin":
            return _shown(decimaltext.read(first)[0])
        x = real.from_stored(first, 0 if second else low)
        if operation == "fout":
            return decimaltext.write(x)
        if operation == "cmp":
            order = real.compare(x, real.from_stored(second, low))
            return {1: "01", 0: "00", -1: "ff"}[order]
        others = [real.from_stored(second, low)] if second else []
        return _shown(_ROUTINES[operation](x, *others))
    except ApplesoftError as error:
        return f"E{error.code}"


def _shown(x: real.Number) -> str:
    e, m, s = x
    if not e:
        return "zero"
    return f"{real.to_stored(x).hex()}:{e:02x}{m >> 8:08x}{s}:{m & 0xFF:02x}"


def result(text: str) -> str:
    """A captured call's result: zeros are one, and of the sign byte only its top bit counts."""
    if text.count(":") != 2:
        return text
    stored, raw, extension = text.split(":")
    if raw.startswith("00"):
        return "zero"
    return f"{stored}:{raw[:10]}{int(raw[10:], 16) >> 7}:{extension}"


def stored(text: str) -> str:
    """Stored bytes in hexadecimal, all zeros alike: the ROM leaves odd mantissas in them."""
    return "00" * 5 if text.startswith("00") else text


def left_behind(reals: Mapping[str, str], a: Mapping[str, Any] | None) -> dict[str, str]:
    """A run's variables and its array by name, in a form that compares."""
    found = {name: stored(text) for name, text in sorted(reals.items())}
    if a:
        rows, found["DIM A"] = a["dims"][0], str(list(a["dims"]))
        cells = enumerate(map(stored, a["data"]))
        found |= {f"A({at % rows},{at // rows})": text for at, text in cells}
    return found


def session(program: str, keys: str = "", *, blanks: bool = True) -> tuple["Applesoft", str]:
    """A program typed in and RUN, then the keys at INPUT, GET or the prompt until they are used up:
    the machine, and all that was displayed after the echo of RUN up to the final prompt, without
    the NULs of the prompts. ``blanks``: whether skipped columns are written as blanks."""

    def typed() -> Iterator[str]:
        yield from filter(None, program.split("\n"))
        machine.take_output()
        machine.machine.statements_left = PLENTY
        machine.feed_keys(keys)
        yield "RUN"

    from ..emulator.emulator import Applesoft

    lines = typed()
    machine = Applesoft(lambda: next(lines, None), blanks=blanks)
    machine.prompt()
    displayed = machine.take_output().removeprefix("RUN\n").removesuffix("\n]")
    return machine, displayed.replace("\0", "")
