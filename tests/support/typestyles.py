"""Draw the characters of the printed page in known typefaces.

``python tests/support/typestyles.py`` writes ``port/impact88/pictures/digits.npz``, from which the
characters of a page get their first names: for each of `STYLES` the characters of `CHARACTERS`, one
cell wide, 255 for full ink, with a capital between the rows `TOP` and `FOOT`. The
fonts are files of Debian's packages, in the folder that IMPACT88_FONTS names or in
/usr/share/fonts:

    apt-get install fonts-dejavu-core fonts-liberation fonts-freefont-ttf fonts-hack \\
        fonts-tlwg-typewriter-ttf fonts-3270 fonts-spleen fonts-dotgothic16 fonts-gnutypewriter \\
        fonts-inconsolata fonts-jetbrains-mono

The last two styles are drawn with a round pin for each mark of `PINS`, as a matrix printer strikes
them, and with pins at half steps between those beside each other.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from impact88.pictures.cells import CHARACTERS
from impact88.pictures.grid import CELL_WIDTH

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
0 .###. #...# #..## #.#.# ##..# #...# .###.
1 ..#.. .##.. ..#.. ..#.. ..#.. ..#.. .###.
2 .###. #...# ....# ...#. ..#.. .#... #####
3 ##### ...#. ..#.. ...#. ....# #...# .###.
4 ...#. ..##. .#.#. #..#. ##### ...#. ...#.
5 ##### #.... ####. ....# ....# #...# .###.
6 ..##. .#... #.... ####. #...# #...# .###.
7 ##### ....# ...#. ..#.. .#... .#... .#...
8 .###. #...# #...# .###. #...# #...# .###.
9 .###. #...# #...# .#### ....# ...#. .##..
. ..... ..... ..... ..... ..... .##.. .##..
- ..... ..... ..... ##### ..... ..... .....
A ..#.. .#.#. #...# #...# ##### #...# #...#
B ####. #...# #...# ####. #...# #...# ####.
C .###. #...# #.... #.... #.... #...# .###.
D ####. #...# #...# #...# #...# #...# ####.
E ##### #.... #.... ####. #.... #.... #####
F ##### #.... #.... ####. #.... #.... #....
G .###. #...# #.... #.### #...# #...# .####
H #...# #...# #...# ##### #...# #...# #...#
I .###. ..#.. ..#.. ..#.. ..#.. ..#.. .###.
K #...# #..#. #.#.. ##... #.#.. #..#. #...#
L #.... #.... #.... #.... #.... #.... #####
M #...# ##.## #.#.# #.#.# #...# #...# #...#
N #...# #...# ##..# #.#.# #..## #...# #...#
O .###. #...# #...# #...# #...# #...# .###.
P ####. #...# #...# ####. #.... #.... #....
R ####. #...# #...# ####. #.#.. #..#. #...#
S .#### #.... #.... .###. ....# ....# ####.
T ##### ..#.. ..#.. ..#.. ..#.. ..#.. ..#..
U #...# #...# #...# #...# #...# #...# .###.
V #...# #...# #...# #...# #...# .#.#. ..#..
W #...# #...# #...# #.#.# #.#.# #.#.# .#.#.
X #...# #...# .#.#. ..#.. .#.#. #...# #...#
Y #...# #...# .#.#. ..#.. ..#.. ..#.. ..#..
a ..... ..... .###. ....# .#### #...# .####
b #.... #.... ####. #...# #...# #...# ####.
x ..... ..... #...# .#.#. ..#.. .#.#. #...#
y ..... ..... #...# #...# .#### ....# .###.
= ..... ..... ##### ..... ##### ..... .....
( ...#. ..#.. .#... .#... .#... ..#.. ...#.
) .#... ..#.. ...#. ...#. ...#. ..#.. .#...
% ##... ##..# ...#. ..#.. .#... #..## ...##
* ..... ..#.. #.#.# .###. #.#.# ..#.. .....
: ..... .##.. .##.. ..... .##.. .##.. .....
, ..... ..... ..... ..... .##.. ..#.. .#...
? .###. #...# ....# ...#. ..#.. ..... ..#..
+ ..... ..#.. ..#.. ##### ..#.. ..#.. .....
"""
"""A character, and its five columns in each of seven rows of pins."""
FILE = Path(__file__).parents[2] / "port/impact88/pictures/digits.npz"
TOP = 4  # rows between which capitals are drawn
FOOT = 20
ROWS = TOP + FOOT
FINE = 16  # pixels to which a pixel is drawn first
Glyphs = np.ndarray[Any, np.dtype[np.uint8]]


def path_of(style: str) -> Path:
    """Return the file of a style's font."""
    return Path(os.environ.get("IMPACT88_FONTS", "/usr/share/fonts")) / STYLES[style]


def type_glyphs(style: str) -> Glyphs:
    """Return the characters of a font, scaled to the height of its E and the width of its cell."""
    font = ImageFont.truetype(str(path_of(style)), 16 * FINE)
    _, top, _, foot = font.getbbox("E", anchor="ls")
    pixel = (foot - top) / (FOOT - TOP)
    glyphs = []
    for character in CHARACTERS:
        cell = Image.new("L", (round(font.getlength("0")), round(ROWS * pixel)))
        pen = ImageDraw.Draw(cell)
        pen.text((0, FOOT * pixel - foot), character, 255, font, anchor="ls")
        glyphs.append(np.asarray(cell.resize((CELL_WIDTH, ROWS), Image.Resampling.BOX)))
    return np.array(glyphs)


def strike_pins(half_steps: bool) -> Glyphs:
    """Return the characters of `PINS`; with pins between neighbours for ``half_steps``."""
    pins = {line[0]: line[2:].split() for line in PINS.split("\n") if line}
    step, radius = CELL_WIDTH / 6, 1.1
    glyphs = []
    for character in CHARACTERS:
        cell = Image.new("L", (CELL_WIDTH * FINE, ROWS * FINE))
        pen = ImageDraw.Draw(cell)
        for row, line in enumerate(pins[character]):
            columns = [float(at) for at, pin in enumerate(line) if pin == "#"]
            if half_steps:
                columns += [at + 0.5 for at in columns if at + 1 in columns]
            y = TOP + (row + 0.5) * (FOOT - TOP) / 7
            for column in columns:
                x = (column + 0.9) * step
                box = [FINE * at for at in (x - radius, y - radius, x + radius, y + radius)]
                pen.ellipse(tuple(box), 255)
        glyphs.append(np.asarray(cell.resize((CELL_WIDTH, ROWS), Image.Resampling.BOX)))
    return np.array(glyphs)


def main() -> None:
    """Write the file."""
    glyphs = [type_glyphs(s) if STYLES[s] else strike_pins(s != "pins") for s in STYLES]
    np.savez_compressed(
        FILE,
        characters=np.array([*CHARACTERS]),
        styles=np.array([*STYLES]),
        glyphs=np.array(glyphs),
    )


if __name__ == "__main__":
    main()
