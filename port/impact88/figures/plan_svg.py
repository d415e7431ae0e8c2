"""The scene from above as SVG, without matplotlib: for reports."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .plan import scene_drawing
from .svg import svg


def scene_svg(scene: Any, result: Mapping[str, Any] | None = None) -> str:
    """The scene as a self-contained SVG element, 85 mm wide, to stand in an HTML page or a file.

    ``scene``: an `impact88.Scene` or any mapping of the listing's names to texts or numbers;
    ``result``: VAX, VAY, VBX, VBY, WAF, WBF and, where known, STATUS (see `impact88.solve`);
    without it only what is before the impact is drawn. Units as the scene's. Raises UserError when
    a value of the scene is missing or not a finite number.
    """
    return svg(scene_drawing(scene, result))
