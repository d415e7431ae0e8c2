"""The listing in the emulator, and an office's own copy of it.

A scene's values replace those of a copy: numbers assigned to the scene's variables, items of DATA
that READ assigns to them, replies to INPUT. Many scenes are run by the copy's compiled steps
(`compiler`); what these do not have, and single scenes, by the emulator.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from hashlib import sha256
from itertools import chain
from typing import Any, NamedTuple

from .. import files
from ..apple.applesoft.console import EndOfInput
from ..apple.emulator.emulator import Applesoft
from ..apple.emulator.faults import TooManyStatements
from ..apple.emulator.programfile import Line, read_program
from ..apple.emulator.tokens import detokenise, tokenise
from ..errors import UserError
from ..names import DEFAULT_M, SCENE
from .compiler import (
    NotCompiled,
    Steps,
    Token,
    compile_program,
    key_of,
    spell,
    split_statements,
    typed_constant,
)
from .run import Run
from .scene import LISTING, Scene

MAX_COPY_BYTES = 100_000  # the listing has 4,700
MAX_STATEMENTS = 100_000  # of one run; the listing takes 3,900, elimination included
ANGLES = ("PA", "PB", "TA", "TB", "GA")
"""The values that line 650 prints below a common heading."""
_LABEL = re.compile(r"([A-Z]+)\s*[=:]?\s*$")
_OTHER_SLOT = re.compile(r"PR# *(?![ 01])")
"""A command that sends output elsewhere than to screen or printer, or may."""


def load_machine(
    scene: Mapping[str, str], *, dos: bool = True, slot: int = 0, text: str | None = None
) -> Applesoft:
    """Return an emulator with the restored listing, or ``text``, a scene's lines typed in and its
    replies queued."""
    scene = scene if isinstance(scene, Scene) else Scene(scene)
    scene.check_typed()
    # like the port's printouts: characters sent, without blanks for skipped columns
    machine = Applesoft(dos=dos, blanks=False)
    machine.load(text or files.packaged_text("impact88.legacy", LISTING))
    for line in scene.typed_lines():
        machine.type_line(line)
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


def run_emulated(scene: Mapping[str, str], *, dos: bool = True, slot: int = 0) -> Run:
    """Run the listing on a scene in the emulator and return the record."""
    return run_machine(load_machine(scene, dos=dos, slot=slot))


class ChangedLine(NamedTuple):
    """A line that differs from the restored listing; a text is empty if the line is missing."""

    line: int
    copy: str
    restored: str


class ListingCopy:
    """A copy of the listing from a file.

    Parameters
    ----------
    path : str
        The file: a program as typed, as printed by LIST, or tokenised.

    Attributes
    ----------
    file : str
        Its name.
    sha256 : str
        The digest of its bytes.

    Raises
    ------
    UserError
        For a file that is not an Applesoft program.
    """

    def __init__(self, path: str) -> None:
        data = files.read_bytes(path, MAX_COPY_BYTES)
        self.file, self.sha256 = files.display_name(path), sha256(data).hexdigest()
        try:
            lines = read_program(data).lines
        except UserError as error:
            raise UserError(f"is not an Applesoft program: {error}", path) from None
        self._lines: list[Line] = sorted(dict(lines).items())
        if not self._lines:
            raise UserError("holds no program; expected numbered lines of Applesoft", path)
        self._statements = [
            statement for _, tokens in self._lines for statement in split_statements(spell(tokens))
        ]
        self._variables = _find_variables(self._statements)
        self._names = {key: name for name, key in self._variables.items()}

    def check_variables(self) -> None:
        """Check that a scene's values can be typed into the copy.

        Raises
        ------
        UserError
            Unless each value of a scene has a variable, and each variable of INPUT a value.
        """
        if names := [name for name in SCENE if name not in self._variables and name != "M"]:
            raise UserError(
                f"{', '.join(names)}: no variable of the copy is given a number and printed under "
                "this label; expected the listing's names, or its labels",
                self.file,
            )
        inputs = dict.fromkeys(chain.from_iterable(self._lists("INPUT")))
        if names := [key for key in inputs if key not in self._names and key[-1] != "$"]:
            raise UserError(
                f"asks for {', '.join(names)} (INPUT), of which nothing is printed under a label "
                "of the listing's; expected a copy that asks for a scene's values alone",
                self.file,
            )

    def changed_lines(self) -> list[ChangedLine]:
        """Return the lines that differ from the restored listing by more than remarks.

        Returns
        -------
        list of ChangedLine
            Number, and the text in both.
        """
        originals = dict(read_program(files.packaged_text("impact88.legacy", LISTING)).lines)
        copies = dict(self._lines)
        numbers = sorted({*copies, *originals})
        pairs = ((n, copies.get(n, b""), originals.get(n, b"")) for n in numbers)
        return [
            ChangedLine(number, detokenise(copy), detokenise(original))
            for number, copy, original in pairs
            if _without_remarks(copy) != _without_remarks(original)
        ]

    def run(self, scene: Mapping[str, str], *, dos: bool = True) -> Run:
        """RUN the copy in the emulator with a scene's values.

        Parameters
        ----------
        scene : mapping of str to str
            The values as typed.
        dos : bool, default True
            True if a disk system handles lines that begin with control-D.

        Returns
        -------
        Run
            The record of the run.

        Raises
        ------
        UserError
            If the copy asks for more input than the scene has, or does not end.
        """
        if "M" not in self._variables and scene.get("M", DEFAULT_M) != DEFAULT_M:
            raise UserError(
                "no variable of the copy holds M; expected a scene with M = 6", self.file
            )
        machine = Applesoft(dos=dos, blanks=False)
        machine.machine.load(self._lines_with(scene))
        for keys in self._lists("INPUT"):
            machine.feed(",".join(scene.get(self._names.get(key, ""), "0") for key in keys))
        machine.machine.statements_left = MAX_STATEMENTS
        try:
            return run_machine(machine)
        except EndOfInput:
            raise UserError("asks for more than a scene holds", self.file) from None
        except TooManyStatements:
            raise self.endless() from None

    def endless(self) -> UserError:
        """Return the error of a copy that does not end."""
        return UserError(f"does not end within {MAX_STATEMENTS:,} statements", self.file)

    def pages(self, columns: Mapping[str, Any]) -> list[str]:
        """Return what the copy prints for many scenes.

        Parameters
        ----------
        columns : mapping of str to str, int, or sequence of them
            Values as `replay` takes them.

        Returns
        -------
        list of str
            All that each scene prints, error messages included, as `Run.printout`.

        Raises
        ------
        UserError
            For columns that cannot be used, and as `run`.
        """
        from . import kernel, replay  # numpy is needed for many scenes only

        cells = replay.read_columns(columns)
        program = kernel.Program(self.steps, list(self._variables)) if self.steps else None
        size = len(self.steps.variables) if self.steps else 0
        results = kernel.empty_results(max(map(len, cells.values())), size, 0, 0)
        return replay.run_scenes(
            program, cells, results, lambda row, scene: self.run(scene).printout, pages=True
        )

    @cached_property
    def steps(self) -> Steps | None:
        """The compiled copy; None for one that only the emulator runs."""
        try:
            steps = compile_program(self._lines, self._variables.values())
        except NotCompiled:
            return None
        is_elsewhere = any(map(_OTHER_SLOT.search, steps.texts))
        return None if is_elsewhere or "M" not in self._variables else steps

    def _lists(self, verb: str) -> Iterator[list[str]]:
        """Yield the variables of every READ or INPUT, in program order."""
        for statement in self._statements:
            if statement[0].text == verb:
                yield [key_of(token.text) for token in statement if token.kind == "name"]

    def _lines_with(self, scene: Mapping[str, str]) -> Iterator[Line]:
        """Yield the program's lines with the values of ``scene`` in place of the copy's own."""
        read = chain.from_iterable(self._lists("READ"))
        for number, tokens in self._lines:
            text = spell(tokens)
            pieces, end = [], 0
            for statement in split_statements(text):
                start, stop, value = statement[0].start, statement[-1].stop, ""
                if statement[0].kind == "data":
                    value = " DATA " + ",".join(self._data(statement[0].text, read, scene))
                elif statement[0].text == "IF":
                    break  # what follows is done at times only: its numbers are the copy's
                elif key := typed_constant(statement, self._names):
                    start = next(token.stop for token in statement if token.text == "=")
                    value = scene.get(self._names[key], text[start:stop])
                if value:
                    pieces += [text[end:start], value.upper()]
                    end = stop
            yield number, tokenise("".join((*pieces, text[end:])))

    def _data(self, text: str, read: Iterator[str], scene: Mapping[str, str]) -> Iterator[str]:
        """Yield the items of DATA, a scene's in place of those that READ assigns to its values."""
        for item in text.removeprefix(" DATA ").split(","):
            yield scene.get(self._names.get(next(read, ""), ""), item)


