"""The verdict on the evidence: whether the measured values of a reconstruction can all be true.

The sum of squared adjustments, each in standard deviations, of r redundant values follows the
chi-square distribution with r degrees of freedom if the tolerances are right (Mikhail and
Ackermann, *Observations and Least Squares*, 1976). Leaving a value out reduces the sum by the
square of its standardized residual (Baarda, *A Testing Procedure for Use in Geodetic Networks*,
1968)."""

import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ...collision.needs import join_words
from ...collision.units import RULES, System
from ...mechanics.state import CHANGES, CRUSH, ENERGIES, SPEEDS
from ...messages.plaintable import number
from ...names import quantity
from .laws import MissedLaw, describe_laws

# Measurements contradict one another if their sum of squares has a smaller probability: one
# consistent set in a thousand is accused.
CONTRADICTION = 1e-3
STRAIN = 0.05  # probability below which they agree poorly
NAMED_RATIO = 0.9  # squared residual, relative to the largest, from which a value is named with it
MAX_NAMED = 3  # values at odds that are named
# Exact values that miss one another by less, as a fraction of the largest speed, are rounded ones:
# numbers of three digits
ROUNDED = 1e-3
NOISE = 1e-9  # sums of squares below are rounding
MIN_PROBABILITY = 1e-12  # smaller ones are printed as "below" this
NEVER_NEGATIVE = (*SPEEDS, *CHANGES, *ENERGIES, *CRUSH)
AGREE = "agree"
STRAINED = "agree poorly"
CONTRADICT = "contradict"
UNCHECKED = "not checked"


@dataclass(frozen=True)
class AtOdds:
    """One measured value in contradiction with the others.

    Parameters
    ----------
    name : str
        Name of the quantity.
    measured, adjusted : float
        Measured and adjusted value.
    expected : float
        The value that the others give it.
    move : float
        How far it would have to move there, in its own standard deviations.
    residual : float
        Adjustment in standard deviations of that adjustment.
    without : float
        Probability of the sum of squares of the other values alone, nan if nothing would be left to
        check.
    """

    name: str
    measured: float
    adjusted: float
    expected: float
    move: float
    residual: float
    without: float


