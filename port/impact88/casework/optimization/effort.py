"""Limits of the work that a search for draws and bounds may take."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple

CHUNK = 1 << 13  # points evaluated at a time, bounds the memory


class Effort(NamedTuple):
    """Limits of a search; the defaults are those that answers are found with."""

    particles: int = 1000
    """Points that a sampler moves at a time, at most."""
    burn_in_moves: int = 16
    """Moves of each before the first draws are taken, shared by its copies."""
    draws_of_bounds: int = 2000
    """Draws from which bounds are searched for, where none are given."""
    spread_points: int = 2000
    """Points spread over the feasible region."""
    spread_steps: int = 10
    """Random steps that spread them."""
    starts: int = 1
    """Searches per extreme from each group of points."""
    rounds: int = 3
    """Rounds of searches from where those for other extremes ended, at most."""


THOROUGH = Effort()
_granted: ContextVar[Effort] = ContextVar("effort", default=THOROUGH)


def granted() -> Effort:
    """Return the effort that searches may take here."""
    return _granted.get()


@contextmanager
def granting(effort: Effort) -> Iterator[None]:
    """Let every search within take this effort."""
    before = _granted.set(effort)
    try:
        yield
    finally:
        _granted.reset(before)
