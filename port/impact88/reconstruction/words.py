"""Reconstructions in words: the sentences that terminal, report and web page print.

They say what is asked, whether the evidence agrees, why no impact does, what was assumed and what
would help.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

from ..cases.units import PLAIN, View
from ..mechanics.laws import BROKEN
from ..names import quantity
from .answer import CONDITIONS, CONTRADICTION, MAX_NAMED, OUTSIDE, Reconstruction
from .bounds import Bounds
from .impacts import COURSES, SPEEDS
from .laws import MissedLaw
from .problem import CRUSH

POOR = 0.05  # probability below which values agree poorly
LARGEST = 0.5  # share of a variance from which a value is named as what would help
ADVISED = (*"SA SB WA WB WAF WBF E EM MUP DVA DVB LOSS".split(),)
"""Results that advice names."""
SOURCES: dict[str, tuple[str, ...]] = {
    axis: (speed,) for speed, axes in SPEEDS.items() for axis in axes
}
SOURCES |= {"EL": CRUSH, "MUP": ("MU",)}
"""Measured values with the entries that they may come from."""
VERDICTS = {
    "agrees": "",
    "at a limit": "the values fit best beyond a limit of physics; this impact lies at it",
    "impossible": "NO IMPACT that physics allows agrees with what is known",
    "contradictory": "NO IMPACT that physics allows agrees with what is known",
}


def number(name: str, value: float, view: View = PLAIN) -> str:
    """Return a number with its unit, as shown."""
    shown = view.shown(name, value)
    text = f"{0.0 if abs(shown) < 1e-12 else shown:.4g}"
    if "e+" in text:
        text = f"{float(text):,.0f}"
    return f"{text} {view.unit(name)}".rstrip()


def entry(result: Reconstruction, name: str) -> str:
    """Return the name of a measured value with the entries that give it.

    Parameters
    ----------
    result : Reconstruction
        The impact.
    name : str
        A name in its ``tests`` or ``drivers``: EL may be the sum of two entries' energies, MUP a
        signed MU, and MU a share of the critical friction.

    Examples
    --------
    >>> known = {"M": 4, "MA": 95, "MB": 110, "HA": 0, "SB": 0, "E": 0.1, "HAF": 0}
    >>> known |= {"EBSA": "14 +- 2", "EBSB": "12 +- 2"}
    >>> entry(impact88.reconstruct(known, samples=0)[0], "EL")
    'EL (EBSA, EBSB)'
    """
    if name == "MU" and result.known[name].share:
        return "MU/MUC"
    return name if name in result.known else f"{name} ({', '.join(_entries(result, name))})"


def _entries(result: Reconstruction, name: str) -> list[str]:
    """Return the entries that give a measured value."""
    return [part for part in (name, *SOURCES.get(name, ())) if part in result.known]


def question(result: Reconstruction, derived: Collection[str] = ()) -> str:
    """Return what is asked, from how many values; ``derived`` ones are not counted."""
    known = result.known
    within_limits = [name for name in known if known[name].varies]
    exact = sum(a.value == a.value for n, a in known.items() if n not in derived)
    exact -= len(within_limits)
    asked = [name for name in ("SA", "SB") if _is_asked(result, name)]
    asked += [n for n in ("E", "MUP", "EM") if n in result.assumed and n not in known]
    parts = [f"{_join(within_limits)} within limits"] if within_limits else []
    parts.append(f"{exact} exact value{'s' * (exact != 1)}")
    open_question = "whether they agree" if result.evidence.redundancy else "the impact"
    return f"{_join(asked) or open_question}, from {_join(parts)}"


def _is_asked(result: Reconstruction, speed: str) -> bool:
    is_known = speed in result.known or {*SPEEDS[speed]} <= result.known.keys()
    return speed in (*result.values, *result.undetermined) and not is_known


def evidence(result: Reconstruction, view: View = PLAIN) -> str:
    """Return whether the known values agree with each other."""
    agreement = result.evidence
    laws = "; ".join(_law(law, view) for law in result.laws[:MAX_NAMED])
    if not agreement.redundancy:
        text = "not checked: no more is known than needed"
        return f"{text}; {laws}" if laws else text
    agree = "agree" if agreement.probability >= POOR else "agree poorly"
    if agreement.probability < CONTRADICTION:
        agree = "contradict one another"
    sentences = [
        f"the values {agree}: sum of squared adjustments {agreement.squares:.3g} where about "
        f"{agreement.redundancy} is expected, probability {agreement.probability:.2g}"
    ]
    if agreement.at_odds and agreement.probability < POOR:
        checks = "; ".join(check(result, name, view) for name in agreement.at_odds)
        sentences.append(f"Most at odds (exact values are not tested): {checks}")
    if laws:
        sentences.append(laws[:1].upper() + laws[1:])
    return ". ".join(sentences)


def _law(law: MissedLaw, view: View) -> str:
    amount = number(law.like, law.amount, view).lstrip("-")
    return f"{law.law} misses by {amount} ({100 * law.relative:.2g} % of its largest term)"


def checks(result: Reconstruction, view: View = PLAIN) -> tuple[str, ...]:
    """Return the known values that others check, beside them, a phrase each."""
    tests = result.tests.items()
    return tuple(check(result, name, view) for name, x in tests if math.isfinite(x.by_others))


def check(result: Reconstruction, name: str, view: View = PLAIN) -> str:
    """Return a known value beside the others."""
    test = result.tests[name]
    texts = _beside(result, name, test.by_others, abs(test.residual), view)
    return "{} {} given, {} by the others{}".format(*texts)


def _beside(
    result: Reconstruction, name: str, other: float, distance: float, view: View
) -> tuple[str, ...]:
    """Return texts of a value's name, of the value given, of another one, and of their distance in
    standard deviations, "" for an exact value."""
    varies = any(result.known[part].varies for part in _entries(result, name))
    values = (number(name, x, view) for x in (result.tests[name].measured, other))
    return entry(result, name), *values, f" ({distance:.1f} sd)" * varies


def refusal(result: Reconstruction, view: View = PLAIN) -> str:
    """Return why no impact agrees, and which values would have to move how far; "" if one does."""
    text = VERDICTS[result.verdict]
    if result.broken:
        conditions = [_broken(result, name, view) for name in result.broken]
        text += f": {'; '.join(conditions)}"
    moves = {n: abs(t.adjusted - t.measured) / t.sd for n, t in result.tests.items()}
    farthest = sorted((name for name in moves if moves[name] >= 1.0), key=lambda n: -moves[n])
    if result.verdict == "contradictory" and farthest:
        text += ". The nearest one has " + "; ".join(
            "{0} at {2}, not {1}{3}".format(
                *_beside(result, name, result.tests[name].adjusted, moves[name], view)
            )
            for name in farthest[:MAX_NAMED]
        )
    return text


def _broken(result: Reconstruction, condition: str, view: View) -> str:
    """Return what would be the case where a condition of physics is violated."""
    name = CONDITIONS.get(condition, condition)
    value = result.broken[condition]
    text = number(name, value, view)
    if name in COURSES:
        return f"{name[1]} would travel against its course {name}"
    if name == "E" and name in result.excluded:
        end = "pass through each other" if value < 0 else "separate faster than they met"
        return (
            f"with the contact normal along the impulse E would be {text}: the vehicles would {end}"
        )
    words = BROKEN.get(condition, "friction would act along the sliding")
    return f"{words} ({name} {text})" if result.is_adverse else words


def warnings(result: Reconstruction, view: View = PLAIN) -> list[str]:
    """Return reasons to doubt the answer: why no impact agrees, that none is within all limits."""
    reasons = [refusal(result, view), *(line for line in result.remarks if line == OUTSIDE)]
    return [reason for reason in reasons if reason]


def assumptions(result: Reconstruction) -> tuple[str, ...]:
    """Return what was assumed of inputs that are not given, a phrase each."""
    return tuple(
        text if name[0] == "T" else f"{name} {text}" for name, text in result.assumed.items()
    )


def advice(result: Reconstruction) -> tuple[str, ...]:
    """Return what would help, a sentence each."""
    sentences = []
    if result.advice:
        names = [name for name in result.undetermined if name in ADVISED] or result.undetermined
        sentences.append(f"give {_join(result.advice)}: that would determine {_join(names)}")
    for name in ("SA", "SB"):
        for driver, share in result.drivers.get(name, {}).items():
            if share >= LARGEST and driver != name:
                sentences.append(
                    f"know {entry(result, driver)} more closely: it makes {100 * share:.0f} % of "
                    f"the variance of {name}"
                )
    return tuple(sentences)


def precision(result: Reconstruction | Bounds) -> str:
    """Return the number of draws, and how exact the intervals are for it."""
    count = len(next(iter(result.draws.values())))
    return (
        f"intervals of {count:,} draws: Monte Carlo error of their ends (1 sd) at most "
        f"{100 * result.sampling_error:.2g} % of the width"
    )


def remarks(result: Reconstruction) -> tuple[str, ...]:
    """Return how the known values were understood, and how the impact was searched."""
    starts, impacts, unseen = result.search
    lines = [text for text in result.remarks if text != OUTSIDE]
    if impacts and math.isfinite(unseen):
        lines.append(
            f"{starts} random starts led to {impacts} impact{'s' * (impacts != 1)}; others that no "
            f"start reached, by estimate: {unseen:.2g}"
        )
        if impacts > result.solutions > 0:
            lines.append(
                f"{impacts - result.solutions} left out: against physics or the sense of the "
                "friction, or far less likely"
            )
    if result.draws:
        lines.append(precision(result))
    for reason in dict.fromkeys(result.excluded.values()):
        names = [name for name in result.excluded if result.excluded[name] == reason]
        verb = "need" if len(names) > 1 else "needs"
        meaning = f" ({quantity(reason).meaning})" if "," not in reason else ""
        lines.append(f"{_join(names)} {verb} {reason}{meaning}")
    return tuple(lines)


def _join(names: Sequence[str]) -> str:
    """Return names as in "A, B and C"."""
    return " and ".join([", ".join(names[:-1])] * (len(names) > 1) + [*names[-1:]])
