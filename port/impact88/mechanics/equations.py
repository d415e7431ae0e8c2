"""Equations 13 to 18, which are linear in the impulses, for numbers of any kind.

They stay linear where each of the six velocities is known before or after the impact, and each of
the three laws by its coefficient or its impulse: with g the relative velocities of the contact
points along n and t and of the spins, as the known velocities give them, and their changes by unit
impulses in two parts, L through the velocities known before the impact and D through those known
after it,

    before:  g - D P        after:  g + L P        P = (Pn, Pt, M)

and each law is one linear equation in before, after and P. Cramer's rule solves the three.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import compress
from operator import mul
from typing import Any

from ..names import COEFFICIENTS, FINAL_STATE, IMPULSES, VELOCITIES

PAIRS = tuple(zip(VELOCITIES, FINAL_STATE, strict=True))
"""Each velocity before and after the impact."""
LAWS = tuple(zip(COEFFICIENTS, IMPULSES, strict=True))
"""Coefficient and impulse of Equations 15, 16 and 18."""

Rows = Sequence[Sequence[Any]]


def impact(
    known: Mapping[str, Any], is_pivot: Any, relative: Rows, inverse_masses: Sequence[Any]
) -> tuple[dict[str, Any], Any]:
    """Return the impulses and the velocities that are not known, and the determinant.

    Parameters
    ----------
    known : mapping of str to number or array
        One of each pair in `PAIRS` and `LAWS`; of two the velocity before and the coefficient
        count.
    is_pivot : bool or array of bool
        Whether Equation 16 is replaced by no slip at separation.
    relative : sequence of sequence
        The relative velocities of the contact points along n and t and of the spins, as rows over
        the six velocities.
    inverse_masses : sequence
        The inverse mass or inertia of each velocity.
    """
    changes = [[*map(mul, row, inverse_masses)] for row in relative]
    is_late = [before not in known for before, _ in PAIRS]
    given = [known[pair[late]] for pair, late in zip(PAIRS, is_late, strict=True)]
    full = [[dot(x, y) for y in changes] for x in relative]
    delayed = [[dot(compress(x, is_late), compress(y, is_late)) for y in changes] for x in relative]
    e, mup, em = (known.get(name, 0.0) for name, _ in LAWS)
    ends = 1.0 * is_pivot
    sums = (  # of the relative velocities after and before, and of the impulses
        (1.0, e, (0.0, 0.0, 0.0)),
        (ends, 0.0, (-mup * (1.0 - ends), 1.0 - ends, 0.0)),
        (1.0 - em, 0.0, (0.0, 0.0, -em * full[2][2])),
    )
    rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    right = [known.get(impulse) for _, impulse in LAWS]
    for k, (after, before, own) in enumerate(sums):
        if LAWS[k][0] in known:
            terms = zip(full[k], delayed[k], own, strict=True)
            rows[k] = [after * x - (after + before) * y + z for x, y, z in terms]
            right[k] = -(after + before) * dot(relative[k], given)
    crosses = [_cross(rows[k - 2], rows[k - 1]) for k in range(3)]
    determinant = dot(rows[0], crosses[0])
    impulses = [dot(right, column) / determinant for column in zip(*crosses, strict=True)]
    values = dict(zip(IMPULSES, impulses, strict=True))
    for pair, late, x, *column in zip(PAIRS, is_late, given, *changes, strict=True):
        values[pair[not late]] = x + (1.0 - 2.0 * late) * dot(impulses, column)
    return values, determinant


def dot(first: Iterable[Any], second: Iterable[Any]) -> Any:
    """Return the sum of the products of pairs."""
    return sum(map(mul, first, second))


def _cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """Return the cross product of two rows."""
    x, y, z = a
    u, v, w = b
    return [y * w - z * v, z * u - x * w, x * v - y * u]
