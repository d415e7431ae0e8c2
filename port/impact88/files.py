"""Files: reading text whatever its encoding, and writing so that nothing is half-written."""

from __future__ import annotations

import codecs
import os
from collections.abc import Iterator
from contextlib import contextmanager

from .errors import UserError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import IO, Any

_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)


def decode(data: bytes, where: str) -> str:
    """The text of ``data``: UTF-8, or UTF-16 with a byte-order mark; line ends become newlines.

    Raises UserError (naming ``where`` and the byte) if it is neither.
    """
    encoding = next((name for mark, name in _BYTE_ORDER_MARKS if data.startswith(mark)), "utf-8")
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        raise UserError(
            f"byte {error.start} is not {encoding[:6].upper()} text; expected a text file", where
        ) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_bytes(path: str, limit: int | None = None) -> bytes:
    """The bytes of a file (``-`` is standard input). Raises UserError if it cannot be read or has
    more than ``limit`` bytes."""
    import sys

    try:
        if path == "-":
            data = sys.stdin.buffer.read(-1 if limit is None else limit + 1)
        else:
            with open(path, "rb") as file:
                data = file.read(-1 if limit is None else limit + 1)
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", path) from None
    if limit is not None and len(data) > limit:
        raise UserError(f"is larger than {limit:,} bytes, the most that is read here", path)
    return data


def read_text(path: str, limit: int | None = None) -> str:
    """The text of a file, see `read_bytes` and `decode`."""
    return decode(read_bytes(path, limit), "standard input" if path == "-" else path)


@contextmanager
def replacing(path: str, mode: str = "w", **options: Any) -> Iterator[IO[Any]]:
    """Open a temporary file beside ``path``; rename it to ``path`` when the block ends well.

    When the block raises, the temporary file is removed and ``path`` stays as it was. A path that
    is not a regular file (a terminal, a pipe, /dev/null) is written directly: there is nothing to
    rename. Raises UserError when the place cannot be written to.
    """
    import tempfile

    if "b" not in mode:
        options.setdefault("encoding", "utf-8")
        options.setdefault("newline", "\n")
    path = os.path.realpath(path)
    if os.path.exists(path) and not os.path.isfile(path):
        if os.path.isdir(path):
            raise UserError("is a folder; expected a file to write", path)
        with open(path, mode, **options) as file:
            yield file
        return
    folder, name = os.path.split(path)
    try:
        handle, beside = tempfile.mkstemp(prefix=f".{name}.", suffix=".part", dir=folder or ".")
    except OSError as error:
        raise UserError(f"cannot be written: {error.strerror or error}", path) from None
    try:
        with os.fdopen(handle, mode, **options) as file:
            yield file
        _take_usual_mode(beside, path)
        os.replace(beside, path)
    except BaseException:
        os.unlink(beside)
        raise


def _take_usual_mode(beside: str, path: str) -> None:
    """mkstemp makes files private; give the new file the mode of the old one or the usual one."""
    try:
        mode = os.stat(path).st_mode & 0o7777
    except FileNotFoundError:
        mask = os.umask(0)
        os.umask(mask)
        mode = 0o666 & ~mask
    os.chmod(beside, mode)


def packaged_bytes(package: str, name: str) -> bytes:
    """A data file that is installed with this project, such as legacy's listing."""
    from importlib import import_module

    module = import_module(package)
    folder = os.path.dirname(module.__file__ or "")
    return module.__loader__.get_data(os.path.join(folder, name))  # type: ignore[union-attr]


def packaged_text(package: str, name: str) -> str:
    """The text of a data file that is installed with this project."""
    return decode(packaged_bytes(package, name), name)
