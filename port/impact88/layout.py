"""Text laid out for a terminal: paragraphs behind a label, and tables of aligned columns."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from textwrap import wrap

WIDTH = 96  # columns of a paragraph


def paragraph(text: str, label: str = "", indent: int = 0) -> list[str]:
    """Return a text behind a label in lines of at most `WIDTH` columns; the second line and those
    behind it are indented."""
    hanging = " " * indent
    return wrap(text, WIDTH, initial_indent=f"{label:<{indent}}", subsequent_indent=hanging) or [
        label.rstrip()
    ]


def table(rows: Iterable[Sequence[str]], left: Sequence[int] = (0,)) -> list[str]:
    """Return lines of aligned columns, two blanks between; those in ``left`` are left-aligned, and
    columns without text are left out."""
    cells = [list(row) for row in rows]
    columns = [
        (number, column) for number, column in enumerate(zip(*cells, strict=True)) if any(column)
    ]
    aligned = []
    for number, column in columns:
        width = max(map(len, column))
        align = str.ljust if number in left else str.rjust
        aligned.append([align(cell, width) for cell in column])
    return ["  ".join(row).rstrip() for row in zip(*aligned, strict=True)]
