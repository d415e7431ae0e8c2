"""A comparison in words, as JSON and as a JUnit report."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

if TYPE_CHECKING:
    from .types import Cause, Comparison, Disagreement


def cause_sentences(cause: "Cause") -> list[str]:
    """Return a cause's sentence, and those of other mistakes with the same numbers."""
    where = f" {cause.where}" if cause.where else ""
    lines = [f"{cause.edit}{where}", *([f"  with {cause.names}"] if cause.names else [])]
    lines += [f"  or: {other}" for other in cause.alternatives]
    rows = f"explains {cause.rows} of {cause.of} rows that disagree in {', '.join(cause.results)}"
    if cause.unexplained:
        rows += f"; {cause.unexplained} remain unexplained (row {_first(cause.unexplained_rows)})"
    return [*lines, f"  {rows}"]


def _first(items: Sequence[Any]) -> str:
    """Return the first of some items."""
    return ", ".join(map(str, items[:5])) + ", ..." * (len(items) > 5)


def disagreement_line(item: "Disagreement") -> str:
    """Return how a result disagrees."""
    where = f" {item.where}" if item.where else ""
    return (
        f"{item.result:<5}{item.rows:>9} of {item.compared} rows{where}; most in row {item.row}: "
        f"{item.theirs[:30]}, should be {item.ours:.12g} (relative difference {item.relative:.2g})"
    )


def as_text(comparison: "Comparison") -> str:
    """Return a comparison as lines of text."""
    verdict = "PASSED" if comparison.passed else "NOT PASSED"
    silent = comparison.rows - comparison.agreeing - comparison.differing
    lines = [
        f"{verdict}: rows {comparison.rows}, agreeing {comparison.agreeing}, "
        f"disagreeing {comparison.differing}, without numbers to compare {silent}"
    ]
    lines += [f"results compared: {' '.join(comparison.results)}", *comparison.notes]
    if comparison.differing:
        lines += ["", "Likely cause"] if comparison.causes else []
        for cause in comparison.causes:
            lines += [f"  {line}" for line in cause_sentences(cause)]
        results = (f"  {disagreement_line(item)}" for item in comparison.disagreements)
        lines += ["", "Results that disagree", *results]
    for reason, ids in comparison.kit.get("failed", {}).items():
        lines.append(f"{reason}: {len(ids)} of the vectors ({_first(ids)})")
    if kit := comparison.kit:
        lines.append(
            f"kit {kit['id']}: {kit['passed']} of {kit['vectors']} vectors pass; "
            f"{comparison.agreeing} agree, the others have no number to compare or fail"
        )
    return "\n".join(lines)


def as_json(comparison: "Comparison") -> dict[str, Any]:
    """Return a comparison as JSON types."""
    fields = asdict(comparison)
    for entry, cause in zip(fields["causes"], comparison.causes, strict=True):
        entry["unexplained"] = cause.unexplained
    return fields


def as_junit(comparison: "Comparison", name: str) -> str:
    """Return a JUnit report: a test for the rows that agree, and one for each that fails."""
    causes = "; ".join(f"{c.edit} {c.where}".strip() for c in comparison.causes)
    rows = () if comparison.kit else comparison.differing_rows
    failures = {f"row {row}": causes or "a result disagrees" for row in rows}
    for reason, ids in comparison.kit.get("failed", {}).items():
        failures |= {f"vector {label}": reason for label in ids}
    if not comparison.passed and not failures:
        failures["table"] = "; ".join(comparison.notes) or "nothing could be compared"
    cases = [f"<testcase name={quoteattr(f'rows that agree: {comparison.agreeing}')}/>"]
    cases += [
        f"<testcase name={quoteattr(title)}><failure message={quoteattr(says)}/></testcase>"
        for title, says in failures.items()
    ]
    head = f"<testsuite name={quoteattr(name)} tests='{len(cases)}' failures='{len(failures)}'>"
    return "\n".join(['<?xml version="1.0" encoding="utf-8"?>', head, *cases, "</testsuite>", ""])
