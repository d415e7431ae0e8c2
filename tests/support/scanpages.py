"""Printouts as pictures, drawn for tests: casework at random, many kinds of type, worn paper.

``python tests/support/scanpages.py FOLDER COUNT [SEED [KIND ...]]`` writes COUNT pages of each of
`KINDS` and their truth (truth.jsonl). Fonts come from Debian's packages; those not installed are
left out. They are looked for in the folder that IMPACT88_FONTS names, else in /usr/share/fonts.
"""

from __future__ import annotations

import io
import json
import math
import os
import random
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

from impact88.program.run import run

KINDS = (
    *("clean", "hard", "photo"),
    *("altered", "font", "pasted", "line", "erased", "labels"),
    *("pins", "carbon", "columns", "half", "turned"),
    *("sign", "point", "digit", "appended", "typedline", "beside", "word"),
    *("desk", "spread", "skew", "pen", "stamp", "holes", "shadow", "screen"),
    *("exchanged", "doubled", "retyped", "cut"),
)
"""The first three genuine, the next six not; five genuine, in ways of their own; on the next seven
something was added in the page's own type; the next eight are genuine: other things than paper
and type are on the picture, or it shows a screen. Of the last four a whole row is hurt: two stand
in each other's place, one is printed twice, one is in another typeface, one is cut through by the
page's edge; no number is another."""
FORGED = KINDS[3:9]
ADDED = KINDS[14:21]
SURROUNDED = KINDS[21:29]
HURT_ROWS = KINDS[29:]
FONTS = {
    "liberation": "truetype/liberation/LiberationMono-Regular.ttf",
    "courierprime": "opentype/courier-prime/Courier Prime.otf",
    "dejavu": "truetype/dejavu/DejaVuSansMono.ttf",
    "hack": "truetype/hack/Hack-Regular.ttf",
    "tlwg": "truetype/tlwg/TlwgTypewriter.ttf",
    "freemono": "truetype/freefont/FreeMono.ttf",
    "3270": "opentype/3270/3270-Regular.otf",
    "spleen": "opentype/spleen/spleen-16x32.otf",
    "gnutypewriter": "truetype/gnutypewriter/GNUTypewriter.ttf",
    "nimbus": "opentype/urw-base35/NimbusMonoPS-Regular.otf",
    "cmu": "truetype/cmu/cmuntt.ttf",
    "inconsolata": "truetype/inconsolata/Inconsolata.otf",
    "jetbrains": "truetype/jetbrains-mono/JetBrainsMono-Regular.ttf",
    "anonymous": "truetype/anonymous-pro/Anonymous Pro.ttf",
    "vt220": "truetype/glasstty/Glass_TTY_VT220.ttf",
    "noto": "truetype/noto/NotoSansMono-Regular.ttf",
    "hermit": "opentype/hermit/Hermit-Regular.otf",
    "monofur": "truetype/monofur/monof55.ttf",
    "tlwgmono": "truetype/tlwg/TlwgMono.ttf",
    "nimbusbold": "opentype/urw-base35/NimbusMonoPS-Bold.otf",
}
DOTS = {"proggy": ("truetype/proggy/ProggyTinyTT.ttf", 16), "dot3270": (FONTS["3270"], 11)}
"""Drawn small and each pixel struck as a pin strikes it."""
Grey = np.ndarray[Any, np.dtype[np.float64]]


def _path(name: str) -> Path:
    return Path(os.environ.get("IMPACT88_FONTS", "/usr/share/fonts")) / name


def fonts() -> list[str]:
    """The names of the fonts that are installed."""
    every = {**FONTS, **{name: path for name, (path, _) in DOTS.items()}}
    return [name for name, path in every.items() if _path(path).exists()]


