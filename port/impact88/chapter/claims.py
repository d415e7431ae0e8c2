"""What the chapter claims of its method, checked on its own eleven collisions.

Each claim is a sentence of the text; what is found is how far the results go, in percent of ΔV_a
and ΔV_b or in what the claim speaks of, over the side impacts (front to side) and the others.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..closedform.solve import solve
from ..reconstruction.contact import moved
from ..reconstruction.impulse import forces
from .staged import Collision, collisions, forward, typed_friction

Array = NDArray[np.float64]

GRAVITY = 32.174
"""ft/s²."""
CONTACT_TIMES = (0.1, 0.2)
"""Seconds, Section III."""


@dataclass(frozen=True)
class Claim:
    """A claim: where it stands, its words in short, what was varied, what it does.

    ``sides``: lowest and highest over the front-to-side collisions, ``others`` over the rest;
    ``unit``: of both; ``verdict``: what follows, in a few words.
    """

    where: str
    claim: str
    varied: str
    sides: tuple[float, float]
    others: tuple[float, float]
    unit: str
    verdict: str


def _with(collision: Collision, changes: dict[str, Any]) -> dict[str, Array]:
    """The collision with Table 2's coefficients and some values changed; friction keeps the sign of
    Table 2, whatever the sliding does."""
    scene = moved({**collision.scene, **changes})
    em = np.asarray(scene.pop("EM", collision.coefficients["EM"]))
    mu = typed_friction(scene, collision.coefficients["MUP"])
    values = {**scene, "E": collision.coefficients["E"], "EM": em, "MU": mu}
    return solve(values, ("DVA", "DVB", "LOSS"))


def _change_of_delta_v(collision: Collision, changes: dict[str, Any]) -> Array:
    """Percent, of both vehicles' ΔV alike: they stand in the ratio of the masses."""
    there, here = _with(collision, changes), forward(collision)
    return 100 * (there["DVA"] / here["DVA"] - 1)


def _turned_plane(collision: Collision) -> Array:
    return _change_of_delta_v(collision, {"GA": collision.scene["GA"] + np.array([-10.0, 10.0])})


def _moved_contact(collision: Collision) -> Array:
    turn = np.radians(np.arange(0, 360, 5.0))
    return _change_of_delta_v(collision, {"CX": np.cos(turn), "CY": np.sin(turn)})


def _moment_coefficient(collision: Collision) -> Array:
    return _change_of_delta_v(collision, {"EM": np.linspace(-1, 0, 21)})


def _loss_and_moment_coefficient(collision: Collision) -> Array:
    there = _with(collision, {"EM": np.linspace(-1, 0, 21)})["LOSS"]
    return np.asarray(there - forward(collision)["LOSS"])


def _turned_vehicle(collision: Collision) -> Array:
    """Either vehicle 22.5 degrees on, the middle of a turn by 45 during contact; its own contact
    point stays."""
    turns = [-22.5, 22.5]
    return np.concatenate(
        [
            _change_of_delta_v(collision, {name: collision.scene[name] + np.array(turns)})
            for name in ("TA", "TB")
        ]
    )


def _force_over_weight(collision: Collision) -> Array:
    found = forward(collision)
    impulse = float(np.hypot(found["PN"], found["PT"]))
    average = forces(impulse, np.array(CONTACT_TIMES))["FA"]
    weights = np.array([collision.scene["MA"], collision.scene["MB"]]) * GRAVITY
    return np.asarray(average[:, None] / weights).ravel()


def _extent(rule: Callable[[Collision], Array], alike: list[Collision]) -> tuple[float, float]:
    values = np.concatenate([np.ravel(rule(collision)) for collision in alike])
    return float(values.min()), float(values.max())


@cache
def claims() -> tuple[Claim, ...]:
    """The claims, each with what the eleven collisions say."""
    sides = [c for c in collisions() if "SIDE" in c.category]
    others = [c for c in collisions() if "SIDE" not in c.category]
    rows = (
        (
            *("IV-A", "results not critically sensitive to Γ", "Γ by 10 degrees either way"),
            *(_turned_plane, "% of ΔV", "false for the side impacts"),
        ),
        (
            *("IV-A", "nor to the location of point C", "C by 1 ft in any direction"),
            *(_moved_contact, "% of ΔV", "true of a foot"),
        ),
        (
            *("V", "ΔV not very sensitive to e_m", "e_m over its whole range, -1 to 0"),
            *(_moment_coefficient, "% of ΔV", "true"),
        ),
        (
            *("V", "nor is the energy loss", "e_m over its whole range, -1 to 0"),
            *(_loss_and_moment_coefficient, "points of loss", "true"),
        ),
        (
            *("IV-A", "turns during contact below 45 degrees matter little"),
            *("one vehicle's heading by 22.5 degrees, half the turn", _turned_vehicle),
            *("% of ΔV", "they matter: up to a fifth of ΔV"),
        ),
        (
            *("III", "average force 5 to 10 times the weight", "contact time .1 to .2 s"),
            *(_force_over_weight, "weights", "the middle of a wider range"),
        ),
    )
    return tuple(
        Claim(where, text, varied, _extent(rule, sides), _extent(rule, others), unit, verdict)
        for where, text, varied, rule, unit, verdict in rows
    )
