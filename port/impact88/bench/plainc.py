"""The benchmark's rival in plain C, `plain.c`: compiled when it is asked for, where a compiler is.

There are as many rivals as sets of flags. The loop that moves memory and computes nothing is
compiled with the last of them.
"""

import ctypes
import shutil
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..names import FINAL_VELOCITIES, SCENE

Floats = NDArray[np.float64]
COMPILERS = ("cc", "gcc", "clang")
FLAGS = ("-O3", "-O3 -march=native -ffast-math -fopenmp-simd")
"""Sets of compiler flags: fast code, and the fastest without exact rounding. With the second,
glibc's sine takes several angles at a time."""
COLUMNS = tuple(name for name in SCENE if name != "M")
TIMEOUT = 60  # seconds that a compiler may take


@cache
def compiler() -> str | None:
    """Return the path of this machine's C compiler, or None."""
    return next(filter(None, map(shutil.which, COMPILERS)), None)


@cache
def version() -> str | None:
    """Return the compiler's version line, or None where there is no compiler."""
    path = compiler()
    if path is None:
        return None
    process = subprocess.run([path, "--version"], capture_output=True, text=True, check=False)
    return next(iter(process.stdout.splitlines()), Path(path).name)


@cache
def library(flags: str) -> Any:
    """Return the compiled functions, or None where they cannot be compiled."""
    path = compiler()
    if path is None:
        return None
    # Windows keeps the file of a library that is in use
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        source, object_file, built = (Path(folder, f"plain.{end}") for end in ("c", "o", "so"))
        source.write_bytes(resources.files(__package__).joinpath("plain.c").read_bytes())
        compilation = [path, *flags.split(), "-fPIC", "-c", "-o", str(object_file), str(source)]
        # linked apart: told of -ffast-math, gcc links what makes the whole process take subnormal
        # numbers for 0 as soon as the library is loaded
        linking = [path, "-shared", "-o", str(built), str(object_file), "-lm"]
        try:
            for command in (compilation, linking):
                subprocess.run(command, capture_output=True, check=True, timeout=TIMEOUT)
            library = ctypes.CDLL(str(built))
        except (OSError, subprocess.SubprocessError):
            return None
    for function in (library.solve_plainly, library.move_plainly):
        function.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64]
        function.restype = None
    return library


def available() -> bool:
    """Return whether all rivals in plain C can be measured here."""
    return all(library(flags) is not None for flags in FLAGS)


def _call(function: Any, read: Sequence[Floats], results: Iterable[Floats]) -> None:
    into, out = (np.array([x.ctypes.data for x in arrays]) for arrays in (read, results))
    function(into.ctypes.data, out.ctypes.data, len(read[0]))


def prepare(columns: Mapping[str, Floats]) -> list[Floats]:
    """Return the columns as C needs them: contiguous doubles, in the scene's order."""
    return [np.ascontiguousarray(columns[name], np.float64) for name in COLUMNS]


def solve(read: Sequence[Floats], flags: str) -> dict[str, Floats]:
    """Return the six final velocities for the columns of `prepare`."""
    results = {name: np.empty(len(read[0])) for name in FINAL_VELOCITIES}
    _call(library(flags).solve_plainly, read, results.values())
    return results


def move(read: Sequence[Floats], results: Mapping[str, Floats]) -> None:
    """Read all columns and write six results, their sum in place of the mechanics."""
    _call(library(FLAGS[-1]).move_plainly, read, results.values())
