"""The compiled library, where it was built: `machine.c`, loaded by ctypes.

It is optional. Where no compiler was found when the package was installed, where it was built from
other formulas, or where the environment variable IMPACT88_ACCELERATED is 0, `library` is None and
numpy computes the same bits.
"""

import ctypes
import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.machinery import EXTENSION_SUFFIXES
from typing import Any

from ...names import RESULTS

VARIABLE = "IMPACT88_ACCELERATED"
"""Environment variable: 0 leaves everything to numpy."""
FORMULAS = "a14c68646dac0027"
"""Digest of `loops.h`: a library that was built from the same formulas has it, too."""
QUANTITIES = (*RESULTS, "gn", "gt", "determinant", "critical_denominator")
"""Results, and other quantities of `closedform.impact` by the names there."""


def _load() -> ctypes.CDLL | None:
    if os.environ.get(VARIABLE, "1") == "0":
        return None
    for suffix in (*EXTENSION_SUFFIXES, ".abi3.so", ".so"):  # free-threaded has no abi3
        path = os.path.join(os.path.dirname(__file__), f"_machine{suffix}")
        if os.path.exists(path):  # pathlib takes 4 ms to import
            try:
                loaded = _declare_functions(ctypes.CDLL(path))
            except (OSError, AttributeError):  # built for another machine, or from older sources
                continue
            # a result that was added since the library was built is none of its results
            results = tuple(loaded.results().decode().split())
            if results == QUANTITIES and loaded.formulas().decode() == FORMULAS:
                return loaded
    return None


def _declare_functions(loaded: ctypes.CDLL) -> ctypes.CDLL:
    """Declare argument and result types of the library's functions and return it. Raises
    AttributeError where one is missing."""
    number, address = ctypes.c_int64, ctypes.c_void_p
    loaded.solve_impacts.argtypes, loaded.solve_impacts.restype = [address, number, number], None
    loaded.solve_rows.argtypes = [*[address] * 4, *[number] * 3]
    loaded.solve_rows.restype = None
    loaded.formulas.restype = loaded.results.restype = ctypes.c_char_p
    loaded.instructions.restype = ctypes.c_char_p
    return loaded


library: Any = _load()
"""The loaded library, or None. Read it at every call: `switched_off` may change it."""
accelerated: str | None = library.instructions().decode() if library else None
"""Instruction set that the compiled library uses; None where numpy computes everything."""


@contextmanager
def switched_off() -> Iterator[None]:
    """Use numpy alone, in all threads, for the length of a ``with`` block."""
    global library
    original, library = library, None
    try:
        yield
    finally:
        library = original
