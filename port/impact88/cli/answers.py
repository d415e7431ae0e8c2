"""An answer as text for the terminal. Numbers are those of the answer; nothing is rounded here."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..layout import paragraph, table
from ..report.answers import Answer, Number

LABEL = 10  # columns of the words at the left


def answer_lines(answer: Answer) -> Iterator[str]:
    """Yield the lines of an answer: the question, what was found, how sure it is, remarks."""
    impacts = [answer, *(other for other in answer.alternatives if other.possible)]
    yield from paragraph(answer.question, "ASKED", LABEL)
    if answer.evidence:
        yield from paragraph(answer.evidence, "EVIDENCE", LABEL)
    for number, impact in enumerate(impacts, 1):
        yield ""
        if len(impacts) > 1:
            yield f"IMPACT {number} OF {len(impacts)}"
        yield from number_lines(impact.found.values())
        if impact.checks:
            yield from ("", *_check_lines(impact))
    yield ""
    for text in answer.assumed:
        yield from paragraph(text, "ASSUMED", LABEL)
    for text in answer.advice:
        yield from paragraph(text, "HELPS", LABEL)
    for other in answer.alternatives:
        if not other.possible:
            reason = other.warnings[0] if other.warnings else other.evidence
            yield from paragraph(reason.partition(": ")[2] or reason, "REJECTED", LABEL)
    for text in answer.warnings:
        yield from paragraph(text, "!", 2)
    for text in answer.remarks:
        yield from paragraph(text, "-", 2)


def number_lines(numbers: Iterable[Number]) -> list[str]:
    """Return a table of results, and what they depend on."""
    numbers = list(numbers)
    head = ["", "value", "90 % interval", "unit", ""]
    if not any(number.interval for number in numbers):
        head[2] = ""
    lines = table([head, *map(_cells, numbers)], left=(0, 3, 4))
    names: dict[str, list[str]] = {}
    for number in numbers:
        names.setdefault(number.drivers, []).append(number.name)
    names.pop("", None)
    depends = [
        line
        for drivers, members in names.items()
        for line in paragraph(f"{' '.join(members)}: {drivers}", "DEPENDS", LABEL)
    ]
    return [*lines, "", *depends] if depends else lines


def _cells(number: Number) -> list[str]:
    """Return the row of one number."""
    meaning = f"{number.meaning} ({number.note})" if number.note else number.meaning
    return [number.name, number.text, number.interval, number.unit, meaning]


def _check_lines(answer: Answer) -> list[str]:
    """Return the table of values known with tolerances, beside the others."""
    head = ["CHECKED", "given", "adjusted", "by the others", "unit", "residual"]
    rows = [
        [
            check.name,
            check.measured,
            check.adjusted,
            check.by_others,
            check.unit,
            f"{check.residual}{' !' if check.is_odd else ''}",
        ]
        for check in answer.checks
    ]
    return table([head, *rows], left=(0, 4))
