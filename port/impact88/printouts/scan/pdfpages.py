"""Pages of a PDF as pictures, rendered in a process of its own.

The process has a memory limit, and a damaged or hostile file cannot harm any other.

The process reads the file from standard input and writes, for each page, a line of JSON, the
page's pixels (blue, green, red) and its text. It imports nothing of impact88.
"""

import json
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from threading import Timer
from typing import IO, Any, NamedTuple

DOTS_PER_INCH = 300  # a character of 10 or 12 an inch is 25 to 30 pixels wide
MAX_INCHES = 60.0  # longest side of a page: more than A0
MAX_PAGES = 200  # pages of a file, at a second or two each
MAX_SECONDS = 10.0  # for a page; one of 300 dots an inch takes 0.1
MAX_BYTES = 512_000_000  # address space of the process
MAX_TEXT = 100_000  # characters of a page's text layer; a printout has 900


class Rendered(NamedTuple):
    """A page: width and height in pixels, its pixels in three bytes each, its text layer."""

    width: int
    height: int
    pixels: bytes
    text: str


class PdfError(Exception):
    """The reason why a file, or one of its pages, was not rendered."""


def render_pages(data: bytes, max_side: int) -> Iterator[Rendered]:
    """Yield the pages of a PDF, none longer than ``max_side`` pixels.

    Raises
    ------
    PdfError
        with the reason in words
    """
    if find_spec("pypdfium2") is None:
        raise PdfError("PDFs need pypdfium2, which is not installed; pip install 'impact88[scan]'")
    command = [sys.executable, __file__, str(max_side)]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as process:
        assert process.stdin
        assert process.stdout
        number = 0
        try:
            _send(process.stdin, data)
            while True:
                number += 1
                header = _read_header(process, number)
                if "error" in header:
                    raise PdfError(header["error"])
                if "end" in header:
                    return
                pixels = process.stdout.read(header["bytes"])
                text = process.stdout.read(header["text"]).decode()
                yield Rendered(header["width"], header["height"], pixels, text)
        finally:
            process.kill()


def _send(pipe: IO[bytes], data: bytes) -> None:
    """Write all data and close the pipe."""
    try:
        pipe.write(data)
        pipe.close()
    except BrokenPipeError:  # the process ended before it read all; its reason is read next
        pass


def _read_header(process: subprocess.Popen[bytes], number: int) -> dict[str, Any]:
    """Return the next line of JSON; the process is killed if it takes over `MAX_SECONDS`."""
    assert process.stdout
    late: list[bool] = []

    def end() -> None:
        late.append(True)
        process.kill()

    timer = Timer(MAX_SECONDS, end)
    timer.start()
    try:
        line = process.stdout.readline()
    finally:
        timer.cancel()
    if late:
        raise PdfError(f"page {number} takes more than {MAX_SECONDS:.0f} s to render")
    if not line:
        raise PdfError(
            f"page {number} cannot be rendered within {MAX_BYTES // 1_000_000} MB of memory"
        )
    header: dict[str, Any] = json.loads(line)
    return header


def _limit_memory() -> None:
    """Limit the address space of this process to `MAX_BYTES`."""
    try:
        import resource
    except ImportError:  # Windows: only the limits of pages and time hold there
        return
    resource.setrlimit(resource.RLIMIT_AS, (MAX_BYTES, MAX_BYTES))


def _answer(out: IO[bytes], header: dict[str, Any], *parts: bytes) -> None:
    """Write a line of JSON and the bytes that it announces."""
    out.write(json.dumps(header).encode() + b"\n")
    for part in parts:
        out.write(part)
    out.flush()


def main() -> None:
    """Render the PDF on standard input."""
    import pypdfium2

    _limit_memory()
    out, max_side = sys.stdout.buffer, int(sys.argv[1])
    try:
        document = pypdfium2.PdfDocument(sys.stdin.buffer.read())
    except pypdfium2.PdfiumError:
        _answer(out, {"error": "is not a PDF that can be read"})
        return
    count = len(document)
    if count > MAX_PAGES:
        _answer(out, {"error": f"has {count:,} pages; expected at most {MAX_PAGES}"})
        return
    for number in range(1, count + 1):
        try:
            page = document[number - 1]
            width, height = page.get_size()
            if not 0 < max(width, height) <= 72 * MAX_INCHES:
                size = f"{width / 72:.4g} x {height / 72:.4g} inches"
                limit = f"expected at most {MAX_INCHES:.0f} inches a side"
                _answer(out, {"error": f"page {number} is {size}; {limit}"})
                return
            scale = min(DOTS_PER_INCH / 72, max_side / max(width, height))
            bitmap = page.render(scale=scale, rev_byteorder=False, prefer_bgrx=False)
            rows = memoryview(bitmap.buffer).cast("B")
            line = bitmap.width * bitmap.n_channels
            pixels = b"".join(
                rows[at : at + line]
                for at in range(0, bitmap.height * bitmap.stride, bitmap.stride)
            )
            if bitmap.n_channels == 1:
                pixels = bytes(value for value in pixels for _ in range(3))
            text = page.get_textpage().get_text_bounded()[:MAX_TEXT].encode("utf-8", "replace")
            page.close()
        except pypdfium2.PdfiumError:
            _answer(out, {"error": f"page {number} cannot be rendered: it is damaged"})
            return
        header = {"width": bitmap.width, "height": bitmap.height}
        header |= {"bytes": len(pixels), "text": len(text)}
        bitmap.close()
        _answer(out, header, pixels, text)
    _answer(out, {"end": True})


if __name__ == "__main__":
    main()
