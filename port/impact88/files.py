"""Files: bounded reading of untrusted input, and writing that leaves no file incomplete or lost.

Every system error becomes a UserError that names the file.
"""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress

from .errors import UserError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import IO, Any

MAX_FILE_BYTES = 100_000_000  # bounds memory; thousands of times the usual size
LONGEST_LINE = 1_000_000  # characters; bounds memory, rows have hundreds
ESCAPED = "backslashreplace"
"""Error handler of text streams: lone surrogates are written as \\uXXXX, as in JSON."""

_PICTURES = "; pictures are read as PNG, JPEG, TIFF or PDF: save it as one of these"
CONTENTS = (
    (0, b"\x89PNG", "a PNG picture", ""),
    (0, b"\xff\xd8\xff", "a JPEG picture", ""),
    (0, b"II*\0", "a TIFF picture", ""),
    (0, b"MM\0*", "a TIFF picture", ""),
    (0, b"%PDF-", "a PDF", ""),
    (0, b"GIF8", "a GIF picture", _PICTURES),
    (0, b"BM", "a BMP picture", _PICTURES),
    (8, b"WEBP", "a WebP picture", _PICTURES),
    (4, b"ftyphei", "a HEIC picture", _PICTURES),
    (
        0,
        b"PK\x03\x04",
        "a packed file, such as a Word or Excel file",
        ": save it as plain text or as CSV, or pandoc -t plain FILE",
    ),
    (
        0,
        b"\xd0\xcf\x11\xe0",
        "an older Word or Excel file",
        ": save it as plain text or as CSV, or antiword FILE",
    ),
    (0, b"\x1f\x8b", "packed", ": gunzip FILE"),
    (0, b"PAR1", "a Parquet file", ": its name ends in .parquet"),
)
"""Files that are no text, by their content: where and with which bytes each is marked, what it is,
and what makes text of it."""


def check_text(data: bytes, where: str, expected: str = "text") -> None:
    """Raise UserError, saying what it is, for a file whose first bytes are those of another kind
    than text."""
    for place, mark, name, advice in CONTENTS:
        # two letters alone may begin a text
        if data.startswith(mark, place) and (len(mark) > 2 or b"\0" in data[:32]):
            raise UserError(f"is {name}; expected {expected}{advice}", where)


def display_name(path: str) -> str:
    """Return the name of an input file for messages; "standard input" for ``-``."""
    return "standard input" if path == "-" else path


def decode(data: bytes, where: str) -> str:
    """Return the text of UTF-8 bytes, or UTF-16 with a byte-order mark; line ends become newlines.
    Raises UserError, naming ``where`` and the byte, if it is neither."""
    check_text(data, where)
    encoding = "utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        name = encoding.removesuffix("-sig").upper()
        message = f"byte {error.start} is not {name} text; expected a text file"
        raise UserError(message, where) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


@contextmanager
def _naming(path: str, action: str) -> Iterator[None]:
    """Context that turns system errors into UserErrors naming the file."""
    try:
        yield
    except (BrokenPipeError, UserError):
        raise
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise UserError(f"cannot be {action}: {why}", path) from None


