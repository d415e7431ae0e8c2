"""Files: reading what may be anything, and writing so that nothing is half-written or lost.

Every reader is bounded, and every error of the system names the file it met.
"""

from __future__ import annotations

import codecs
import errno
import io
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress

from .errors import UserError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import IO, Any

LARGEST = 100_000_000
"""Bytes of the largest file that is read as a whole, unless a reader says otherwise: a bound on
memory, thousands of times what is usual."""
LONGEST_LINE = 1_000_000
"""Characters of the longest line that is read: a bound on memory; rows have hundreds."""
ESCAPED = "impact88.escaped"
"""The error handler of text streams: what they cannot encode becomes \\uXXXX, as in JSON."""

_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)


def _escape(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    units = error.object[error.start : error.end].encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{units[at : at + 4]}" for at in range(0, len(units), 4)), error.end


codecs.register_error(ESCAPED, _escape)


def called(path: str) -> str:
    """What messages call a file to read: its name, and ``-`` by what it stands for."""
    return "standard input" if path == "-" else path


def encoding_of(start: bytes) -> str:
    """The encoding that a text's first bytes announce: UTF-8, or UTF-16 with its mark."""
    return next((name for mark, name in _BYTE_ORDER_MARKS if start.startswith(mark)), "utf-8")


def decode(data: bytes, where: str) -> str:
    """The text of ``data``: UTF-8, or UTF-16 with a byte-order mark; line ends become newlines.
    Raises UserError (naming ``where`` and the byte) if it is neither."""
    encoding = encoding_of(data)
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        raise UserError(
            f"byte {error.start} is not {encoding[:6].rstrip('-').upper()} text; "
            "expected a text file",
            where,
        ) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


@contextmanager
def _naming(path: str, done: str) -> Iterator[None]:
    """Errors of the system within are UserErrors that name the file."""
    try:
        yield
    except (BrokenPipeError, UserError):
        raise
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise UserError(f"cannot be {done}: {why}", path) from None


@contextmanager
def decoding(path: str, message: str = "cannot be read") -> Iterator[None]:
    """Turn whatever a library raises while it decodes a named file into a UserError.

    Libraries raise what they like at bytes that are not what they expect (zlib.error, struct.error,
    UnicodeDecodeError, SystemError ...). Only the library's calls belong within: an error of this
    package's own code is a bug.

    Parameters
    ----------
    path : str
        The file, and the place in it where that is known.
    message : str
        What is said before the library's reason.

    Raises
    ------
    UserError
        For any exception but those that say something else: memory that ran out, a closed pipe.
    """
    try:
        yield
    except (UserError, MemoryError, BrokenPipeError):
        raise
    except Exception as error:
        if isinstance(error, OSError) and error.strerror:
            raise UserError(f"cannot be read: {error.strerror}", path) from None
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise UserError(f"{message}: {reason}", path) from None


class Source(io.RawIOBase):
    """The bytes of a file or of standard input; an error in reading them is a UserError that names
    it. ``count``: the bytes read so far."""

    def __init__(self, path: str) -> None:
        """Raises UserError if there is no such file or it cannot be opened."""
        self.name = called(path)
        self.count = 0
        self._inner: Any = None
        self._keep = path == "-"
        with _naming(self.name, "read"):
            self._inner = sys.stdin.buffer if self._keep else io.FileIO(path)
        self._fill = getattr(self._inner, "readinto1", self._inner.readinto)

    @property
    def extent(self) -> tuple[int | None, Callable[[], int]]:
        """Its size in bytes, None where that is not known; and how many have been read."""
        with suppress(OSError):
            if not self._keep and os.path.isfile(self._inner.name):
                return os.fstat(self._inner.fileno()).st_size, lambda: self.count
        return None, lambda: 0

    def readable(self) -> bool:
        """True."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Read into ``buffer``; how many bytes, 0 at the end. Raises UserError."""
        with _naming(self.name, "read"):
            count: int = self._fill(buffer) or 0
        self.count += count
        return count

    def close(self) -> None:
        """Close the file; standard input stays open."""
        if self._inner and not self._keep:
            self._inner.close()
        super().close()


def open_bytes(path: str) -> io.BufferedReader:
    """A file opened for reading, ``-`` is standard input. Raises UserError, later reads too."""
    return io.BufferedReader(Source(path))


def read_bytes(path: str, limit: int = LARGEST) -> bytes:
    """The bytes of a file (``-`` is standard input). Raises UserError if it cannot be read or has
    more than ``limit`` bytes."""
    with open_bytes(path) as file:
        data = file.read(limit + 1)
    if len(data) > limit:
        raise UserError(f"is larger than {limit:,} bytes, the limit here", called(path))
    return data


def read_text(path: str, limit: int = LARGEST) -> str:
    """The text of a file, see `read_bytes` and `decode`."""
    return decode(read_bytes(path, limit), called(path))


def typed_line() -> str | None:
    """The next line of standard input without its end, None when there is none. Raises UserError
    if it is not text or too long."""
    sys.stdout.flush()
    with _naming(called("-"), "read"):
        try:
            line = sys.stdin.readline(LONGEST_LINE)
        except UnicodeDecodeError as error:
            what = f"contains bytes that are not {error.encoding} text"
            raise UserError(what, called("-")) from None
    if len(line) == LONGEST_LINE and not line.endswith("\n"):
        raise UserError(f"has a line longer than {LONGEST_LINE:,} characters", called("-"))
    return line.rstrip("\r\n") if line else None


class _Sink(io.FileIO):
    """A file being written; an error in writing it is a UserError that names it."""

    target = ""

    def write(self, data: Any) -> int:
        with _naming(self.target, "written"):
            return super().write(data)


def _sink(file: str, target: str, mode: str, private: bool) -> IO[Any]:
    """A file to write; ``private``: one that must not be there yet, for its owner only."""

    def opener(path: str, flags: int) -> int:
        return os.open(path, flags | os.O_EXCL, 0o600)

    with _naming(target, "written"):
        raw = _Sink(file, "w", opener=opener if private else None)
    raw.target = target
    buffered = io.BufferedWriter(raw)
    if "b" in mode:
        return buffered
    return io.TextIOWrapper(buffered, encoding="utf-8", errors=ESCAPED, newline="\n")


@contextmanager
def replacing(path: str, mode: str = "w") -> Iterator[IO[Any]]:
    """Open a temporary file beside ``path``; rename it to ``path`` when the block ends well.
    ``mode`` is ``"w"`` (text, UTF-8) or ``"wb"``. The bytes are on the disk before the rename. When
    the block raises, or the process is asked to leave, the temporary file is removed and ``path``
    stays as it was. A path that is not a regular file (a terminal, a pipe, /dev/null) is written
    directly: there is nothing to rename. Raises UserError when the place cannot be written to, the
    disk is full, or what stands there is read-only."""
    target, usual = _target(path)
    if os.path.exists(target) and not os.path.isfile(target):
        with _sink(target, path, mode, False) as file:
            yield file
        return
    folder, name = os.path.split(target)
    # at most 255 bytes if that name has
    beside = os.path.join(folder, f".{name[:56]}.{os.urandom(8).hex()}.part")
    # its name is known before it is there: a signal at any moment finds what to remove
    try:
        with _sink(beside, path, mode, True) as file:
            yield file
            file.flush()
            with _naming(path, "written"):
                _settle(file.fileno())
        with _naming(path, "written"):
            os.chmod(beside, usual)
            os.replace(beside, target)
    except BaseException:
        with suppress(OSError):
            os.unlink(beside)
        raise


def write_folder(folder: str, files: Mapping[str, bytes]) -> None:
    """Write files, by their paths in a folder, which is made. Raises UserError."""
    for name, data in files.items():
        path = os.path.join(folder, name)
        with _naming(folder, "made"):
            os.makedirs(os.path.dirname(path), exist_ok=True)
        with replacing(path, "wb") as file:
            file.write(data)


def _target(path: str) -> tuple[str, int]:
    """What ``path`` leads to, and the mode of a file there. Raises UserError for a folder and for
    what may not be replaced."""
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
    # a superuser may write anything, but a file without a bit for it is meant to stay
    if not mode & 0o222 or not os.access(target, os.W_OK):
        raise UserError("is read-only; expected a name that may be written", path)
    return target, mode & 0o7777


def _settle(handle: int) -> None:
    try:
        os.fsync(handle)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP, errno.ENOSYS):
            raise


