"""Reports in the form that systems for continuous integration read (JUnit's XML)."""

from xml.etree import ElementTree

from ..errors import printable
from ..files import replacing

OUTCOMES = (("failures", "failure"), ("errors", "error"), ("skipped", "skipped"))


class Suite:
    """Tests of one suite, written together."""

    def __init__(self, name: str) -> None:
        self._whole = ElementTree.Element("testsuite", name=printable(name))
        self._about: ElementTree.Element | None = None

    def tell(self, name: str, value: str) -> None:
        """Add a property of the whole suite."""
        if self._about is None:
            self._about = ElementTree.SubElement(self._whole, "properties")
        ElementTree.SubElement(self._about, "property", name=name, value=printable(value))

    def test(
        self, name: str, outcome: str = "", message: str = "", kind: str = "impact88.compare"
    ) -> None:
        """Add a test; ``outcome``: failure, error or skipped, "" where it passes."""
        case = ElementTree.SubElement(self._whole, "testcase", classname=kind, name=printable(name))
        if outcome:
            ElementTree.SubElement(case, outcome, message=printable(message))

    def write(self, path: str) -> None:
        """Write the report. Raises UserError when the place cannot be written to."""
        self._whole.set("tests", str(len(self._whole.findall("testcase"))))
        for count, outcome in OUTCOMES:
            self._whole.set(count, str(len(self._whole.findall(f"testcase/{outcome}"))))
        ElementTree.indent(self._whole)
        with replacing(path, "wb") as file:
            ElementTree.ElementTree(self._whole).write(file, "utf-8", xml_declaration=True)
