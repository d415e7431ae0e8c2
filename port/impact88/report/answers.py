"""The answer to a case: the one record that terminal, JSON, report and web page print.

`ask` decides what a case asks for. Nothing that prints an answer computes, converts or rounds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ..cases.case import Case

FORM = "impact88 answer 1"
"""Name and version of the form that `Answer.as_json` returns."""


@dataclass(frozen=True, slots=True)
class Number:
    """One number of an answer, in the unit in which it is shown.

    Parameters
    ----------
    name, meaning, unit : str
        Of the quantity (`impact88.names`); the unit is "" for ratios and without named units.
    value : float
        The number, not rounded.
    text : str
        The number as every reader sees it, without its unit.
    low, high : float or None
        Ends of its 90 % interval; None for an exact number.
    low_text, high_text : str
        The ends, rounded alike; "" for an exact number.
    note : str
        The same in other words: "10 o'clock".
    drivers : str
        What makes it uncertain, the largest first: "UX 62 %, MU 20 %".
    """

    name: str
    meaning: str
    unit: str
    value: float
    text: str
    low: float | None = None
    high: float | None = None
    low_text: str = ""
    high_text: str = ""
    note: str = ""
    drivers: str = ""

    @property
    def interval(self) -> str:
        """The 90 % interval as text: "28.1 .. 31.5"; "" for an exact number."""
        return f"{self.low_text} .. {self.high_text}" if self.low_text else ""


@dataclass(frozen=True, slots=True)
class Given:
    """One entry of the case.

    Parameters
    ----------
    name, meaning, unit : str
        Of the quantity.
    text : str
        The entry as written.
    source : str
        Where it comes from, as the case says.
    """

    name: str
    meaning: str
    unit: str
    text: str
    source: str = ""


@dataclass(frozen=True, slots=True)
class Check:
    """A value known with a tolerance, beside the others (Baarda 1968); texts, rounded.

    Parameters
    ----------
    name, unit : str
        Of the quantity.
    measured, adjusted, by_others : str
        As given, in the impact found, and as the other values alone would have it.
    residual : str
        Adjustment in its standard deviations.
    is_odd : bool
        True if it is most at odds with the others.
    """

    name: str
    unit: str
    measured: str
    adjusted: str
    by_others: str
    residual: str
    is_odd: bool = False


@dataclass(frozen=True)
class Answer:
    """The answer to a case, in the units, axes and headings of the case.

    Parameters
    ----------
    asked : {"forward", "bounds", "reconstruct"}
        The question that the case leaves open.
    question : str
        The same in words: "SA and SB, from 10 exact values".
    given : tuple of Given
        The entries, in the order of the file.
    found : mapping of str to Number
        Results by name, the most asked first.
    evidence : str
        Agreement of what is known, in words; "" for a forward question.
    possible : bool
        False if no impact that physics allows agrees with what is known.
    assumed : tuple of str
        Ranges assumed for what is not given.
    advice : tuple of str
        Values that would help if they were given.
    checks : tuple of Check
        Values known with tolerances, beside the others.
    remarks : tuple of str
        How entries were understood, estimates, results that lack an input.
    warnings : tuple of str
        Reasons to doubt the answer.
    scene : mapping of str to float
        Inputs and results in base units along the listing's axes, for drawings.
    alternatives : tuple of Answer
        Other impacts that agree with what is known, in the order of likelihood.
    case : Case
        The case.
    """

    asked: str
    question: str
    given: tuple[Given, ...]
    found: Mapping[str, Number]
    case: Case = field(repr=False)
    evidence: str = ""
    possible: bool = True
    assumed: tuple[str, ...] = ()
    advice: tuple[str, ...] = ()
    checks: tuple[Check, ...] = ()
    remarks: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    scene: Mapping[str, float] = field(default_factory=dict, repr=False)
    alternatives: tuple[Answer, ...] = ()

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """The 90 % intervals of the results that have one."""
        return {
            name: (number.low, number.high)
            for name, number in self.found.items()
            if number.low is not None and number.high is not None
        }

    def as_json(self) -> dict[str, Any]:
        """Return the answer as an object for JSON, see `FORM`."""
        record = {
            "asked": self.asked,
            "question": self.question,
            "given": [asdict(entry) for entry in self.given],
            "found": [asdict(number) for number in self.found.values()],
            "evidence": self.evidence,
            "possible": self.possible,
        }
        for name in ("assumed", "advice", "remarks", "warnings"):
            record[name] = list(getattr(self, name))
        record["checks"] = [asdict(check) for check in self.checks]
        record["alternatives"] = [answer.as_json() for answer in self.alternatives]
        return record


def ask(case: Case) -> Answer:
    """Return the answer to a case: forward, bounds or reconstruction.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Answer
        Forward where a complete scene is given and nothing else, with 90 % intervals where it has
        tolerances; else the impact that agrees best with what is known.

    Raises
    ------
    UserError
        For a case that gives too little, or values that no impact has.
    """
    raise NotImplementedError
