"""Impacts that agree with Equations 13 to 18, over arrays, from velocities before *or* after.

An impact is determined by six velocities, each before or after the impact, and for each of the
three laws (restitution, Equation 15; friction, 16; moment, 18) either its coefficient or its
impulse. The laws are linear in the impulses (P_n, P_t, M): three equations, from which everything
else follows. Formulas of the impact come from `mechanics.evaluate`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanics.formulas import sine_and_cosine
from ..mechanics.solve import evaluate

Array = NDArray[np.float64]
Row = list[Any]  # three numbers or arrays, over (P_n, P_t, M)

BEFORE = ("UX", "UY", "WA", "VX", "VY", "WB")
AFTER = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")
COEFFICIENTS = ("E", "MUP", "EM")
IMPULSES = ("PN", "PT", "PM")
VEHICLES = ("MA", "MB", "IA", "IB", "DA", "DB", "PA", "PB", "TA", "TB", "GA")
SPEEDS = {"SA": ("UX", "UY"), "SB": ("VX", "VY"), "SAF": ("VAX", "VAY"), "SBF": ("VBX", "VBY")}
COURSES = {"HA": "SA", "HB": "SB", "HAF": "SAF", "HBF": "SBF"}
FORCES = ("PDOFA", "PDOFB")
PIVOT = -10.0
NO_MOMENT = 0.0
NOTHING: list[Row] = [[0.0] * 3] * 3
GEOMETRY = (
    "s c an at bn bt ia ib ma mb R J Ired part_a part_b sn st kn kt angle_a angle_b da db "
    "D1 D2 D3 D4"
).split()


class Bodies:
    """The two vehicles in contact: inverse masses, arms and axes.

    Parameters
    ----------
    values : mapping of str to float or array
        `VEHICLES`, in one set of units.
    """

    def __init__(self, values: Mapping[str, Any]) -> None:
        self.values = {name: values[name] for name in VEHICLES}
        self.geometry, _ = evaluate({"M": 6.0, **self.values}, GEOMETRY)
        g = self.geometry
        c, s, a, b, i, j = (g[name] for name in ("c", "s", "ma", "mb", "ia", "ib"))
        an, at, bn, bt = (g[name] for name in ("an", "at", "bn", "bt"))
        # changes of the six velocities by a unit of each impulse
        self.by_impulse: list[Row] = [
            [c * a, -s * a, 0.0],
            [s * a, c * a, 0.0],
            [an * i, at * i, i],
            [-c * b, s * b, 0.0],
            [-s * b, -c * b, 0.0],
            [bn * j, bt * j, -j],
        ]
        # velocities of contact points along n and t, and of spins, A's minus B's
        self.relative: list[Row] = [
            [c, s, an, -c, -s, bn],
            [-s, c, at, s, -c, bt],
            [0.0, 0.0, 1.0, 0.0, 0.0, -1.0],
        ]
        self.relative_spin = i + j  # change of the relative spin by a unit of the moment
        self._compliances: dict[tuple[bool, ...], list[Row]] = {}

    def compliance(self, chosen: Sequence[bool]) -> list[Row]:
        """Return changes of the relative velocities by impulses, through the ``chosen`` ones among
        the six changes of velocity."""
        key = tuple(chosen)
        if key not in self._compliances:
            places = [k for k in range(6) if key[k]]
            self._compliances[key] = [
                [sum((row[k] * self.by_impulse[k][p] for k in places), 0.0) for p in range(3)]
                for row in self.relative
            ]
        return self._compliances[key]


class Impacts:
    """Impacts, with every quantity that follows from them by name.

    Parameters
    ----------
    bodies : Bodies
        The vehicles.
    known : mapping of str to float or array
        For each velocity the one in `BEFORE` or the one in `AFTER`; for each law the coefficient or
        the impulse. MUP = -10 ends the sliding.
    """

    def __init__(self, bodies: Bodies, known: Mapping[str, Any]) -> None:
        self.bodies, self.known = bodies, known
        # point masses have no moment: its law is the impulse of 0
        self.exact = ("EM",) if known.get("PM") is NO_MOMENT else ()
        self.late = [early not in known for early in BEFORE]
        pairs = zip(BEFORE, AFTER, self.late, strict=True)
        given = [known[late if is_late else early] for early, late, is_late in pairs]
        self._all = bodies.compliance([True] * 6)
        rows, right = self._laws(given, bodies.compliance(self.late), known)
        self.impulse = solve_three(rows, right)
        self.change = [_dot(row, self.impulse) for row in bodies.by_impulse]
        triples = list(zip(given, self.change, self.late, strict=True))
        self.before = [x - change if late else x for x, change, late in triples]
        self.after = [x if late else x + change for x, change, late in triples]
        self.relative_before = [_dot(row, self.before) for row in bodies.relative]
        self.relative_after = [_dot(row, self.after) for row in bodies.relative]
        self.headings: dict[str, Any] = {}  # of vehicles that face the way they travel
        self._found: dict[str, Any] = {}

    def _laws(
        self, given: list[Any], deferred: list[Row], known: Mapping[str, Any]
    ) -> tuple[list[Row], list[Any]]:
        """Return Equations 15, 16 and 18 as rows over the impulses, and their right sides.

        ``deferred``: the part of the compliance that acts before the velocities ``given``;
        ``known``: coefficients, or impulses in their place."""
        full = self._all
        speeds = [_dot(row, given) for row in self.bodies.relative]
        rows: list[Row] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        right = [known.get(name, 0.0) for name in IMPULSES]
        if "E" in known:
            e = 1.0 + known["E"]
            rows[0] = [full[0][p] - e * deferred[0][p] for p in range(3)]
            right[0] = -e * speeds[0]
        if "MUP" in known and np.all(known["MUP"] == PIVOT):
            rows[1] = [full[1][p] - deferred[1][p] for p in range(3)]
            right[1] = -speeds[1]
        elif "MUP" in known:
            rows[1], right[1] = [-known["MUP"], 1.0, 0.0], 0.0
        if "EM" in known:
            em = known["EM"]
            rows[2] = [(1.0 - em) * (full[2][p] - deferred[2][p]) for p in range(3)]
            rows[2][2] = rows[2][2] - em * full[2][2]
            right[2] = -(1.0 - em) * speeds[2]
        return rows, right

    def log_volume(self) -> Any:
        """Return the log of the volume of velocities before the impact and coefficients per unit
        of what is given in their place.

        It is a ratio of two determinants of the laws over the impulses (the matrix determinant
        lemma), and for each impulse that is given a factor of its law."""
        as_coefficients = {name: self[name] for name in COEFFICIENTS if name not in self.exact}
        early = _determinant(self._laws(self.before, NOTHING, {**self.known, **as_coefficients})[0])
        deferred = self.bodies.compliance(self.late)
        mixed = _determinant(self._laws(self.before, deferred, self.known)[0])
        total = np.log(np.abs(early)) - np.log(np.abs(mixed))
        spin = self.relative_after[2] + self.impulse[2] * self._all[2][2]
        factors = (self.relative_before[0], self.impulse[0], spin)
        for name, factor in zip(COEFFICIENTS, factors, strict=True):
            if name in as_coefficients and name not in self.known:
                total = total - np.log(np.abs(factor))
        return total

    def __getitem__(self, name: str) -> Any:
        """Return a quantity by name, over the impacts."""
        if name not in self._found:
            self._found[name] = self._quantity(name)
        return self._found[name]

    def _quantity(self, name: str) -> Any:
        for names, values in ((BEFORE, self.before), (AFTER, self.after), (IMPULSES, self.impulse)):
            if name in names:
                return values[names.index(name)]
        if name in VEHICLES:
            return self.headings.get(name, self.bodies.values[name])
        if name in COEFFICIENTS:
            return self._coefficient(name)
        if name in SPEEDS:
            return np.hypot(*(self[part] for part in SPEEDS[name]))
        if name in COURSES:
            x, y = (self[part] for part in SPEEDS[COURSES[name]])
            return np.degrees(np.arctan2(y, x))
        if name in FORCES or name in ("DVAF", "DVAR", "DVBF", "DVBR"):
            return self._along_vehicle(name)
        if name == "EL":
            return self._evaluated("lost")
        if name == "DT":
            return self["LOSS"] / 100.0
        if name == "P":
            return np.hypot(self["PN"], self["PT"])
        if name == "RR0":
            return -self["EM"] / (1.0 - 2.0 * self["EM"])
        if name in ("CAX", "CAY"):
            return -self.bodies.geometry["D4" if name == "CAX" else "D3"]
        if name in ("CBX", "CBY"):
            return self.bodies.geometry["D2" if name == "CBX" else "D1"]
        return self._evaluated(name)

    def _coefficient(self, name: str) -> Any:
        if name in self.known:
            return self.known[name] + 0.0 * self.impulse[0]
        if name == "E":
            return -self.relative_after[0] / self.relative_before[0]
        if name == "MUP":
            return self.impulse[1] / self.impulse[0]
        spin = self.relative_after[2]
        return spin / (spin + self.impulse[2] * self._all[2][2])

    def _along_vehicle(self, name: str) -> Any:
        """Return the velocity change forward or to the right, or where the force comes from."""
        vehicle = name[4] if name in FORCES else name[2]
        x, y = self.change[:2] if vehicle == "A" else self.change[3:5]
        front = self["T" + vehicle] + (180.0 if vehicle == "A" else 0.0)
        if name in FORCES:
            return 180.0 - (np.degrees(np.arctan2(y, x)) - front) % 360.0
        s, c = sine_and_cosine(front)
        return x * c + y * s if name[3] == "F" else x * s - y * c

    def _evaluated(self, name: str) -> Any:
        """Return a result of `mechanics` of these impacts."""
        known: dict[str, Any] = {"M": 6.0, **self.bodies.values, **self.bodies.geometry}
        known |= dict(zip(BEFORE, self.before, strict=True))
        known |= dict(zip(AFTER, self.after, strict=True))
        known |= dict(zip(IMPULSES, self.impulse, strict=True))
        known |= dict(zip(("gn", "gt"), self.relative_before, strict=False))
        ax, ay, _, bx, by, _ = self.change
        known |= {"ax": ax, "ay": ay, "bx": -bx, "by": -by, "gt_after": self.relative_after[1]}
        known |= {"wa": self.before[2], "wb": self.before[5]}
        known |= {"E": self["E"], "MU": self["MUP"], "mu": self["MUP"], "em": self["EM"]}
        values, missing = evaluate(known, (name,))
        if missing:
            raise KeyError(name)
        return values[name]


def _dot(row: Sequence[Any], column: Sequence[Any]) -> Any:
    return sum((a * b for a, b in zip(row, column, strict=True)), 0.0)


def _determinant(m: Sequence[Sequence[Any]]) -> Any:
    a, b, c = m
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def solve_three(rows: Sequence[Sequence[Any]], right: Sequence[Any]) -> list[Any]:
    """Return the solution of three linear equations (Cramer's rule), over arrays."""
    total = _determinant(rows)
    columns = list(zip(*rows, strict=True))
    solution = []
    for k in range(3):
        changed = [right if j == k else columns[j] for j in range(3)]
        solution.append(_determinant(changed) / total)
    return solution
