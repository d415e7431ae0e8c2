"""Known values from Python: numbers, texts and amounts by the listing's names."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from numbers import Real
from typing import Any

from ..cases.amounts import Amount, read
from ..errors import UserError, quoted
from ..names import check_names


def as_amounts(known: Mapping[str, Any], allowed: Collection[str]) -> dict[str, Amount]:
    """Return known values as amounts.

    Parameters
    ----------
    known : mapping of str to float, str or Amount
        Values by name; None and empty texts count as not given.
    allowed : collection of str
        Names that may be known.

    Raises
    ------
    UserError
        For an unknown name, and a value that is no amount.
    """
    if not isinstance(known, Mapping):
        raise UserError(f"{quoted(known)} is not a mapping; expected names with their values")
    check_names(known, allowed, "quantity")
    amounts = {}
    for name, value in known.items():
        if value is None or value == "":
            continue
        amounts[name] = _as_amount(name, value)
    return amounts


def _as_amount(name: str, value: Any) -> Amount:
    if isinstance(value, Amount):
        return value
    if isinstance(value, str):
        if name in ("TA", "TB") and value.strip() == "course":
            return Amount.exactly(math.nan, "course")
        if name == "MU" and value.strip() == "locked":
            return Amount.exactly(-10.0)
        return read(name, value)
    if not isinstance(value, Real) and getattr(value, "shape", None) != ():
        raise UserError(f"{name} is {quoted(value)}; expected a number, a text or an Amount")
    number = float(value)
    if math.isnan(number) or (math.isinf(number) and name not in ("MA", "MB", "IA", "IB")):
        raise UserError(f"{name} is {number}; expected a finite number")
    return Amount.exactly(number)
