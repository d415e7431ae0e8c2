"""Provenance: which program, listing and captures stand behind a result, by version and hash."""

import hashlib
import platform
from functools import lru_cache
from importlib import resources

from .. import native
from ..version import __version__

LISTING = "impact.bas"
CAPTURES = ("scenes.jsonl.gz", "fuzz.jsonl.gz")
CAPTURE_FOLDERS = ("arithmetic", "programs")


def sha256(data: bytes) -> str:
    """SHA-256 in hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def listing_hash() -> str:
    """SHA-256 of the restored listing that is packaged."""
    return sha256(resources.files("impact88.legacy").joinpath(LISTING).read_bytes())


@lru_cache(maxsize=1)
def captures_hash() -> str:
    """SHA-256 over all packaged captures of the real ROM: of the lines ``hash  path``, sorted by
    path, as `sha256sum` prints them."""
    return sha256("".join(f"{digest}  {path}\n" for path, digest in capture_hashes()).encode())


def capture_hashes() -> list[tuple[str, str]]:
    """Path in golden/ and SHA-256 of each packaged capture, sorted by path."""
    golden = resources.files("impact88.golden")
    files = [(name, golden.joinpath(name)) for name in CAPTURES]
    for folder in CAPTURE_FOLDERS:
        files += [(f"{folder}/{file.name}", file) for file in golden.joinpath(folder).iterdir()]
    return sorted((path, sha256(file.read_bytes())) for path, file in files if file.is_file())


def versions() -> dict[str, str]:
    """Versions of this package, of Python and numpy, and the machine."""
    try:  # importlib.metadata would import email and socket
        import numpy

        numpy_version = numpy.__version__
    except ImportError:
        numpy_version = "not installed"
    return {
        "impact88": __version__,
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "numpy": numpy_version,
        "solve": f"compiled, {native.accelerated}" if native.accelerated else "numpy",
        "machine": f"{platform.system()} {platform.release()} {platform.machine()}",
    }
