"""Suggestions for amounts that the grammar does not accept.

A text outside the grammar of `collision.units` often follows another habit of writing:
``40-45 mph``, ``5'-10 1/2"``, ``1,78 m``. It is not read, because it may mean something else, but
the message says how to write it. Each habit is a rewriting rule; a suggestion is an accepted text
reached by a chain of rewritings.
"""

import re
from collections.abc import Callable
from typing import NamedTuple

MAX_SUGGESTIONS = 2  # with more readings the text is too ambiguous to suggest any
MAX_LENGTH = 80  # characters of a text that is rewritten
MAX_TEXTS = 200  # rewritings of one text, a bound on time


class Habit(NamedTuple):
    """A habit of writing: a ``pattern`` to replace, and ``forms``, its accepted equivalents."""

    pattern: re.Pattern[str]
    forms: tuple[str, ...]


def _habit(pattern: str, *forms: str) -> Habit:
    return Habit(re.compile(pattern, re.IGNORECASE), forms)


_UNIT_OF_FEET = r"(?:ft\.?|feet|foot|'(?!'))"
_START = r"(?<![\d.,])"
"""Before the first digit of a number."""

HABITS = (
    # words that say the number is not exact; a tolerance says how far
    _habit(r"^(?:approx(?:\.|imately)?|about|around|ca\.?|circa|some|~|≈) *(?=[-+.\d])", ""),
    # between two limits
    _habit(r"^(?:from|between) +(?=.*\d.*\d)", ""),
    _habit(r"(?<=[\w.%°'\"]) +(?:to|until|till|through|thru|and) +(?=[-+.\d])", " .. "),
    _habit(r"(?<=[\w%°'\"]) *(?:\.{3,}|…) *(?=[-+.\d])", " .. "),
    _habit(r"^([.\d][^-–—]*?) *[-–—] *(?=[.\d])(?!.*[-–—] *[.\d])", r"\1 .. "),
    _habit(r"(?<=[\w.%°'\"]) +[-–—] +(?=[-.\d])", " .. "),
    _habit(r"(?<=[\w%°'\"]) *[–—] *(?=[-.\d][^–—]*$)", " .. "),
    _habit(r"(?<![\w.])[–—](?=[.\d])", "-"),
    # feet and inches
    _habit(rf"(\d *{_UNIT_OF_FEET}) *[-–,] *(?=\d)", r"\1 "),
    _habit(r"(?<=\d)[-–](?=\d+/\d+)", " "),
    _habit(rf"^([-+]?[\d.]+ *{_UNIT_OF_FEET} *[\d.]+)$", r"\1 in"),
    _habit(r"^([-+]?[\d.]+ *(?:°|deg(?:rees?)?\.?) *[\d.]+)$", r"\1'"),
    # a decimal comma, and marks between thousands
    _habit(rf"{_START}(\d+),(\d{{1,2}}|\d{{4,}})(?![\d,])", r"\1.\2"),
    _habit(rf"{_START}(\d+),(\d{{3}})(?![\d,.])", r"\1\2", r"\1.\2"),
    _habit(rf"{_START}(\d{{1,3}})[,](\d{{3}})(?=[,.]\d)", r"\1\2"),
    _habit(rf"{_START}(\d{{1,3}})[ '’](\d{{3}})(?![\d])", r"\1\2"),
    _habit(rf"{_START}(\d{{1,3}})\.(\d{{3}})\.(?=\d{{3}}(?!\d))", r"\1\2."),
    _habit(rf"{_START}(\d{{1,3}})\.(\d{{3}}),(?=\d)", r"\1\2."),
    # units
    _habit(r"(?<=\d) *M\.P\.H\.?", " mph"),
    _habit(r"(?<=\d) *#(?!\w)", " lb"),
    _habit(r"\bkgm([2²])", r"kg m\1"),
    _habit(r"(?<=[\d ])percent\b", "%"),
    _habit(r"\b(?:per cent|pct\.?)(?!\w)", "%"),
)


def suggestions(text: str, accepted: Callable[[str], bool]) -> list[str]:
    """Return the accepted ways of writing ``text``, an amount that is not accepted as it stands.

    Parameters
    ----------
    text : str
        The text as typed.
    accepted : callable
        Returns True if a text is an amount of the quantity in question.

    Returns
    -------
    list of str
        The accepted texts reached by the fewest rewritings; empty if there are none, or more than
        `MAX_SUGGESTIONS`.

    Examples
    --------
    >>> from impact88.collision.suggestions import suggestions
    >>> from impact88.collision.units import is_amount
    >>> suggestions("40-45 mph", lambda text: is_amount(text, "length/time"))
    ['40 .. 45 mph']
    """
    start = " ".join(text.split())
    if len(start) > MAX_LENGTH:
        return []
    texts, texts_reached = [start], {start}
    while texts:
        rewritten = []
        for source in texts:
            for pattern, forms in HABITS:
                for form in forms:
                    result = " ".join(pattern.sub(form, source).split())
                    if result not in texts_reached and len(texts_reached) < MAX_TEXTS:
                        texts_reached.add(result)
                        rewritten.append(result)
        accepted_texts = [result for result in rewritten if accepted(result)]
        if accepted_texts:
            return accepted_texts if len(accepted_texts) <= MAX_SUGGESTIONS else []
        texts = rewritten
    return []
