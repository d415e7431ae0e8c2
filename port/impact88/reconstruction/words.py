"""Reconstructions in words: the sentences that terminal, report and web page print.

What was asked, whether the evidence agrees, why no impact does, what was assumed, what would help,
and what was made of the problem.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..cases.units import PLAIN, View
from ..mechanics.laws import BROKEN
from ..names import quantity
from .answer import CONTRADICTION, MAX_NAMED, OUTSIDE, Reconstruction, Test
from .impacts import SPEEDS

POOR = 0.05  # probability below which values agree poorly
ADVISED = (*"SA SB WA WB WAF WBF E EM MUP DVA DVB LOSS".split(),)
"""Results that advice names."""
CONDITIONS = {
    "approach": "VC",
    "push": "PN",
    "energy": "EL",
    "E": "E",
    "EM": "EM",
    "friction": "MUP",
}
"""Conditions of physics, each with the result that shows by how much it is broken."""
VERDICTS = {
    "agrees": "",
    "at a limit": "the values fit best beyond a limit of physics; this impact lies at it",
    "impossible": "NO IMPACT that physics allows agrees with what is known",
    "contradictory": "NO IMPACT that physics allows agrees with what is known",
}


def number(name: str, value: float, view: View = PLAIN, digits: int = 4) -> str:
    """Return a number with its unit, as shown."""
    shown = view.shown(name, value)
    text = f"{0.0 if abs(shown) < 1e-12 else shown:.{digits}g}"
    if "e+" in text and abs(shown) < 1e9:
        text = f"{float(text):,.0f}"
    return f"{text} {view.unit(name)}".rstrip()


def question(result: Reconstruction) -> str:
    """Return what was asked, from how many values."""
    known = result.known
    measured = [name for name in known if known[name].varies]
    exact = len(known) - len(measured)
    asked = [name for name in ("SA", "SB") if _is_asked(result, name)]
    asked += [n for n in ("E", "MUP", "EM") if n in result.assumed and n not in known]
    parts = []
    if measured:
        parts.append(f"{_join(measured)} within limits")
    parts.append(f"{exact} exact value{'s' * (exact != 1)}")
    open_question = "whether they agree" if result.evidence.redundancy else "the impact"
    return f"{_join(asked) if asked else open_question}, from {' and '.join(parts)}"


def _is_asked(result: Reconstruction, speed: str) -> bool:
    has_motion = speed in result.values or speed in result.undetermined
    return has_motion and speed not in result.known and not {*SPEEDS[speed]} <= result.known.keys()


def evidence(result: Reconstruction, view: View = PLAIN) -> str:
    """Return whether the known values agree with each other."""
    found = result.evidence
    laws = "; ".join(_law(law, view) for law in result.laws[:MAX_NAMED])
    if not found.redundancy:
        text = "not checked: no more is known than needed"
        return f"{text}; {laws}" if laws else text
    agree = "agree" if found.probability >= POOR else "agree poorly"
    if found.probability < CONTRADICTION:
        agree = "contradict one another"
    text = (
        f"the values {agree}: sum of squared adjustments {found.squares:.3g} where about "
        f"{found.redundancy} is expected, probability {found.probability:.2g}"
    )
    odd = "; ".join(check(result, name, view) for name in found.at_odds)
    if odd and found.probability < POOR:
        text += f". Most at odds: {odd}"
    return f"{text}. {laws[:1].upper()}{laws[1:]}" if laws else text


def _law(law: Any, view: View) -> str:
    amount = number(law.like, law.amount, view)
    amount = amount.lstrip("-")
    return f"{law.law} misses by {amount} ({100 * law.relative:.2g} % of its largest term)"


def check(result: Reconstruction, name: str, view: View = PLAIN) -> str:
    """Return a known value beside the others."""
    test = result.tests[name]
    given, others = (number(name, x, view) for x in (test.measured, test.by_others))
    return f"{name} {given} given, {others} by the others{_moved(result, name, test.by_others)}"


def _moved(result: Reconstruction, name: str, value: float) -> str:
    """Return how far a value is from the given one in its standard deviations, "" if exact."""
    test = result.tests[name]
    if name not in result.known or not result.known[name].varies:
        return ""
    return f" ({abs(value - test.measured) / test.sd:.1f} sd)"


def refusal(result: Reconstruction, view: View = PLAIN) -> str:
    """Return why no impact agrees, and which values would have to move how far; "" if one does."""
    text = VERDICTS[result.verdict]
    conditions = []
    for name in result.broken:
        amount = result.values.get(CONDITIONS.get(name, ""), None)
        words = BROKEN.get(name, f"{name} would be the other one")
        if amount is not None and result.verdict == "impossible":
            words += f" ({CONDITIONS[name]} {number(CONDITIONS[name], amount, view)})"
        conditions.append(words)
    if conditions:
        text += f": {'; '.join(conditions)}"
    moves = [
        f"{name} at {number(name, test.adjusted, view)}, not {number(name, test.measured, view)}"
        f"{_moved(result, name, test.adjusted)}"
        for name, test in _farthest(result.tests)
    ]
    if result.verdict == "contradictory" and moves:
        text += f". The nearest one has {'; '.join(moves)}"
    return text


def warnings(result: Reconstruction, view: View = PLAIN) -> list[str]:
    """Return reasons to doubt the answer: why no impact agrees, that none is within all limits."""
    reason = refusal(result, view)
    return [*([reason] if reason else []), *(text for text in result.remarks if text == OUTSIDE)]


def _farthest(tests: Any) -> list[tuple[str, Test]]:
    """Return the values that an impact has farthest from where they were measured."""
    moved = [(n, t) for n, t in tests.items() if abs(t.adjusted - t.measured) >= t.sd]
    return sorted(moved, key=lambda pair: -abs(pair[1].adjusted - pair[1].measured) / pair[1].sd)[
        :MAX_NAMED
    ]


def assumptions(result: Reconstruction) -> tuple[str, ...]:
    """Return what was assumed of inputs that are not given, a phrase each."""
    return tuple(
        f"{text}" if name[0] == "T" else f"{name} {text}" for name, text in result.assumed.items()
    )


def advice(result: Reconstruction) -> tuple[str, ...]:
    """Return what would help, a sentence each."""
    sentences = []
    if result.advice:
        opened = [name for name in result.undetermined if name in ADVISED]
        names = _join(result.advice)
        sentences.append(
            f"give {names}: that would determine {_join(opened or result.undetermined)}"
        )
    for name in ("SA", "SB"):
        driver = next(iter(result.drivers.get(name, {}).items()), None)
        if driver and driver[1] >= 0.5 and driver[0] != name:
            sentences.append(
                f"know {driver[0]} more closely: it makes {100 * driver[1]:.0f} % of the variance "
                f"of {name}"
            )
    return tuple(sentences)


def remarks(result: Reconstruction) -> tuple[str, ...]:
    """Return what was made of the problem, and how it was searched."""
    ended, impacts, unseen = result.search
    lines = [text for text in result.remarks if text != OUTSIDE]
    if impacts and ended > 1:
        lines.append(
            f"{ended} random starts led to {impacts} impact{'s' * (impacts != 1)}; expected number "
            f"not seen {unseen:.2g}"
        )
    needs: dict[str, list[str]] = {}
    for name, reason in result.excluded.items():
        needs.setdefault(reason, []).append(name)
    for reason, names in needs.items():
        verb = "need" if len(names) > 1 else "needs"
        meaning = f" ({quantity(reason).meaning})" if "," not in reason else ""
        lines.append(f"{_join(names)} {verb} {reason}{meaning}")
    return tuple(lines)


def _join(names: Iterable[str]) -> str:
    """Return names as in "A, B and C"."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else str(last)
