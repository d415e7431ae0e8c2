"""The result of comparing another program's table with the reference."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Cause:
    """A mistake of another program that reproduces its numbers.

    Parameters
    ----------
    edit : str
        The edit that a developer would undo: "IB = ..., should be IA, in the moment equation".
    where : str
        The condition under which rows disagree; "" for all rows.
    rows : int
        Disagreeing rows that the cause reproduces.
    of : int
        Disagreeing rows.
    unexplained : tuple of str
        Columns that still disagree.
    """

    edit: str
    where: str
    rows: int
    of: int
    unexplained: tuple[str, ...] = ()


@dataclass(frozen=True)
class Comparison:
    """The comparison of a table with the reference.

    Parameters
    ----------
    passed : bool
        True if every row agrees.
    rows : int
        Rows compared.
    causes : tuple of Cause
        Mistakes that reproduce the table's numbers, the best first.
    disagreements : tuple of str
        Columns and rows that disagree, by how much, and under which condition.
    """

    passed: bool
    rows: int
    causes: tuple[Cause, ...] = ()
    disagreements: tuple[str, ...] = ()
