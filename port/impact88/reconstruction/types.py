"""The result of a reconstruction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Reconstruction:
    """One impact that agrees with what is known.

    Parameters
    ----------
    values : mapping of str to float
        Inputs and results of the impact.
    intervals : mapping of str to (float, float)
        90 % intervals.
    assumed : mapping of str to str
        Ranges assumed for values that were not given.
    verdict : str
        Agreement with the evidence in one line.
    law : str
        The law that misses, with its amount; "" if none does.
    tests : mapping of str to float
        Baarda's normalized residual of each value known with a tolerance.
    solutions : int
        Impacts that agree with what is known.
    draws : mapping of str to sequence of float
        Draws of the posterior; empty if it was not sampled.
    """

    values: Mapping[str, float]
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    assumed: Mapping[str, str] = field(default_factory=dict)
    verdict: str = ""
    law: str = ""
    tests: Mapping[str, float] = field(default_factory=dict)
    solutions: int = 1
    draws: Mapping[str, object] = field(default_factory=dict)
