"""Files that are no pages: one line of error, whatever they are."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import pytest
from typedpages import draw, encode

import impact88
from impact88.pictures import verify_picture
from impact88.pictures.picture import MAX_PIXELS, MIN_SIDE, ink_of, read_pages

WHITE = np.full((400, 300), 255.0)


def png_header(width: int, height: int) -> bytes:
    """Return a PNG file that claims a size and has no pixels."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        checksum = zlib.crc32(kind + body)
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", checksum)

    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    start = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
    return start + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x89PNG\r\n\x1a\n",
        png_header(0, 0),
        png_header(60_000, 60_000),
        png_header(8_000, MAX_PIXELS // 8_000 + 1),
        encode(draw("MA= 1"))[:-200],
        encode(WHITE[: MIN_SIDE - 1]),
        b"%PDF-1.4 damaged",
    ],
    ids="empty start zero huge large truncated small pdf".split(),
)
def test_unusable_file_is_one_line(data: bytes) -> None:
    with pytest.raises(impact88.UserError) as error:
        verify_picture(data, "page.png")
    assert str(error.value).startswith("page.png: ")
    assert "\n" not in str(error.value)


def test_blank_page_has_no_printout() -> None:
    with pytest.raises(impact88.UserError, match="no printout was found"):
        verify_picture(encode(WHITE))


@pytest.mark.parametrize("mode", ["1", "L", "RGB", "RGBA", "P", "LA", "I;16", "F"])
def test_modes_of_a_picture(mode: str) -> None:
    form = {"F": "TIFF"}.get(mode, "PNG")
    (page,) = read_pages(encode(WHITE, form, mode), "page")
    assert page.grey.shape == (400, 300)
    assert page.grey.min() > 250


def test_cmyk_and_quarter_turn_of_a_camera() -> None:
    (page,) = read_pages(encode(WHITE, "JPEG", "CMYK"), "page")
    assert page.grey.shape == (400, 300)


def test_pages_of_a_pdf() -> None:
    data = encode(WHITE, "PDF")
    (page,) = read_pages(data, "page.pdf")
    assert page.number == 1
    assert page.text == ""
    assert page.grey.min() > 250
    assert not [*read_pages(data, "page.pdf", range(2, 3))]


def test_page_that_a_file_lacks() -> None:
    with pytest.raises(impact88.UserError, match="page 2: the file has 1"):
        [*read_pages(encode(WHITE), "page", range(2, 3))]


def test_ink_of_a_negative_is_that_of_the_page() -> None:
    grey = draw("MA= 1 MB= 2", margin=120).astype(np.float32)
    assert abs(ink_of(grey) - ink_of(255 - grey)).max() < 0.05


def test_shadow_is_paper_and_a_dark_surround_is_not() -> None:
    grey = draw("MA= 1 MB= 2", margin=200).astype(np.float32)
    shadow = grey * np.linspace(0.5, 1.0, grey.shape[1], dtype=np.float32)
    assert (ink_of(shadow) > 0.5).sum() > 0.8 * (ink_of(grey) > 0.5).sum()
    framed = np.pad(grey, 60, constant_values=90.0)
    assert (ink_of(framed) > 0.5)[:50].sum() == 0
