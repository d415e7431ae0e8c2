"""Run the restored listing, or an office's own copy of it, in the Applesoft emulator.

In a copy, which may have been changed, a scene's values replace the copy's own: numbers assigned to
the scene's variables, items of DATA that READ assigns to them, replies to INPUT.
"""

import re
from collections.abc import Iterator, Mapping
from hashlib import sha256
from itertools import chain
from typing import NamedTuple

from .. import files
from ..apple.applesoft.console import EndOfInput
from ..apple.applesoft.errorcodes import ApplesoftError
from ..apple.emulator.emulator import Applesoft
from ..apple.emulator.faults import TooManyStatements
from ..errors import UserError
from .copyvariables import find_variables, key_of
from .run import Run
from .scene import Scene

LISTING = "impact.bas"


def load_machine(
    scene: Mapping[str, str], *, dos: bool = True, slot: int = 0, text: str | None = None
) -> Applesoft:
    """Return a machine with the restored listing, or ``text``, a scene's lines typed in and its
    replies queued."""
    scene = scene if isinstance(scene, Scene) else Scene.from_mapping(scene)
    scene.check_typed()
    # like the port's printouts: characters sent, without blanks for skipped columns
    machine = Applesoft(dos=dos, blanks=False)
    machine.load(text or files.packaged_text("impact88.legacy", LISTING))
    for line in scene.typed_lines():
        machine.enter(line)
    if slot:
        machine.enter(f'190 P$ = "PR# " + "{slot}"')
    machine.feed(*scene.keyboard())
    return machine


def run_machine(machine: Applesoft) -> Run:
    """RUN the program and return the record. Raises `console.EndOfInput` if a changed program asks
    for more input than a scene has."""
    machine.run()
    printout, error = machine.take_output(), machine.machine.error
    return Run(
        printout,
        error.message if error else None,
        error.line if error else None,
        machine.reals(),
        machine.array("A"),
        error is None and "ZERO DETERMINANT" in printout,
    )


def run(scene: Mapping[str, str], *, dos: bool = True, slot: int = 0) -> Run:
    """Run the listing on a scene in the emulator and return the record."""
    return run_machine(load_machine(scene, dos=dos, slot=slot))


MAX_COPY_BYTES = 100_000  # the listing has 4,700
MAX_STATEMENTS = 100_000  # of one run; the listing takes 3,900, elimination included

_STATEMENT = re.compile(r'\s*REM.*|(?:"[^"]*"?|[^":])*', re.I | re.S)
"""A statement up to the next colon; a remark goes to the end of the line."""
_CONSTANT = r"[-+*/^(). 0-9]+(?:E\s*[-+]?\s*[0-9]+)?"
_ASSIGNED = re.compile(
    rf"(?P<before>\s*(?:LET\s*)?(?P<name>[A-Z][A-Z0-9]*)\s*=\s*){_CONSTANT}\s*", re.I
)
_LIST = re.compile(r"\s*(?P<verb>READ|INPUT|DATA)\b\s*(?:\"[^\"]*\"\s*;)?\s*(?P<items>.*)", re.I)


class ChangedLine(NamedTuple):
    """A line that differs from the restored listing; a text is empty if the line is missing."""

    line: int
    copy: str
    restored: str