@dataclass(frozen=True)
class Evidence:
    """Verdict on whether the measured values of a reconstruction can all be true.

    Parameters
    ----------
    verdict : str
        `AGREE`, `STRAINED`, `CONTRADICT`, or `UNCHECKED` if no more is known than needed. Exact
        values agree where more is known than needed and everything holds.
    squares : float
        Sum of squared adjustments in standard deviations.
    redundancy : int
        Known values more than needed.
    probability : float
        Probability of a sum of squares that large or larger, nan if unchecked.
    at_odds : sequence of AtOdds
        The values that are together most at odds with the others, first what would have to move
        least in its own standard deviations.
    inside : bool, optional
        True if some impact lies within all limits at once, None if that was not searched for.
    exact : bool
        True if all values are exact; standard deviations are then those of the misfit.
    laws : tuple of MissedLaw
        The laws that exact values do not satisfy.
    tested : tuple of str
        The laws by which exact values that agree test one another, "" for what several laws
        together test.
    """

    verdict: str
    squares: float
    redundancy: int
    probability: float
    at_odds: Sequence[AtOdds]
    inside: bool | None = None
    exact: bool = False
    laws: tuple[MissedLaw, ...] = ()
    tested: tuple[str, ...] = ()

    @property
    def contradictory(self) -> bool:
        """True if the values contradict one another."""
        return self.verdict == CONTRADICT

    @property
    def widening(self) -> float:
        """Factor on the standard deviations of values that contradict one another, else 1.

        It is the square root of the sum of squares over the redundancy, also of exact values that
        miss one another by rounding.
        """
        is_scaled = self.contradictory or (self.exact and self.redundancy > 0)
        return math.sqrt(self.squares / self.redundancy) if is_scaled else 1.0

    @property
    def sum_text(self) -> str:
        """The sum of squares as printed, 0 if it is rounding only."""
        return _format_amount(self.squares if self.squares > NOISE else 0.0, 3)

    def text(self, units: System = RULES, given: Collection[str] = ()) -> str:
        """Return the verdict in a sentence or two.

        Parameters
        ----------
        units : System
            Units of the numbers in it.
        given : collection of str, optional
            Names of what was given: a vehicle known to stand is then named by its speed.

        Returns
        -------
        str
            The verdict, without a full stop.
        """
        if self.verdict == UNCHECKED:
            kind = "exact value" if self.exact else "measurement"
            return f"not checked: no more is known than needed, so no {kind} tests another"
        if self.exact and self.verdict == AGREE:
            names = [name for name in self.tested if name]
            hold = "hold" if len(names) > 1 else "holds"
            words = (
                f"{join_words(names)} {hold}" if names else f"{len(self.tested)} more than needed"
            )
            return f"these exact values agree: {words}"
        if self.exact:
            laws = f": {describe_laws(self.laws, units)}" if self.laws else ""
            if not self.contradictory:
                return f"these exact values agree but for rounding{laws}"
            at_odds = self.name_values_at_odds(units, given)
            return f"these exact values contradict one another{laws}; {at_odds}"
        sums = (
            f"sum of squared adjustments, in standard deviations, {self.sum_text} where about "
            f"{self.redundancy} is expected; probability {_format_probability(self.probability)}"
        )
        if not self.contradictory:
            return f"the measurements {self.verdict}: {sums}"
        if self.probability >= CONTRADICTION:
            sums = f"no impact lies within all limits at once; {sums}"
        at_odds = self.name_values_at_odds(units, given)
        return f"these measurements contradict one another; {at_odds}. {sums[0].upper()}{sums[1:]}"

    def name_values_at_odds(self, units: System = RULES, given: Collection[str] = ()) -> str:
        """Return the values most at odds, each as measured and as the others give it.

        Parameters
        ----------
        units : System
            Units of the numbers.
        given : collection of str, optional
            Names of what was given.

        Returns
        -------
        str
            The values, in one line.
        """
        parts = []
        for item in self.at_odds:
            name, unit = as_given(item.name, given), units.unit(item.name)
            unit = "°" if unit == "deg" else f" {unit}" if unit else ""
            # the first part of the meaning; the rest is for the tables
            meaning = re.split("[:;,]| as printed", quantity(name).meaning)[0]
            measured, expected = (
                _format_amount(units.display_unwrapped(item.name, float(x))) + unit
                for x in (item.measured, item.expected)
            )
            word = "given" if self.exact else "measured"
            distance = "" if self.exact else f", {_format_amount(abs(item.move), 2)} sd away"
            parts.append(
                f"{meaning} {name} ({measured} {word}, {expected} by the others{distance})"
            )
        text = "together" if len(parts) > 1 else "most"
        text += " at odds: " + "; ".join(parts)
        if not self.exact and self.at_odds and all(item.without >= STRAIN for item in self.at_odds):
            any_one = "any one of them" if len(self.at_odds) > 1 else "it"
            text += f"; without {any_one} the others agree"
        return text

    def as_json(self, units: System = RULES, given: Collection[str] = ()) -> dict[str, Any]:
        """Return the object that ``impact88 reconstruct --json`` prints for the evidence.

        Parameters
        ----------
        units : System
            Units of the numbers.
        given : collection of str, optional
            Names of what was given.

        Returns
        -------
        dict of str to object
            The evidence as JSON types.
        """
        rows = [
            {
                "name": item.name,
                "measured": units.display_unwrapped(item.name, float(item.measured)),
                "adjusted": units.display_unwrapped(item.name, float(item.adjusted)),
                "by_the_others": units.display_unwrapped(item.name, float(item.expected)),
                "move": item.move,
                "standardized_residual": item.residual,
                "probability_without": item.without,
            }
            for item in self.at_odds
        ]
        return {
            "verdict": self.verdict,
            "text": self.text(units, given),
            "probability": self.probability,
            "within_all_limits": self.inside,
            "most_at_odds": rows,
            "laws_missed": [law.text(units) for law in self.laws],
        }


