"""Run the restored listing, or an office's own copy of it, in the Applesoft emulator.

In a copy, which may have been changed, the values of a scene go where it gets them itself: numbers
assigned to the scene's variables, items of DATA that READ gives them, replies to INPUT.
"""

import re
from collections.abc import Iterator, Mapping
from hashlib import sha256
from itertools import chain
from typing import NamedTuple

from .. import files
from ..applesoft.console import EndOfInput
from ..applesoft.errorcodes import ApplesoftError
from ..emulator.emulator import Applesoft
from ..emulator.faults import TooManyStatements
from ..errors import UserError
from .copyvariables import find_variables, key_of
from .run import Run
from .scene import Scene

LISTING = "impact.bas"


def load_machine(
    scene: Mapping[str, str], *, dos: bool = True, slot: int = 0, text: str | None = None
) -> Applesoft:
    """The restored listing, or ``text``, in a machine, with a scene's lines typed in, and its
    replies to come."""
    scene = scene if isinstance(scene, Scene) else Scene.from_mapping(scene)
    scene.check_typed()
    # the port's printouts hold what the machine sends, not the columns it skips
    machine = Applesoft(dos=dos, blanks=False)
    machine.load(text or files.packaged_text("impact88.legacy", LISTING))
    for line in scene.typed_lines():
        machine.enter(line)
    if slot:
        machine.enter(f'190 P$ = "PR# " + "{slot}"')
    machine.feed(*scene.keyboard())
    return machine


def run_machine(machine: Applesoft) -> Run:
    """RUN, and what it left. Raises `console.EndOfInput` if a changed program asks for more than a
    scene holds."""
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
    """Run the listing on a scene in the emulator, and keep everything."""
    return run_machine(load_machine(scene, dos=dos, slot=slot))


LARGEST_COPY = 100_000
"""Bytes; the listing has 4,700."""
STATEMENTS = 100_000
"""Statements a run takes at most; the listing's takes 3,900, Todd's elimination included."""

_STATEMENT = re.compile(r'\s*REM.*|(?:"[^"]*"?|[^":])*', re.I | re.S)
"""A remark is one statement, whatever stands in it."""
_CONSTANT = r"[-+*/^(). 0-9]+(?:E\s*[-+]?\s*[0-9]+)?"
_ASSIGNED = re.compile(
    rf"(?P<before>\s*(?:LET\s*)?(?P<name>[A-Z][A-Z0-9]*)\s*=\s*){_CONSTANT}\s*", re.I
)
_LIST = re.compile(r"\s*(?P<verb>READ|INPUT|DATA)\b\s*(?:\"[^\"]*\"\s*;)?\s*(?P<items>.*)", re.I)


class ChangedLine(NamedTuple):
    """A line that is not the restored listing's; either text may be empty."""

    line: int
    copy: str
    restored: str


class ListingCopy:
    """A copy of the listing from a file. ``file``: its name; ``sha256``: of its bytes.

    Raises UserError for a file that is not an Applesoft program."""

    def __init__(self, path: str) -> None:
        data = files.read_bytes(path, LARGEST_COPY)
        self.file, self.sha256 = files.called(path), sha256(data).hexdigest()
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
        """Raise UserError where it is not plain which of the copy's variables takes a value of a
        scene, or which value a variable that it asks for takes."""
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
        """The lines in which the copy is another program than the restored listing; remarks and
        blanks apart."""
        both = self._lines, _list_program(files.packaged_text("impact88.legacy", LISTING))
        changed = []
        for number in sorted({*both[0], *both[1]}):
            copy, restored = (lines.get(number, []) for lines in both)
            if _plain(copy) != _plain(restored):
                changed.append(ChangedLine(number, ":".join(copy), ":".join(restored)))
        return changed

    def run(self, scene: Mapping[str, str], *, dos: bool = True) -> Run:
        """RUN of the copy with a scene's values. Raises UserError where it asks for other input
        than the scene's, or does not end."""
        machine = Applesoft(dos=dos, blanks=False)
        machine.load("\n".join(self._with(scene)))
        for names in self._lists("INPUT"):
            values = (self._values.get(key_of(name), "") for name in names)
            machine.feed(",".join(scene.get(value, "0") for value in values))
        machine.machine.statements_left = STATEMENTS
        try:
            return run_machine(machine)
        except EndOfInput:
            raise UserError("asks for more than a scene holds", self.file) from None
        except TooManyStatements:
            raise UserError(f"does not end within {STATEMENTS:,} statements", self.file) from None

    def _lists(self, verb: str) -> Iterator[list[str]]:
        """The items of every READ or INPUT, in the order of the lines."""
        for statement in chain.from_iterable(self._lines.values()):
            if items := _items(statement, verb):
                yield items

    def _with(self, scene: Mapping[str, str]) -> Iterator[str]:
        names = chain.from_iterable(self._lists("READ"))

        def given(statement: str) -> str:
            if items := _items(statement, "DATA"):
                read = [(item, self._values.get(key_of(next(names, "")))) for item in items]
                return " DATA " + ",".join(scene[n] if n else item for item, n in read)
            match = _ASSIGNED.fullmatch(statement)
            if match and (value := self._values.get(key_of(match["name"]))):
                return match["before"] + scene[value]
            return statement

        for number, statements in self._lines.items():
            yield f"{number} {':'.join(map(given, statements))}"


def _items(statement: str, verb: str) -> list[str]:
    match = _LIST.fullmatch(statement)
    found = match and match["verb"].upper() == verb
    return [item.strip() for item in match["items"].split(",")] if match and found else []


def _list_program(program: str | bytes) -> dict[int, list[str]]:
    """The statements of a program by line, as LIST shows them."""
    machine = Applesoft()
    machine.load(program)
    pairs = (line.strip().partition(" ") for line in machine.source().splitlines())
    return {int(number): list(_statements(rest)) for number, _, rest in pairs}


def _statements(text: str) -> Iterator[str]:
    place = 0
    while place <= len(text) and (match := _STATEMENT.match(text, place)):
        yield match[0]
        place = match.end() + 1


def _plain(statements: list[str]) -> str:
    """A line without blanks and remarks."""
    kept = (text for text in statements if not text.lstrip().upper().startswith("REM"))
    return ":".join("".join(statement.split()) for statement in kept)