@cache
def _glyph(font: str, character: str, pixels: int) -> Image.Image:
    """One character's cell, black on white, about ``pixels`` high."""
    if font not in DOTS:
        drawn = ImageFont.truetype(str(_path(FONTS[font])), pixels)
        cell = Image.new("L", (round(drawn.getlength("0")), round(1.25 * pixels)), 255)
        ImageDraw.Draw(cell).text((0, 0), character, 0, drawn)
        return cell
    name, size = DOTS[font]
    drawn = ImageFont.truetype(str(_path(name)), size)
    small = Image.new("1", (round(drawn.getlength("0")), size), 1)
    ImageDraw.Draw(small).text((0, 0), character, 0, drawn)
    dot = pixels / size
    cell = Image.new("L", (round(small.width * dot), round(1.25 * pixels)), 255)
    pen = ImageDraw.Draw(cell)
    for y, x in zip(*np.nonzero(~np.asarray(small)), strict=True):
        pen.ellipse((x * dot, y * dot, (x + 1.1) * dot, (y + 1.1) * dot), 0)
    return cell


def _number(choose: random.Random, low: float, high: float) -> str:
    text = f"{choose.uniform(low, high):.{choose.choice((0, 1, 1, 2, 2, 3))}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def casework(choose: random.Random) -> dict[str, str]:
    """A collision such as people have."""
    heavy = choose.random() < 0.2  # in kilograms
    scene = {name: _number(choose, *((800, 2500) if heavy else (60, 250))) for name in ("MA", "MB")}
    scene |= {name: _number(choose, 1000, 6000).partition(".")[0] for name in ("IA", "IB")}
    scene |= {name: _number(choose, 0.5, 9) for name in ("DA", "DB")}
    scene |= {name: _number(choose, -179, 179) for name in ("PA", "PB", "TA", "TB", "GA")}
    scene |= {name: _number(choose, -70, 70) for name in ("UX", "UY", "VX", "VY")}
    scene |= {name: choose.choice(("0", _number(choose, -4, 4))) for name in ("WA", "WB")}
    scene["E"] = f"{choose.uniform(0, 0.6):.{choose.choice((1, 2))}f}"
    scene["MU"] = choose.choice(
        ("-10", f"{choose.uniform(-0.9, 0.9):.{choose.choice((1, 2, 3))}f}")
    )
    scene["EM"] = choose.choice(("0", "-1", f"{-choose.random():.3f}"))
    return scene | {"M": choose.choice("66664")}


def printed(choose: random.Random) -> str:
    """A printout with its prompts, of a collision that the program runs to its end."""
    while True:
        page = run(casework(choose)).page
        if "VBX=" in page and all(len(line) < 88 for line in page.split("\n")):
            return page.strip("\n")


def drawn(lines: list[str], font: str, pixels: int, leading: float = 1.0) -> Grey:
    """Lines of text as grey paper, a cell to a character."""
    cell = _glyph(font, "0", pixels)
    step = round(cell.height * leading)
    margin = 3 * cell.width
    size = (
        max(map(len, lines)) * cell.width + 2 * margin,
        step * len(lines) + 2 * margin,
    )
    paper = Image.new("L", size, 255)
    for row, line in enumerate(lines):
        for column, character in enumerate(line):
            if character != " ":
                at = (margin + column * cell.width, margin + row * step)
                paper.paste(_glyph(font, character, pixels), at)
    return np.asarray(paper, float)


def _pasted(
    paper: Grey, glyph: Grey, pixels: int, font: str, at: tuple[int, int], leading: float
) -> None:
    """Lays a glyph over the cell at (row, column) of drawn paper."""
    cell = _glyph(font, "0", pixels)
    top = 3 * cell.width + at[0] * round(cell.height * leading)
    left = 3 * cell.width + at[1] * cell.width
    paper[top : top + cell.height, left : left + cell.width] = glyph


