"""Section VII as a worked example: a reconstruction, step by step, computed.

A 90° front-to-side collision whose truth is Table 3. The analyst knows the vehicles and, from
"trajectory calculations", the final velocities, and that neither vehicle swerved (v_ay = v_bx = 0).
Every number comes from the modules of this package; what the chapter prints stands beside it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from math import hypot

from ...collision.casescene import sample
from ...collision.uncertain import Uncertain
from ...mechanics.closedform.solve import solve
from ...mechanics.outcome import moment_ratio
from ...mechanics.state import State
from ...names import FINAL_VELOCITIES
from ...program.arithmetics import FLOAT64
from ..reconstruction.adjustment import reconstruct
from ..reconstruction.unknowns import solve_for
from .deltav import AS_PRINTED, AS_USED, delta_v, initial_velocity
from .staged import Collision, closure

ESTIMATES = {"VAX": -10.0, "VAY": 20.0, "VBX": -20.0, "VBY": 45.0}
"""The analyst's final velocities, ft/s."""
BOTH_SPINS = {"WAF": -2.9, "WBF": -0.9}
"""Table 3's to one digit after the point."""
TOLERANCES = {"velocity": 2.0, "spin": 0.3}
"""Tolerances of the analyst's final velocities (ft/s) and spins (rad/s) for the adjustment."""
NO_SWERVING = {"UY": 0.0, "VX": 0.0}
NO_TURNING = {"WA": 0.0, "WB": 0.0}
STATED_LOSS = 40.0
"""ΔT = 0.4 "follows from Table 2 for this type of collision", in percent."""
SPIN_ESTIMATE = {"WAF": -2.9}
"""A's final spin for the last step, Table 3's to two digits: the chapter names the step and gives
no numbers."""


@dataclass(frozen=True)
class Number:
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
    numbers: tuple[Number, ...]
    remark: str = ""

    def __getitem__(self, name: str) -> float:
        return next(number.value for number in self.numbers if number.name == name)


@cache
def steps() -> tuple[Step, ...]:
    """Return the steps of Section VII, in its order."""
    scene = {name: FLOAT64.number(text) for name, text in sample(3).items()}
    truth = {name: float(value) for name, value in solve(scene).items()}
    vehicles = {
        name: value
        for name, value in scene.items()
        if name not in ("E", "MU", "EM", "UX", "UY", "WA", "VX", "VY", "WB")
    }
    momentum = _momentum(vehicles)
    initial = {"UX": momentum["UX"], "VY": momentum["VY"]}
    a = hypot(ESTIMATES["VAX"] - initial["UX"], ESTIMATES["VAY"])
    b = hypot(ESTIMATES["VBX"], ESTIMATES["VBY"] - initial["VY"])
    return (
        _truth(scene, truth),
        momentum,
        Step(
            "Velocity changes from them",
            "Equations 20 and 21",
            _of_both("DVA DVB", "velocity change", (a, b), "36.2 24.0"),
        ),
        *_equation_19(scene, truth, initial),
        _coefficients(vehicles),
        _both_spins(vehicles, initial),
    )


def _of_both(
    names: str, meaning: str, values: Sequence[float], printed: str = ""
) -> tuple[Number, ...]:
    """Return the numbers for a velocity of A and one of B."""
    rows = zip(names.split(), "AB", values, printed.split() or (None, None), strict=True)
    return tuple(Number(n, f"{meaning} of {v}", value, "ft/s", p) for n, v, value, p in rows)


def _truth(scene: dict[str, float], truth: dict[str, float]) -> Step:
    velocities = (
        Number(name, "", truth[name], "rad/s" if name.startswith("W") else "ft/s")
        for name in FINAL_VELOCITIES
    )
    changes = (truth["DVA"], truth["DVB"])
    return Step(
        "What really happened, unknown to the analyst (Table 3)",
        "Equations 13-18",
        (
            *_of_both("UX VY", "initial velocity", (scene["UX"], scene["VY"])),
            *velocities,
            *_of_both("DVA DVB", "true velocity change", changes, "39.1 25.9"),
            Number("LOSS", "energy lost", truth["LOSS"], "percent", "37.4"),
        ),
    )