def _without_remarks(tokens: bytes) -> list[str]:
    """Return the statements of a line, for comparison."""
    statements = split_statements(spell(tokens))
    return ["".join(t.text for t in s) for s in statements if s[0].kind != "remark"]


# --- the variables of a copy ---


def _find_variables(statements: Sequence[Sequence[Token]]) -> dict[str, str]:
    """Return the variable of each value of a scene, in the order of `SCENE`.

    It is given a number by the copy: a constant, READ or INPUT. It is the one printed under the
    value's label, has the listing's name, or is the only one from which the printed one is
    computed (``INPUT V:UX = V * 1.46667``)."""
    numbers: set[str] = set()
    uses: dict[str, set[str]] = {}
    for statement in map(_after_then, statements):
        names = [key_of(token.text) for token in statement if token.kind == "name"]
        first = next((k for k, token in enumerate(statement) if token.text == "="), 0)
        target = names[0] if names and first and statement[first - 1].kind == "name" else ""
        if statement[0].text in ("READ", "INPUT"):
            numbers |= {name for name in names if name[-1] != "$"}
        elif target and typed_constant(statement, [target]):
            numbers.add(target)
        elif target:
            uses.setdefault(target, set()).update(set(names[1:]) - {target})
    variables = {}
    for name, key in _printed_variables(statements).items():
        sources = _sources(key, uses, numbers)
        if key in numbers and (name not in numbers or key not in SCENE):
            variables[name] = key
        elif name in numbers:
            variables[name] = name
        elif len(sources) == 1:
            variables[name] = sources.pop()
    return variables


