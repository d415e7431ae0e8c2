"""Sessions at the ROM's own prompt: the restored listing on a scene, any program, one calculation.

Everything is done with the keys a user would press: the listing and the scene's lines are typed,
its small letters POKEd into its text at the prompt, as was done in the days, RUN, and the replies.
"""

from functools import cached_property
from typing import Any, NamedTuple

from ..errors import UserError
from ..files import packaged_text
from ..program.emulated import LISTING
from ..progress import progress
from ..scene import Scene
from . import basic, routines
from .apple import Apple, Lost, State
from .packaged import LONGEST_TYPED

PROMPT = "]"
_OTHER_PROMPTS = {
    "*": "the monitor's prompt *: an older monitor, or no Applesoft in this ROM",
    ">": "the prompt > of Integer BASIC; the listing is Applesoft",
}


class Finished(NamedTuple):
    """What a run on the ROM left, in the captures' form: all that was displayed after the echo of
    RUN, the real variables, and the array A."""

    printout: str
    reals: dict[str, str]
    A: dict[str, Any] | None


class Session:
    """A switched-on Apple with a ROM. Raises UserError when the ROM does not come to a ``]``."""

    def __init__(self, rom: bytes) -> None:
        self.apple = Apple(rom)
        try:
            shown = self.apple.boot()
        except Lost as lost:
            raise UserError(f"this ROM does not come to a prompt: {lost}") from None
        last = shown.rstrip()[-1:]
        if last != PROMPT:
            what = _OTHER_PROMPTS.get(last, f"{shown[-20:]!r}, no prompt of Applesoft")
            raise UserError(f"this ROM comes to {what}")
        self._fresh = self.apple.state()

    @cached_property
    def _with_listing(self) -> State:
        self.apple.restore(self._fresh)
        program = packaged_text("impact88.legacy", LISTING)
        lines = program.splitlines()
        with progress(len(lines), "typing the listing in") as meter:
            for line in lines:
                self._enter(line)
                meter.update(1)
        for command in basic.small_letters(self.apple, program):
            self._enter(command)
        return self.apple.state()

    def run_scene(self, scene: Scene) -> Finished:
        """RUN the listing, typed once, on a scene. Raises UserError for a line too long to be typed
        and a program that does not come to an end."""
        self.apple.restore(self._with_listing)
        self.apple.blanks = False
        for line in scene.typed_lines():
            self._enter(line)
        printout = self._run("".join(f"{reply}\n" for reply in scene.keyboard()))
        return Finished(printout, basic.reals(self.apple), basic.array(self.apple, "A"))

    def run_program(self, program: str, keys: str = "", *, blanks: bool = True) -> str:
        """Type a program in, RUN, then the keys: what is displayed, without the prompts' NULs."""
        self.apple.restore(self._fresh)
        self.apple.blanks = blanks
        for line in filter(None, program.split("\n")):
            self._enter(line)
        return self._run(keys).replace("\0", "")

    def calculate(self, *call: str) -> str:
        """One call of the ROM's arithmetic, see `routines.call`."""
        self.apple.restore(self._fresh)
        return routines.call(self.apple, *call)

    def _enter(self, line: str) -> None:
        if len(line) > LONGEST_TYPED:
            raise UserError(
                f"{line[:20]}… has {len(line)} characters; {LONGEST_TYPED} can be typed on a line"
            )
        self.apple.type_keys(f"{line}\n")

    def _run(self, keys: str) -> str:
        """RUN and the keys: what is displayed after the echo of RUN up to the final prompt."""
        self.apple.take_output()
        self.apple.type_keys(f"RUN\n{keys}")
        return self.apple.take_output().partition("RUN\n")[2].removesuffix(f"\n{PROMPT}")
