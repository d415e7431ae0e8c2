"""Drawings in files: SVG by ourselves, PNG and PDF by matplotlib, imported when one is written."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING, Any

from ...errors import UserError
from ...files import replacing
from .drawing import MM_PER_POINT, Drawing, Path, Text, dashes, text_runs

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.path import Path as Outline

FORMATS = ("svg", "png", "pdf")
DOTS_PER_INCH = 300
"""Resolution of PNG: the usual one for print."""
FONTS = "'DejaVu Sans', Verdana, Arial, sans-serif"
HALO = "halo"
"""Class of the white text behind each text."""


class Svg(str):
    """The text of an SVG element, which a notebook shows as a picture.

    Examples
    --------
    >>> picture = impact88.scene_svg(impact88.sample(1))
    >>> isinstance(picture, str), picture.count("</svg>")
    (True, 1)
    """

    __slots__ = ()

    def _repr_svg_(self) -> str:
        return str(self)


def svg(drawing: Drawing) -> Svg:
    """The drawing as one SVG element, in millimetres, with title and description; it may stand in
    a file or inside an HTML page."""
    width, height = _number(drawing.width), _number(drawing.height)
    across, up = (_number(x * drawing.enlarged) for x in (drawing.width, drawing.height))
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{across}mm" height="{up}mm" '
        f'viewBox="0 0 {width} {height}" role="img" font-family="{FONTS}">',
        f"<title>{escape(drawing.title, False)}</title>",
        f"<desc>{escape(drawing.description, False)}</desc>",
        f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
    ]
    lines += [_path(item) if isinstance(item, Path) else _text(item) for item in drawing.items]
    return Svg("\n".join([*lines, "</svg>", ""]))


def _number(value: float) -> str:
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _role(role: str) -> str:
    return f' class="{escape(role)}"' if role else ""


def _pieces(path: Path) -> Sequence[tuple[complex, ...]]:
    """Return the lines that a path draws: dashes as pieces of their own, because some renderers
    know no dashed strokes and others start them elsewhere."""
    return dashes(path.points, path.dash) if path.dash and not path.fill else [path.points]


def _outline(path: Path) -> Outline:
    """Return the path for matplotlib. Its Polygon would drop the last point of an open outline
    that ends where it began."""
    from matplotlib.path import Path as Outline

    vertices: list[tuple[float, float]] = []
    codes: list[Any] = []
    for piece in _pieces(path):
        vertices += [(point.real, point.imag) for point in piece]
        codes += [Outline.MOVETO, *[Outline.LINETO] * (len(piece) - 1)]
    if path.fill:
        vertices.append(vertices[0])
        codes.append(Outline.CLOSEPOLY)
    return Outline(vertices, codes)


def _path(path: Path) -> str:
    steps = " ".join(
        "M" + " L".join(f"{_number(point.real)} {_number(-point.imag)}" for point in piece)
        for piece in _pieces(path)
    )
    close = "Z" if path.fill else ""
    look = f'fill="{path.fill or "none"}"'
    if path.stroke:
        look += f' stroke="{path.stroke}" stroke-width="{_number(path.width)}"'
        look += ' stroke-linejoin="round"'
    return f'<path{_role(path.role)} d="{steps}{close}" {look}/>'


def _text(text: Text) -> str:
    weight = ' font-weight="bold"' if text.bold else ""
    spans = "".join(
        f'<tspan x="{_number(at.real)}" y="{_number(-at.imag)}" '
        f'font-size="{_number(size * MM_PER_POINT)}">{escape(piece, False)}</tspan>'
        for at, piece, size in text_runs(text)
    )
    space = 'xml:space="preserve"'
    # an element of its own: not every renderer paints a stroke before the fill (``paint-order``)
    behind = (
        f'<text class="{HALO}" aria-hidden="true" fill="#ffffff"{weight} {space} '
        f'stroke="#ffffff" stroke-width="0.5" stroke-linejoin="round">{spans}</text>'
    )
    return f'{behind}<text{_role(text.role)} fill="{text.colour}"{weight} {space}>{spans}</text>'


def import_matplotlib() -> None:
    """Import matplotlib without the user's settings (MPLBACKEND, ``matplotlibrc``), over errors in
    which it fails or prints on stderr. Raises UserError where it is missing."""
    if sys.modules.get("matplotlib") is not None:
        return
    before = dict(os.environ)
    os.environ |= {"MPLBACKEND": "agg", "MATPLOTLIBRC": os.devnull}
    try:
        # the current folder's file comes before all others
        with _quiet(), contextlib.chdir(os.path.dirname(__file__)):
            import matplotlib  # noqa: F401
    except ImportError:
        raise UserError(
            "PNG and PDF need matplotlib, which is not installed; pip install 'impact88[plot]'"
        ) from None
    finally:
        os.environ.clear()
        os.environ |= before


@contextlib.contextmanager
def _quiet() -> Any:
    """Silence matplotlib's remarks on fonts, caches and settings."""
    import logging  # 3 ms, and SVG needs none

    logger = logging.getLogger("matplotlib")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(level)


