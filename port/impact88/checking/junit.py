"""A comparison as a JUnit report, the form that systems for continuous integration read."""

from xml.etree import ElementTree

from ..files import replacing
from .compare import HARMLESS, Comparison


def write_junit(path: str, name: str, comparison: Comparison, strict: bool) -> None:
    """Write a report: a failing test for every row that disagrees, one test for those that agree,
    one for each reason why rows were not compared (failing with ``strict``). Raises UserError when
    the place cannot be written to."""
    suite = ElementTree.Element("testsuite", name=f"impact88 compare {name}")
    _case(suite, f"{comparison.agreeing} of {comparison.rows} rows agree")
    for row in comparison.differences:
        place = f"row {row.row}" + (f", id {row.id}" if row.id else "")
        said = f"{row.result} {row.theirs}, here {row.ours:.12g}, off by {row.relative:.2g}"
        _case(suite, place, "failure", f"{said}; {row.cause}")
    for bad in comparison.bad:
        _case(suite, f"row {bad.row}", "error", str(bad))
    for said in comparison.silent:
        _case(suite, said, "failure" if strict else "skipped", said)
    for reason in HARMLESS:
        if reason in comparison.not_compared:
            skipped = comparison.not_compared[reason]
            _case(suite, f"{skipped.rows} rows: {reason}", "skipped", reason)
    suite.set("tests", str(len(suite)))
    for count, outcome in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(count, str(len(suite.findall(f"testcase/{outcome}"))))
    tree = ElementTree.ElementTree(suite)
    ElementTree.indent(tree)
    with replacing(path, "wb") as file:
        tree.write(file, "utf-8", xml_declaration=True)


def _case(suite: ElementTree.Element, name: str, outcome: str = "", message: str = "") -> None:
    case = ElementTree.SubElement(suite, "testcase", classname="impact88.compare", name=name)
    if outcome:
        ElementTree.SubElement(case, outcome, message=message)
