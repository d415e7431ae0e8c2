"""The compiled library, where it was built: the optional extension ``impact88._compiled``.

It is plain C, loaded by ctypes: it calls nothing of Python's, so that one file serves every Python
of a platform, and the interpreter's lock is free while it computes. Where no compiler was found
when the package was installed, where the library was built from other formulas, or where the
environment variable IMPACT88_ACCELERATED is 0, there is none, and numpy computes the same bits.

Each package that has C sources asks for the library with the digest of its own (`loaded`).
"""

import ctypes
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.machinery import EXTENSION_SUFFIXES
from typing import Any

SWITCH = "IMPACT88_ACCELERATED"  # environment variable: 0 leaves everything to numpy


def _load() -> Any:
    """Return the library, None where it cannot be loaded."""
    if os.environ.get(SWITCH, "1") == "0":
        return None
    folder = os.path.dirname(__file__)  # pathlib takes 4 ms to import
    for suffix in (*EXTENSION_SUFFIXES, ".abi3.so", ".so"):  # free-threaded Pythons lack abi3
        # absent, built for another platform, or from older sources
        with suppress(OSError, AttributeError):
            loaded = ctypes.CDLL(os.path.join(folder, "_compiled" + suffix))
            loaded.instructions.restype = ctypes.c_char_p
            return loaded
    return None


_library = _load()

accelerated: str | None = _library.instructions().decode() if _library else None
"""Instruction set of the compiled library; None without it. A part whose sources have changed since
it was built is not taken from it (`loaded`)."""


def loaded(digest_function: str, digest: str) -> Any:
    """Return the library for a part of the package.

    Parameters
    ----------
    digest_function : str
        Name of the library's function that returns the digest of the part's generated header.
    digest : str
        The digest of the sources that are here.

    Returns
    -------
    ctypes.CDLL or None
        None where there is no library, where it was built from other sources, or where it is
        switched off (`switched_off`).
    """
    ask = getattr(_library, digest_function, None)
    if ask is None:
        return None
    ask.restype = ctypes.c_char_p
    return _library if ask().decode() == digest else None


_blocks: list[None] = []  # one for each `switched_off` in effect, in any order and thread


def is_switched_off() -> bool:
    """Return whether `switched_off` is in effect."""
    return bool(_blocks)


@contextmanager
def switched_off() -> Iterator[None]:
    """Leave everything to numpy, in all threads, for the length of a ``with`` block."""
    _blocks.append(None)
    try:
        yield
    finally:
        _blocks.pop()