def _momentum(vehicles: dict[str, float]) -> Step:
    (solution,) = solve_for({**vehicles, **ESTIMATES, **NO_SWERVING}, ["UX", "VY"])
    velocities = (float(solution["UX"]), float(solution["VY"]))
    return Step(
        "Initial velocities from the estimated final ones, v_ay = v_bx = 0",
        "Equations 13 and 14",
        _of_both("UX VY", "initial velocity", velocities, "-40.21 58.24"),
        "Conservation of momentum alone: no coefficient and no spin is needed. The final "
        "velocities are estimates: VAX -10, VAY 20, VBX -20, VBY 45 ft/s.",
    )


def _equation_19(
    scene: dict[str, float], truth: dict[str, float], initial: dict[str, float]
) -> tuple[Step, Step]:
    """Return the steps by Equation 19: with the values that give the printed numbers, and beside
    them with the values that the text states."""

    def changes(speeds: tuple[float, float], loss: float, factor: float) -> tuple[float, float]:
        speeds_of = dict(zip(("SA", "SB"), speeds, strict=True))
        estimate = delta_v({**scene, **speeds_of, "LOSS": loss}, factor)
        return float(estimate["DVA"]), float(estimate["DVB"])

    true_speeds = (abs(scene["UX"]), abs(scene["VY"]))
    momentum_speeds = (abs(initial["UX"]), abs(initial["VY"]))
    velocity_changes = changes(true_speeds, truth["LOSS"], AS_USED)
    variants = (
        ("stated", "loss 40 % as stated, true speeds", true_speeds, STATED_LOSS, AS_USED),
        (
            "analyst",
            "loss 40 %, speeds from Equations 13-14",
            momentum_speeds,
            STATED_LOSS,
            AS_USED,
        ),
        ("printed", "as printed, no 2/3", true_speeds, truth["LOSS"], AS_PRINTED),
    )
    alternatives = [
        Number(f"DV{vehicle} {key}", f"{vehicle}: {meaning}", value, "ft/s")
        for key, meaning, speeds, loss, factor in variants
        for vehicle, value in zip("AB", changes(speeds, loss, factor), strict=True)
    ]
    estimate = Step(
        "Velocity changes without the impact equations",
        "Equation 19 with the factor 2/3",
        (*_of_both("DVA DVB", "velocity change", velocity_changes, "39.1 25.9"), *alternatives),
        "The printed 39.1 and 25.9 need the factor 2/3 (which Equation 19 lacks as printed) and "
        "Table 3's own loss (ΔT = .374) and speeds; with the stated ΔT = 0.4 they would be "
        "larger (below). An analyst has only the last step's speeds.",
    )

    a, b = (round(change, 1) for change in velocity_changes)
    ux = initial_velocity(a, ESTIMATES["VAX"], ESTIMATES["VAY"])
    vy, unrounded = (
        initial_velocity(x, ESTIMATES["VBY"], ESTIMATES["VBX"]) for x in (b, velocity_changes[1])
    )
    back = Step(
        "Initial velocities from those velocity changes and the estimated final velocities",
        "Equations 20 and 21, solved for v_ax and v_by",
        _of_both("UX VY", "initial velocity", (ux, vy), "-43.6 61.5"),
        "From the velocity changes rounded to one decimal, as the chapter must have done: "
        f"unrounded, VY is {unrounded:.2f}.",
    )
    return estimate, back


