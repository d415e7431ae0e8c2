"""A drawing as SVG: self-contained text, no library."""

from html import escape

from .drawing import FONTS, MM_PER_POINT, Drawing, Path, Text, dashes, text_runs


class Svg(str):
    """The text of an SVG element, which a notebook shows as a picture."""

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


def _path(path: Path) -> str:
    # dashes as pieces of their own: some renderers know no stroke-dasharray
    pieces = dashes(path.points, path.dash) if path.dash and not path.fill else [path.points]
    steps = " ".join(
        "M" + " L".join(f"{_number(point.real)} {_number(-point.imag)}" for point in piece)
        for piece in pieces
    )
    close = "Z" if path.fill else ""
    look = f'fill="{path.fill or "none"}"'
    if path.stroke:
        look += f' stroke="{path.stroke}" stroke-width="{_number(path.width)}"'
        look += ' stroke-linejoin="round"'
    return f'<path{_role(path.role)} d="{steps}{close}" {look}/>'


HALO = "halo"
"""Class of the white text behind each text: a separate element, because not every renderer paints a
stroke before the fill (``paint-order``)."""


def _text(text: Text) -> str:
    weight = ' font-weight="bold"' if text.bold else ""
    spans = "".join(
        f'<tspan x="{_number(at.real)}" y="{_number(-at.imag)}" '
        f'font-size="{_number(size * MM_PER_POINT)}">{escape(piece, False)}</tspan>'
        for at, piece, size in text_runs(text)
    )
    space = 'xml:space="preserve"'
    behind = (
        f'<text class="{HALO}" aria-hidden="true" fill="#ffffff"{weight} {space} '
        f'stroke="#ffffff" stroke-width="0.5" stroke-linejoin="round">{spans}</text>'
    )
    return f'{behind}<text{_role(text.role)} fill="{text.colour}"{weight} {space}>{spans}</text>'
