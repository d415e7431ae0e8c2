"""Rows laid out as a table of aligned columns, for people to read."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from textwrap import wrap
from typing import Any

WIDTH = 96
"""Columns of a paragraph: those of the widest table."""


def number(value: Any, digits: int = 6) -> str:
    """A number to ``digits`` significant digits; nothing where there is none."""
    value = float(value)
    if math.isnan(value):
        return ""
    # 0 for -0 and for what the digits cannot show
    return f"{value + 0.0:.{digits}g}"


def fixed(value: Any, decimals: int) -> str:
    """A number with a fixed count of decimals, never -0; nothing where there is none."""
    value = float(value)
    if math.isnan(value):
        return ""
    text = f"{value:.{decimals}f}"
    return text.removeprefix("-") if float(text) == 0 else text


def decimals_for(values: Sequence[float]) -> int:
    """The decimals that show the largest of ``values`` to six significant digits."""
    largest = max((abs(v) for v in values if math.isfinite(v)), default=0.0)
    return max(0, 5 - math.floor(math.log10(largest))) if largest else 5


def table(
    rows: Iterable[Sequence[str]], heading: Sequence[str] | None = None, left: Sequence[int] = (0,)
) -> list[str]:
    """Lines of aligned columns, two blanks between; columns in ``left`` start at the left."""
    lines = [list(row) for row in ((heading,) if heading else ()) + tuple(rows)]
    count = max(map(len, lines), default=0)
    lines = [line + [""] * (count - len(line)) for line in lines]
    widths = [max(len(line[i]) for line in lines) for i in range(count)]
    laid = [
        "  ".join(
            text.ljust(width) if i in left else text.rjust(width)
            for i, (text, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    ]
    if heading:
        laid.insert(1, "-" * max(map(len, laid)))
    return laid


def quantities(
    values: Mapping[str, float], label: Callable[[str], str], meanings: Mapping[str, str]
) -> list[str]:
    """Values of any table of names as lines: name, number, unit, meaning (of the table, unless
    ``meanings`` has another). ``label``: the unit of a rule (`units.System.label`)."""
    from ..names import quantity

    meant = {name: quantity(name).meaning for name in values} | dict(meanings)
    rows = [(n, number(x), label(quantity(n).unit), meant[n]) for n, x in values.items()]
    return table(rows, left=(0, 2, 3))


def paragraph(text: str, indent: str = "") -> list[str]:
    """A text in lines of at most `WIDTH`."""
    return wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent)


def plain(value: Any) -> Any:
    """A value as JSON takes it: numpy numbers and arrays unwrapped, not finite ones as null."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
