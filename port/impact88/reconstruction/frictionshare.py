"""A share of the critical friction (MU = "85 %") among what is known of an impact.

The critical friction follows from the whole scene. Where that is known, MU is; where some of it is
solved for, MUP = share · MUC is one more equation, met by trying friction until it holds.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..closedform.solve import share_typed, solve
from ..errors import UserError
from ..names import DEFAULT_M, SCENE
from ..uncertainty.uncertain import Uncertain, fixed
from .adjustment import needs_adjustment, reconstruct
from .unknowns import solve_for

STEPS = 40
"""Frictions tried; secants need six to ten."""
SETTLED = 1e-12
"""Change of P_t/P_n at which it has settled."""


def share_resolved(known: Mapping[str, Uncertain]) -> tuple[dict[str, Uncertain], str | None]:
    """``known`` with a number, or limits, for a MU that is a share, and how it was found; as it is
    where MU is none. Raises UserError where no friction is found that is the share."""
    item = known.get("MU")
    if item is None or not item.share:
        return dict(known), None
    others = {name: value for name, value in known.items() if name != "MU"}
    scene = {"M": float(DEFAULT_M)} | {n: x.nominal for n, x in others.items() if n in SCENE}
    if len(scene) == len(SCENE) - 1:
        name, value = "MU", float(share_typed(scene, item.nominal))
    else:
        name, value = "MUP", _signed(others, item.nominal)
    if value != value:
        raise UserError("no friction ends the sliding here; expected a number", "MU")
    scale = value / item.nominal if item.nominal else 0.0
    low, high = sorted((item.low * scale, item.high * scale))
    found = fixed(value)
    if item.varies:
        spread = abs(item.deviation * scale)
        found = replace(item, nominal=value, low=low, high=high, deviation=spread, share=False)
    text = f"MU is {100 * item.nominal:g} % of the critical friction: {name} = {value:.9g}"
    return {**others, name: found}, text


def _signed(others: Mapping[str, Uncertain], share: float) -> float:
    """The P_t/P_n that is a share of MUC in the impact that follows from it and the others."""
    exact = not needs_adjustment(others, None)
    numbers = {name: item.nominal for name, item in others.items()}

    def excess(mu: float) -> float:
        scene: dict[str, Any]
        if exact:
            scene = {**numbers, **solve_for({**numbers, "MUP": mu})[0].values}
        else:
            scene = reconstruct({**others, "MUP": fixed(mu)})[0].scene()
        scene = {name: value for name, value in scene.items() if name in SCENE}
        return mu - share * float(solve({**scene, "MU": 0.0}, ("MUC",))["MUC"])

    failure = UserError("no friction is found that is this share of the critical friction", "MU")
    for start in (0.3, -0.3):
        try:
            a, b = 0.0, start
            at_a, at_b = excess(a), excess(b)
            for _ in range(STEPS):
                if abs(at_b) <= SETTLED or at_a == at_b:
                    break
                a, at_a, b = b, at_b, b - at_b * (b - a) / (at_b - at_a)
                at_b = excess(b)
            if abs(at_b) <= 1e3 * SETTLED:
                return b
        except UserError as error:
            failure = error
    raise failure
