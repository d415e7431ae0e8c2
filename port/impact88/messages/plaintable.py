"""Rows laid out as a table of aligned columns, for people to read."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from textwrap import wrap
from typing import Any

WIDTH = 96  # columns of a paragraph, those of the widest table


def number(value: Any, digits: int = 6) -> str:
    """Return a number with ``digits`` significant digits; "" for NaN."""
    value = float(value)
    if math.isnan(value):
        return ""
    # adding 0.0 turns -0 into 0
    return f"{value + 0.0:.{digits}g}"


def format_fixed(value: Any, decimals: int) -> str:
    """Return a number with ``decimals`` decimals, never -0; "" for NaN."""
    value = float(value)
    if math.isnan(value):
        return ""
    text = f"{value:.{decimals}f}"
    return text.removeprefix("-") if float(text) == 0 else text


def decimals_for(values: Sequence[float]) -> int:
    """Return the decimals that give the largest of ``values`` six significant digits."""
    largest = max((abs(v) for v in values if math.isfinite(v)), default=0.0)
    return max(0, 5 - math.floor(math.log10(largest))) if largest else 5


def table(
    rows: Iterable[Sequence[str]], heading: Sequence[str] | None = None, left: Sequence[int] = (0,)
) -> list[str]:
    """Return lines of aligned columns, two blanks between; those in ``left`` are left-aligned."""
    lines = [list(row) for row in ((heading,) if heading else ()) + tuple(rows)]
    count = max(map(len, lines), default=0)
    lines = [line + [""] * (count - len(line)) for line in lines]
    widths = [max(len(line[i]) for line in lines) for i in range(count)]
    text_lines = [
        "  ".join(
            text.ljust(width) if i in left else text.rjust(width)
            for i, (text, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    ]
    if heading:
        text_lines.insert(1, "-" * max(map(len, text_lines)))
    return text_lines


def quantities(
    values: Mapping[str, float], label: Callable[[str], str], meanings: Mapping[str, str]
) -> list[str]:
    """Return values as table lines: name, number, unit, meaning (that of `names`, unless
    ``meanings`` has another). ``label``: returns the unit of a rule (`units.System.label`)."""
    from ..names import quantity

    all_meanings = {name: quantity(name).meaning for name in values} | dict(meanings)
    rows = [(n, number(x), label(quantity(n).unit), all_meanings[n]) for n, x in values.items()]
    return table(rows, left=(0, 2, 3))


def paragraph(text: str, indent: str = "") -> list[str]:
    """Return a text in lines of at most `WIDTH` columns."""
    return wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent)


def plain(value: Any) -> Any:
    """Return a value for JSON: numpy numbers and arrays as Python's, non-finite numbers as None."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
