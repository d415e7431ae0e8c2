"""The chapter's tables and example in words."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..layout import paragraph, table
from .example import steps
from .staged import COLUMNS_2, collisions, comparison
from .validation import checks, medians


def comparison_lines() -> Iterator[str]:
    """Yield Table 2 beside its recomputation, and what explains the cells that differ."""
    rows: dict[int, list[str]] = {}
    cells = comparison()
    for cell in cells:
        mark = "" if cell.agrees else "!"
        value = "lost" if math.isnan(cell.value) else f"{cell.value:.2f}"
        text = f"{cell.printed:.1f} {value}{mark:1}"
        rows.setdefault(cell.collision, [str(cell.collision)]).append(text)
    yield "Table 2: printed value, recomputed value (! differs); loss in percent, dV in ft/s"
    yield from table([["no.", *(f"{name} " for name in COLUMNS_2)], *rows.values()])
    yield f"{sum(cell.agrees for cell in cells)} of {len(cells)} agree within their rounding."
    for cell in cells:
        if not cell.agrees:
            yield from paragraph(f"{cell.collision}, {cell.column}: {cell.explanation}", "!", 2)


def table_lines(number: int) -> Iterator[str]:
    """Yield a table as emended, and the configuration of each collision."""
    rows: list[list[str]] = []
    for collision in collisions():
        values = collision.table2 if number == 2 else collision.scene | collision.measured
        if not rows:
            rows.append(["no.", *values])
        cells = ["lost" if math.isnan(x) else f"{x:g}" for x in values.values()]
        rows.append([str(collision.number), *cells])
    yield f"Table {number}, emended; ft, slug, s, degrees; loss in percent; mu is P_t/P_n"
    yield from table(rows)
    for collision in collisions():
        yield f"{collision.number}: {collision.category}"


def validation_lines() -> Iterator[str]:
    """Yield numbers of published crash tests beside those computed, and sizes of differences."""
    rows = [["source", "test", "quantity", "reported", "computed", "unit", "by"]]
    rows += [
        [c.source, c.test, c.quantity, f"{c.reported:g}", f"{c.computed:.2f}", c.unit, c.kind]
        for c in checks()
    ]
    yield from table(rows, left=(0, 1, 2, 5, 6))
    yield ""
    heads = ["source", "quantity", "unit", "by", "numbers", "median", "largest"]
    sizes = [[*map(str, row[:5]), f"{row[5]:.3g}", f"{row[6]:.3g}"] for row in medians(checks())]
    yield from table([heads, *sizes], left=(0, 1, 2, 3))


def example_lines() -> Iterator[str]:
    """Yield Section VII step by step, each number beside the printed one."""
    verdicts = {None: "", True: "agrees", False: "DIFFERS"}
    for place, step in enumerate(steps()):
        yield from paragraph(f"{place}. {step.title} ({step.equation})")
        rows = [["  name", "value", "unit", "chapter", "", ""]]
        rows += [
            [
                f"  {n.name}",
                f"{n.value:.3f}",
                n.unit,
                n.printed or "",
                verdicts[n.agrees],
                n.meaning,
            ]
            for n in step.numbers
        ]
        yield from table(rows, left=(0, 2, 4, 5))
        yield from paragraph(step.remark, "", 2) if step.remark else []
        yield ""
