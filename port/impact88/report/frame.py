"""The frame of a page for the case file: jinja2 templates, and what identifies the work.

A page is one HTML file without any other, laid out for Letter or A4 when a browser prints it. The
same input gives the same bytes: nothing on it comes from a clock.
"""

import platform
from collections.abc import Sequence
from hashlib import sha256
from typing import Any

from ..errors import UserError
from ..version import __version__

PAPERS = {"letter": "8.5in 11in", "a4": "210mm 297mm"}
"""Paper -> its size in CSS."""


def render(
    template: str,
    *,
    package: str = __package__ or "",
    title: str,
    case: str = "",
    paper: str = "letter",
    files: Sequence[tuple[str, bytes]] = (),
    **content: Any,
) -> str:
    """The page that ``template`` of ``package`` makes of ``content``, in the frame (frame.html).
    ``title`` and ``case`` stand on every printed page; ``files``: names and bytes of what was read.
    Raises UserError where jinja2 is not installed."""
    import numpy

    try:
        import jinja2
    except ImportError:
        raise UserError("a report needs jinja2; pip install 'impact88[report]'") from None
    loaders = [jinja2.PackageLoader(name) for name in dict.fromkeys((package, __package__ or ""))]
    environment = jinja2.Environment(
        loader=jinja2.ChoiceLoader(loaders),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    page = environment.get_template(template).render(
        title=title,
        case=case,
        running=_css_text(f"Case {case}" if case else title),
        paper=PAPERS[paper],
        files=[(name, f"{len(data):,}", sha256(data).hexdigest()) for name, data in files],
        versions=f"impact88 {__version__}, Python {platform.python_version()}, "
        f"numpy {numpy.__version__}",
        **content,
    )
    return page + "\n"


def _css_text(text: str) -> str:
    """A text as CSS has it between quotes, whatever it holds."""
    return "".join(c if c.isalnum() or c in " .,-/:" else f"\\{ord(c):06x}" for c in text)
