"""An answer as text for the terminal. Numbers are those of the answer; nothing is rounded here."""

from __future__ import annotations

from collections.abc import Iterator

from ..layout import paragraph, table
from ..report.answers import Answer
from .options import Args
from .output import show

LABEL = 10  # columns of the words at the left


def show_answer(answer: Answer, args: Args) -> bool:
    """Print an answer, and return whether it is that no impact is possible."""
    show(args, "answer", answer.as_json(), answer_lines(answer))
    return not answer.possible


def answer_lines(answer: Answer) -> Iterator[str]:
    """Yield the lines of an answer: the question, what was found, how sure it is, remarks."""
    impacts = [answer, *answer.alternatives]
    for label, text in (("ASKED", answer.question), ("EVIDENCE", answer.evidence)):
        if text:
            yield from paragraph(text, label, LABEL)
    yield ""
    for number, impact in enumerate(impacts, 1):
        if len(impacts) > 1:
            yield f"IMPACT {number} OF {len(impacts)}"
        if impact.found:
            yield from table(_result_rows(impact), left=(0, 3, 4))
            yield ""
    sections = [(name.upper(), LABEL, texts) for name, texts in answer.sections.items()]
    for label, width, texts in (*sections, ("!", 2, answer.warnings), ("-", 2, answer.remarks)):
        for text in texts:
            yield from paragraph(text, label, width)


def _result_rows(answer: Answer) -> Iterator[list[str]]:
    """Yield the rows of the table of results."""
    yield ["", "value", "90 % interval" if answer.intervals else "", "unit", ""]
    for row in answer.found.values():
        note = f" ({row.note})" if row.note else ""
        yield [row.name, row.text, row.interval, row.unit, row.meaning + note]
