"""The compiled machine for plans, where it was built: `machine.c`, loaded by ctypes.

It is optional. Where no compiler was there when the package was installed, or where the
environment variable IMPACT88_ACCELERATED is 0, `library` is None and numpy computes the same bits.
"""

import ctypes
import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import Any

VARIABLE = "IMPACT88_ACCELERATED"
"""Environment variable: 0 leaves everything to numpy."""


def _load() -> ctypes.CDLL | None:
    if os.environ.get(VARIABLE, "1") == "0":
        return None
    for suffix in (*EXTENSION_SUFFIXES, ".abi3.so", ".so"):  # free-threaded has no abi3
        path = Path(__file__).with_name(f"_machine{suffix}")
        if path.exists():
            try:
                return _declared(ctypes.CDLL(str(path)))
            except (OSError, AttributeError):  # built for another machine, or from older sources
                continue
    return None


def _declared(found: ctypes.CDLL) -> ctypes.CDLL:
    """The library, with what its functions take and return. Raises AttributeError for one that has
    not all of them."""
    number, address = ctypes.c_int64, ctypes.c_void_p
    found.find_extremes.argtypes = [address, number, number, number, address]
    found.run_program.argtypes, found.run_program.restype = [address], None
    found.solve_impacts.argtypes, found.solve_impacts.restype = [address, number, number], None
    found.solve_prepared.argtypes = [*[address] * 4, number]
    found.solve_prepared_part.argtypes = [*[address] * 4, *[number] * 3]
    found.solve_bound.argtypes = [address]
    for function in (found.solve_prepared, found.solve_prepared_part, found.solve_bound):
        function.restype = None
    found.kernel_of.argtypes, found.kernel_of.restype = [number, ctypes.c_uint64], address
    found.formulas.restype = ctypes.c_char_p
    found.read_numbers.argtypes = [ctypes.c_char_p, number, address, address]
    found.write_numbers.argtypes = [address, number, address, address]
    found.instructions.restype = found.operations.restype = ctypes.c_char_p
    for counts in (found.strip, found.most_places):
        counts.restype = number
    return found


library: Any = _load()
"""What was loaded, or None: asked at every call, so that it may be switched off meanwhile."""
STRIP: int = library.strip() if library else 0
"""Scenes the machine takes at a time."""


accelerated: str | None = library.instructions().decode() if library else None
"""Which instructions of this processor the compiled machine uses; None where numpy does it all."""


@contextmanager
def switched_off() -> Iterator[None]:
    """Everything by numpy, in all threads, as long as this lasts."""
    global library
    kept, library = library, None
    try:
        yield
    finally:
        library = kept
