"""An answer as text for the terminal. Numbers are those of the answer; nothing is rounded here."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..layout import paragraph, table
from ..report.answers import Answer, Number
from .output import show

LABEL = 10  # columns of the words at the left


def show_answer(answer: Answer, is_json: bool) -> int:
    """Print an answer, and return the exit status."""
    show(is_json, "answer", answer.as_json(), answer_lines(answer))
    return int(not answer.possible)


def answer_lines(answer: Answer) -> Iterator[str]:
    """Yield the lines of an answer: the question, what was found, how sure it is, remarks."""
    impacts = [answer, *(other for other in answer.alternatives if other.possible)]
    rejected = (other for other in answer.alternatives if not other.possible)
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
    reasons = [(*other.warnings, other.evidence)[0] for other in rejected]
    for label, width, texts in (
        ("ASSUMED", LABEL, answer.assumed),
        ("HELPS", LABEL, answer.advice),
        ("REJECTED", LABEL, [reason.partition(": ")[2] or reason for reason in reasons]),
        ("!", 2, answer.warnings),
        ("-", 2, answer.remarks),
    ):
        for text in texts:
            yield from paragraph(text, label, width)


def number_lines(numbers: Iterable[Number]) -> list[str]:
    """Return a table of results, and what they depend on."""
    numbers = list(numbers)
    head = ["", "value", "90 % interval", "unit", ""]
    if not any(number.interval for number in numbers):
        head[2] = ""
    names: dict[str, list[str]] = {}
    rows = [head]
    for number in numbers:
        note = f" ({number.note})" if number.note else ""
        meaning = number.meaning + note
        rows.append([number.name, number.text, number.interval, number.unit, meaning])
        names.setdefault(number.drivers, []).append(number.name)
    names.pop("", None)
    depends = [
        line
        for drivers, members in names.items()
        for line in paragraph(f"{' '.join(members)}: {drivers}", "DEPENDS", LABEL)
    ]
    return [*table(rows, left=(0, 3, 4)), *([""] if depends else []), *depends]


def _check_lines(answer: Answer) -> list[str]:
    """Return the table of values known with tolerances, beside the others."""
    rows = [["CHECKED", "given", "adjusted", "by the others", "unit", "residual"]]
    for check in answer.checks:
        residual = f"{check.residual}{' !' if check.is_odd else ''}"
        columns = (check.name, check.measured, check.adjusted, check.by_others, check.unit)
        rows.append([*columns, residual])
    return table(rows, left=(0, 4))
