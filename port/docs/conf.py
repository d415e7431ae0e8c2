"""How Sphinx builds the documentation: sphinx-build -W --keep-going port/docs build/docs.

Two directives are this project's own: ``quantities`` lists a table of `impact88.names`, ``bits``
those of STATUS.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise

from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList
from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

import impact88

project = "impact88"
author = "the impact88 developers"
release = version = impact88.__version__
copyright = author

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.viewcode",
]
exclude_patterns = ["pictures"]
default_role = "py:obj"
myst_enable_extensions = ["substitution"]
myst_heading_anchors = 3
myst_substitutions = {"version": version}

autodoc_typehints = "none"  # types stand in the docstrings, where they are shorter
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
autosummary_generate = False
numpydoc_show_class_members = False
python_maximum_signature_line_length = 80
toc_object_entries_show_parents = "hide"

html_theme = "furo"
html_title = f"impact88 {version}"
html_show_copyright = False
html_static_path = ["static"]
html_css_files = ["wide.css"]

CONSTRUCTED = [f"impact88.{name}" for name in "Amount Applesoft Prepared Scene".split()]
"""Classes that are called. Others are returned: their parameters are shown as attributes."""


class Quantities(Directive):
    """A table of `impact88.names`: ``SCENE`` or ``RESULTS``."""

    required_arguments = 1

    def run(self) -> Sequence[nodes.Node]:
        """Return the table."""
        quantities = getattr(impact88.names, self.arguments[0]).values()
        rows = [(f"``{q.name}``", q.symbol, q.meaning, q.unit) for q in quantities]
        return table(self, ("name", "symbol", "meaning", "unit"), rows)


class Bits(Directive):
    """The table of STATUS's bits."""

    def run(self) -> Sequence[nodes.Node]:
        """Return the table."""
        words = impact88.status.WORDS.items()
        rows = [(str(int(bit)), f"``{bit.name}``", sentence) for bit, sentence in words]
        return table(self, ("bit", "name", "meaning"), rows)


def table(
    directive: Directive, heading: Sequence[str], rows: Sequence[Sequence[str]]
) -> Sequence[nodes.Node]:
    """Return a table of texts in a directive's place."""
    lines = [".. list-table::", "   :header-rows: 1", ""]
    for row in [heading, *rows]:
        for at, cell in enumerate(row):
            literal = cell.startswith("``")
            text = cell if literal else cell.replace("_", r"\_").replace("*", r"\*")
            lines.append(f"   {' ' if at else '*'} - {text}")
    node = nodes.Element()
    directive.state.nested_parse(StringList(lines, "table"), 0, node)
    return node.children


def without_constructor(
    app: Sphinx,
    what: str,
    name: str,
    value: object,
    options: object,
    signature: str | None,
    returned: str,
) -> tuple[str, str] | None:
    """Leave the parameters out of the heading of a class that is not constructed."""
    return ("", "") if signature and what == "class" and name not in CONSTRUCTED else None


def attributes(
    app: Sphinx, what: str, name: str, value: object, options: object, lines: list[str]
) -> None:
    """Show the parameters of a class that is not constructed as attributes, but for private ones.

    Where its docstring lists attributes, these are shown alone.
    """
    if what != "class" or name in CONSTRUCTED or ":Parameters:" not in lines:
        return
    start = lines.index(":Parameters:")
    if ":Attributes:" in lines:
        del lines[start : lines.index(":Attributes:")]
        return
    lines[start] = ":Attributes:"
    field = re.compile(r" +\*\*(\w)")
    starts = [at for at, line in enumerate(lines) if field.match(line)]
    for first, after in reversed([*pairwise(starts)]):
        if "**_" in lines[first]:
            del lines[first:after]


def documented(
    app: Sphinx, what: str, name: str, value: object, skip: bool, options: object
) -> bool | None:
    """Leave out a named tuple's fields, which the class's docstring describes."""
    return True if str(value.__doc__).startswith("Alias for field number") else None


def setup(app: Sphinx) -> None:
    """Add this project's directives, and names of languages that Pygments lacks."""
    app.add_directive("quantities", Quantities)
    app.add_directive("bits", Bits)
    app.add_lexer("csv", TextLexer)
    app.connect("autodoc-skip-member", documented)
    # before numpydoc's handler of signatures, and after its handler of docstrings
    app.connect("autodoc-process-signature", without_constructor, priority=400)
    app.connect("autodoc-process-docstring", attributes, priority=900)