def make_figure(drawing: Drawing, dots_per_inch: float = DOTS_PER_INCH) -> Figure:
    """The drawing as a matplotlib figure of exactly its size, tied to no screen."""
    from matplotlib.figure import Figure
    from matplotlib.patches import PathPatch
    from matplotlib.patheffects import Stroke

    size, points = drawing.enlarged, drawing.enlarged / MM_PER_POINT
    inches = (size * drawing.width / 25.4, size * drawing.height / 25.4)
    figure = Figure(figsize=inches, dpi=dots_per_inch)
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, drawing.width), ylim=(-drawing.height, 0))
    axes.axis("off")
    halo = [Stroke(linewidth=0.5 * points, foreground="white")]
    for order, item in enumerate(drawing.items, 10):
        if isinstance(item, Path):
            axes.add_patch(
                PathPatch(
                    _outline(item),
                    facecolor=item.fill or "none",
                    edgecolor=item.stroke or "none",
                    linewidth=points * item.width if item.stroke else 0,
                    joinstyle="round",
                    zorder=order,
                )
            )
            continue
        for at, piece, points_high in text_runs(item):
            look: dict[str, Any] = {"fontsize": size * points_high, "zorder": order}
            look["fontweight"] = "bold" if item.bold else "normal"
            place = (at.real, at.imag, piece.replace("$", r"\$"))
            # the halo is drawn as outlines, the text itself stays text
            axes.text(*place, path_effects=halo, **look)
            axes.text(*place, color=item.colour, **look)
    return figure


def check_ending(path: str) -> str:
    """The format the ending of ``path`` asks for. Raises UserError for any other."""
    ending = path.rpartition(".")[2].lower()
    if ending not in FORMATS:
        form = f"format .{ending}" if "." in path else "format (no file extension)"
        raise UserError(f"unsupported picture {form}; expected .{', .'.join(FORMATS)}", path)
    return ending


def save(drawing: Drawing, path: str, dots_per_inch: float = DOTS_PER_INCH) -> None:
    """Write a drawing, title and description with it; the format is the ending of ``path``. Raises
    UserError for another, a place that cannot be written to, or missing matplotlib."""
    ending = check_ending(path)
    if ending == "svg":
        with replacing(path) as file:
            file.write('<?xml version="1.0" encoding="UTF-8"?>\n' + svg(drawing))
        return
    import_matplotlib()
    import matplotlib

    about: dict[str, Any] = {"Title": drawing.title}
    if ending == "png":
        about["Description"] = drawing.description
    else:  # undated: the same drawing gives the same bytes
        about |= {"Subject": drawing.description, "CreationDate": None}
    with _quiet(), matplotlib.rc_context():
        matplotlib.rcdefaults()
        # without hinting a text is as wide as the layout reckons with, at any resolution
        matplotlib.rcParams.update(
            {"font.family": "DejaVu Sans", "pdf.fonttype": 42, "text.hinting": "no_hinting"}
        )
        figure = make_figure(drawing, dots_per_inch)
        with replacing(path, "wb") as file:
            figure.savefig(file, format=ending, dpi=dots_per_inch, metadata=about)
