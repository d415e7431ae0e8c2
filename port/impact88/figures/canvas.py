"""Where matplotlib is met: imported when a figure is drawn, one style for all of them."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ..errors import UserError
from ..files import replacing
from .drawing import (
    BLACK,
    BLUE,
    GREEN,
    MM_PER_POINT,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    Drawing,
    Path,
    text_runs,
)
from .svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = ("svg", "png", "pdf")
DOTS_PER_INCH = 300
STYLE: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 7,
    "axes.labelsize": 7,
    "axes.titlesize": 7.5,
    "xtick.labelsize": 6.5,
    "ytick.labelsize": 6.5,
    "legend.fontsize": 6.5,
    "legend.frameon": False,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.2,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "hatch.linewidth": 0.5,
    "svg.fonttype": "none",
    # the same data give the same file
    "svg.hashsalt": "impact88",
    "pdf.fonttype": 42,
}
COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)


def new_figure(width_mm: float, height_mm: float) -> Figure:
    """An empty figure of that size, in this project's style, tied to no screen. Text sizes and
    other style are those at the time artists are added: draw inside ``with style():``.

    Raises UserError naming the extra to install when matplotlib is missing.
    """
    import_matplotlib()
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    factor = _enlarged[-1]
    inches = (factor * width_mm / 25.4, factor * height_mm / 25.4)
    figure = Figure(figsize=inches, dpi=DOTS_PER_INCH)
    FigureCanvasAgg(figure)
    return figure


@contextmanager
def style() -> Iterator[None]:
    """A context in which matplotlib uses this project's style, whatever the user has set, and says
    nothing. Raises UserError as above."""
    import_matplotlib()
    import matplotlib

    with _quiet(), matplotlib.rc_context():
        matplotlib.rcdefaults()
        factor = _enlarged[-1]
        sizes = {k: v * factor if isinstance(v, float | int) else v for k, v in STYLE.items()}
        sizes |= {name: STYLE[name] for name in STYLE if isinstance(STYLE[name], bool)}
        matplotlib.rcParams.update(dict[Any, Any](sizes | {"pdf.fonttype": 42}))
        yield


_enlarged = [1.0]


@contextmanager
def enlarged(factor: float) -> Iterator[None]:
    """A context in which charts are drawn ``factor`` times as large, their texts and lines too."""
    _enlarged.append(factor)
    try:
        yield
    finally:
        _enlarged.pop()


def import_matplotlib() -> None:
    """Import matplotlib without anybody's settings, unless somebody has imported it already.

    It reads MPLBACKEND and a file ``matplotlibrc`` of the current folder or the user's while it is
    imported, and fails, or talks on stderr, about what it finds there. Raises UserError naming the
    extra to install when it is missing.
    """
    if sys.modules.get("matplotlib") is not None:
        return
    settings = {"MPLBACKEND": "agg", "MATPLOTLIBRC": os.devnull}
    before = {name: os.environ.get(name) for name in settings}
    os.environ.update(settings)
    try:
        with _quiet():
            try:
                import matplotlib  # noqa: F401
            except ImportError:
                raise UserError(
                    "figures need matplotlib, which is not installed; pip install 'impact88[plot]'"
                ) from None
            except Exception:  # the current folder's file comes before all others
                _import_elsewhere()
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _import_elsewhere() -> None:
    """Import matplotlib with another current folder, one that has no file of its name."""
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        del sys.modules[name]  # what the first try left
    folder = os.getcwd()
    os.chdir(os.path.dirname(__file__))
    try:
        import matplotlib  # noqa: F401
    finally:
        os.chdir(folder)


@contextmanager
def _quiet() -> Iterator[None]:
    """Matplotlib's remarks on fonts, caches and settings are no message of this project's."""
    logger = logging.getLogger("matplotlib")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(level)


def drawn(drawing: Drawing) -> Figure:
    """The drawing as a matplotlib figure of exactly its size."""
    with style():
        from matplotlib.patheffects import Stroke

        size = drawing.enlarged
        figure = new_figure(size * drawing.width, size * drawing.height)
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set_xlim(0, drawing.width)
        axes.set_ylim(0, drawing.height)
        axes.axis("off")
        halo = [Stroke(linewidth=size * 0.5 / MM_PER_POINT, foreground="white")]
        for order, item in enumerate(drawing.items):
            if isinstance(item, Path):
                _add_path(axes, item, order, size)
                continue
            look: dict[str, Any] = {
                "fontweight": "bold" if item.bold else "normal",
                "zorder": 10 + order,
            }
            for run in text_runs(item):
                shown = run.text.replace("$", r"\$")
                # the halo is drawn as outlines, the text itself stays text
                axes.text(run.x, run.y, shown, fontsize=size * run.size, path_effects=halo, **look)
                axes.text(
                    *(run.x, run.y, shown),
                    fontsize=size * run.size,
                    color=item.colour,
                    gid=item.role or None,
                    **look,
                )
    return figure


def _add_path(axes: Any, path: Path, order: int, size: float) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    points = size * path.width / MM_PER_POINT
    dashes = tuple(part / path.width for part in path.dash)
    corners = (*path.points, path.points[0]) if path.fill else path.points
    axes.add_patch(
        PathPatch(
            Outline(corners),
            facecolor=path.fill or "none",
            edgecolor=path.stroke or "none",
            linewidth=points if path.stroke else 0,
            linestyle=(0, dashes) if dashes else "-",
            joinstyle="round",
            zorder=10 + order,
            gid=path.role or None,
        )
    )


def check_ending(path: str) -> str:
    """The format the ending of ``path`` asks for. Raises UserError for any other."""
    ending = path.rpartition(".")[2].lower()
    if ending not in FORMATS:
        raise UserError(f"no picture ends so; expected .{', .'.join(FORMATS)}", path)
    return ending


def save(figure: Figure | Drawing, path: str) -> None:
    """Write a figure; the format is the ending of ``path``. A drawing as SVG needs no matplotlib.

    Raises UserError for another ending, a place that cannot be written to, missing matplotlib.
    """
    ending = check_ending(path)
    if isinstance(figure, Drawing):
        if ending == "svg":
            text = '<?xml version="1.0" encoding="UTF-8"?>\n' + svg(figure)
            with replacing(path) as file:
                file.write(text)
            return
        figure = drawn(figure)
    undated = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}[ending]
    with style(), replacing(path, "wb") as file:
        figure.savefig(file, format=ending, dpi=DOTS_PER_INCH, metadata=undated)
