"""What a picture's verdict rests on, as a section of the report: the page with every number's cells
outlined, the cells in doubt beside the glyphs they were compared with, and all margins."""

import base64
import io
from collections.abc import Sequence
from html import escape

import numpy as np

from .evidence import RATES, THRESHOLDS, state
from .holding import Cell
from .ink import Floats, Image
from .sheets import Leaf
from .typeface import BLANK, sample_of, typeface_of

_WIDEST = 1400
"""Pixels across the page as the report shows it; a digit of 80 columns has 17 of them."""
_MOST_STRIPS = 24
_STROKES = {
    "holds": 'stroke="#3a7d5d" stroke-width="1"',
    "doubtful": 'stroke="#1f5f8b" stroke-width="2.5" stroke-dasharray="5 3"',
    "differs": 'stroke="#a33c00" stroke-width="4"',
}


def exhibit(grey: Image, leaves: Sequence[Leaf], leaf: Leaf) -> str:
    """The section on one of a page's printouts as HTML, its pictures within it."""
    upright = np.rot90(grey, leaf.grid.turns)
    shown = [cell for cell in leaf.cells if cell.predicted != BLANK or state(cell) != "holds"]
    places = [cell for cell in shown if cell.name or state(cell) != "holds"]
    corners = [leaf.grid.around(*cell.place) for cell in places]
    doubted = [
        (cell, at) for cell, at in zip(places, corners, strict=True) if state(cell) != "holds"
    ]
    parts = [
        "<h2>The page, cell by cell</h2>",
        _page(upright, places, corners),
        "<p>thin: the character the program prints; dashed: in doubt; thick with a cross: another "
        "character</p>",
        _strips(upright, leaves, doubted[:_MOST_STRIPS], leaf),
        "<h2>Margins of the numbers' cells</h2>",
        _histogram([cell.margin for cell in leaf.cells if cell.name and cell.predicted != BLANK]),
        f"<p>{escape(RATES)}</p>",
    ]
    if len(doubted) > _MOST_STRIPS:
        parts.insert(4, f"<p>{len(doubted) - _MOST_STRIPS} more such cells are not shown.</p>")
    return "\n".join(parts)


def _uri(grey: Image, form: str = "PNG") -> str:
    from PIL import Image as Pillow

    file = io.BytesIO()
    whole = np.clip(grey, 0, 255).astype(np.uint8)
    Pillow.fromarray(np.ascontiguousarray(whole)).save(file, form)
    kind = form.lower()
    return f"data:image/{kind};base64,{base64.b64encode(file.getvalue()).decode()}"


def _page(upright: Image, cells: Sequence[Cell], corners: Sequence[Floats]) -> str:
    from PIL import Image as Pillow

    height, width = upright.shape
    scale = min(1.0, _WIDEST / width)
    size = (max(1, round(width * scale)), max(1, round(height * scale)))
    whole = np.clip(upright, 0, 255).astype(np.uint8)
    small = np.asarray(Pillow.fromarray(np.ascontiguousarray(whole)).resize(size))
    boxes = []
    for cell, around in zip(cells, [one * scale for one in corners], strict=True):
        kind = state(cell)
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in around)
        told = f"{cell.name or 'label'}: {cell.predicted} expected"
        if kind != "holds":
            told += f", looks like {shown(cell.other)}"
        cross = ""
        if kind == "differs":
            (a, b), (c, d) = around[0], around[2]
            (e, f), (g, h) = around[1], around[3]
            cross = f'<path d="M{a:.0f} {b:.0f}L{c:.0f} {d:.0f}M{e:.0f} {f:.0f}L{g:.0f} {h:.0f}" '
            cross += 'fill="none" stroke="#a33c00" stroke-width="0.8"/>'
        boxes.append(
            f'<polygon points="{points}" fill="none" {_STROKES[kind]}>'
            f"<title>{escape(told)}</title></polygon>{cross}"
        )
    return (
        f'<svg viewBox="0 0 {size[0]} {size[1]}" style="width:100%;border:.2mm solid #bbb" '
        f'role="img" aria-label="the page with its cells"><image href="{_uri(small)}" '
        f'width="{size[0]}" height="{size[1]}"/>{"".join(boxes)}</svg>'
    )