def check_apart(inputs: Iterable[str], outputs: Mapping[str, str | None]) -> None:
    """Raise UserError when a file to write is one that is read, or another one to write, links of
    either kind included; or when a folder to write into holds a file that is read. ``inputs``:
    paths; ``outputs``: what a message calls the place (an option) -> its path, None where there is
    none. ``-`` is a standard stream."""
    inputs = list(inputs)
    places = {_place(path): "a file that is read" for path in inputs}
    for name, path in outputs.items():
        if path is None or path == "-":
            continue
        if os.path.isdir(path):
            root = os.path.join(os.path.realpath(path), "")
            if any(p != "-" and os.path.realpath(p).startswith(root) for p in inputs):
                raise UserError(
                    f"{name} names the folder of a file that is read; expected another", path
                )
        if (place := _place(path)) is None:
            continue
        if place in places:
            raise UserError(f"{name} names {places[place]}; expected another name", path)
        places[place] = f"the file of {name} too"


def _place(path: str) -> tuple[Any, ...] | None:
    """What identifies a regular file, or one that is not there yet; None for anything else."""
    from stat import S_ISREG

    try:
        about = os.fstat(sys.stdin.fileno()) if path == "-" else os.stat(path)
    except FileNotFoundError:
        return (os.path.realpath(path),)
    except (OSError, ValueError, AttributeError):
        return None
    return (about.st_dev, about.st_ino) if S_ISREG(about.st_mode) else None


def packaged_bytes(package: str, name: str) -> bytes:
    """A data file that is installed with this project, such as legacy's listing."""
    from importlib import import_module  # pkgutil, which has this, takes 5 ms to import

    module: Any = import_module(package)
    data: bytes = module.__loader__.get_data(os.path.join(os.path.dirname(module.__file__), name))
    return data


def packaged_text(package: str, name: str) -> str:
    """The text of a data file that is installed with this project."""
    return decode(packaged_bytes(package, name), name)


def files_of(folder: Any, name: str) -> list[Any]:
    """Return the files of a folder's subfolder by name, as paths to read from.

    A wheel holds a subfolder of many small files as one archive beside its place.
    """
    import zipfile

    files = folder.joinpath(name)
    archive = folder.joinpath(f"{name}.zip")
    if not files.is_dir() and archive.is_file():
        files = zipfile.Path(io.BytesIO(archive.read_bytes()))
    return sorted((file for file in files.iterdir() if file.is_file()), key=lambda file: file.name)
