"""The cheapest way to read one text as another, by dynamic programming."""

from collections.abc import Callable
from typing import Any

Step = tuple[int, int, Any]
"""Characters of the reading and of the print that a step takes, 0 or 1 each, and what is said of
it."""
Price = tuple[float, Any]
"""Cost of a step, and what is said of it."""


def cheapest_path(
    read: int,
    printed: int,
    replaced: Callable[[int, int], Price],
    extra: Callable[[int, int], Price],
    lost: Callable[[int, int], Price],
) -> tuple[float, list[Step]]:
    """Return the least cost of reading a printed text so, and the steps of that path.

    Parameters
    ----------
    read, printed : int
        Number of characters that were read, and that are printed.
    replaced, extra, lost : callable
        Map i, j to cost and description of reading printed character j as character i, of character
        i read in addition before j, and of character j lost before i. Of equal costs the first in
        this order counts.
    """
    least: dict[tuple[int, int], float] = {(0, 0): 0.0}
    back: dict[tuple[int, int], Step] = {}
    for i in range(read + 1):
        for j in range(printed + 1):
            here = least[i, j]
            steps: list[tuple[int, int, Price]] = []
            if i < read and j < printed:
                steps.append((1, 1, replaced(i, j)))
            if i < read:
                steps.append((1, 0, extra(i, j)))
            if j < printed:
                steps.append((0, 1, lost(i, j)))
            for di, dj, (cost, said) in steps:
                place = i + di, j + dj
                if place not in least or here + cost < least[place]:
                    least[place], back[place] = here + cost, (di, dj, said)
    path: list[Step] = []
    i, j = read, printed
    while i or j:
        path.append(back[i, j])
        i, j = i - path[-1][0], j - path[-1][1]
    return least[read, printed], path[::-1]
