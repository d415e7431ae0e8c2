"""Draw the pictures of README and guide: `python port/docs/pictures/draw.py`.

`impact88.svg` is a page of the 1988 program beside the drawing of `impact88 report`, `crash.svg`
that drawing of the guide's collision, `axes.svg` the angles and signs of a scene.
"""

from __future__ import annotations

import cmath
import math
import re
from html import escape
from pathlib import Path

import impact88
from impact88.cases.case import Case
from impact88.report.answers import ask
from impact88.report.drawing import draw

HERE = Path(__file__).parent
GUIDE = HERE.parent / "guide"
PX = 78  # per unit of length in axes.svg
BLUE, RED, BLACK = "#0068a3", "#bd4f00", "#000"
FONT = 'font-family="DejaVu Sans, Verdana, Arial, sans-serif"'
MONO = 'font-family="DejaVu Sans Mono, Menlo, Consolas, monospace" font-size="12.5"'


def page_and_drawing() -> str:
    """Return a page of the program beside the drawing of its scene."""
    scene = impact88.sample(3)
    lines = [line for line in impact88.run(scene).page.splitlines() if line.strip()][2:]
    view = {name: f"{text} {unit}" for name, text, unit in _with_units(scene)}
    answer = ask(Case.of({**view, "units": "us"}, "Table 3"))
    drawing = draw(answer)
    box = re.search(r'viewBox="([^"]+)"', drawing)
    assert box is not None
    width, height = map(float, box[1].split()[2:])
    scale = min(350 / width, 400 / height)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 830 420" {FONT}>',
        "<title>A page of the 1988 program, and its collision from above</title>",
        '<rect width="830" height="420" fill="#fff"/>',
        '<rect x="10" y="10" width="430" height="400" fill="#fbf9ef" stroke="#d8d2b5"/>',
    ]
    for row, line in enumerate(lines):
        y = 42 + 27 * row
        if row % 2:
            parts.append(f'<rect x="10" y="{y - 18}" width="430" height="27" fill="#e6f0df"/>')
        parts.append(f'<text x="26" y="{y}" xml:space="preserve" {MONO}>{escape(line)}</text>')
    caption = "as an Apple II Plus printed it: every digit is computed again"
    parts.append(f'<text x="26" y="396" font-size="12" fill="#666">{caption}</text>')
    inner = drawing.replace(
        "<svg ",
        f'<svg x="470" y="10" width="{width * scale:.0f}" height="{height * scale:.0f}" ',
        1,
    )
    return "\n".join([*parts, inner, "</svg>"]) + "\n"


def _with_units(scene: impact88.Scene) -> list[tuple[str, str, str]]:
    """Return name, text and unit of each value of a published scene."""
    units = {"mass": "slug", "length": "ft", "length/time": "ft/s"}
    units |= {"mass·length²": "slug-ft2", "degree": "deg", "rad/time": "rad/s"}
    rows = impact88.names.SCENE
    return [(name, scene[name], units.get(rows[name].unit, "")) for name in rows if name in scene]


def collision() -> str:
    """Return the drawing of the guide's collision with dimensions."""
    page = (GUIDE / "collision.md").read_text(encoding="utf-8")
    toml = re.search(r"```toml\n(.*?)```", page, re.S)
    assert toml is not None
    return draw(ask(Case.loads(toml[1])))


class Sheet:
    """A drawing with y upwards, C at its origin."""

    def __init__(self) -> None:
        self.parts: list[str] = []

    def xy(self, point: complex) -> str:
        """Return the SVG coordinates of a point."""
        return f"{360 + PX * point.real:.1f} {250 - PX * point.imag:.1f}"

    def line(self, *points: complex, colour: str, more: str = "") -> None:
        """Draw a line through points."""
        path = "L".join(map(self.xy, points))
        self.parts.append(f'<path d="M{path}" fill="none" stroke="{colour}" {more}/>')

    def arrow(self, start: complex, stop: complex, colour: str, more: str = "") -> None:
        """Draw an arrow."""
        along = (stop - start) / abs(stop - start)
        self.line(start, stop, colour=colour, more=more)
        barbs = (stop, stop - 0.13 * along + 0.05j * along, stop - 0.13 * along - 0.05j * along)
        self.parts.append(f'<path d="M{"L".join(map(self.xy, barbs))}Z" fill="{colour}"/>')

    def arc(self, center: complex, radius: float, start: float, stop: float, colour: str) -> None:
        """Draw an arc from one angle to another, in degrees, with an arrowhead at its end."""
        steps = [math.radians(start + (stop - start) * k / 40) for k in range(41)]
        points = [center + cmath.rect(radius, angle) for angle in steps]
        self.line(*points[:-3], colour=colour, more='stroke-width="1.3"')
        self.arrow(points[-4], points[-1], colour)

    def text(self, point: complex, words: str, colour: str, size: int = 15) -> None:
        """Write words around a point."""
        x, y = self.xy(point).split()
        self.parts.append(
            f'<text x="{x}" y="{y}" font-size="{size}" text-anchor="middle" fill="{colour}" '
            f'stroke="#fff" stroke-width="4" paint-order="stroke">{words}</text>'
        )


