"""Another program: the planar impact as somebody else would write it, right or with one mistake.

Equations 13 to 18 stated from momentum, restitution, friction and moment, solved by plain Gaussian
elimination in double precision. It shares no code with the package. A mistake is a class that
overrides one method; `MISTAKES` names them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

Numbers = dict[str, float]
FINALS = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")
RESULTS = (*FINALS, "XAF", "YAF", "XBF", "YBF", "KI", "KF", "LOSS", "DVA", "DVB", "PN", "PT")


class Refused(Exception):
    """The program has no answer to this scene."""


class Program:
    """A correct program. ``answer`` is what it prints for a scene."""

    pi = math.pi

    def answer(self, scene: Mapping[str, str]) -> Numbers:
        given = {name: float(text) for name, text in scene.items()}
        seen = self.read(given)
        return self.show(self.results(seen), given)

    # what a mistake may override -----------------------------------------------------------

    def read(self, g: Numbers) -> Numbers:
        """The scene as the program takes it."""
        return g

    def show(self, r: Numbers, g: Numbers) -> Numbers:
        """The results as the program prints them."""
        return r

    def angle(self, degrees: float) -> float:
        return degrees * self.pi / 180

    def friction(self, g: Numbers, sliding: float) -> float | None:
        """The coefficient with its sign; None for the pivot."""
        if g["MU"] == -10:
            return None
        return -g["MU"] if sliding > 0 else g["MU"]

    def momentum(self, g: Numbers) -> tuple[float, float]:
        return g["MA"] * g["UX"] + g["MB"] * g["VX"], g["MA"] * g["UY"] + g["MB"] * g["VY"]

    def restitution(self, g: Numbers) -> float:
        return g["E"]

    def moment(self, g: Numbers) -> float:
        return 1.0 if g["M"] == 4 else g["EM"]

    def arms(self, g: Numbers) -> tuple[float, float, float, float]:
        """The contact point from A, and from B."""
        if g["M"] == 4:
            return 0.0, 0.0, 0.0, 0.0
        a = self.angle(g["TA"]) + self.angle(g["PA"])
        b = self.angle(g["TB"]) + self.angle(g["PB"])
        da, db = g["DA"], g["DB"]
        return -da * math.cos(a), -da * math.sin(a), db * math.cos(b), db * math.sin(b)

    def restitution_arms(self, g: Numbers) -> tuple[float, float, float, float]:
        return self.arms(g)

    def energy(self, g: Numbers, v: Numbers) -> float:
        total = g["MA"] * (v["ax"] ** 2 + v["ay"] ** 2) + g["MB"] * (v["bx"] ** 2 + v["by"] ** 2)
        if g["M"] != 4:
            total += g["IA"] * v["wa"] ** 2 + g["IB"] * v["wb"] ** 2
        return total / 2

    def delta_v(self, dx: float, dy: float) -> float:
        return math.hypot(dx, dy)

    def loss(self, before: float, after: float) -> float:
        return 100 * (before - after) / before

    def rounded(self, x: float) -> float:
        """What an operation leaves."""
        return x

    # the computation ----------------------------------------------------------------------

    def results(self, g: Numbers) -> Numbers:
        if min(g["MA"], g["MB"]) <= 0 or (g["M"] != 4 and min(g["IA"], g["IB"]) <= 0):
            raise Refused
        rows = self.equations(g)
        x = eliminated(rows, self.rounded)
        after = dict(zip(("ax", "ay", "bx", "by", "wa", "wb"), x, strict=True))
        before = {
            "ax": g["UX"], "ay": g["UY"], "bx": g["VX"], "by": g["VY"], "wa": g["WA"], "wb": g["WB"]
        }  # fmt: skip
        rax, ray, rbx, rby = self.arms(g)
        c, s = math.cos(self.angle(g["GA"])), math.sin(self.angle(g["GA"]))
        dax, day = after["ax"] - g["UX"], after["ay"] - g["UY"]
        dbx, dby = after["bx"] - g["VX"], after["by"] - g["VY"]
        r = dict(zip(FINALS, x, strict=True))
        r["XAF"], r["YAF"] = after["ax"] - ray * after["wa"], after["ay"] + rax * after["wa"]
        r["XBF"], r["YBF"] = after["bx"] - rby * after["wb"], after["by"] + rbx * after["wb"]
        r["KI"], r["KF"] = self.energy(g, before), self.energy(g, after)
        if r["KI"]:
            r["LOSS"] = self.loss(r["KI"], r["KF"])
        r["DVA"], r["DVB"] = self.delta_v(dax, day), self.delta_v(dbx, dby)
        r["PN"], r["PT"] = g["MA"] * (dax * c + day * s), g["MA"] * (day * c - dax * s)
        return r

    def equations(self, g: Numbers) -> list[list[float]]:
        """Six rows of six coefficients and a right-hand side; unknown are VAX VAY VBX VBY WA WB."""
        ma, mb = g["MA"], g["MB"]
        point = g["M"] == 4
        ia, ib = (1.0, 1.0) if point else (g["IA"], g["IB"])
        ga = self.angle(g["GA"])
        c, s = math.cos(ga), math.sin(ga)
        rax, ray, rbx, rby = self.arms(g)
        ux, uy, vx, vy, wa, wb = (g[name] for name in ("UX", "UY", "VX", "VY", "WA", "WB"))
        # velocity of the contact points: v + w x r
        dx = (ux - ray * wa) - (vx - rby * wb)
        dy = (uy + rax * wa) - (vy + rbx * wb)
        px, py = self.momentum(g)
        rows = [[ma, 0, mb, 0, 0, 0, px], [0, ma, 0, mb, 0, 0, py]]
        qax, qay, qbx, qby = self.restitution_arms(g)
        normal = [c, s, -c, -s, rax_n(qax, qay, c, s), -rax_n(qbx, qby, c, s)]
        closing = sum(k * v for k, v in zip(normal, (ux, uy, vx, vy, wa, wb), strict=True))
        rows.append([*normal, -self.restitution(g) * closing])
        mu = self.friction(g, dy * c - dx * s)
        if mu is None:
            rows.append([-s, c, s, -c, rax * c + ray * s, -(rbx * c + rby * s), 0.0])
        else:
            kx, ky = -s - mu * c, c - mu * s
            rows.append([ma * kx, ma * ky, 0, 0, 0, 0, ma * (kx * ux + ky * uy)])
        # the impulse on A is MA times its change; B takes the opposite
        mx, my = -(ray - rby) * ma, (rax - rbx) * ma
        rows.append([-mx, -my, 0, 0, ia, ib, -mx * ux - my * uy + ia * wa + ib * wb])
        em, both = self.moment(g), 1 / ia + 1 / ib
        rows.append(
            [
                em * both * ray * ma, -em * both * rax * ma, 0, 0,
                em * both * ia - (1 - em), 1 - em,
                em * both * (ray * ma * ux - rax * ma * uy + ia * wa),
            ]
        )  # fmt: skip
        return rows


def rax_n(rx: float, ry: float, c: float, s: float) -> float:
    """What a spin adds to the normal velocity of a point at (rx, ry)."""
    return -ry * c + rx * s


def eliminated(rows: list[list[float]], rounded: Callable[[float], float]) -> list[float]:
    """Gaussian elimination with the largest pivot of each column, and back substitution."""
    rows = [[rounded(x) for x in row] for row in rows]
    n = len(rows)
    for j in range(n):
        p = max(range(j, n), key=lambda i: abs(rows[i][j]))
        rows[j], rows[p] = rows[p], rows[j]
        if rows[j][j] == 0:
            raise Refused
        for i in range(j + 1, n):
            f = rounded(rows[i][j] / rows[j][j])
            rows[i] = [rounded(a - rounded(f * b)) for a, b in zip(rows[i], rows[j], strict=True)]
    x = [0.0] * n
    for i in reversed(range(n)):
        total = rows[i][n]
        for k in range(i + 1, n):
            total = rounded(total - rounded(rows[i][k] * x[k]))
        x[i] = rounded(total / rows[i][i])
    return x


def answers(program: Program, scenes: list[Mapping[str, str]]) -> list[dict[str, Any]]:
    """What a program prints for scenes: numbers, or None for each result where it refuses."""
    found = []
    for scene in scenes:
        try:
            row: dict[str, Any] = program.answer(scene)
        except (Refused, ZeroDivisionError, OverflowError):
            row = {}
        found.append({name: row.get(name) for name in RESULTS})
    return found
