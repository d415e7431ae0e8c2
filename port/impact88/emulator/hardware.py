"""The machine's state: everything it consists of but what makes it run."""

from __future__ import annotations

from ..applesoft import functions
from ..applesoft.console import Console, Device, Keyboard
from ..applesoft.real import Number
from .control import Control
from .inputs import Inputs
from .onerr import Errors
from .output import Output
from .programtext import ProgramText
from .screen import Screen
from .variables import Variables

AFTER_TYPING = (0xD0, 0xD0 << 32, 0)
"""What the ROM's parser leaves in the accumulator: an address."""
SPEED = 241


class Hardware:
    """Screen, keyboard, program, variables, stack, ONERR, RAM (``ram``),
    RND's ``seed``, whether TRACE is on (``tracing``, and the byte ``trace_flag``), the ``line`` being
    executed and the address of the ``statement`` as far as a program can ask for them, and the
    number in the floating-point accumulator (``fac``, a list of one) as far as anything is left of
    it."""

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
        self.screen = Screen(screen, blanks=blanks)
        self.console = Console(keyboard, self.screen.write, printer, dos=dos, echo=echo)
        self.console.typed = self.screen.typed
        self.output = Output(self.console, self.screen)
        self.ram = bytearray(0x10000)
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
        self.seed = functions.FIRST_SEED
        self.tracing = False
        self.trace_flag = 0
        self.line = 0
        self.statement = 0
        self.fac: list[Number] = [AFTER_TYPING]
        self.ram[SPEED] = 1
