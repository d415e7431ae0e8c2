"""Operands of compiled formulas, and the tables of operators and functions they are made with.

The 6502 stack has 192 bytes to spare; every formula takes some of them while it is worked out, and
the numbers below are the ROM's pushes and calls.
"""

from __future__ import annotations

from .tokens import TOKENS

NUMBER = "n"
TEXT = "s"
OPEN, CLOSE, COMMA, POINT = map(ord, "(),.")
PLUS, MINUS, NOT, FN = (TOKENS[word] for word in ("+", "-", "NOT", "FN"))
GREATER, EQUAL, LESS = (TOKENS[word] for word in (">", "=", "<"))
FIRST_FUNCTION = TOKENS["SGN"]
RELATION_BITS = {GREATER: 1, EQUAL: 2, LESS: 4}
RELATIONS = {1: ">", 2: "==", 3: ">=", 4: "<", 5: "!=", 6: "<="}
ALL_RELATIONS = 7
COMPARED = {1: "< 0", 2: "== 0", 3: "<= 0", 4: "> 0", 5: "!= 0", 6: ">= 0"}
"""The same by what `real.compare` says of the right operand."""
RELATIONAL = 0x64
HIGHEST = 0x7F
"""Precedence of the unary minus and of NOT, above ^."""
OPERATORS = {
    TOKENS["+"]: (0x79, "add"),
    TOKENS["-"]: (0x79, "subtract"),
    TOKENS["*"]: (0x7B, "multiply"),
    TOKENS["/"]: (0x7B, "divide"),
    TOKENS["^"]: (0x7D, "power"),
    TOKENS["AND"]: (0x50, "&"),
    TOKENS["OR"]: (0x46, "|"),
}
NUMERIC = {
    TOKENS[word]: word for word in "SGN INT ABS SQR RND LOG EXP COS SIN TAN ATN PEEK".split()
}
OF_TEXT = {TOKENS["LEN"]: "LEN", TOKENS["VAL"]: "VAL", TOKENS["ASC"]: "ASC"}
SLICES = {TOKENS["LEFT$"]: "left", TOKENS["RIGHT$"]: "right", TOKENS["MID$"]: "mid"}
USR = TOKENS["USR"]
REFUSED_FUNCTIONS = {TOKENS["PDL"]: "PDL", TOKENS["SCRN("]: "SCRN"}
"""Paddles and graphics: listed, but not done."""

PENDING = 12
PARENTHESIS = 5
STACK = 248
"""The stack pointer when nothing is on the stack."""
ROOM = 59
"""An expression needs the stack pointer to be at least here."""


class Operand:
    """Python text for a value: a triple of `real`, or a `strings.Descriptor`.

    ``rounded``: it has no extension. ``truth``: text for a bool, whether it is not zero.
    ``whole``: the number itself when it is a constant 0 ... 32767; ``huge``: it is a constant of
    more than 32 bits. ``variable``: the bare value of a string variable. ``text``: its characters
    if it stands in the program; ``tracked``: text for a string that follows the accumulator's
    extension. ``text_relation``: a relation comes next that takes this number for a string.
    ``dead``: it ends in an error.
    """

    __slots__ = (
        "code",
        "dead",
        "huge",
        "kind",
        "rounded",
        "text",
        "text_relation",
        "tracked",
        "truth",
        "variable",
        "whole",
    )

    def __init__(
        self,
        code: str,
        kind: str = NUMBER,
        *,
        rounded: bool = False,
        truth: str | None = None,
        dead: bool = False,
        variable: bool = False,
        whole: int | None = None,
        text_relation: bool = False,
        tracked: str | None = None,
        text: str | None = None,
        huge: bool = False,
    ) -> None:
        self.code = code
        self.kind = kind
        self.rounded = rounded
        self.truth = truth
        self.dead = dead
        self.variable = variable
        self.whole = whole
        self.text_relation = text_relation
        self.tracked = tracked
        self.text = text
        self.huge = huge

    @property
    def condition(self) -> str:
        """Text for whether the number is not zero."""
        return self.truth or f"({self.code}[0] != 0)"

    @property
    def stored(self) -> str:
        """Text for the value as a variable takes it."""
        return self.code if self.rounded else f"rounded({self.code})"
