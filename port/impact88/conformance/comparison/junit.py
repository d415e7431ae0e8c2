"""Write reports in JUnit's XML, which continuous integration systems read."""

from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple
from xml.etree import ElementTree

from ...errors import printable
from ...files import replacing

OUTCOMES = {"failures": "failure", "errors": "error", "skipped": "skipped"}


class Test(NamedTuple):
    """A test of a suite. ``outcome``: failure, error or skipped, "" where it passes."""

    name: str
    outcome: str = ""
    message: str = ""
    kind: str = "impact88.compare"


def write(path: str, name: str, tests: Iterable[Test], **properties: str) -> None:
    """Write a suite's report. Raises UserError when the place cannot be written to."""
    root = ElementTree.Element("testsuite", name=printable(name))
    if properties:
        parent = ElementTree.SubElement(root, "properties")
        for key, value in properties.items():
            ElementTree.SubElement(parent, "property", name=key, value=printable(value))
    counts: Counter[str] = Counter()
    for test in tests:
        title = printable(test.name)
        case = ElementTree.SubElement(root, "testcase", classname=test.kind, name=title)
        counts.update(["tests", test.outcome])
        if test.outcome:
            ElementTree.SubElement(case, test.outcome, message=printable(test.message))
    root.set("tests", str(counts["tests"]))
    for count, outcome in OUTCOMES.items():
        root.set(count, str(counts[outcome]))
    ElementTree.indent(root)
    with replacing(path, "wb") as file:
        ElementTree.ElementTree(root).write(file, "utf-8", xml_declaration=True)
