"""What the machine is made of, without what makes it run."""

from __future__ import annotations

from ..applesoft import functions
from ..applesoft.console import Console, Device, Keyboard
from .control import Control
from .inputs import Inputs
from .onerr import Errors
from .output import Output
from .programtext import ProgramText
from .screen import Screen
from .variables import Variables


class Hardware:
    """Screen, keyboard, program, variables, stack, ONERR, RAM that nothing else explains (``ram``),
    RND's ``seed``, whether TRACE is on (``tracing``), and the ``line`` being executed as far as a
    program can ask for it."""

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
        self.program = ProgramText()
        self.variables = Variables()
        self.control = Control(self.variables)
        self.errors = Errors()
        self.inputs = Inputs(
            self.program, self.console, self.variables.strings, lambda: self.errors.on
        )
        self.ram: dict[int, int] = {}
        self.seed = functions.FIRST_SEED
        self.tracing = False
        self.line = 0
