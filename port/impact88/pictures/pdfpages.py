"""Pages of a PDF as pictures, rendered in a process of its own.

The process has a memory limit, so that a damaged or hostile file harms no other. It reads the file
from standard input and writes, for each page, a line of JSON, the page's grey pixels and its text.
It imports nothing of impact88.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from importlib.util import find_spec
from threading import Timer
from typing import IO, Any, NamedTuple

MAX_PAGES = 200  # pages of a file, at a second or two each
MAX_SECONDS = 10.0  # for a page; one of 300 dots an inch takes 0.1
MAX_BYTES = 400_000_000  # address space of the process
MAX_TEXT = 100_000  # characters of a page's text layer; a printout has 900


class Rendered(NamedTuple):
    """A page: width and height in pixels, its grey pixels, its text layer."""

    width: int
    height: int
    pixels: bytes
    text: str


def render_pages(data: bytes, name: str, max_side: int) -> Iterator[Rendered]:
    """Yield the pages of a PDF, each ``max_side`` pixels long.

    Raises
    ------
    UserError
        If the file cannot be rendered within the limits; ``name`` begins the message.
    """
    from impact88.errors import UserError

    if find_spec("pypdfium2") is None:
        raise UserError(
            "a PDF needs the extra pictures: pip install '.[pictures]' in the checkout", name
        )
    command = [sys.executable, __file__, str(max_side)]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as process:
        assert process.stdin
        assert process.stdout
        number = 1
        try:
            with suppress(BrokenPipeError):  # it ended early; its reason is read next
                process.stdin.write(data)
                process.stdin.close()
            while "end" not in (header := _read_header(process, number)):
                if "error" in header:
                    raise UserError(header["error"], name)
                pixels = process.stdout.read(header["width"] * header["height"])
                text = process.stdout.read(header["text"]).decode()
                yield Rendered(header["width"], header["height"], pixels, text)
                number += 1
        finally:
            process.kill()


def _read_header(process: subprocess.Popen[bytes], number: int) -> dict[str, Any]:
    """Return the next line of JSON; the process is killed after `MAX_SECONDS`."""
    assert process.stdout
    timer = Timer(MAX_SECONDS, process.kill)
    timer.start()
    try:
        line = process.stdout.readline()
    finally:
        timer.cancel()
    if not line:
        limits = f"{MAX_SECONDS:.0f} s and {MAX_BYTES // 1_000_000} MB"
        return {"error": f"page {number} cannot be rendered within {limits}"}
    header: dict[str, Any] = json.loads(line)
    return header


def _write(out: IO[bytes], header: dict[str, Any], *parts: bytes) -> None:
    """Write a line of JSON and the bytes that it announces."""
    out.write(json.dumps(header).encode() + b"\n")
    for part in parts:
        out.write(part)
    out.flush()


def _render(document: Any, number: int, max_side: int) -> tuple[dict[str, Any], bytes, bytes]:
    """Return the header, the pixels and the text of a page."""
    page = document[number - 1]
    width, height = page.get_size()
    bitmap = page.render(scale=max_side / max(width, height, 1), grayscale=True)
    rows = memoryview(bitmap.buffer).cast("B")
    starts = range(0, bitmap.height * bitmap.stride, bitmap.stride)
    pixels = b"".join(rows[start : start + bitmap.width] for start in starts)
    text = page.get_textpage().get_text_bounded()[:MAX_TEXT].encode("utf-8", "replace")
    header = {"width": bitmap.width, "height": bitmap.height, "text": len(text)}
    bitmap.close()
    page.close()
    return header, pixels, text


def main() -> None:
    """Render the PDF on standard input."""
    import pypdfium2

    with suppress(ImportError):  # Windows: only the limits of pages and time hold there
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MAX_BYTES, MAX_BYTES))
    out, max_side = sys.stdout.buffer, int(sys.argv[1])
    try:
        document = pypdfium2.PdfDocument(sys.stdin.buffer.read())
    except pypdfium2.PdfiumError:
        _write(out, {"error": "is not a PDF that can be read"})
        return
    count = len(document)
    if count > MAX_PAGES:
        _write(out, {"error": f"has {count:,} pages; expected at most {MAX_PAGES}"})
        return
    for number in range(1, count + 1):
        try:
            header, pixels, text = _render(document, number, max_side)
        except pypdfium2.PdfiumError:
            _write(out, {"error": f"page {number} cannot be rendered: it is damaged"})
            return
        _write(out, header, pixels, text)
    _write(out, {"end": True})


if __name__ == "__main__":
    main()
