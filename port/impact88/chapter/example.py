"""Section VII as a worked example: a reconstruction, step by step, computed.

A 90° front-to-side collision whose truth is Table 3. The analyst knows the vehicles and, from
trajectory calculations, the final velocities, and that neither vehicle swerved (v_ay = v_bx = 0).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from ..mechanics.solve import evaluate, solve
from ..names import FINAL_VELOCITIES
from .deltav import AS_PRINTED, AS_USED, delta_v, initial_velocity

TABLE_3 = {
    "E": 0.25,
    "MU": 0.89,
    "EM": -0.9,
    "DA": 4.5,
    "DB": 4.0,
    "GA": 0.0,
    "PA": 0.0,
    "PB": -40.0,
    "TA": 0.0,
    "TB": 90.0,
    "MA": 96.0,
    "MB": 145.0,
    "IA": 1970.0,
    "IB": 3770.0,
    "UX": -36.667,
    "UY": 0.0,
    "WA": 0.0,
    "VX": 0.0,
    "VY": 58.667,
    "WB": 0.0,
}
ESTIMATES = {"VAX": -10.0, "VAY": 20.0, "VBX": -20.0, "VBY": 45.0}
"""The analyst's final velocities, ft/s."""
SPINS = {"WA": 0.0, "WB": 0.0, "WAF": -2.9, "WBF": -0.9}
"""Spins for the last step: Table 3's to one digit; the chapter names the step without numbers."""
STATED_LOSS = 40.0  # percent: ΔT = 0.4 "follows from Table 2 for this type of collision"


@dataclass(frozen=True)
class Result:
    """A number of the example: what it is, its value, and what the chapter prints, if it does."""

    name: str
    meaning: str
    value: float
    unit: str
    printed: str | None = None

    @property
    def agrees(self) -> bool | None:
        """True if the value rounds to the printed digits; None where nothing is printed."""
        if self.printed is None:
            return None
        decimals = len(self.printed.partition(".")[2])
        return f"{self.value:.{decimals}f}" == self.printed


@dataclass(frozen=True)
class Step:
    """One step: what is done, with which equation, its numbers, and a remark."""

    title: str
    equation: str
    numbers: tuple[Result, ...]
    remark: str = ""

    def __getitem__(self, name: str) -> float:
        """Return the value of a number."""
        return next(number.value for number in self.numbers if number.name == name)


@cache
def steps() -> tuple[Step, ...]:
    """Return the steps of Section VII, in its order."""
    truth = {name: float(value) for name, value in solve(TABLE_3).items()}
    momentum = _momentum()
    motion = {"UX": momentum["UX"], "UY": 0.0, "VX": 0.0, "VY": momentum["VY"], **ESTIMATES}
    changes, _ = evaluate(motion, "DVA DVB")
    values = [float(changes[name]) for name in ("DVA", "DVB")]
    return (
        _truth(truth),
        momentum,
        Step(
            "Velocity changes from them",
            "Equations 20 and 21",
            _of_both("DVA DVB", "velocity change", values, "36.2 24.0"),
        ),
        *_equation_19(truth, momentum),
        _coefficients(momentum),
    )


def _of_both(
    names: str, meaning: str, values: Sequence[float], printed: str = ""
) -> tuple[Result, ...]:
    """Return the numbers for a velocity of A and one of B."""
    rows = zip(names.split(), "AB", values, printed.split() or (None, None), strict=True)
    return tuple(Result(n, f"{meaning} of {v}", value, "ft/s", p) for n, v, value, p in rows)


def _truth(truth: dict[str, float]) -> Step:
    velocities = (
        Result(name, "", truth[name], "rad/s" if name.startswith("W") else "ft/s")
        for name in FINAL_VELOCITIES
    )
    changes = (truth["DVA"], truth["DVB"])
    return Step(
        "What really happened, unknown to the analyst (Table 3)",
        "Equations 13 to 18",
        (
            *_of_both("UX VY", "initial velocity", (TABLE_3["UX"], TABLE_3["VY"])),
            *velocities,
            *_of_both("DVA DVB", "true velocity change", changes, "39.1 25.9"),
            Result("LOSS", "energy lost", truth["LOSS"], "percent", "37.4"),
        ),
    )


