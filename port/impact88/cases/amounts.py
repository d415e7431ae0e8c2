"""Amounts: a number with its tolerance, and the affine maps that convert it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from fractions import Fraction
from typing import Any, Literal

from ..decimals import exact, negated

Kind = Literal["exact", "uniform", "triangular", "normal"]


@dataclass(frozen=True, slots=True)
class Amount:
    """A value, exact or known within limits: the one type of uncertainty in this package.

    Parameters
    ----------
    value : float
        Nominal value.
    low, high : float
        Limits; equal to ``value`` if exact, infinite if normal.
    kind : {"exact", "uniform", "triangular", "normal"}, default "exact"
        Distribution between the limits.
    sd : float, default 0
        Standard deviation of a normal.
    text : str, default ""
        Digits of an exact number as typed, where nothing has converted them.

    Examples
    --------
    >>> Amount(30.0, 28.0, 32.0, "uniform").mapped(Fraction(-2), Fraction(90)).low
    26.0
    """

    value: float
    low: float
    high: float
    kind: Kind = "exact"
    sd: float = 0.0
    text: str = ""

    def mapped(self, factor: Fraction, offset: Fraction = Fraction(0)) -> Amount:
        """Return ``offset + factor * self``.

        Digits as typed are mapped exactly; a change of sign alone keeps them."""
        if factor == 1 and offset == 0:
            return self
        if self.text:
            value = float(offset + factor * exact(self.text))
            keeps_digits = factor == -1 and offset == 0 and value != 0
            return Amount(value, value, value, text=negated(self.text) if keeps_digits else "")
        scale, shift = float(factor), float(offset)
        value, *limits = (shift + scale * x for x in (self.value, self.low, self.high))
        return Amount(value, min(limits), max(limits), self.kind, abs(scale) * self.sd)

    def as_json(self) -> dict[str, Any]:
        """Return the amount as an object for JSON."""
        return asdict(self)
