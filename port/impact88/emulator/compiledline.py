"""From a line's tokens to Python functions, once for every different line.

What is compiled depends on the tokens alone (variables have the same slot in every machine), so
machines share it: loading a program that was run before costs next to nothing.
"""

from __future__ import annotations

from functools import lru_cache
from types import CodeType, FunctionType
from typing import Any, NamedTuple

from .statementcompiler import StatementCompiler

Namespace = dict[str, Any]
_LOOK_AROUND = ("PEEK", "POKE(", "CALL(")
"""Code that may ask where the program is."""


class Line(NamedTuple):
    """A compiled line.

    ``codes`` are the bodies of its steps; ``constants`` the names they use; ``traced`` and
    ``positions`` are what `linecompiler.Step` tells of each; ``starts``: the step with which its
    statement begins; ``need``: how deep the line's formulas go into the stack. ``leftovers``:
    whether a formula may ask what an earlier one left in the accumulator.
    """

    codes: tuple[CodeType, ...]
    constants: dict[str, Any]
    traced: tuple[bool, ...]
    positions: tuple[int, ...]
    starts: tuple[int, ...]
    need: int
    leftovers: bool

    def functions(self, names: Namespace) -> list[Any]:
        """The steps as functions that find the machine in ``names``."""
        names.update(self.constants)
        return [FunctionType(code, names) for code in self.codes]


@lru_cache(maxsize=8192)
def compiled(tokens: bytes, *, careful: bool = False, direct: bool = False) -> Line:
    """The compiled line; ``careful``: every step looks at the stack; ``direct``: typed without a
    line number."""
    line = StatementCompiler(tokens, careful=careful, direct=direct)
    text = []
    for number, step in enumerate(line.steps):
        text.append(f"def step{number}(pc):")
        if any(word in code for code in step.code for word in _LOOK_AROUND):
            text.append("    look(pc)")
        text += [f"    {code}" for code in step.code]
        text.append("    return pc + 1")
    try:
        code = compile("\n".join(text), "<basic>", "exec")
    except (RecursionError, MemoryError, SyntaxError):  # nested past what Python takes
        text = [f"def step{n}(pc): bad('OUT OF MEMORY')" for n in range(len(line.steps))]
        code = compile("\n".join(text), "<basic>", "exec")
    starts: list[int] = []
    for number, step in enumerate(line.steps):
        starts.append(number if step.begins else starts[-1])
    return Line(
        tuple(each for each in code.co_consts if isinstance(each, CodeType)),
        line.formulas.constants,
        tuple(step.traced for step in line.steps),
        tuple(step.position for step in line.steps),
        tuple(starts),
        max(step.need for step in line.steps),
        line.formulas.leftovers,
    )