def as_given(name: str, given: Collection[str]) -> str:
    """Return the name under which a value was given: the speed of a vehicle known to stand, whose
    components the equations have."""
    speeds = (speed for speed, parts in SPEEDS.items() if name in parts and speed in given)
    return name if name in given else next(speeds, name)


def _format_amount(value: float, digits: int = 4) -> str:
    """Return a number with so many digits, without an exponent up to a billion."""
    text = number(value, digits)
    return f"{float(text):,.0f}" if "e+" in text and abs(value) < 1e9 else text


def _format_probability(value: float) -> str:
    """Return a probability with two digits."""
    return number(value, 2) if value >= MIN_PROBABILITY else f"below {MIN_PROBABILITY:g}"


def weigh(
    squares: float,
    redundancy: int,
    values: Mapping[str, tuple[float, float, float, float]],
    inside: bool | None = None,
    exact: bool = False,
    laws: tuple[MissedLaw, ...] = (),
    tested: tuple[str, ...] = (),
    speed: float = 0.0,
) -> Evidence:
    """Return the verdict on adjusted values.

    ``values``: by name the measured and the adjusted value, the adjustment in standard deviations,
    and the redundancy number (the part of an error of the value that its adjustment shows, 0 to 1).
    ``inside``: True if some impact lies within all limits, None if that was not searched for.
    ``exact``: the values are exact and contradict one another; ``laws``: the laws they violate;
    ``tested``: those that exact values satisfy; ``speed``: the largest known velocity, of which
    exact values may miss `ROUNDED`."""
    # eight arguments: what searches and laws found, which the verdict alone brings together
    if redundancy < 1:
        verdict = AGREE if tested and not values else UNCHECKED
        exact = not values
        return Evidence(verdict, squares, redundancy, math.nan, (), inside, exact, (), tested)
    probability = chi_square_tail(squares, redundancy)
    items = []
    for name, (measured, adjusted, adjustment, redundancy_number) in values.items():
        if redundancy_number > 1e-9:
            residual = adjustment / math.sqrt(redundancy_number)
            other_squares = max(squares - residual * residual, 0.0)
            without = chi_square_tail(other_squares, redundancy - 1) if redundancy > 1 else 1.0
            expected = measured + (adjusted - measured) / redundancy_number
            move = adjustment / redundancy_number
            items.append(AtOdds(name, measured, adjusted, expected, move, residual, without))
    # a negative speed is no value that the others could give
    items = [i for i in items if i.expected >= 0 or i.name not in NEVER_NEGATIVE] or items
    largest = max((item.residual**2 for item in items), default=0.0)
    together = [item for item in items if item.residual**2 >= NAMED_RATIO * largest]
    worst = sorted(together, key=lambda item: abs(item.move))[:MAX_NAMED]
    verdict = AGREE if probability >= STRAIN else STRAINED
    if exact:
        verdict = CONTRADICT if math.sqrt(squares) > ROUNDED * speed else STRAINED
    elif probability < CONTRADICTION or inside is False:
        verdict = CONTRADICT
    probability = math.nan if exact else probability
    return Evidence(verdict, squares, redundancy, probability, tuple(worst), inside, exact, laws)


def chi_square_tail(squares: float, freedom: int) -> float:
    """Return the probability that a chi-square variate with ``freedom`` degrees of freedom, 1 or
    more, is at least ``squares``: the finite sums of Abramowitz and Stegun 26.4.4 and 26.4.5."""
    half = squares / 2
    if half > 700:
        return 0.0
    odd = freedom % 2
    total = math.erfc(math.sqrt(half)) if odd else 0.0
    term = math.exp(-half) * (2 * math.sqrt(half / math.pi) if odd else 1.0)
    for step in range((freedom - odd) // 2):
        total += term
        term *= half / (step + 1 + odd / 2)
    return min(total, 1.0)
