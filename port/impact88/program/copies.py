"""An office's own copy of the listing.

A scene's values replace those of a copy: numbers assigned to the scene's variables, or READ from
DATA, and replies to INPUT. Many scenes are run by the copy's compiled steps (`compiler`); what
these do not have, and single scenes, by the emulator.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cached_property
from typing import Any

from .. import files
from ..apple.applesoft.console import EndOfInput
from ..apple.emulator.emulator import Applesoft
from ..apple.emulator.faults import TooManyStatements
from ..apple.emulator.programfile import read_program
from ..apple.emulator.tokens import tokenise
from ..errors import UserError
from ..names import SCENE
from .compiler import GIVEN, NotCompiled, Steps, compile_program, key_of, spell, with_values
from .run import Run

MAX_COPY_BYTES = 100_000  # the listing has 4,700
MAX_STATEMENTS = 100_000  # of one run; the listing takes 3,900, elimination included
_NAME = re.compile("(?<![0-9.])[A-Z][A-Z0-9]*")
_FORMULA = re.compile(r"(?<![^:\n])(?: LET )?([A-Z][A-Z0-9]*) = ([^:\n]*)")
_OTHER_SLOT = re.compile(r"PR# *(?![ 01])")
"""A command that sends output elsewhere than to screen or printer, or may."""


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

    Raises
    ------
    UserError
        For a file that is not an Applesoft program, one into which a scene's values cannot be
        typed, and one that asks for other values than a scene's.
    """

    def __init__(self, path: str) -> None:
        self.file = files.display_name(path)
        try:
            lines = read_program(files.read_bytes(path, MAX_COPY_BYTES))
        except UserError as error:
            raise UserError(f"is not an Applesoft program: {error}", path) from None
        self._lines = [(number, spell(tokens)) for number, tokens in sorted(dict(lines).items())]
        text = "\n".join(text for _, text in self._lines)
        numbers: set[str] = set()
        self._lists: list[tuple[str, list[str]]] = []  # READ or INPUT, and its variables
        for match in GIVEN.finditer(text):
            if names := match["name"] or match["list"]:
                keys = [key_of(name) for name in names.split(",")]
                numbers.update(keys)
                self._lists.append((match["verb"], keys))
        self._variables = _find_variables(text, numbers)
        self._names = {key: name for name, key in self._variables.items()}
        if names := [name for name in SCENE if name not in self._variables]:
            raise UserError(
                f"gives no number to {', '.join(names)}; expected the listing's variables, or "
                "formulas of one number such as UX = S * 1.46667",
                self.file,
            )
        asked = [key for verb, keys in self._lists if verb for key in keys if key[-1] != "$"]
        if names := [key for key in asked if key not in self._names]:
            raise UserError(
                f"asks for {', '.join(names)} (INPUT or READ); expected a copy that asks for a "
                "scene's values alone",
                self.file,
            )

    def run(self, scene: Mapping[str, str]) -> Run:
        """RUN the copy in the emulator with a scene's values.

        Parameters
        ----------
        scene : mapping of str to str
            The values as typed.

        Returns
        -------
        Run
            The record of the run.

        Raises
        ------
        UserError
            If the copy asks for more input than the scene has, or does not end.
        """
        values = {key: scene[name].upper() for key, name in self._names.items()}
        # like the port's printouts: characters sent, without blanks for skipped columns
        machine = Applesoft(dos=True, blanks=False)
        machine.machine.load((n, tokenise(with_values(text, values))) for n, text in self._lines)
        for verb, keys in self._lists:
            if verb == "INPUT":
                machine.feed(",".join(values.get(key, "0") for key in keys))
        machine.machine.statements_left = MAX_STATEMENTS
        try:
            return run_machine(machine)
        except EndOfInput:
            raise UserError("asks for more than a scene holds", self.file) from None
        except TooManyStatements:
            raise UserError(
                f"does not end within {MAX_STATEMENTS:,} statements", self.file
            ) from None

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
        from . import batches, kernel  # numpy is needed for many scenes only

        program = kernel.Program(self.steps, list(self._variables)) if self.steps else None
        return batches.run_scenes(
            program, columns, lambda _, scene: self.run(scene).printout, (0, 0), pages=True
        )[1]

    @cached_property
    def steps(self) -> Steps | None:
        """The compiled copy; None for one that only the emulator runs."""
        try:
            steps = compile_program(self._lines, self._variables.values())
        except NotCompiled:
            return None
        return None if any(map(_OTHER_SLOT.search, steps.texts)) else steps


def _find_variables(text: str, numbers: set[str]) -> dict[str, str]:
    """Return the variable in which a copy takes each value of a scene, in the order of `SCENE`.

    It is one of ``numbers``, to which the copy gives numbers: the listing's own, or the only one in
    its formula, as S is of UX in ``INPUT S:UX = S * 1.46667``."""
    formulas = _FORMULA.findall(text)
    variables = {}
    for name in SCENE:
        sources = {
            key_of(source)
            for target, formula in formulas
            if key_of(target) == name
            for source in _NAME.findall(re.sub(r" \S+ ", " ", formula))
        } & numbers
        if name in numbers:
            variables[name] = name
        elif len(sources) == 1:
            variables[name] = sources.pop()
    return variables
