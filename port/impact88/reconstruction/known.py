"""Known values from Python: numbers, texts and amounts by the listing's names."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any

from ..cases.amounts import Amount
from ..cases.case import Case
from ..errors import UserError, quoted
from ..names import check_names

MAY_BE_INFINITE = ("MA", "MB", "IA", "IB")  # a barrier


def as_amounts(known: Mapping[str, Any], allowed: Collection[str]) -> dict[str, Amount]:
    """Return known values as amounts.

    Parameters
    ----------
    known : mapping of str to float, str or Amount
        Values by name. Texts are read as in a file of these entries (`Case.of`), with their units;
        None counts as not given.
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
    given = {name: value for name, value in known.items() if value is not None}
    amounts = {name: v for name, v in given.items() if isinstance(v, Amount)}
    others = {name: value for name, value in given.items() if name not in amounts}
    if any(isinstance(value, str) for value in others.values()):
        return {**Case.of(others, "values").entries, **amounts}
    return {name: amounts.get(name) or _as_amount(name, value) for name, value in given.items()}


def _as_amount(name: str, value: Any) -> Amount:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise UserError(f"{name} is {quoted(value)}; expected a number, text or Amount") from None
    if math.isnan(number) or (math.isinf(number) and name not in MAY_BE_INFINITE):
        raise UserError(f"{name} is {number}; expected a finite number")
    return Amount.exactly(number)