def _after_then(statement: Sequence[Token]) -> Sequence[Token]:
    """Return the statement that IF makes conditional; another one as it is."""
    thens = (k for k, token in enumerate(statement[:-1]) if token.text == "THEN")
    return statement[next(thens, -1) + 1 :]


def _sources(variable: str, uses: Mapping[str, set[str]], numbers: set[str]) -> set[str]:
    """Return the variables of ``numbers`` from which a variable is computed, directly or not."""
    closure = {variable}
    pending = [variable]
    while pending:
        following = uses.get(pending.pop(), set()) - closure
        closure |= following
        pending += following
    return closure & numbers


def _printed_variables(statements: Sequence[Sequence[Token]]) -> dict[str, str]:
    """Return the variable first printed under the label of each value, "" if none is."""
    variables = dict.fromkeys(SCENE, "")
    label, row = "", list[str]()
    for statement in statements:
        if statement[0].text != "PRINT":
            continue
        for k, token in enumerate(statement):
            if token.kind == "text":
                text = token.text.strip('"')
                if text.split() == [*ANGLES]:
                    row = list(ANGLES)
                elif match := _LABEL.search(text):
                    label, row = match[1], []
            elif token.kind == "name" and all(
                neighbour.kind == "text" or neighbour.text in (";", "PRINT")
                for neighbour in (statement[k - 1], *statement[k + 1 : k + 2])
            ):
                name = row.pop(0) if row else label
                if not variables.get(name, "-"):
                    variables[name] = key_of(token.text)
                label = ""
    return variables