class ListingCopy:
    """A copy of the listing from a file. ``file``: its name; ``sha256``: the digest of its bytes.

    Raises UserError for a file that is not an Applesoft program."""

    def __init__(self, path: str) -> None:
        data = files.read_bytes(path, MAX_COPY_BYTES)
        self.file, self.sha256 = files.display_name(path), sha256(data).hexdigest()
        try:
            self._lines = _list_program(data)
        except (ValueError, ApplesoftError) as error:
            raise UserError(f"is not an Applesoft program: {error}", path) from None
        if not self._lines:
            raise UserError("holds no program; expected numbered lines of Applesoft", path)
        restored = _list_program(files.packaged_text("impact88.legacy", LISTING))
        self._variables = find_variables(self._lines, restored)
        self._values = {key: name for name, key in self._variables.of_value.items()}

    def check_variables(self) -> None:
        """Raise UserError unless each value of a scene has a variable, and each variable of INPUT a
        value."""
        if names := self._variables.missing:
            raise UserError(
                f"{', '.join(names)}: no variable of the copy is given a number and printed under "
                "this label; expected the listing's names, or its labels",
                self.file,
            )
        if names := self._variables.unknown:
            raise UserError(
                f"asks for {', '.join(names)} (INPUT), of which nothing is printed under a label "
                "of the listing's; expected a copy that asks for a scene's values alone",
                self.file,
            )

    def changed_lines(self) -> list[ChangedLine]:
        """Return the lines that differ from the restored listing by more than remarks and
        blanks."""
        programs = self._lines, _list_program(files.packaged_text("impact88.legacy", LISTING))
        differences = []
        for number in sorted({*programs[0], *programs[1]}):
            copy, original = (lines.get(number, []) for lines in programs)
            if _plain(copy) != _plain(original):
                differences.append(ChangedLine(number, ":".join(copy), ":".join(original)))
        return differences

    def run(self, scene: Mapping[str, str], *, dos: bool = True) -> Run:
        """RUN the copy with a scene's values. Raises UserError if it asks for more input than the
        scene has, or does not end."""
        machine = Applesoft(dos=dos, blanks=False)
        machine.load("\n".join(self._lines_with(scene)))
        for names in self._lists("INPUT"):
            values = (self._values.get(key_of(name), "") for name in names)
            machine.feed(",".join(scene.get(value, "0") for value in values))
        machine.machine.statements_left = MAX_STATEMENTS
        try:
            return run_machine(machine)
        except EndOfInput:
            raise UserError("asks for more than a scene holds", self.file) from None
        except TooManyStatements:
            raise UserError(
                f"does not end within {MAX_STATEMENTS:,} statements", self.file
            ) from None

    def _lists(self, verb: str) -> Iterator[list[str]]:
        """Yield the items of every READ or INPUT, in program order."""
        for statement in chain.from_iterable(self._lines.values()):
            if items := _items(statement, verb):
                yield items

    def _lines_with(self, scene: Mapping[str, str]) -> Iterator[str]:
        """Yield the program's lines with the values of ``scene`` in place of the copy's own."""
        names = chain.from_iterable(self._lists("READ"))

        def substitute(statement: str) -> str:
            if items := _items(statement, "DATA"):
                read = [(item, self._values.get(key_of(next(names, "")))) for item in items]
                return " DATA " + ",".join(scene[n] if n else item for item, n in read)
            match = _ASSIGNED.fullmatch(statement)
            if match and (value := self._values.get(key_of(match["name"]))):
                return match["before"] + scene[value]
            return statement

        for number, statements in self._lines.items():
            yield f"{number} {':'.join(map(substitute, statements))}"


def _items(statement: str, verb: str) -> list[str]:
    """Return the items of a READ, INPUT or DATA statement; none of another."""
    match = _LIST.fullmatch(statement)
    if not match or match["verb"].upper() != verb:
        return []
    return [item.strip() for item in match["items"].split(",")]


def _list_program(program: str | bytes) -> dict[int, list[str]]:
    """Return the statements of a program by line, as LIST shows them."""
    machine = Applesoft()
    machine.load(program)
    pairs = (line.strip().partition(" ") for line in machine.source().splitlines())
    return {int(number): list(_statements(statements)) for number, _, statements in pairs}


def _statements(text: str) -> Iterator[str]:
    """Yield the statements of a line."""
    place = 0
    while place <= len(text) and (match := _STATEMENT.match(text, place)):
        yield match[0]
        place = match.end() + 1


def _plain(statements: list[str]) -> str:
    """Return a line without blanks and remarks, for comparison."""
    without_remarks = (text for text in statements if not text.lstrip().upper().startswith("REM"))
    return ":".join("".join(statement.split()) for statement in without_remarks)
