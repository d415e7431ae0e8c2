"""Known values from Python: numbers, texts and amounts by the listing's names."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..cases.amounts import Amount
from ..cases.case import Case
from ..errors import UserError, quoted
from ..mechanics.solve import BODIES, POINT
from ..names import check_names

WITHOUT_MOMENT = 0.5  # the EM at which Equation 18 does not contain the moment
ABOVE_ZERO = ("MA", "MB", "IA", "IB")


def as_amounts(known: Mapping[str, Any], allowed: Collection[str]) -> dict[str, Amount]:
    """Return known values as amounts.

    Parameters
    ----------
    known : mapping of str to float, str or Amount
        Values by name, read as in a file of these entries (`Case.of`), with their units; None
        counts as not given.
    allowed : collection of str
        Names that may be known.

    Raises
    ------
    UserError
        For an unknown name, a value that is no amount, another M than 6 or 4, and limits of a mass
        or an inertia that reach 0.
    """
    if not isinstance(known, Mapping):
        raise UserError(f"{quoted(known)} is not a mapping; expected names with their values")
    check_names(known, allowed, "quantity")
    amounts = {name: value for name, value in known.items() if isinstance(value, Amount)}
    others = {name: value for name, value in known.items() if name not in amounts}
    entries = {**Case.of(others, "values").entries, **amounts}
    for name in ABOVE_ZERO:
        if name in entries and entries[name].varies and entries[name].limits()[0] <= 0:
            raise UserError(f"{name} is known within limits that reach 0; expected limits above 0")
    check_equations(entries["M"].value)
    return entries


def check_moment(least: ArrayLike, greatest: ArrayLike) -> None:
    """Raise UserError if EM may be 0.5."""
    if np.any((np.asarray(least) <= WITHOUT_MOMENT) & (np.asarray(greatest) >= WITHOUT_MOMENT)):
        raise UserError(
            f"EM may be {WITHOUT_MOMENT:g}, where Equation 18 determines no moment; expected -1 to "
            "0, or 1 for no moment"
        )


def check_equations(m: ArrayLike) -> None:
    """Raise UserError for values of M that are neither 6, of bodies, nor 4, of point masses."""
    for value in {*np.ravel(m).tolist()} - {BODIES, POINT}:
        raise UserError(f"M is {value:g}; expected 6 for bodies or 4 for point masses")
