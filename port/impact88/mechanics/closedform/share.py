"""MU as a share of the critical friction: MU = "85 %".

Critical is the friction that just ends the sliding at separation, MUC; the share is of P_t/P_n. MU
is then the number to be typed at line 280: the listing turns its sign where gt > 0 (line 400); see
`share_typed`.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.case import share_of
from ...collision.doubles import double
from ...errors import UserError
from ...names import DEFAULT_M, PIVOT, SCENE
from .general import quantities

Array = NDArray[Any]


def friction_typed(arrays: Mapping[str, Array], shares: Array) -> dict[str, Array]:
    """Return a scene's columns with MU as line 280 would take it where it is one of the ``shares``
    (NaN elsewhere)."""
    without = {name: array for name, array in arrays.items() if name != "MU"}
    mu = np.where(np.isnan(shares), arrays["MU"], share_typed(without, shares))
    return {**without, "MU": mu}


def resolve_share(texts: Mapping[str, str], source: str) -> tuple[str, str]:
    """Return MU's number as text for a scene whose MU is a share, and a remark that says so. Raises
    UserError."""
    share = share_of(texts["MU"])
    if share is None:
        raise UserError(f"MU = {texts['MU']!r} is not a share; expected one such as 85 %", source)
    numbers = {"M": double(DEFAULT_M)}
    numbers |= {name: double(texts[name]) for name in SCENE if name in texts and name != "MU"}
    mu = float(share_typed(numbers, share))
    if not math.isfinite(mu):
        raise UserError(
            f"MU = {texts['MU']}: no friction ends the sliding here; expected a number", source
        )
    number = repr(mu).removesuffix(".0").upper()
    return number, f"MU = {number} is {100 * share:g} % of the critical friction"


def share_typed(columns: Mapping[str, Any], share: Any) -> Array:
    """Return MU as line 280 would take it, for a fraction of each scene's critical friction
    (MUC); NaN where no friction ends the sliding. ``columns``: without MU."""
    critical = quantities({**columns, "MU": PIVOT}, ("MUC", "PN", "gt"))
    with np.errstate(invalid="ignore"):
        mu = np.where(critical["PN"] > 0, np.asarray(share) * critical["MUC"], np.nan)
        return np.asarray(np.where(critical["gt"] > 0, -mu, mu) + 0.0)
