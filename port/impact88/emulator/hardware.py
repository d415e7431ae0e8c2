"""The machine's state: everything it consists of but what makes it run."""

from __future__ import annotations

from ..applesoft.console import Console, Device, Keyboard
from ..applesoft.real import from_stored
from .accumulator import Accumulator
from .control import Control
from .inputs import Inputs
from .onerr import Errors
from .output import Output
from .programtext import ProgramText
from .screen import Screen
from .variables import Variables

SPEED = 241
PAGE_ZERO = bytes.fromhex("4C3CD4 4C3ADB 000000 00 4C99E1")
"""The jumps with which switching on begins page 0: to the prompt, to print a text, and USR's."""


FIRST_SEED = from_stored("804FC75200")
"""RND's seed after switching on: of the ROM's five bytes, which end in 58, four are copied."""


class Hardware:
    """Screen, keyboard, program, variables, stack, ONERR, RAM (``ram``), RND's ``seed``.

    ``tracing``: whether TRACE is on, ``trace_flag`` its byte. ``line`` and ``statement``: the line
    being executed and the address of its statement, as far as a program can ask for them.
    ``accumulator``: what is left in the floating-point accumulator, as far as one can tell.
    """

    def __init__(
        self,
        keyboard: Keyboard,
        screen: Device,
        printer: Device | None = None,
        *,
        dos: bool = False,
        echo: bool = True,
        blanks: bool = True,
    ) -> None:
        self.ram = bytearray(0x10000)
        self.ram[: len(PAGE_ZERO)] = PAGE_ZERO
        self.ram[SPEED] = 1
        self.screen = Screen(self.ram, screen, blanks=blanks)
        self.console = Console(keyboard, self.screen.write, printer, dos=dos, echo=echo)
        self.console.editor = self.screen
        self.output = Output(self.console, self.screen)
        self.program = ProgramText(self.ram)
        self.variables = Variables(self.ram)
        self.control = Control(self.variables)
        self.errors = Errors()
        self.inputs = Inputs(
            self.program,
            self.console,
            self.output.put,
            self.variables.strings,
            lambda: self.errors.on,
        )
        self.seed = FIRST_SEED
        self.tracing = False
        self.trace_flag = 0
        self.line = 0
        self.statement = 0
        self.accumulator = Accumulator(self.variables, self.ram)