def _strips(
    upright: Image, leaves: Sequence[Leaf], doubted: Sequence[tuple[Cell, Floats]], leaf: Leaf
) -> str:
    if not doubted:
        return ""
    # the printouts on a grid share their mean characters
    everything = [cell for one in leaves if one.grid is leaf.grid for cell in one.cells]
    sample = sample_of(leaf.grid, [cell.place for cell in everything])
    typeface = typeface_of(sample, ["" if cell.cut else cell.predicted for cell in everything])

    def glyph(character: str, count: int) -> str:
        at = typeface.index(character)
        if at < 0:
            return "<td>blank paper</td>"
        picture = 255 - 220 * np.clip(typeface.means[at].reshape(typeface.shape), 0, 1)
        return f'<td><img src="{_uri(picture)}" alt="" style="height:11mm"><br>{count} cells</td>'

    rows = []
    for cell, around in doubted:
        (left, top), (right, bottom) = around.min(axis=0), around.max(axis=0)
        wide, tall = right - left, bottom - top
        y = slice(max(0, int(top - 0.2 * tall)), max(1, int(bottom + 0.2 * tall)))
        x = slice(max(0, int(left - wide)), max(1, int(right + wide)))
        crop = upright[y, x]
        picture = f'<img src="{_uri(crop)}" alt="" style="height:14mm">' if crop.size else "cut off"
        rows.append(
            f'<tr class="{state(cell)}"><th scope="row">{escape(cell.name or "label")}, line '
            f"{cell.place.line + 1}, cell {cell.place.cell + 1}</th><td>{picture}</td>"
            f"<td>{escape(shown(cell.predicted))}</td>{glyph(cell.predicted, cell.count)}"
            f"<td>{escape(shown(cell.other))}</td>{glyph(cell.other, cell.other_count)}"
            f"<td>{cell.margin:+.2f}</td><td>{state(cell)}</td></tr>"
        )
    return (
        '<h2>Cells in doubt</h2><div class="wide"><table><thead><tr><th scope="col">place</th>'
        '<th scope="col">the paper</th><th scope="col" colspan="2">the program prints</th>'
        '<th scope="col" colspan="2">it looks like</th><th scope="col">margin</th>'
        f'<th scope="col">state</th></tr></thead><tbody>{"".join(rows)}</tbody></table></div>'
    )


def shown(character: str) -> str:
    """A character as the report names it."""
    return "blank" if character == BLANK else character


def _histogram(margins: Sequence[float]) -> str:
    """Margins in steps of 0.05 from -1.5 to 1.5, with the thresholds."""
    counts, edges = np.histogram(np.clip(margins, -1.5, 1.499), bins=60, range=(-1.5, 1.5))
    high = max(int(counts.max(initial=1)), 1)

    def at(value: float) -> float:
        return 20 + (value + 1.5) / 3 * 560

    bars = "".join(
        f'<rect x="{at(edge):.1f}" y="{90 - 70 * count / high:.1f}" width="8.3" '
        f'height="{70 * count / high:.1f}" fill="#666"/>'
        for edge, count in zip(edges[:-1], counts, strict=True)
    )
    lines = "".join(
        f'<path d="M{at(value):.1f} 12V94" stroke="{colour}" stroke-dasharray="{dash}"/>'
        f'<text x="{at(value) + side:.1f}" y="11" text-anchor="{anchor}">{name} {value:+.2f}</text>'
        for value, name, colour, dash, anchor, side in (
            (THRESHOLDS.holds, "holds below", "#1f5f8b", "5 3", "end", -2),
            (THRESHOLDS.differs, "differs above", "#a33c00", "none", "start", 2),
        )
    )
    ticks = "".join(
        f'<text x="{at(value):.1f}" y="106" text-anchor="middle">{value:+g}</text>'
        for value in (-1.5, -1, -0.5, 0, 0.5, 1, 1.5)
    )
    return (
        '<svg viewBox="0 0 600 112" style="width:100%" font-size="9" role="img" '
        f'aria-label="margins of {len(margins)} cells">{bars}{lines}'
        f'<path d="M20 90H580" stroke="#333"/>{ticks}</svg>'
        "<p>-1: the mean glyph of the character predicted; +1: that of another</p>"
    )
