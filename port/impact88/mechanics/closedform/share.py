"""MU as a share of the critical friction: MU = "85 %".

Critical is the friction that just ends the sliding at separation, MUC; the share is of P_t/P_n. MU
is then the number to be typed at line 280: the listing turns its sign where gt > 0 (line 400). For
the texts of one scene it is computed without numpy; `closedform.solve.share_typed` does the same
over arrays.
"""

import math
import re
from collections.abc import Mapping

from ...collision.doubles import double
from ...errors import UserError
from ...names import DEFAULT_M, SCENE
from ..native.formulas import ExpressionTable
from ..native.schedule import Schedule
from .impact import impact
from .written import compile_function

_SHARE = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+))\s*%\s*")


def share_of(text: object) -> float | None:
    """Return the fraction a text such as ``85 %`` stands for, 0.85; None for anything else."""
    match = _SHARE.fullmatch(text) if isinstance(text, str) else None
    return float(match[1]) / 100 if match else None


def resolve_share(texts: Mapping[str, str], source: str) -> tuple[str, str]:
    """Return MU's number as text for a scene whose MU is a share, and a remark that says so. Raises
    UserError."""
    share = share_of(texts["MU"])
    if share is None:
        raise UserError(f"MU = {texts['MU']!r} is not a share; expected one such as 85 %", source)
    numbers = {"M": double(DEFAULT_M)}
    numbers |= {name: double(texts[name]) for name in SCENE if name in texts and name != "MU"}
    table = ExpressionTable()
    columns = {name: table.column(name, varies=True) for name in SCENE}
    quantities = impact(table, columns, pivot=True, point=numbers["M"] == 4, infinite=False)
    results = {name: quantities[name] for name in ("PN", "MUC", "gt")}
    values = [numbers.get(name, 0.0) for name in SCENE]
    try:
        pn, critical, slip = compile_function(Schedule(results, ["RESULT"] * 3))(*values)
    except ArithmeticError:
        pn = critical = slip = math.nan
    mu = share * critical
    if not (pn > 0 and math.isfinite(mu)):
        raise UserError(
            f"MU = {texts['MU']}: no friction ends the sliding here; expected a number", source
        )
    number = repr((-mu if slip > 0 else mu) + 0.0).removesuffix(".0").upper()
    return number, f"MU = {number} is {100 * share:g} % of the critical friction"
