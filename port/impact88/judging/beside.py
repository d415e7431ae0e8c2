"""What stands beside a verdict and never changes it: exact values and warnings.

Exact means the mechanics of Equations 13 to 18 in double precision by the closed form, with exact
pi, for the recovered scene: what the program would print had its arithmetic cost nothing.
"""

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
        value = values[check.name]
        if value != value:
            continue
        check.exact = f"{value + 0.0:.{_DIGITS}g}"
        if (printed := value_of(check.printed or "")) is not None:
            difference = printed - Decimal(check.exact)
            check.difference = f"{difference:+.3g}" if difference else "0"


def warnings(scene: Mapping[str, str]) -> list[str]:
    """What is unphysical about a scene (the bits of STATUS), and which of the program's known traps
    it steps into, one sentence each."""
    values = solved(scene, ["STATUS", "MUC", "MUP", "XA", "YA", "XB", "YB"]) | doubles_of(scene)
    bits = int(values["STATUS"])
    sentences = [f"{bit.name}: {status.WORDS[bit]}" for bit in status.Status if bits & bit]
    sentences += status.admissible_friction(bits, values)
    point, mu = values["M"] == 4, values["MU"]
    if point and (values["DA"] or values["DB"]):
        sentences.append(
            "M = 4 with DA or DB not zero: the XA, YA, XB, YB printed after the impact are "
            "nonsense (line 550 stores a sum where line 700 expects a spin)"
        )
    if point and (values["WA"] or values["WB"]):
        sentences.append("M = 4 with WA or WB not zero: the KE LOSS printed is wrong")
    if mu == 10:
        sentences.append("MU = 10 becomes -10 in line 400, which line 510 takes for a pivot")
    if mu < -10:
        sentences.append("MU below -10: line 510 zeroes a right-hand side that is not a pivot's")
    return sentences


def solved(scene: Mapping[str, str], outputs: Sequence[str]) -> dict[str, float]:
    """Results of one scene by the closed form, as Python floats."""
    from ..closedform.solve import solve

    results = solve(doubles_of(scene), list(outputs))
    return {name: float(results[name]) for name in outputs}
