"""Templates: the pages, and the drawing, of which Python gives the content alone."""

from __future__ import annotations

import platform
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy

from ..cases.scenefile import INPUTS
from ..errors import library, printable
from ..printouts import words
from ..version import __version__

if TYPE_CHECKING:
    from jinja2 import Environment

VERSIONS = f"impact88 {__version__}, numpy {numpy.__version__}, Python {platform.python_version()}"


@lru_cache(maxsize=1)
def environment() -> Environment:
    """Return the environment of the templates. Raises UserError if jinja2 is not installed."""
    jinja2 = library("jinja2", "report", "a report")
    templates: Environment = jinja2.Environment(
        loader=jinja2.PackageLoader(__package__),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    templates.filters["printable"] = _displayed_text
    templates.globals.update(words=words, inputs=INPUTS, versions=VERSIONS)
    return templates


def _displayed_text(text: object) -> str:
    """Return a text of any source for a page, with escapes for what does not print."""
    lines = str(text).replace("\r\n", "\n").replace("\r", "\n")
    return printable(lines, "\n\t")


def render(template: str, **values: object) -> str:
    """Return a page, or a drawing."""
    return environment().get_template(template).render(values)
