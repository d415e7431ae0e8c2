"""A scene swept: a table whose rows are one scene with some values running through ranges."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import islice, product
from math import isfinite, prod
from typing import NamedTuple

from ..doubles import digits, double, is_number
from ..errors import UserError, quoted
from ..names import SCENE, check_names
from ..scene import in_base_units
from ..units import shown_text, system_of
from .rows import BLOCK_ROWS, Column, Heading, Reader, Rows

MOST = 10_000_000
"""Scenes of one sweep: a bound on time and room; twice as many take twice as much."""


class Range(NamedTuple):
    """``steps`` evenly spaced values from ``low`` to ``high``, both included."""

    low: float
    high: float
    steps: int

    def values(self) -> list[float]:
        """The values, the ends as they were given."""
        if self.steps == 1:
            return [self.low]
        step = (self.high - self.low) / (self.steps - 1)
        return [*(self.low + i * step for i in range(self.steps - 1)), self.high]


def read_ranges(texts: Mapping[str, str], units: str | None = None) -> dict[str, Range]:
    """Name -> range, in base units, of texts LOW:HIGH:COUNT; ``units``: the system of bare numbers,
    the scene's. Raises UserError naming the value and the form."""
    check_names(texts, tuple(SCENE), "value of a scene", "--sweep")
    ranges = {}
    for name, text in texts.items():
        parts = [part.strip() for part in text.split(":")]
        if len(parts) != 3 or not parts[2].isdigit():
            raise UserError(f"--sweep {name}: {quoted(text)} is not LOW:HIGH:COUNT, such as 0:1:51")
        limits = in_base_units({name: " .. ".join(parts[:2])}, "--sweep", units)[0][name]
        ends = limits.split(" .. ")
        if len(ends) != 2 or not all(map(is_number, ends)):
            raise UserError(f"--sweep {name}: {quoted(text)} is not LOW:HIGH:COUNT, such as 0:1:51")
        low, high, count = double(ends[0]), double(ends[1]), int(parts[2])
        if not (isfinite(low) and isfinite(high)) or not 1 <= count <= MOST:
            raise UserError(f"--sweep {name}: {quoted(text)} is out of range")
        ranges[name] = Range(low, high, count)
    if prod(r.steps for r in ranges.values()) > MOST:
        raise UserError(f"--sweep: more than {MOST:,} scenes; expected fewer")
    return ranges


def _blocks(scene: Mapping[str, str], ranges: Mapping[str, Range]) -> Iterator[Rows]:
    grid = product(*(map(digits, r.values()) for r in ranges.values()))
    while block := list(islice(grid, BLOCK_ROWS)):
        columns: dict[str, Column] = {n: [t] * len(block) for n, t in scene.items()}
        columns |= dict(zip(ranges, zip(*block, strict=True), strict=True))
        yield Rows(len(block), columns)


@contextmanager
def read_sweep(
    scene: Mapping[str, str], ranges: Mapping[str, Range], units: str | None = None
) -> Iterator[Reader]:
    """A reader of the scene's texts with every combination of the ranges' values, the last range
    running fastest; in the system ``units``, the values that have a unit headed with it."""
    system = system_of(units)
    headed = {n: Heading(n, system.heading(n), system.unit(n)) for n in scene}
    texts: dict[str, str] = {headed[n]: shown_text(n, t, system) for n, t in scene.items()}
    swept: dict[str, Range] = {}
    for n, values in ranges.items():
        low, high = (system.factor(n) * limit for limit in values[:2])
        swept[headed[n]] = Range(low, high, values.steps)
    yield Reader(list(texts), _blocks(texts, swept), prod(r.steps for r in ranges.values()))
