"""What stands beside a verdict and never changes it: exact values and warnings.

Exact means the mechanics of Equations 13 to 18 in double precision by the closed form, with exact
pi, for the recovered scene: what the program would print had its arithmetic cost nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal

from .. import status
from ..doubles import doubles_of
from ..fields import INPUTS
from ..names import RESULTS
from ..reading.numerals import value_of
from .judgement import FieldCheck

_DIGITS = 12
"""Digits an exact value is shown with: as many as double precision is sure of."""


def add_exact_values(scene: Mapping[str, str], checks: Sequence[FieldCheck]) -> None:
    """Set ``exact`` and ``difference`` (printed less exact) of every check of a result."""
    wanted = [check for check in checks if check.name in RESULTS and check.name not in INPUTS]
    values = solved(scene, [check.name for check in wanted])
    for check in wanted:
        value = values.get(check.name)
        if value is None or value != value:
            continue
        check.exact = f"{value + 0.0:.{_DIGITS}g}"
        if check.printed is not None:
            printed = value_of(check.printed)
            if printed is None:
                continue
            difference = printed - Decimal(check.exact)
            check.difference = f"{difference:+.3g}" if difference else "0"


def warnings(scene: Mapping[str, str]) -> list[str]:
    """What is unphysical about a scene (the bits of STATUS), and which of the program's known traps
    it steps into, one sentence each."""
    values = solved(scene, ["STATUS", "MUC", "MUP", "XA", "YA", "XB", "YB"]) | doubles_of(scene)
    bits = int(values["STATUS"])
    sentences = [f"{bit.name}: {status.WORDS[bit]}" for bit in status.Status if bits & bit]
    return sentences + status.admissible_friction(bits, values) + list(_traps(scene))


def solved(scene: Mapping[str, str], outputs: Sequence[str]) -> dict[str, float]:
    """Results of one scene by the closed form, as Python floats."""
    from ..closedform.solve import solve

    results = solve(doubles_of(scene), list(outputs))
    return {name: float(results[name]) for name in outputs}


def _traps(scene: Mapping[str, str]) -> list[str]:
    value = doubles_of(scene)
    traps = []
    if value["M"] == 4 and (value["DA"] or value["DB"]):
        traps.append(
            "M = 4 with DA or DB not zero: the XA, YA, XB, YB printed after the impact are "
            "nonsense (line 550 stores a sum where line 700 expects a spin)"
        )
    if value["M"] == 4 and (value["WA"] or value["WB"]):
        traps.append("M = 4 with WA or WB not zero: the KE LOSS printed is wrong")
    if value["MU"] == 10:
        traps.append("MU = 10 becomes -10 in line 400, which line 510 takes for a pivot")
    if value["MU"] < -10:
        traps.append("MU below -10: line 510 zeroes a right-hand side that is not a pivot's")
    return traps