def _momentum() -> Step:
    ma, mb = TABLE_3["MA"], TABLE_3["MB"]
    ux = ESTIMATES["VAX"] + mb / ma * ESTIMATES["VBX"]
    vy = ESTIMATES["VBY"] + ma / mb * ESTIMATES["VAY"]
    return Step(
        "Initial velocities from the estimated final ones, v_ay = v_bx = 0",
        "Equations 13 and 14",
        _of_both("UX VY", "initial velocity", (ux, vy), "-40.21 58.24"),
        "Conservation of momentum alone: no coefficient and no spin is needed. The final "
        "velocities are estimates: VAX -10, VAY 20, VBX -20, VBY 45 ft/s.",
    )


def _equation_19(truth: dict[str, float], momentum: Step) -> tuple[Step, Step]:
    """Return the steps by Equation 19: with the values that give the printed numbers, and beside
    them with the values that the text states."""

    def changes(speeds: Sequence[float], loss: float, factor: float) -> list[float]:
        impact = {**TABLE_3, "SA": abs(speeds[0]), "SB": abs(speeds[1]), "LOSS": loss}
        return [float(x) for x in delta_v(impact, factor).values()]

    true = TABLE_3["UX"], TABLE_3["VY"]
    by_momentum = momentum["UX"], momentum["VY"]
    values = changes(true, truth["LOSS"], AS_USED)
    variants = (
        ("stated", "loss 40 % as stated, true speeds", changes(true, STATED_LOSS, AS_USED)),
        ("analyst", "loss 40 %, speeds from momentum", changes(by_momentum, STATED_LOSS, AS_USED)),
        ("printed", "as printed, no 2/3", changes(true, truth["LOSS"], AS_PRINTED)),
    )
    alternatives = [
        Result(f"DV{vehicle} {key}", f"{vehicle}: {meaning}", value, "ft/s")
        for key, meaning, pair in variants
        for vehicle, value in zip("AB", pair, strict=True)
    ]
    estimate = Step(
        "Velocity changes without the impact equations",
        "Equation 19 with the factor 2/3",
        (*_of_both("DVA DVB", "velocity change", values, "39.1 25.9"), *alternatives),
        "The printed 39.1 and 25.9 need the factor 2/3 (which Equation 19 lacks as printed) and "
        "Table 3's own loss (ΔT = .374) and speeds; with the stated ΔT = 0.4 they would be larger.",
    )
    a, b = (round(change, 1) for change in values)
    ux = initial_velocity(a, ESTIMATES["VAX"], ESTIMATES["VAY"])
    vy = initial_velocity(b, ESTIMATES["VBY"], ESTIMATES["VBX"])
    back = Step(
        "Initial velocities from those velocity changes and the estimated final velocities",
        "Equations 20 and 21, solved for v_ax and v_by",
        _of_both("UX VY", "initial velocity", (ux, vy), "-43.6 61.5"),
        "From the velocity changes rounded to one decimal, as the chapter must have done.",
    )
    return estimate, back


def _coefficients(momentum: Step) -> Step:
    """Return the step that takes coefficients from all velocities by Equations 15, 16 and 18."""
    motion = {n: x for n, x in TABLE_3.items() if n not in ("E", "MU", "EM")}
    motion |= {**ESTIMATES, **SPINS, "UX": momentum["UX"], "VY": momentum["VY"]}
    values, _ = evaluate(motion, ("E", "MUP", "EM", "D1", "D2", "D3", "D4"))
    v = {name: float(value) for name, value in values.items()}
    x, y = motion["VAX"] - motion["UX"], motion["VAY"] - motion["UY"]
    bx, by = motion["VBX"] - motion["VX"], motion["VBY"] - motion["VY"]
    a_turns = motion["IA"] * motion["WAF"] - motion["MA"] * (v["D3"] * x - v["D4"] * y)
    b_turns = -motion["IB"] * motion["WBF"] + motion["MB"] * (v["D2"] * by - v["D1"] * bx)
    return Step(
        "Coefficients from both final spins, WAF -2.9 and WBF -0.9 rad/s",
        "Equations 15, 16 and 18",
        (
            Result("E", "coefficient of restitution", v["E"], "1"),
            Result("MUP", "P_t/P_n", v["MUP"], "1"),
            Result("EM", "moment coefficient", v["EM"], "1"),
            Result("17", "residual of Equation 17", a_turns - b_turns, "slug-ft2/s"),
        ),
        '"Generally, these estimates are not very accurate": Table 3 has e = .25, μ = .89, '
        "e_m = -.9. The estimates are one too many and violate the angular momentum; a "
        "reconstruction with tolerances adjusts them so that every law holds.",
    )
