"""Run compiled programs on many scenes at once, in `applesoft.c`."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import starmap
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import library
from ..apple.applesoft import decimaltext
from ..files import packaged_text
from .compiler import CODES, Steps
from .generate import compile_listing, digest
from .scene import LISTING

FIELD = 16  # bytes of a printed number, as in applesoft.c
PAGE = 2048  # characters of a page, as there
BLOCK = 4096
"""Scenes of one call: enough for its overhead to vanish, few enough for the processor's cache."""
OUTSIDE = 0x200
"""The code of a run that applesoft.c leaves to the port or the emulator: it needs something else,
does not end, or has a text that is no number."""


class Real(ctypes.Structure):
    """A number as applesoft.c has it."""

    _fields_ = (("m", ctypes.c_uint64), ("e", ctypes.c_int32), ("s", ctypes.c_int32))


class Source(ctypes.Structure):
    """A program as applesoft.c has it."""

    _fields_ = (
        ("steps", ctypes.c_void_p),
        ("constants", ctypes.c_void_p),
        ("texts", ctypes.c_char_p),
        ("starts", ctypes.c_void_p),
    )


class Results(NamedTuple):
    """The results of runs, a row for each.

    ``ending``: the error's code, 0 for none, its line, the size of the page, rows of the array;
    ``assigned``: a bit for each variable; ``reals``: variables as stored bytes; ``array``: its
    elements, first subscript fastest; ``fields``: the numbers printed, in order."""

    ending: npt.NDArray[np.int32]
    assigned: npt.NDArray[np.uint64]
    reals: npt.NDArray[np.uint64]
    array: npt.NDArray[np.uint64]
    fields: npt.NDArray[np.bytes_]


def empty_results(count: int, variables: int, elements: int, fields: int) -> Results:
    """Return results of ``count`` runs, to be filled."""
    return Results(
        np.zeros((count, 4), np.int32),
        np.zeros(count, np.uint64),
        np.zeros((count, variables), np.uint64),
        np.zeros((count, elements), np.uint64),
        np.zeros((count, fields), f"S{FIELD}"),
    )


class Program:
    """A compiled program, ready to run.

    ``names``: those of its inputs' columns, by default the variables; ``in_library``: the library
    was compiled with these steps, as those of the listing, and runs them twice as fast."""

    def __init__(
        self, steps: Steps, names: Sequence[str] | None = None, in_library: bool = False
    ) -> None:
        self.steps = steps
        self.names = names or steps.inputs
        codes = [(CODES[operation], number) for operation, number in steps.steps]
        self._arrays = (
            np.array(codes, np.int32),
            real_array(*(decimaltext.read(text)[0] for text in steps.constants)),
            "".join(steps.texts).encode("ascii"),
            np.cumsum([0, *map(len, steps.texts)], dtype=np.int32),
        )
        code, constants, texts, starts = self._arrays
        self.source = Source(
            None if in_library else code.ctypes.data,
            ctypes.addressof(constants),
            texts,
            starts.ctypes.data,
        )

    def run(
        self,
        columns: Sequence[Sequence[str]],
        results: Results,
        pages: npt.NDArray[np.bytes_] | None = None,
    ) -> None:
        """Run the program on some scenes, and fill their results and pages.

        ``columns``: for each input the texts of all scenes, or one for all; ``pages``: `PAGE`
        characters for each scene. Raises TypeError and ValueError for what is no text of one line
        in ASCII."""
        texts = ["\n".join(column).upper().encode("ascii") + b"\n" for column in columns]
        if any(t.count(b"\n") != len(c) for t, c in zip(texts, columns, strict=True)):
            raise ValueError("a text of two lines")
        *sizes, fields = (array.shape[1] for array in results[2:])
        *arrays, fields_address = (ctypes.c_void_p(array.ctypes.data) for array in results)
        compiled_library().applesoft_run(
            ctypes.byref(self.source),
            (ctypes.c_char_p * len(texts))(*texts),
            bytes(len(column) == 1 for column in columns),
            ctypes.c_int64(len(results.ending)),
            len(columns),
            *sizes,
            fields,
            *arrays,
            None if pages is None else ctypes.c_void_p(pages.ctypes.data),
            fields_address,
        )


def real_array(*numbers: tuple[int, int, int]) -> Any:
    """Return numbers, as exponent, mantissa and sign, as an array for applesoft.c."""
    return (Real * len(numbers))(*(Real(m, e, s) for e, m, s in numbers))


def run_blocks(work: Callable[[int, int], object], count: int, threads: int | None) -> None:
    """Call ``work(start, stop)`` for blocks of ``count`` scenes, on several threads where several
    blocks are to be done. The library releases Python's lock."""
    blocks = [(start, min(start + BLOCK, count)) for start in range(0, count, BLOCK)]
    workers = min(len(blocks), threads or os.cpu_count() or 1)
    if workers < 2:
        list(starmap(work, blocks))
        return
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(lambda block: work(*block), blocks))


@cache
def listing() -> Program:
    """Return the 1988 listing, compiled."""
    return Program(compile_listing(packaged_text("impact88.legacy", LISTING)), in_library=True)


@cache
def _library() -> Any:
    return library.loaded("applesoft_listing", digest(listing().steps))


def compiled_library() -> Any:
    """Return the compiled library; None where it was not built from this listing, or is switched
    off."""
    return None if library.is_switched_off() else _library()
