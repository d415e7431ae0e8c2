"""Draws the digits of known typefaces by which a page's first characters are named.

``python tests/support/digitstyles.py`` writes ``port/impact88/printouts/scan/digits.npz``: for each
of `STYLES` the twelve of `CHARACTERS`, a cell wide, 255 for full ink, with the top of a capital and
its foot in the rows of `CAPITALS`. The fonts are files of Debian's packages, in the folder
that IMPACT88_FONTS names or in /usr/share/fonts:

    apt-get install fonts-dejavu-core fonts-liberation fonts-freefont-ttf fonts-hack \\
        fonts-tlwg-typewriter-ttf fonts-3270 fonts-spleen fonts-dotgothic16 fonts-gnutypewriter \\
        fonts-inconsolata fonts-jetbrains-mono

The last two styles are drawn here, a round pin for each mark of `PINS`, as a matrix printer strikes
them, and with pins at half steps between those beside each other.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from impact88.printouts.scan.grid import CELL_WIDTH
from impact88.printouts.scan.typeface import CAPITALS
from impact88.printouts.scan.typeface import NUMERIC as CHARACTERS

STYLES = {
    "DejaVu Sans Mono": "truetype/dejavu/DejaVuSansMono.ttf",
    "Liberation Mono": "truetype/liberation/LiberationMono-Regular.ttf",
    "FreeMono": "truetype/freefont/FreeMono.ttf",
    "Hack": "truetype/hack/Hack-Regular.ttf",
    "Tlwg Typewriter": "truetype/tlwg/TlwgTypewriter.ttf",
    "IBM 3270": "truetype/3270/3270-Regular.ttf",
    "Spleen": "opentype/spleen/spleen-16x32.otf",
    "DotGothic16": "truetype/dotgothic16/DotGothic16-Regular.ttf",
    "GNU Typewriter": "truetype/gnutypewriter/GNUTypewriter.ttf",
    "Inconsolata": "truetype/inconsolata/Inconsolata.otf",
    "JetBrains Mono": "truetype/jetbrains-mono/JetBrainsMono-Regular.ttf",
    "pins": "",
    "pins at half steps": "",
}
PINS = """
.###. ..#.. .###. ##### ...#. ##### ..##. ##### .###. .###. ..... .....
#...# .##.. #...# ...#. ..##. #.... .#... ....# #...# #...# ..... .....
#..## ..#.. ....# ..#.. .#.#. ####. #.... ...#. #...# #...# ..... .....
#.#.# ..#.. ...#. ...#. #..#. ....# ####. ..#.. .###. .#### ..... #####
##..# ..#.. ..#.. ....# ##### ....# #...# .#... #...# ....# ..... .....
#...# ..#.. .#... #...# ...#. #...# #...# .#... #...# ...#. .##.. .....
.###. .###. ##### .###. ...#. .###. .###. .#... .###. .##.. .##.. .....
"""
"""`CHARACTERS` on five columns and seven rows of pins, the nought with a stroke through it."""
FILE = Path(__file__).parents[2] / "port/impact88/printouts/scan/digits.npz"
_TOP, _BOTTOM = CAPITALS
_WIDTH, _ROWS = CELL_WIDTH, _TOP + _BOTTOM
_FINE = 16  # pixels to which a pixel is drawn first
Glyphs = np.ndarray[Any, np.dtype[np.uint8]]


def path_of(style: str) -> Path:
    """The file of a style's font."""
    return Path(os.environ.get("IMPACT88_FONTS", "/usr/share/fonts")) / STYLES[style]


def typed(style: str) -> Glyphs:
    """The characters of a font, scaled to the height of its E and the width of its cell."""
    font = ImageFont.truetype(str(path_of(style)), 16 * _FINE)
    _, top, _, foot = font.getbbox("E", anchor="ls")
    pixel = (foot - top) / (_BOTTOM - _TOP)
    glyphs = []
    for character in CHARACTERS:
        cell = Image.new("L", (round(font.getlength("0")), round(_ROWS * pixel)))
        pen = ImageDraw.Draw(cell)
        pen.text((0, _BOTTOM * pixel - foot), character, 255, font, anchor="ls")
        glyphs.append(np.asarray(cell.resize((_WIDTH, _ROWS), Image.Resampling.BOX)))
    return np.array(glyphs)


def struck(half_steps: bool) -> Glyphs:
    """The characters of `PINS`; with pins between those beside each other for ``half_steps``."""
    rows = [line.split() for line in PINS.split("\n") if line]
    step, radius = _WIDTH / 6, 1.1
    glyphs = []
    for pins in zip(*rows, strict=True):
        cell = Image.new("L", (_WIDTH * _FINE, _ROWS * _FINE))
        pen = ImageDraw.Draw(cell)
        for row, line in enumerate(pins):
            columns = [float(at) for at, pin in enumerate(line) if pin == "#"]
            if half_steps:
                columns += [at + 0.5 for at in columns if at + 1 in columns]
            y = _TOP + (row + 0.5) * (_BOTTOM - _TOP) / len(rows)
            for column in columns:
                x = (column + 0.9) * step
                box = [_FINE * at for at in (x - radius, y - radius, x + radius, y + radius)]
                pen.ellipse(tuple(box), 255)
        glyphs.append(np.asarray(cell.resize((_WIDTH, _ROWS), Image.Resampling.BOX)))
    return np.array(glyphs)


def glyphs_of(style: str) -> Glyphs:
    """The characters of a style."""
    return typed(style) if STYLES[style] else struck(style != "pins")


def main() -> None:
    np.savez_compressed(
        FILE,
        characters=np.array([*CHARACTERS]),
        styles=np.array([*STYLES]),
        glyphs=np.array([glyphs_of(style) for style in STYLES]),
    )


if __name__ == "__main__":
    main()
