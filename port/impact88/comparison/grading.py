"""Grade a table: results that agree, that lose digits, that disagree, that are missing."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ..errors import quoted
from .agreement import LOST_DIGITS, Bools, elimination_bounds, reference
from .evaluation import Floats
from .numbers import numbers, units
from .spellings import COMPARED

NO_DIGIT_LEFT = 1e-3  # of the scene's size: a difference that rounding makes, and tells nothing


class Table:
    """Another program's results beside the reference.

    Parameters
    ----------
    scene : mapping of str to ndarray
        The columns of the scenes.
    columns : mapping of str to array_like
        Results by name: texts, whose digits count, or numbers.
    factors : mapping of str to float
        What converts results to the units of the scene.

    Attributes
    ----------
    names, empty : list of str
        Results in the table, and those without any number.
    factors : dict of str to float
        What converts each result to the units of the scene.
    theirs, ours, units : dict of str to ndarray
        The table's numbers, the reference, a unit of the last digit written.
    difference : dict of str to ndarray
        How far off the table's numbers are.
    misfit : dict of str to ndarray of bool
        Where a result disagrees.
    disagreeing : list of str
        Results that disagree.
    elimination : dict of str to ndarray
        What rounding may change in rows that disagree, where elimination finds the velocities.
    wrong, agreeing, lost, unstable, missing, surplus : ndarray of bool
        Rows that disagree; that agree; that agree but for digits lost; in which rounding leaves no
        digit to compare; without a result where there is one; with one where there is none.
    """

    def __init__(
        self, scene: Mapping[str, Floats], columns: Mapping[str, Any], factors: Mapping[str, float]
    ) -> None:
        self.scene, self.columns = scene, columns
        self.size = len(scene["UX"])
        self.names = [name for name in COMPARED if name in columns]
        self.factors = {name: factors.get(name, 1.0) for name in self.names}
        self.theirs = {name: numbers(columns[name]) * k for name, k in self.factors.items()}
        digits = units({name: columns[name] for name in self.names})
        self.units = {name: unit * abs(self.factors[name]) for name, unit in digits.items()}
        self.empty = [n for n in self.names if not np.isfinite(self.theirs[n]).any()]
        self.reference = reference(scene, self.names)
        self.ours = dict(self.reference.values)
        self._take_ties()
        self.difference = {n: np.abs(self.theirs[n] - self.ours[n]) for n in self.names}
        self._grade()

    def _limit(self, name: str) -> Floats:
        """Return how far off a correct result may be."""
        return self.reference.bounds[name] + self.units[name] / 2

    def _take_ties(self) -> None:
        """Take the results of a contact that slides the other way, where rounding decides that."""
        ties = self.reference.ties.copy()
        if ties.any():
            alternatives = self.reference.alternatives
            for name in self.names:
                off = np.abs(self.theirs[name] - alternatives[name])
                ties &= ~(off > self._limit(name))
            for name in self.names:
                self.ours[name] = np.where(ties, alternatives[name], self.ours[name])

    def _grade(self) -> None:
        """Set the rows of each grade."""
        self.misfit: dict[str, Bools] = {}
        self.lost = np.zeros(self.size, bool)
        for name, difference in self.difference.items():
            off = difference > self._limit(name)
            close = LOST_DIGITS * self.reference.scales[name] + self.units[name] / 2
            self.misfit[name] = off & ~(difference <= close)
            self.lost |= off & ~self.misfit[name]
        self._excuse_elimination()
        self.wrong = self.differing(self.names)
        self.disagreeing = [name for name in self.names if self.misfit[name].any()]
        answer, expectation = (
            np.isfinite(np.array([results[name] for name in self.names]))
            for results in (self.theirs, self.ours)
        )
        self.missing: Bools = (~answer & expectation).any(0) & ~self.reference.optional
        self.surplus: Bools = (answer & ~expectation).any(0)
        compared = (answer & expectation).any(0)
        self.agreeing: Bools = compared & ~(self.wrong | self.missing | self.unstable)

    def _excuse_elimination(self) -> None:
        """Take differences that elimination may cause for digits lost."""
        self.elimination = {name: np.zeros(self.size) for name in self.names}
        self.unstable = np.zeros(self.size, bool)
        rows = np.flatnonzero(self.differing(self.names))
        if not rows.size:
            return
        bounds = elimination_bounds({n: c[rows] for n, c in self.scene.items()}, self.names)
        within = np.ones(rows.size, bool)
        sizable = np.zeros(rows.size, bool)
        for name in self.names:
            self.elimination[name][rows] = np.nan_to_num(bounds[name])
            difference = self.difference[name][rows]
            misfit = self.misfit[name][rows]
            within &= ~misfit | (difference <= bounds[name] + self._limit(name)[rows])
            sizable |= misfit & (difference > NO_DIGIT_LEFT * self.reference.scales[name][rows])
        for name in self.names:
            self.misfit[name][rows[within]] = False
        self.lost[rows[within & ~sizable]] = True
        self.unstable[rows[within & sizable]] = True

    def differing(self, names: Iterable[str]) -> Bools:
        """Return the rows in which one of some results disagrees."""
        return sum((self.misfit[name] for name in names), np.zeros(self.size, bool))

    def relative_difference(self, name: str) -> Floats:
        """Return differences where a result disagrees, relative to the largest of its kind."""
        size = np.fmax(self.reference.scales[name], np.abs(self.theirs[name]))
        return np.where(self.misfit[name], self.difference[name] / size, 0.0)

    def notes(self) -> list[str]:
        """Return what was not compared, and digits that are lost, in words."""
        notes = [f"{name} has no number in any row" for name in self.empty]
        counts = {
            "agree, but lose digits to rounding": self.lost & ~self.wrong,
            "leave no digit to compare: the equations are too nearly singular": self.unstable,
            "lack a result where there is one": self.missing,
            "have a number where the equations have no answer": self.surplus,
        }
        for says, rows in counts.items():
            if rows.any():
                notes.append(f"rows that {says}: {int(rows.sum())}")
        if self.missing.any():
            row = int(self.missing.argmax())
            name = next(n for n in self.names if not np.isfinite(self.theirs[n][row]))
            cell = quoted(str(self.columns[name][row] or ""))
            notes.append(f"the first of them is row {row + 1}: {name} = {cell}; expected a number")
        return notes
