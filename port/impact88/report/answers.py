"""The answer to a case: the one record that terminal, JSON, report and web page print."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..cases.amounts import Amount


@dataclass(frozen=True)
class Answer:
    """The answer to a case, in the units of the case.

    Parameters
    ----------
    asked : {"forward", "bounds", "reconstruct"}
        The question that the case leaves open.
    given : mapping of str to Amount
        Values given.
    found : mapping of str to float
        Results.
    intervals : mapping of str to (float, float)
        90 % intervals of the results that have one.
    remarks : tuple of str
        Assumptions.
    warnings : tuple of str
        Reasons to doubt the answer.
    """

    asked: str
    given: Mapping[str, Amount]
    found: Mapping[str, float]
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