@contextmanager
def decoding(path: str, message: str = "cannot be read") -> Iterator[None]:
    """Turn whatever a library raises while it decodes a named file into a UserError.

    Libraries raise arbitrary exceptions for unexpected bytes (zlib.error, struct.error,
    UnicodeDecodeError, SystemError ...). Only calls of the library belong in the block: an error of
    this package's own code is a bug.

    Parameters
    ----------
    path : str
        The file, and the place in it if that is known.
    message : str
        Text before the library's reason.

    Raises
    ------
    UserError
        For any exception except those that have other causes, such as MemoryError.
    """
    try:
        yield
    except (UserError, MemoryError, BrokenPipeError, KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # a panic of a library in Rust is no Exception
        if why := getattr(error, "strerror", None):
            raise UserError(f"cannot be read: {why}", path) from None
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise UserError(f"{message}: {reason}", path) from None


class Source(io.RawIOBase):
    """A binary stream from a file or standard input, whose read errors are UserErrors naming it."""

    def __init__(self, path: str) -> None:
        """Raises UserError if there is no such file or it cannot be opened."""
        self.name = display_name(path)
        self._inner: Any = None
        self._keep = path == "-"
        with _naming(self.name, "read"):
            self._inner = sys.stdin.buffer if self._keep else io.BufferedReader(io.FileIO(path))

    def readable(self) -> bool:
        """Return True."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Read into ``buffer`` and return the number of bytes, 0 at the end. Raises UserError."""
        with _naming(self.name, "read"):
            count: int = self._inner.readinto1(buffer)
        return count

    def close(self) -> None:
        """Close the file; standard input stays open."""
        if self._inner and not self._keep:
            self._inner.close()
        super().close()


def open_bytes(path: str) -> io.BufferedReader:
    """Open a file for reading (``-``: standard input). Raises UserError, as do later reads."""
    return io.BufferedReader(Source(path))


def read_bytes(path: str, limit: int = MAX_FILE_BYTES) -> bytes:
    """Return the bytes of a file (``-``: standard input). Raises UserError if it cannot be read or
    has more than ``limit`` bytes."""
    with open_bytes(path) as file:
        data = file.read(limit + 1)
    if len(data) > limit:
        raise UserError(f"is larger than {limit:,} bytes, the limit here", display_name(path))
    return data


def read_text(path: str, limit: int = MAX_FILE_BYTES) -> str:
    """Return the text of a file, see `read_bytes` and `decode`."""
    return decode(read_bytes(path, limit), display_name(path))


def typed_line() -> str | None:
    """Return the next line of standard input without its end, None at the end of input. Raises
    UserError if it is not text or too long."""
    sys.stdout.flush()
    with _naming(display_name("-"), "read"):
        line = sys.stdin.readline(LONGEST_LINE)
    if len(line) == LONGEST_LINE and not line.endswith("\n"):
        raise UserError(f"has a line longer than {LONGEST_LINE:,} characters", display_name("-"))
    return line.rstrip("\r\n") if line else None


def _open_output(path: str, mode: str, private: bool) -> IO[Any]:
    """Open a file for writing; ``private``: it must not exist yet, and only its owner may access
    it."""

    def opener(path: str, flags: int) -> int:
        return os.open(path, flags | os.O_EXCL, 0o600)

    binary = io.BufferedWriter(io.FileIO(path, "w", opener=opener if private else None))
    if "b" in mode:
        return binary
    return io.TextIOWrapper(binary, encoding="utf-8", errors=ESCAPED, newline="\n")


@contextmanager
def replacing(path: str, mode: str = "w") -> Iterator[IO[Any]]:
    """Context that writes a temporary file and renames it to ``path`` when the block succeeds.

    ``mode`` is ``"w"`` (text, UTF-8) or ``"wb"``. The bytes are on the disk before the rename. If
    the block raises, or the process is terminated, the temporary file is removed and
    ``path`` is unchanged. A path that is not a regular file (a terminal, a pipe, /dev/null) is
    written directly. Raises UserError if the place cannot be written to, the disk is full, or the
    file is read-only: system errors in the block are errors of writing, because all reading raises
    UserError."""
    target, mode_bits = _target(path)
    is_direct = os.path.exists(target) and not os.path.isfile(target)
    folder, name = os.path.split(target)
    # the name is chosen before the file exists, so that a signal at any time removes it; it is
    # short enough for the limit of 255 bytes
    temporary = os.path.join(folder, f".{name[:56]}.{os.urandom(8).hex()}.part")
    try:
        with _open_output(target if is_direct else temporary, mode, not is_direct) as file:
            yield file
            file.flush()
            if not is_direct:
                _settle(file.fileno())
        if not is_direct:
            os.chmod(temporary, mode_bits)
            os.replace(temporary, target)
    except BaseException as error:
        with suppress(OSError):
            os.unlink(temporary)
        if isinstance(error, OSError) and not isinstance(error, BrokenPipeError):
            raise UserError(f"cannot be written: {error.strerror or error}", path) from None
        raise


def write_folder(folder: str, files: Mapping[str, bytes]) -> None:
    """Write files by their paths in a folder, creating folders as needed. Raises UserError."""
    for name, data in files.items():
        path = os.path.join(folder, name)
        with _naming(folder, "made"):
            os.makedirs(os.path.dirname(path), exist_ok=True)
        with replacing(path, "wb") as file:
            file.write(data)


def _target(path: str) -> tuple[str, int]:
    """Return the real path, links resolved,, and the mode of the file there or of a new one. Raises
    UserError for a folder and for a read-only file."""
    with _naming(path, "written"):
        try:
            target = os.path.realpath(path)
            mode = os.stat(target).st_mode
        except FileNotFoundError:
            mask = os.umask(0)
            os.umask(mask)
            return target, 0o666 & ~mask
    if os.path.isdir(target):
        raise UserError("is a folder; expected a file to write", path)
    # root may write anything, but a file without write permission is meant to be kept
    if not mode & 0o222 or not os.access(target, os.W_OK):
        raise UserError("is read-only; expected a name that may be written", path)
    return target, mode & 0o7777


def _settle(handle: int) -> None:
    """Flush a file to the disk, where the file system supports it."""
    try:
        os.fsync(handle)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP, errno.ENOSYS):
            raise


def check_apart(inputs: Iterable[str], outputs: Mapping[str, str | None]) -> None:
    """Raise UserError if an output is also an input or another output, by links, too.

    ``inputs``: paths; ``outputs``: paths by the name of the option, None if it is not given. ``-``
    is a standard stream."""
    places = {_place(path): "a file that is read" for path in inputs}
    for name, path in outputs.items():
        place = _place(path) if path else None
        if place is None:
            continue
        if place in places:
            raise UserError(f"{name} names {places[place]}; expected another name", path)
        places[place] = f"the file of {name} too"


def _place(path: str) -> object:
    """Return an identifier of a regular or not yet existing file; None for anything else."""
    if path == "-":
        return None
    try:
        stat = os.stat(path)
    except FileNotFoundError:
        return os.path.realpath(path)
    except (OSError, ValueError):
        return None
    return (stat.st_dev, stat.st_ino) if os.path.isfile(path) else None


def packaged_bytes(package: str, name: str) -> bytes:
    """Return the bytes of a data file installed with this package, such as legacy's listing."""
    from importlib import import_module  # pkgutil, which has this, takes 5 ms to import

    (folder,) = import_module(package).__path__
    return read_bytes(os.path.join(folder, name))


def packaged_text(package: str, name: str) -> str:
    """Return the text of a data file installed with this package."""
    return decode(packaged_bytes(package, name), name)
