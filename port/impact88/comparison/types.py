"""The result of a comparison."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

MAX_ROWS_LISTED = 1000  # in a cause or comparison; their counts have all


@dataclass(frozen=True)
class Cause:
    """A mistake that gives the other program's numbers.

    Parameters
    ----------
    edit : str
        What the other program computes, and what it should.
    where : str
        The condition on the scene under which it does, "" for all rows.
    results : tuple of str
        The results whose disagreement it explains.
    rows, of : int
        Rows explained, of those that disagree in these results.
    alternatives : tuple of str
        Other mistakes that give the same numbers.
    names : str
        What the names stand for with which the edit is described.
    unexplained_rows : tuple of int
        The first rows that disagree and that it does not explain, from 1.

    Examples
    --------
    >>> cause = impact88.Cause("MA, should be MB", "", ("VBX",), rows=290, of=300)
    >>> cause.unexplained
    10
    """

    edit: str
    where: str
    results: tuple[str, ...]
    rows: int
    of: int
    alternatives: tuple[str, ...] = ()
    names: str = ""
    unexplained_rows: tuple[int, ...] = ()

    @property
    def unexplained(self) -> int:
        """Rows that disagree and that it does not explain."""
        return self.of - self.rows


@dataclass(frozen=True)
class Disagreement:
    """The disagreement of a result.

    Parameters
    ----------
    result : str
        Its name.
    rows, compared : int
        Rows that disagree, of those compared.
    row : int
        The row that disagrees most, from 1.
    theirs : str
        The other program's number there.
    ours : float
        The reference.
    relative : float
        The difference there, relative to the scene's largest velocity, spin or energy.
    where : str
        A condition on the scene under which rows disagree, "" without one.
    """

    result: str
    rows: int
    compared: int
    row: int
    theirs: str
    ours: float
    relative: float
    where: str = ""


@dataclass(frozen=True)
class Comparison:
    """The result of `impact88.compare`.

    Parameters
    ----------
    passed : bool
        True if every result was compared and none disagrees; of a kit, if every vector passes.
    rows, agreeing, differing : int
        Rows of the table, those that agree and those that do not.
    results : tuple of str
        The results compared.
    causes : tuple of Cause
        Mistakes that explain the rows that disagree.
    disagreements : tuple of Disagreement
        For each result that disagrees, in how many rows and by how much.
    notes : tuple of str
        Digits lost, rows and columns that could not be compared.
    differing_rows : tuple of int
        The first rows that disagree, from 1.
    kit : dict of str to object, optional
        The kit's id, its number of vectors, and the reason of each that fails.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> impact88.compare({**scene, "LOSS": "57.0"}).disagreements[0].row
    1
    """

    passed: bool
    rows: int
    agreeing: int
    differing: int
    results: tuple[str, ...] = ()
    causes: tuple[Cause, ...] = ()
    disagreements: tuple[Disagreement, ...] = ()
    notes: tuple[str, ...] = ()
    differing_rows: tuple[int, ...] = ()
    kit: Mapping[str, Any] = field(default_factory=dict)

    def __str__(self) -> str:
        from .words import as_text

        return as_text(self)
