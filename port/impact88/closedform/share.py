"""MU as a share of the critical friction: MU = "85 %".

Critical is the friction that just ends the sliding at separation, MUC; the share is of P_t/P_n. MU
is then what line 280 would hold: the listing turns its sign where gt > 0 (line 400).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..doubles import double
from ..errors import UserError
from ..names import DEFAULT_M, PIVOT, SCENE
from .solve import quantities

Floats = NDArray[np.float64]

_SHARE = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+))\s*%\s*")


def share_of(text: object) -> float | None:
    """The share that a text such as ``85 %`` is, 0.85; None where it is none."""
    match = _SHARE.fullmatch(text) if isinstance(text, str) else None
    return float(match[1]) / 100 if match else None


def typed_friction(columns: Mapping[str, Any], share: Any) -> Floats:
    """MU of scenes (columns without MU, as `impact88.solve` takes them) for a share of the critical
    friction; NaN where no friction ends the sliding."""
    critical = quantities({**columns, "MU": PIVOT}, ("MUC", "PN", "gt"))
    possible = critical["PN"] > 0
    signed = np.where(possible, np.asarray(share) * critical["MUC"], np.nan)
    return np.asarray(np.where(critical["gt"] > 0, -signed, signed) + 0.0)


def resolved(texts: Mapping[str, str], source: str) -> tuple[str, str]:
    """MU's number for a scene whose MU is a share, and how it was found. Raises UserError."""
    share = share_of(texts["MU"])
    if share is None:
        raise UserError(f"MU = {texts['MU']!r} is not a share; expected one such as 85 %", source)
    numbers = {"M": double(DEFAULT_M)}
    numbers |= {name: double(texts[name]) for name in SCENE if name in texts and name != "MU"}
    mu = float(typed_friction(numbers, share))
    if not np.isfinite(mu):
        raise UserError(
            f"MU = {texts['MU']}: no friction ends the sliding here; expected a number", source
        )
    number = repr(mu).removesuffix(".0").upper()
    return number, f"MU = {number} is {100 * share:g} % of the critical friction"
