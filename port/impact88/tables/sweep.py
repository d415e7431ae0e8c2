"""A scene swept: a table whose rows are one scene with some values running through ranges."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from itertools import islice, product
from math import isfinite, prod
from typing import NamedTuple

from ..collision.case import Case, share_of
from ..collision.doubles import digits, double, is_number
from ..collision.units import nominal, units_in
from ..errors import UserError, quoted
from ..names import SCENE, check_names
from .rows import BLOCK_ROWS, Column, Heading, Reader, Rows

MAX_SCENES = 10_000_000  # of one sweep; time and memory grow with them


class Range(NamedTuple):
    """``steps`` evenly spaced values from ``low`` to ``high``, both included; ``unit``: behind
    each, "%" for shares of the critical friction."""

    low: float
    high: float
    steps: int
    unit: str = ""

    def values(self) -> list[float]:
        """The values, the ends as they were given."""
        if self.steps == 1:
            return [self.low]
        step = (self.high - self.low) / (self.steps - 1)
        return [*(self.low + i * step for i in range(self.steps - 1)), self.high]

    def texts(self) -> list[str]:
        """The values as texts of a scene."""
        return [f"{digits(value)} {self.unit}".rstrip() for value in self.values()]


def read_ranges(texts: Mapping[str, str], case: Case) -> dict[str, Range]:
    """Return name -> range, in base units, of texts LOW:HIGH:COUNT, each an edit of the ``case``.
    Raises UserError naming the value and the form."""
    check_names(texts, tuple(SCENE), "value of a scene", "--sweep")
    ranges = {}
    for name, text in texts.items():
        parts = [part.strip() for part in text.split(":")]
        if len(parts) != 3 or not parts[2].isdigit():
            raise UserError(f"--sweep {name}: {quoted(text)} is not LOW:HIGH:COUNT, such as 0:1:51")
        for part in parts[:2]:
            nominal(name, part, f"--sweep {name}")
        units = {unit for part in parts[:2] for unit, _ in units_in(name, part)}
        if len(units) == 1:  # the unit of one end is the other's
            unit = units.pop()
            parts = [
                p if units_in(name, p) or i == 2 else f"{p} {unit}" for i, p in enumerate(parts)
            ]
        ends = [case.replaced({name: part}, "--sweep").values[name] for part in parts[:2]]
        share = "" if None in map(share_of, ends) else "%"
        ends = [end.removesuffix(share).rstrip() for end in ends]
        if not all(map(is_number, ends)):
            raise UserError(f"--sweep {name}: {quoted(text)} is not LOW:HIGH:COUNT, such as 0:1:51")
        low, high, count = double(ends[0]), double(ends[1]), int(parts[2])
        if not (isfinite(low) and isfinite(high)) or not 1 <= count <= MAX_SCENES:
            raise UserError(f"--sweep {name}: {quoted(text)} is out of range")
        ranges[name] = Range(low, high, count, share)
    if prod(r.steps for r in ranges.values()) > MAX_SCENES:
        raise UserError(f"--sweep: more than {MAX_SCENES:,} scenes; expected fewer")
    return ranges


def _blocks(case: Case, texts: Mapping[str, str], ranges: Mapping[str, Range]) -> Iterator[Rows]:
    inertias = {name: estimate for name, estimate in estimates(case).items() if name in texts}
    grid = product(*(run.texts() for run in ranges.values()))
    while block := list(islice(grid, BLOCK_ROWS)):
        columns: dict[str, Column] = {n: [t] * len(block) for n, t in texts.items()}
        columns |= dict(zip(ranges, zip(*block, strict=True), strict=True))
        for name, estimate in inertias.items():
            if f"M{name[1]}" in ranges:
                columns[name] = [estimate(mass) for mass in columns[f"M{name[1]}"]]
        yield Rows(len(block), columns)


def estimates(case: Case) -> dict[str, Callable[[str], str]]:
    """Return, for each yaw inertia that the case has estimated, the function that gives it as text
    for the text of another mass."""

    def estimate_of(name: str) -> Callable[[str], str]:
        @lru_cache(maxsize=4096)
        def estimate(mass: str) -> str:
            new_case = case.replaced({f"M{name[1]}": mass}).at_nominal()
            return new_case.display_texts({name: new_case.values[name]})[name]

        return estimate

    return {name: estimate_of(name) for name in case.estimated}


@contextmanager
def read_sweep(case: Case, ranges: Mapping[str, Range]) -> Iterator[Reader]:
    """Yield a reader of the case's texts with every combination of the ranges' values, the last
    range running fastest; in the case's system, the values that have a unit headed with it. What
    depends on a value that runs, an estimated inertia or a share of the critical friction, is
    that of each scene."""
    system = case.system
    values = case.at_nominal().values
    scene = {name: values[name] for name in SCENE if name in values}
    headings = {n: Heading(n, system.heading(n), system.unit(n)) for n in scene}
    texts: dict[str, str] = {"case": case.case} if case.case else {}
    texts |= {headings[n]: t for n, t in case.display_texts(scene).items()}
    swept: dict[str, Range] = {}
    for n, run in ranges.items():
        low, high = run[:2] if run.unit else (system.display(n, limit) for limit in run[:2])
        swept[headings[n]] = Range(low, high, run.steps, run.unit)
    yield Reader(list(texts), _blocks(case, texts, swept), prod(r.steps for r in ranges.values()))