def worn(paper: Grey, choose: random.Random, grade: str) -> Grey:
    """Paper turned, faded, blurred, noisy, shaded, speckled, made black and white."""
    noise = np.random.default_rng(choose.getrandbits(32))
    dry = grade == "hard"
    if grade == "clean":
        grade = choose.choice(("good", "medium"))
    elif grade == "hard":
        grade = choose.choices(("good", "medium", "bad"), (50, 17, 13))[0]
    if grade == "good":
        return paper
    turn, blur, grain, specks = {
        "medium": (0.4, (0.4, 1.1), choose.choice((0, 10)), choose.choice((0, 0.5))),
        "bad": (1.2, (0.6, 1.4), choose.choice((10, 25)), choose.choice((0, 2, 4))),
    }[grade]
    ink = 255 - paper
    if dry and (grade == "bad" or choose.random() < 0.5):  # a ribbon that runs dry in places
        shape = (paper.shape[0] // 40 + 2, paper.shape[1] // 120 + 2)
        weak = Image.fromarray((255 * noise.random(shape)).astype(np.uint8))
        weak = weak.resize(paper.shape[::-1], Image.Resampling.BICUBIC)
        ink = ink * (1 - choose.choice((0.4, 0.6)) * np.asarray(weak) / 255)
    picture = Image.fromarray((255 - ink).astype(np.uint8))
    picture = picture.rotate(
        choose.uniform(-turn, turn), Image.Resampling.BICUBIC, expand=True, fillcolor=255
    ).filter(ImageFilter.GaussianBlur(choose.uniform(*blur)))
    grey = np.asarray(picture, float)
    if grade == "bad" and choose.random() < 0.3:
        grey = grey - 50 * np.linspace(0, 1, grey.shape[1])
    grey = grey + noise.normal(0, grain, grey.shape)
    rows, columns = noise.integers(0, 1 << 30, (2, int(specks * grey.size / 10_000)))
    for row, column in zip(rows % grey.shape[0], columns % grey.shape[1], strict=True):
        grey[row : row + 2, column : column + 2] = 40
    if choose.random() < 0.4:
        grey = np.where(grey > choose.choice((120, 155) if dry else (140, 150)), 255.0, 0.0)
    return np.clip(grey, 0, 255)


def photographed(paper: Grey, choose: random.Random) -> Grey:
    """Paper on a table, askew, unevenly lit and a little bent."""
    noise = np.random.default_rng(choose.getrandbits(32))
    height, width = paper.shape
    scale = choose.uniform(10.5, 14.5) / (width / 86)
    size = (round(width * scale * 1.12), round(height * scale * 1.12))
    picture = Image.fromarray(paper.astype(np.uint8))
    corners = [
        (
            u * width + choose.uniform(-0.03, 0.03) * width - (1 - 2 * u) * 0.06 * width,
            v * height + choose.uniform(-0.03, 0.03) * height - (1 - 2 * v) * 0.06 * height,
        )
        for u, v in ((0, 0), (0, 1), (1, 1), (1, 0))
    ]
    targets = [(0, 0), (0, size[1]), size, (size[0], 0)]
    rows, right = [], []
    for (x, y), (u, v) in zip(corners, targets, strict=True):
        rows += [[u, v, 1, 0, 0, 0, -u * x, -v * x], [0, 0, 0, u, v, 1, -u * y, -v * y]]
        right += [x, y]
    map_ = np.linalg.solve(np.array(rows, float), np.array(right, float))
    blurred = picture.filter(ImageFilter.GaussianBlur(0.4 / scale))
    picture = blurred.transform(
        size, Image.Transform.PERSPECTIVE, tuple(map_), Image.Resampling.BICUBIC, fillcolor=215
    )
    grey = np.asarray(picture, float)
    y, x = np.mgrid[0 : size[1], 0 : size[0]] / max(size)
    angle = choose.uniform(0, 2 * math.pi)
    light = 0.8 + choose.uniform(0.1, 0.3) * (x * math.cos(angle) + y * math.sin(angle) - 0.3)
    bend = choose.uniform(0, 2.5) * np.sin(math.pi * x[0] * choose.uniform(0.5, 1.5))
    moved = np.arange(size[1])[:, None] + np.round(bend).astype(int)[None]
    grey = np.take_along_axis(grey, np.clip(moved, 0, size[1] - 1), axis=0)
    return np.clip(grey * light + noise.normal(0, choose.choice((1, 4)), grey.shape), 0, 255)


def _styled(prints: list[str], style: str) -> list[str]:
    """The lines of the paper."""
    if style == "columns":
        one, two = (text.split("\n") for text in prints)
        wide = max(map(len, one)) + 8
        count = max(len(one), len(two))
        one, two = (side + [""] * (count - len(side)) for side in (one, two))
        return [f"{a:{wide}}{b}" for a, b in zip(one, two, strict=True)]
    lines: list[str] = []
    for text in prints:
        lines += ["", "", ""] * bool(lines) + text.split("\n")
    if style == "noprompt":
        first = next(k for k, line in enumerate(lines) if " IA= " in line)
        lines = lines[first:]
    if style == "wrap40":
        lines = [part for line in lines for part in _wrapped(line)]
    if style == "headfoot":
        lines = ["CASE 85-CV-1093      EXHIBIT B", "", "", *lines, "", "", f"{'- 3 -':>40}"]
    return lines


def _wrapped(line: str) -> list[str]:
    return [line[k : k + 40] for k in range(0, max(len(line), 1), 40)]


def _altered(text: str, choose: random.Random) -> tuple[str, tuple[str, str, int]]:
    """One digit of a printed number changed; the digits and the place."""
    start = text.index("MA=")
    at = choose.choice([k for k, c in enumerate(text) if c.isdigit() and k > start])
    new = choose.choice([d for d in "0123456789" if d != text[at]])
    return text[:at] + new + text[at + 1 :], (text[at], new, at)


def _mislabelled(text: str, choose: random.Random) -> tuple[str, tuple[str, str, int]]:
    """One label changed for another."""
    pairs = ("MA=", "MB="), ("UX=", "VX="), ("WA=", "WB="), ("XB=", "YB="), ("VAX", "VBX")
    old, new = choose.choice([pair[:: choose.choice((1, -1))] for pair in pairs])
    places = [k for k in range(text.index("MA="), len(text)) if text.startswith(old, k)]
    at = choose.choice(places)
    return text[:at] + new + text[at + len(new) :], (old, new, at)


_LINES = (
    "VAX SHOULD READ {}, KE LOSS {} %",
    "KE LOSS= {} %",
    "VAX= {} VAY= {}",
    "CORRECTED: IA= {}",
    "RUN {} SUPERSEDES RUN {}",
)


def _number_places(lines: list[str]) -> list[tuple[int, int, int]]:
    """Row, and first and last column, of the numbers from the first printed input to the last
    printed result: a foot of the page has numbers, too."""
    first = next(k for k, line in enumerate(lines) if "MA=" in line and "IB" in line)
    last = max(k for k, line in enumerate(lines) if "VBX=" in line)
    last += "WA=" in "".join(lines[last + 1 : last + 2])
    return [
        (row, match.start(), match.end())
        for row in range(first, last + 1)
        for match in re.finditer(r"-?[0-9.]+(?:E-[0-9]+)?", lines[row])
        if re.search("[A-Z]= ?$", lines[row][: match.start()]) or "=" not in lines[row]
    ]


def _added(lines: list[str], kind: str, choose: random.Random) -> tuple[list[str], Any]:
    """The lines with something typed where the program prints a blank; what, and where."""
    new = [*lines]
    places = _number_places(lines)
    number = f"{choose.uniform(1, 90):.{choose.choice((0, 1, 2, 3))}f}"
    if kind == "typedline":
        row = choose.choice([len(new), *(k for k in range(places[0][0], len(new)) if not new[k])])
        text = choose.choice(_LINES).format(number, choose.randint(2, 99))
        new[row : row + 1] = [text] if row < len(new) else ["", text]
        return new, (kind, "", text, [row, 0])
    if kind in ("beside", "word"):
        row = choose.choice(places)[0]
        text = f"VAX= {number}" if kind == "beside" else choose.choice(("NOT", "KE", "VAX", "WB="))
        column = len(new[row]) + (choose.randint(3, 8) if kind == "beside" else 1)
        new[row] = new[row].ljust(column) + text
        return new, (kind, "", text, [row, column])
    spots = []
    for row, start, stop in places:
        line = f"{lines[row]}  "
        before, digit = line[start - 1 : start], line[start] != "-"
        if kind == "appended" and line[stop] == " ":
            spots.append((row, stop, choose.choice("0123456789")))
        elif kind == "sign" and before == " " and digit:
            spots.append((row, start - 1, "-"))
        elif kind == "digit" and before == " " and digit:
            spots.append((row, start - 1, choose.choice("123456789")))
        elif kind == "point" and "." not in line[start:stop]:
            spots += [(row, start - 1, ".")] * (before == " " and digit)
            spots += [(row, stop, ".")] * (line[stop] == " ")
    row, column, character = choose.choice(spots)
    line = new[row].ljust(column + 1)
    new[row] = line[:column] + character + line[column + 1 :]
    return new, (kind, " ", character, [row, column])


_ROW_STARTS = ("MA=", "DA=", " PA ", "UX=", "VX=", " E=", "INITIAL", "VAX=", "VBX=")
"""How the rows begin that every printout has."""


def _row_hurt(lines: list[str], kind: str, choose: random.Random) -> tuple[list[str], Any]:
    """The lines with two rows in each other's place, or one twice; what, and which lines of the
    paper, from 0."""
    new = [*lines]
    rows = [next(k for k, line in enumerate(lines) if line.startswith(s)) for s in _ROW_STARTS]
    if kind == "exchanged":
        one, two = sorted(choose.sample([row for row in rows if lines[row][:4] != " PA "], 2))
        new[one], new[two] = lines[two], lines[one]
        return new, (kind, one, two)
    row = choose.choice(rows)
    count = 2 if lines[row].startswith(" PA ") else 1
    if kind == "doubled":
        new[row:row] = [*lines[row : row + count], *[""] * (lines[row - 1] == "")]
        return new, (kind, row)
    return new, (kind, row + count - 1)


def _retype(
    paper: Grey, lines: list[str], row: int, hand: str, font: str, pixels: int, leading: float
) -> None:
    """Types a row of drawn paper anew in another typeface, in the same cells."""
    cell = _glyph(font, "0", pixels)
    for column, character in enumerate(lines[row]):
        glyph = _glyph(hand, character, pixels).resize(cell.size)
        _pasted(paper, np.asarray(glyph, float), pixels, font, (row, column), leading)


def _cut(
    paper: Grey, row: int, font: str, pixels: int, leading: float, choose: random.Random
) -> Grey:
    """Drawn paper whose upper or lower edge runs through a row: what is left is the larger part."""
    cell = _glyph(font, "0", pixels)
    ink = 255 - paper
    top = 3 * cell.width + row * round(cell.height * leading)
    inked = np.flatnonzero(ink[top : top + cell.height].sum(axis=1))
    at = top + inked[0] + round(choose.uniform(0.35, 0.65) * 0.7 * (inked[-1] - inked[0]))
    return paper[at:] if at < 0.4 * len(paper) else paper[:at]


def page(kind: str, choose: random.Random, of: list[str]) -> tuple[Image.Image, dict[str, Any]]:
    """One page of a kind, and its truth; ``of``: the fonts that may be used."""
    plain = kind in ("clean", "photo", *FORGED, *ADDED, *SURROUNDED, *HURT_ROWS)
    font = choose.choice([one for one in of if not plain or one not in DOTS])
    sizes = (36, 42, 48) if plain and kind not in FORGED else (30, 36, 42)
    pixels = choose.choice((22, 28, 34, 40) if kind == "hard" else sizes)
    if kind == "half":
        pixels = choose.choice((16, 18, 20))
    styles = ("plain", "headfoot", "noprompt")
    style = choose.choice((*styles, "two", "wrap40") if kind == "hard" else styles)
    style = {"columns": "columns"}.get(kind, style)
    several = style in ("two", "columns") or kind == "spread"
    prints = [printed(choose) for _ in range(2 if several else 1)]
    shown, altered = list(prints), None
    if kind in FORGED:
        shown[0], altered = (_mislabelled if kind == "labels" else _altered)(prints[0], choose)
        while kind == "pasted" and altered[1] not in prints[0]:
            shown[0], altered = _altered(prints[0], choose)
    by_hand = kind in ("font", "pasted", "line", "erased")
    lines = _styled(prints if by_hand else shown, style)
    if kind in ADDED:
        lines, altered = _added(lines, kind, choose)
    if kind in HURT_ROWS:
        lines, altered = _row_hurt(lines, kind, choose)
    leading = choose.choice((1.0, 1.1)) if kind == "hard" else 1.0
    paper = drawn(lines, font, pixels, leading)
    if kind == "retyped":
        hand = choose.choice([one for one in of if one != font and one not in DOTS])
        _retype(paper, lines, altered[1], hand, font, pixels, leading)
        altered = (*altered, hand)
    if kind == "cut":
        paper = _cut(paper, altered[1], font, pixels, leading, choose)
    if altered and by_hand:
        _forge(paper, kind, lines, _styled(shown, style), font, pixels, leading, choose, of)
    if kind in SURROUNDED:
        if kind == "spread":
            papers = [drawn(_styled([text], style), font, pixels) for text in prints]
        else:
            papers = [paper]
        picture = surrounded([worn(one, choose, "clean") for one in papers], kind, choose)
        truth = {"kind": kind, "style": style, "font": font, "pixels": pixels, "condition": ""}
        return picture, {**truth, "prints": prints, "altered": None}
    paper = _aged(paper, kind, pixels, choose)
    if altered and kind in FORGED:
        altered = (kind, *altered)
    grey = Image.fromarray(np.clip(paper, 0, 255).astype(np.uint8))
    quality = choose.choice((None, None, 85, 70)) if kind != "photo" else choose.randint(60, 90)
    if quality:
        file = io.BytesIO()
        grey.save(file, "JPEG", quality=quality)
        grey = Image.open(file)
    truth = {"kind": kind, "style": style, "font": font, "pixels": pixels, "condition": ""}
    return grey, {**truth, "prints": prints, "altered": altered}


def surrounded(papers: list[Grey], kind: str, choose: random.Random) -> Image.Image:
    """Paper as it comes to be pictured: on a desk, two sheets with a gutter, askew, written on away
    from its lines, stamped in colour, with the strips of continuous forms."""
    noise = np.random.default_rng(choose.getrandbits(32))
    sheets = [Image.fromarray(np.clip(paper, 0, 255).astype(np.uint8)) for paper in papers]
    sheet = sheets[0]
    width, height = sheet.size
    if kind == "skew":
        turn = choose.choice((-1, 1)) * choose.uniform(3, 8)
        return sheet.rotate(turn, Image.Resampling.BICUBIC, expand=True, fillcolor=255)
    if kind == "spread":
        gutter = choose.randint(20, 70)
        size = sum(one.width for one in sheets) + gutter, max(one.height for one in sheets)
        both = Image.new("L", size, choose.randint(20, 90))
        for one, left in zip(sheets, (0, sheets[0].width + gutter), strict=True):
            both.paste(255, (left, 0, left + one.width, size[1]))
            both.paste(one, (left, 0))
        return both
    if kind == "desk":
        margin = round(choose.uniform(0.08, 0.2) * width)
        size = width + 2 * margin, height + 2 * margin
        shift = 0.35 * margin
        corners = [
            (choose.uniform(-shift, shift) + x, choose.uniform(-shift, shift) + y)
            for x, y in ((margin, margin), (margin + width, margin),
                         (margin + width, margin + height), (margin, margin + height))
        ]  # fmt: skip
        rows, right = [], []
        for (u, v), (x, y) in zip(corners, ((0, 0), (width, 0), (width, height), (0, height)),
                                  strict=True):  # fmt: skip
            rows += [[u, v, 1, 0, 0, 0, -u * x, -v * x], [0, 0, 0, u, v, 1, -u * y, -v * y]]
            right += [x, y]
        table = tuple(np.linalg.solve(np.array(rows, float), np.array(right, float)))
        laid = sheet.transform(size, Image.Transform.PERSPECTIVE, table, Image.Resampling.BICUBIC)
        there = Image.new("L", sheet.size, 255).transform(
            size, Image.Transform.PERSPECTIVE, table, Image.Resampling.BILINEAR
        )
        desk = choose.randint(30, 90) + 12 * np.sin(np.arange(size[0]) / choose.uniform(9, 60))
        part = np.asarray(there, float) / 255
        light = 0.75 + 0.2 * np.linspace(*choose.choice(((0, 1), (1, 0))), size[0])
        grey = (part * np.asarray(laid, float) + (1 - part) * desk) * light
        grey = grey + noise.normal(0, 3, grey.shape)
        return Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8))
    if kind == "shadow":  # a soft one, of a page on a grey desk
        return shadowed(sheet, choose)
    if kind == "screen":
        return on_screen(sheet, choose)
    strip = round(0.18 * width)
    if kind == "holes":
        wide = Image.new("L", (width + 2 * strip, height), 255)
        wide.paste(sheet, (strip, 0))
        pen, radius = ImageDraw.Draw(wide), round(0.022 * width)
        for middle in (strip // 2, wide.width - strip // 2):
            for y in range(2 * radius, height - radius, 7 * radius):
                pen.ellipse((middle - radius, y - radius, middle + radius, y + radius), 40)
        for x in (strip - 2 * radius, wide.width - strip + 2 * radius):
            for y in range(0, height, 14):
                pen.line((x, y, x, y + 5), 150, 2)
        return wide
    wide = Image.new("L", (width + strip, height + strip), 255)
    wide.paste(sheet, (0, strip))
    ink = choose.randint(20, 90)
    if kind == "stamp":  # over the type, too, in a colour
        colour = choose.choice(((190, 30, 40), (40, 60, 190), (120, 30, 140)))
        shown = wide.convert("RGB")
        stamp = Image.new("L", shown.size, 255)
        pen, x, y = ImageDraw.Draw(stamp), choose.randint(0, width // 2), choose.randint(0, height)
        pen.ellipse((x, y, x + 0.3 * width, y + 0.3 * width), outline=0, width=max(4, width // 150))
        pen.text((x + 0.05 * width, y + 0.13 * width), "RECEIVED", 0,
                 ImageFont.truetype(str(_path(FONTS["liberation"])), width // 26))  # fmt: skip
        over = (255 - np.asarray(stamp, float))[:, :, None] / 255
        tint = np.asarray(shown, float) * (1 - over * (1 - np.array(colour) / 255))
        return Image.fromarray(np.clip(tint, 0, 255).astype(np.uint8))
    pen = ImageDraw.Draw(wide)
    for _ in range(choose.randint(1, 3)):  # words by hand, in the margins
        across = choose.random() < 0.6
        x, y = (choose.uniform(0.05, 0.5) * width, 0.45 * strip) if across else (
            width + 0.25 * strip, choose.uniform(0.2, 0.8) * height)  # fmt: skip
        points = []
        for step in range(choose.randint(25, 60)):
            length = 0.006 * width * step * (1.0 if across else 0.25)
            wave = 0.1 * strip * math.sin(1.9 * step) * choose.uniform(0.4, 1.0)
            points.append((x + length, y + wave))
        pen.line(points, ink, choose.randint(3, 6))
    return wide


def shadowed(sheet: Image.Image, choose: random.Random) -> Image.Image:
    """Paper on a grey desk, a soft shadow over both."""
    noise = np.random.default_rng(choose.getrandbits(32))
    margin, desk = round(0.12 * sheet.width), choose.randint(110, 165)
    laid = Image.new("L", (sheet.width + 2 * margin, sheet.height + 2 * margin), desk)
    laid.paste(Image.eval(sheet, lambda value: round(value * 235 / 255)), (margin, margin))
    laid = laid.rotate(choose.uniform(-1.5, 1.5), Image.Resampling.BICUBIC, fillcolor=desk)
    grey = np.asarray(laid, float)
    y, x = np.mgrid[0 : grey.shape[0], 0 : grey.shape[1]] / max(grey.shape)
    angle = choose.uniform(0, 2 * math.pi)
    within = (x - 0.5) * math.cos(angle) + (y - 0.5) * math.sin(angle) + choose.uniform(-0.2, 0.2)
    light = 1 - choose.uniform(0.35, 0.55) / (1 + np.exp(-within / choose.uniform(0.03, 0.08)))
    grey = grey * light + noise.normal(0, 2, grey.shape)
    return Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8))


PHOSPHORS = {"green": (51, 255, 51), "amber": (255, 176, 0), "white": (255, 255, 255)}


def on_screen(sheet: Image.Image, choose: random.Random, phosphor: str = "") -> Image.Image:
    """Type as an emulator's screen shows it: a colour on black, some with dark scan lines."""
    lit = 1 - np.asarray(sheet.convert("L"), float) / 255
    if choose.random() < 0.4:
        lit[::3] *= 0.5
    colour = PHOSPHORS[phosphor or choose.choice(list(PHOSPHORS))]
    return Image.fromarray((lit[:, :, None] * np.array(colour)).astype(np.uint8))


def _aged(paper: Grey, kind: str, pixels: int, choose: random.Random) -> Grey:
    noise = np.random.default_rng(choose.getrandbits(32))
    if kind == "photo":
        return photographed(worn(paper, choose, "clean"), choose)
    if kind == "pins":  # one pin of the head is dead
        step = max(2, pixels // 9)
        for row in range(step * choose.choice((2, 3, 4)), len(paper), round(1.25 * pixels)):
            paper[row : row + max(1, step // 2)] = 255
        return worn(paper, choose, choose.choice(("good", "medium")))
    if kind == "carbon":
        copy = Image.fromarray(paper.astype(np.uint8)).filter(ImageFilter.GaussianBlur(pixels / 20))
        return 255 - (255 - np.asarray(copy, float)) * 0.6 + noise.normal(0, 12, paper.shape)
    if kind == "turned":
        return np.rot90(worn(paper, choose, "clean"), choose.choice((1, 2, 3)))
    return worn(paper, choose, "hard" if kind == "hard" else "clean")


def _forge(
    paper: Grey,
    kind: str,
    lines: list[str],
    others: list[str],
    font: str,
    pixels: int,
    leading: float,
    choose: random.Random,
    of: list[str],
) -> None:
    """A character erased, or another laid over it: from elsewhere on the page, or in other type."""
    row, column = next(
        (i, j)
        for i, (one, two) in enumerate(zip(lines, others, strict=True))
        for j in range(len(one))
        if one[j] != two[j]
    )
    cell = _glyph(font, "0", pixels)
    if kind == "erased":
        blank = np.full((cell.height, cell.width), 255.0)
        _pasted(paper, blank, pixels, font, (row, column), leading)
        return
    if kind == "line":  # typed anew over white, a trifle beside the old
        blank = np.full((cell.height, cell.width), 255.0)
        for j in range(len(lines[row])):
            _pasted(paper, blank, pixels, font, (row, j), leading)
        fresh = drawn([others[row]], font, pixels)[3 * cell.width :][: cell.height]
        top = 3 * cell.width + row * round(cell.height * leading) + choose.choice((-2, -1, 1, 2))
        fresh = np.roll(fresh, choose.choice((-2, -1, 1, 2)), axis=1)
        area = paper[top : top + cell.height, : fresh.shape[1]]
        np.minimum(area, fresh[: len(area), : area.shape[1]], out=area)
        return
    hand = font
    if kind == "font":
        hand = choose.choice([one for one in of if one != font and one not in DOTS])
    glyph = _glyph(hand, others[row][column], pixels).resize(cell.size)
    moved = np.roll(np.asarray(glyph, float), choose.choice((-2, -1, 0, 1, 2)), axis=(0, 1))
    _pasted(paper, moved, pixels, font, (row, column), leading)


def pages(count: int, seed: int, kinds: tuple[str, ...]) -> Iterator[tuple[Image.Image, Any]]:
    """``count`` pages of each kind."""
    of = fonts()
    for kind in kinds:
        for number in range(count):
            yield page(kind, random.Random(f"{seed} {kind} {number}"), of)


def main() -> None:
    folder, count, *rest = sys.argv[1:]
    seed, kinds = int(rest[0]) if rest else 1988, tuple(rest[1:]) or KINDS
    Path(folder).mkdir(parents=True, exist_ok=True)
    with (Path(folder) / "truth.jsonl").open("a") as truths:
        for number, (picture, truth) in enumerate(pages(int(count), seed, kinds)):
            name = f"{truth['kind']}-{number % int(count) + 1:03}.png"
            picture.save(Path(folder) / name, compress_level=1)
            truths.write(json.dumps({"file": name, **truth}) + "\n")
            truths.flush()


if __name__ == "__main__":
    main()
