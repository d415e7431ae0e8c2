"""Text laid out for a terminal: paragraphs after a label, and tables of aligned columns."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from textwrap import wrap

WIDTH = 96  # columns of a paragraph


def paragraph(text: str, label: str = "", indent: int = 0) -> list[str]:
    """Return a text after a label in lines of at most `WIDTH` columns; from the second line on they
    are indented."""
    hanging = " " * indent
    return wrap(text, WIDTH, initial_indent=f"{label:<{indent}}", subsequent_indent=hanging) or [
        label.rstrip()
    ]


def table(rows: Iterable[Sequence[str]], left: Sequence[int] = (0,)) -> list[str]:
    """Return lines of aligned columns, two blanks between; those in ``left`` are left-aligned, and
    columns without text are left out."""
    aligned = []
    for number, column in enumerate(zip(*rows, strict=True)):
        if any(column):
            width = max(map(len, column))
            align = str.ljust if number in left else str.rjust
            aligned.append([align(cell, width) for cell in column])
    return ["  ".join(row).rstrip() for row in zip(*aligned, strict=True)]