def _coefficients(vehicles: dict[str, float]) -> Step:
    values = {**vehicles, **ESTIMATES, **NO_SWERVING, **NO_TURNING, **SPIN_ESTIMATE}
    (solution,) = solve_for(values)
    worst, em = float(solution.amplification["EM"]), float(solution["EM"])
    ratio = float(moment_ratio(em))
    return Step(
        "Coefficients, given a final spin of A of -2.9 rad/s and no initial spins",
        "Equations 13-18 for UX, VY, Ω_b, e, μ and e_m",
        (
            Number("WBF", "final spin of B", float(solution["WBF"]), "rad/s"),
            Number("E", "coefficient of restitution", float(solution["E"]), "1"),
            Number("MUP", "P_t/P_n", float(solution["MUP"]), "1"),
            Number("EM", "moment coefficient", em, "1"),
            Number("RR0", "share of relative spin the moment leaves", ratio, "1"),
        ),
        '"Generally, these estimates are not very accurate": Table 3 has e = .25, μ = .89, '
        f"e_m = -.9. An e_m of {em:.2f} is outside -1 ... 0: the moment alone would leave R/R0 = "
        f"-e_m/(1 - 2 e_m) = {ratio:.3f} of a relative spin, more than the third that the elastic "
        "e_m = -1 leaves and less than all of it (e_m = +1, no moment). The amplification "
        f"says why: an error of 1 % of the closing speed in each known velocity changes e_m by "
        f"{worst / 100:.2g}.",
    )


def _both_spins(vehicles: dict[str, float], initial: dict[str, float]) -> Step:
    """Return the step that takes coefficients from both spins: by Equations 15, 16 and 18 alone, as
    the chapter means it, and adjusted so that all equations hold."""
    scene, after = {**vehicles, **NO_SWERVING, **NO_TURNING, **initial}, {**ESTIMATES, **BOTH_SPINS}
    state = State.of_known({**scene, **after})
    here, e = state.here, float(state["E"])
    # what A and B gain of linear and angular momentum
    closed = closure(Collision(0, "", scene, after, {}))
    x, y, on_a, on_b = (closed[name] for name in ("x_of_a", "y_of_a", "spin_of_a", "spin_of_b"))
    pn, pt = float(x * here.cosine + y * here.sine), float(y * here.cosine - x * here.sine)
    spin, bracket = after["WBF"] - after["WAF"], on_a / scene["IA"] + on_b / scene["IB"]
    measurements = {
        name: Uncertain("uniform", value, value - tolerance, value + tolerance)
        for estimates, kind in ((ESTIMATES, "velocity"), (BOTH_SPINS, "spin"))
        for tolerance in [TOLERANCES[kind]]
        for name, value in estimates.items()
    }
    (solution,) = reconstruct({**vehicles, **NO_SWERVING, **NO_TURNING, **measurements})
    values = solution.values
    return Step(
        "Coefficients from both final spins, WAF -2.9 and WBF -0.9 rad/s",
        "Equations 15, 16 and 18",
        (
            Number("E", "coefficient of restitution, as the estimates stand", e, "1"),
            Number("MUP", "P_t/P_n, as they stand", pt / pn, "1"),
            # (1 - e_m) spin = -e_m bracket
            Number("EM", "moment coefficient, as they stand", spin / (spin - bracket), "1"),
            Number("17", "what Equation 17 is missed by", on_a - on_b, "slug-ft2/s"),
            Number("E adjusted", "adjusted so that all equations hold", values["E"], "1"),
            Number("MUP adjusted", "adjusted", values["MUP"], "1"),
            Number("EM adjusted", "adjusted", values["EM"], "1"),
            Number("UX adjusted", "adjusted initial velocity of A", values["UX"], "ft/s"),
            Number("VY adjusted", "adjusted initial velocity of B", values["VY"], "ft/s"),
        ),
        "The estimates are one too many and miss the angular momentum. Adjusted (2 ft/s and .3 "
        "rad/s of tolerance each) they keep every law; impact88 reconstruct does that for any "
        "file.",
    )