def _vehicle(
    sheet: Sheet, name: str, center: complex, front: float, size: tuple[float, float], colour: str
) -> None:
    """Draw a vehicle, its center and the way it faces."""
    unit = cmath.rect(1, math.radians(front))
    long, wide = size
    corners = [center + unit * complex(long * a, wide * b) for a, b in _CORNERS]
    fill = f'fill="{colour}" fill-opacity=".1" stroke-width="1.5"'
    outline = "L".join(map(sheet.xy, corners))
    sheet.parts.append(f'<path d="M{outline}Z" stroke="{colour}" {fill}/>')
    sheet.arrow(center, center + unit * (long + 0.75), colour, 'stroke-dasharray="6 4"')
    x, y = sheet.xy(center).split()
    sheet.parts.append(f'<circle cx="{x}" cy="{y}" r="4" fill="#fff" stroke="{colour}"/>')
    side = 0.5 * wide if name == "B" else -0.5 * wide
    sheet.text(center - unit * complex(0.8 * long, side), name, colour, 22)


_CORNERS = ((1, 1), (-1, 1), (-1, -1), (1, -1))


def axes() -> str:
    """Return the drawing of axes, angles and signs."""
    ga, ta, pa, tb, pb, da, db = -30, -50, 25, 60, -50, 2.15, 1.44
    sheet = Sheet()
    n = cmath.rect(1, math.radians(ga))
    a = cmath.rect(da, math.radians(pa + ta))
    b = -cmath.rect(db, math.radians(pb + tb))
    _vehicle(sheet, "A", a, ta + 180, (1.95, 0.92), BLUE)
    _vehicle(sheet, "B", b, tb, (2.0, 1.1), RED)
    sheet.line(-2.9j * n, 2.6j * n, colour=BLACK, more='stroke-dasharray="9 3 2 3"')
    sheet.text(-3.1j * n - 0.1, "contact plane", BLACK, 13)
    sheet.arrow(0, 0.95 * n, BLACK, 'stroke-width="1.6"')
    sheet.arrow(0, 0.95j * n, BLACK, 'stroke-width="1.6"')
    sheet.text(1.12 * n - 0.06j, "n", BLACK)
    sheet.text(1.12j * n + 0.14, "t", BLACK)
    sheet.line(0, 2.1, colour="#777", more='stroke-dasharray="2 3"')
    sheet.arc(0, 1.75, 0, ga, BLACK)
    sheet.text(cmath.rect(1.98, math.radians(ga / 3)) - 0.05j, "GA", BLACK)
    for center, turn, colour, words in ((a, ta, BLUE, "TA"), (b, tb, RED, "TB")):
        sheet.line(center, center + 1.3, colour="#777", more='stroke-dasharray="2 3"')
        sheet.arc(center, 1.05, 0, turn, colour)
        sheet.text(center + cmath.rect(1.3, math.radians(turn * 0.7)) - 0.05j, words, colour)
    sheet.line(a, a + cmath.rect(1.5, math.radians(ta)), colour=BLUE, more='stroke-dasharray="2 3"')
    sheet.line(a, 0, colour=BLUE, more='stroke-width="2"')
    sheet.line(b, 0, colour=RED, more='stroke-width="2"')
    sheet.text(a * 0.84 - 0.3j, "DA", BLUE)
    sheet.text(b * 0.5 - 0.27j, "DB", RED)
    sheet.arc(a, 0.65, ta + 180, ta + pa + 180, BLUE)
    sheet.text(a + cmath.rect(0.87, math.radians(ta + pa / 2 + 180)), "PA", BLUE)
    sheet.arc(b, 0.6, tb, tb + pb, RED)
    sheet.text(b + cmath.rect(0.81, math.radians(tb + 0.6 * pb)) - 0.05j, "PB", RED)
    sheet.parts.append('<circle cx="360" cy="250" r="5" fill="#fff" stroke="#000"/>')
    sheet.text(-0.22 + 0.1j, "C", BLACK)
    origin = -4.1 - 2.6j
    sheet.arrow(origin, origin + 0.9, BLACK)
    sheet.arrow(origin, origin + 0.9j, BLACK)
    sheet.text(origin + 1.05 - 0.05j, "x", BLACK)
    sheet.text(origin + 1.0j, "y", BLACK)
    note = "GA = -30, TA = -50, PA = 25, TB = 60, PB = -50: counterclockwise is positive"
    sheet.text(0.6 - 3.5j, note, "#555", 13)
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 40 780 500" {FONT}>'
    title = "<title>Axes, angles and signs of a scene</title>"
    ground = '<rect y="40" width="780" height="500" fill="#fff"/>'
    return "\n".join([head, title, ground, *sheet.parts, "</svg>"]) + "\n"


if __name__ == "__main__":
    for name, svg in (
        ("impact88", page_and_drawing()),
        ("crash", collision()),
        ("axes", axes()),
    ):
        (HERE / f"{name}.svg").write_text(svg, encoding="utf-8")
