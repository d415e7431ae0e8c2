"""Run compiled programs on many scenes at once, in `applesoft.c`."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import library
from ..apple.applesoft import decimaltext
from ..files import packaged_text
from .compiler import CODES, Steps
from .generate import compile_listing, digest
from .scene import LISTING

Rows = npt.NDArray[np.void]
FIELD = 16  # bytes of a printed number, as in applesoft.c
PAGE = 2048  # characters of a page, as there
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


def row_type(variables: int, elements: int, fields: int) -> npt.DTypeLike:
    """Return the type of a run's results, as applesoft.c writes them.

    ``code``, ``line``: the error's code, 0 for none, and the line of the end; ``size``: characters
    of the page; ``rows``: those of the array, 0 before DIM; ``assigned``: a bit for each variable;
    ``reals``: variables as stored bytes; ``array``: its elements, first subscript fastest;
    ``fields``: the numbers printed, in order."""
    return [
        *((name, "i4") for name in ("code", "line", "size", "rows")),
        ("assigned", "u8"),
        ("reals", "u8", (variables,)),
        ("array", "u8", (elements,)),
        ("fields", f"S{FIELD}", (fields,)),
    ]


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
            np.cumsum([0, *map(len, steps.texts)], dtype=np.int32),
        )
        code, constants, starts = self._arrays
        self.source = Source(
            None if in_library else code.ctypes.data,
            ctypes.addressof(constants),
            "".join(steps.texts).encode("ascii"),
            starts.ctypes.data,
        )

    def run(self, columns: Sequence[Sequence[str]], rows: Rows, pages: Any = None) -> None:
        """Run the program on some scenes, and fill a row of results for each.

        ``columns``: for each input the texts of all scenes, or one for all, of one line of ASCII
        each; ``pages``: a buffer of `PAGE` characters for each scene, None if they are not kept."""
        texts = ["\n".join((*column, "")).upper().encode("ascii") for column in columns]
        compiled_library().applesoft_run(
            ctypes.byref(self.source),
            (ctypes.c_char_p * len(texts))(*texts),
            bytes(len(column) == 1 for column in columns),
            ctypes.c_int64(len(rows)),
            len(columns),
            *(rows[name].shape[1] for name in ("reals", "array", "fields")),
            ctypes.c_void_p(rows.ctypes.data),
            pages,
        )


def real_array(*numbers: tuple[int, int, int]) -> Any:
    """Return numbers, as exponent, mantissa and sign, as an array for applesoft.c."""
    return (Real * len(numbers))(*(Real(m, e, s) for e, m, s in numbers))


@cache
def listing() -> Program:
    """Return the 1988 listing, compiled."""
    return Program(compile_listing(packaged_text("impact88.legacy", LISTING)), in_library=True)


@cache
def _library() -> Any:
    return library.loaded("applesoft_source", digest(listing().steps))


def compiled_library() -> Any:
    """Return the compiled library; None where it was not built from this listing, or is switched
    off."""
    return None if library.is_switched_off() else _library()
