"""Write reports in JUnit's XML, which continuous integration systems read."""

from xml.etree import ElementTree

from ...errors import printable
from ...files import replacing

OUTCOMES = (("failures", "failure"), ("errors", "error"), ("skipped", "skipped"))


class Suite:
    """A test suite: collects tests, then writes them to one file."""

    def __init__(self, name: str) -> None:
        self._root = ElementTree.Element("testsuite", name=printable(name))
        self._properties: ElementTree.Element | None = None

    def add_property(self, name: str, value: str) -> None:
        """Add a property of the suite."""
        if self._properties is None:
            self._properties = ElementTree.SubElement(self._root, "properties")
        ElementTree.SubElement(self._properties, "property", name=name, value=printable(value))

    def test(
        self, name: str, outcome: str = "", message: str = "", kind: str = "impact88.compare"
    ) -> None:
        """Add a test; ``outcome``: failure, error or skipped, "" where it passes."""
        case = ElementTree.SubElement(self._root, "testcase", classname=kind, name=printable(name))
        if outcome:
            ElementTree.SubElement(case, outcome, message=printable(message))

    def write(self, path: str) -> None:
        """Write the report. Raises UserError when the place cannot be written to."""
        self._root.set("tests", str(len(self._root.findall("testcase"))))
        for count, outcome in OUTCOMES:
            self._root.set(count, str(len(self._root.findall(f"testcase/{outcome}"))))
        ElementTree.indent(self._root)
        with replacing(path, "wb") as file:
            ElementTree.ElementTree(self._root).write(file, "utf-8", xml_declaration=True)
