"""Files that are no pages: one line of error, whatever they are."""

from __future__ import annotations

import io
import struct
import zlib

import numpy as np
import PIL.Image
import pytest
from typedpages import draw, encode

import impact88
from impact88.pictures import verify_picture
from impact88.pictures.picture import ink_of, points_of, read_pages

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
        png_header(8_000, 7_501),
        encode(draw("MA= 1"))[:-200],
        encode(WHITE[:1, :1]),
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


def typed_pdf(*strings: str) -> bytes:
    """Return a PDF of one page, 400 x 4 points, with invisible text."""
    shown = " ".join(f"({string}) Tj" for string in strings)
    stream = f"BT /F .005 Tf 3 Tr 2 2 Td {shown} ET"
    page = "/Type/Page/Parent 2 0 R/MediaBox[0 0 400 4]/Contents 4 0 R"
    bodies = [
        "<</Type/Catalog/Pages 2 0 R>>",
        "<</Type/Pages/Kids[3 0 R]/Count 1>>",
        f"<<{page}/Resources<</Font<</F 5 0 R>>>>>>",
        f"<</Length {len(stream)}>>stream\n{stream}\nendstream",
        "<</Type/Font/Subtype/Type1/BaseFont/Courier>>",
    ]
    objects = [f"{number} 0 obj{body}endobj\n" for number, body in enumerate(bodies, 1)]
    return f"%PDF-1.4\n{''.join(objects)}trailer<</Root 1 0 R>>".encode()


def test_page_of_a_pdf() -> None:
    data = typed_pdf("MA= 1.5 ", "MB= 2")
    (page,) = read_pages(data, "page.pdf")
    assert page.number == 1
    assert page.text == "MA= 1.5 MB= 2"
    assert page.grey.shape == (40, 4_000)
    assert page.grey.min() > 250
    assert not [*read_pages(data, "page.pdf", range(2, 3))]


def test_longest_text_of_a_page_of_a_pdf() -> None:
    (page,) = read_pages(typed_pdf(*["0123456789" * 1000] * 11), "page.pdf")
    assert len(page.text) == 100_000


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


def test_largest_picture_and_its_size_as_read() -> None:
    with pytest.raises(impact88.UserError, match="expected at most 60,000,000"):
        [*read_pages(png_header(8_000, 7_501), "page")]
    with pytest.raises(impact88.UserError, match="not a picture"):
        [*read_pages(png_header(8_000, 7_500), "page")]
    (page,) = read_pages(encode(np.zeros((100, 6_000))), "page")
    assert page.grey.shape[1] == 4_000
    assert page.scale == 1.5


@pytest.mark.parametrize(("frames", "message"), [(200, ""), (201, "has 201 pages")])
def test_pages_of_a_file(frames: int, message: str) -> None:
    file = io.BytesIO()
    frame = PIL.Image.new("1", (9, 9))
    frame.save(file, "TIFF", save_all=True, append_images=[frame] * (frames - 1))
    if message:
        with pytest.raises(impact88.UserError, match=message):
            next(read_pages(file.getvalue(), "page"))
    else:
        assert next(read_pages(file.getvalue(), "page")).number == 1


def test_limits_of_a_pdf() -> None:
    import subprocess
    import sys

    from impact88.pictures.pdfpages import _read_header

    with subprocess.Popen([sys.executable, "-S", "-c", ""], stdout=subprocess.PIPE) as process:
        assert _read_header(process, 3)["error"].endswith("within 10 s and 400 MB")


def test_ink_is_darker_than_the_grain_of_its_paper() -> None:
    grain = np.random.default_rng(1).normal(200, 5, (400, 400))
    grain[100:110, 100:110] = 50
    assert (ink_of(grain.astype(np.float32)) > 0).mean() == pytest.approx(0.2, abs=0.03)


@pytest.mark.parametrize(("brightness", "is_inked"), [(0.4, True), (0.2, False)])
def test_darkest_shadow_on_paper(brightness: float, is_inked: bool) -> None:
    grey = np.full((900, 900), 250.0, np.float32)
    grey[:, 450:] *= brightness
    grey[100:800:60, 50:850] *= 0.3
    assert (ink_of(grey)[:, 500:800] > 0.5).any() == is_inked


@pytest.mark.parametrize(("side", "is_inked"), [(15, True), (28, False)])
def test_widest_stroke_of_type(side: int, is_inked: bool) -> None:
    grey = np.full((900, 900), 250.0, np.float32)
    grey[450 : 450 + side, 450 : 450 + side] = 20
    assert (ink_of(grey)[455:460, 455:460] > 0.5).all() == is_inked


@pytest.mark.parametrize(
    ("ink", "length", "is_inked"),
    [(0.3, 50, False), (0.6, 50, True), (1.0, 80, True), (1.0, 160, False)],
)
def test_inked_places(ink: float, length: int, is_inked: bool) -> None:
    page = np.zeros((400, 400), np.float32)
    page[200:206, 100 : 100 + length] = ink
    assert (len(points_of(page).x) > 0) == is_inked
