"""Run the restored listing itself in the Applesoft emulator, as an independent check of the port.

The scene's lines are retyped into the listing and the velocities typed at its prompts. The result
has the form of `run.run`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ..emulator.emulator import Applesoft
from ..files import packaged_text
from ..scene import Scene
from .run import Run

LISTING = "impact.bas"
SLOT_LINE = 190
ZERO_DETERMINANT_LINE = 1160

AfterLine = Callable[[int, "Emulated"], object]


class Emulated:
    """The listing in a machine, with a scene's lines typed in.

    ``text`` is the program, the restored listing unless given. `reals` and `A` are the machine's
    variables at any moment, in the form of `run.Run`.
    """

    def __init__(
        self, scene: Mapping[str, str], *, dos: bool = True, slot: int = 0, text: str | None = None
    ) -> None:
        scene = scene if isinstance(scene, Scene) else Scene.from_mapping(scene)
        scene.check_typed()
        # the port's printouts hold what the machine sends, not the columns it skips
        self.machine = Applesoft(dos=dos, blanks=False)
        self.machine.load(text or packaged_text("impact88.legacy", LISTING))
        for line in scene.typed_lines():
            self.machine.enter(line)
        if slot:
            self.machine.enter(f'{SLOT_LINE} P$ = "PR# " + "{slot}"')
        self.machine.feed(*scene.keyboard())

    @property
    def reals(self) -> dict[str, str]:
        """Real variables by name: stored bytes in hexadecimal."""
        return self.machine.reals()

    @property
    def A(self) -> dict[str, Any] | None:
        """The array A: sizes, and data with the first subscript fastest."""
        return self.machine.array("A")

    def run(self, after_line: AfterLine | None = None) -> Run:
        """RUN; with ``after_line``, stop each time the program leaves a line.

        Raises `console.EndOfInput` if a changed program asks for more than a scene holds.
        """
        machine = self.machine
        inner = machine.machine
        inner.after_line = (lambda line: after_line(line, self)) if after_line else None
        try:
            machine.run()
        finally:
            inner.after_line = None
        return finished(machine, inner.last_line == ZERO_DETERMINANT_LINE)


def finished(machine: Applesoft, zero_determinant: bool = False) -> Run:
    """What a program's run left in a machine; ``zero_determinant``: whether that is how it ended,
    unless by an error."""
    error = machine.machine.error
    return Run(
        machine.take_output(),
        error.message if error else None,
        error.line if error else None,
        machine.reals(),
        machine.array("A"),
        error is None and zero_determinant,
    )


def run(
    scene: Mapping[str, str],
    *,
    dos: bool = True,
    slot: int = 0,
    after_line: AfterLine | None = None,
) -> Run:
    """Run the listing on a scene in the emulator, and keep everything."""
    return Emulated(scene, dos=dos, slot=slot).run(after_line)
