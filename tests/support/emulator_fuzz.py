"""Random bytes, random tokens and random edits of programs, for the emulator to survive.

    python tests/support/emulator_fuzz.py 100000 [seed]

Every case must end in output or an Applesoft error: never another exception, and never more memory
than 48K of Applesoft can hold.
"""

from __future__ import annotations

import random
import sys
from contextlib import suppress
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import captures

from impact88.apple.applesoft.console import EndOfInput
from impact88.apple.emulator.emulator import Applesoft
from impact88.apple.emulator.faults import TooManyStatements
from impact88.apple.emulator.tokens import FIRST, KEYWORDS

STATEMENTS = 400
NAMES = ("A", "B", "I", "N%", "A$", "B$", "A(1)", "A$(2)", "N%(I)", "FN A(I)", "X1")
NUMBERS = ("0", "1", "-1", "2.5", "1E38", "1E-38", "32768", "65535", "255", ".", "1E5", "12E", "3")
PUNCTUATION = ("(", ")", ",", ";", ":", '"', "=", "$", "%", "#", "?", " ", "\x04", "\x07")
LINES = ("10", "20", "30", "99", "63999", "64000", "5E3")
SHAPES = (
    "FOR I={n} TO {n} STEP {n}:PRINT I:NEXT",
    "DIM A({n},{n}),B$({n})",
    "DEF FN A({v})={n}+{v}:PRINT FN A({n})",
    "ONERR GOTO {l}",
    "GOSUB {l}:PRINT {v}",
    "IF {v}={n} THEN {l}",
    "ON {v} GOTO {l},{l}:ON {n} GOSUB {l}",
    "A$=A$+B$+MID$(A$,{n},{n})+CHR$({n}):PRINT LEN(A$)",
    'READ {v},{v}:DATA {n},{v},"{v}',
    'INPUT "{v}";{v},{v}',
    "GET {v}:PRINT {v}",
    "POKE {n},{n}:PRINT PEEK({n})",
    "PRINT TAB({n});SPC({n});{v},{n};POS({n})",
    "HTAB {n}:VTAB {n}:HOME",
    "RESUME",
    "RETURN",
    "POP",
    "NEXT {v}",
    "HIMEM:{n}:LOMEM:{n}",
    "CALL {n}",
    "LIST {l}-{l}",
    "DEL {l},{l}",
    "RUN {l}",
    "TRACE:NOTRACE",
    "STOP",
    "CONT",
    "CLEAR",
    "WAIT {n},{n}",
    "PRINT {v}{o}{n}{o}{v}",
    "{v}={v}{o}({n}{o}{v})",
)
OPERATORS = ("+", "-", "*", "/", "^", " AND ", " OR ", "<", ">", "=", "<>", ">=", "=<")


class Cases:
    """Programs from a seed."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        folder = captures.folder() / "programs"
        self.programs = [path.read_text("latin-1") for path in sorted(folder.glob("*.bas"))]

    def word(self) -> str:
        """A keyword or something between keywords."""
        pick = self.random.choice
        return pick(pick((KEYWORDS, KEYWORDS, NAMES, NUMBERS, PUNCTUATION, LINES)))

    def shaped(self) -> str:
        """A statement of a known shape with random parts."""
        pick = self.random.choice
        text = pick(SHAPES)
        for mark, words in (("{n}", NUMBERS), ("{v}", NAMES), ("{l}", LINES), ("{o}", OPERATORS)):
            while mark in text:
                text = text.replace(mark, pick(words), 1)
        return text

    def line(self) -> str:
        """Statements for one line."""
        kind = self.random.randrange(4)
        if kind == 0:
            return "".join(self.word() for _ in range(self.random.randrange(12)))
        if kind == 1:
            return "".join(
                chr(self.random.randrange(256)) for _ in range(self.random.randrange(40))
            )
        return ":".join(self.shaped() for _ in range(self.random.randrange(1, 4)))

    def edited(self) -> list[str]:
        """A captured program with characters changed, taken out or put in."""
        text = list(self.random.choice(self.programs))
        for _ in range(self.random.randrange(1, 6)):
            at = self.random.randrange(len(text) + 1)
            match self.random.randrange(3):
                case 0:
                    text[at : at + 1] = self.word()
                case 1:
                    del text[at : at + self.random.randrange(1, 4)]
                case 2:
                    text[at:at] = chr(self.random.randrange(32, 127))
        return "".join(text).split("\n")

    def case(self) -> tuple[list[str], list[str], list[bytes]]:
        """Lines to type, lines for the keyboard, and tokens to put into the program raw."""
        if self.random.random() < 0.4:
            lines = self.edited()
        else:
            numbers = [str(10 * n) for n in range(1, self.random.randrange(2, 8))]
            lines = [f"{number} {self.line()}" for number in numbers]
            lines += [self.line() for _ in range(self.random.randrange(2))]
        raw = []
        if self.random.random() < 0.2:
            some = [*range(32, 96), *range(FIRST, 256)]
            raw = [bytes(self.random.choices(some, k=20)) for _ in range(2)]
        keys = [self.word() for _ in range(self.random.randrange(4))]
        return [*lines, "RUN", *(self.line() for _ in range(2)), "CONT", "LIST"], keys, raw


def survive(case: tuple[list[str], list[str], list[bytes]]) -> set[str]:
    """Type a case in and let it run; the kinds of errors it ended lines in."""
    lines, keys, raw = case
    machine = Applesoft()
    kinds: set[str] = set()
    for number, tokens in enumerate(raw, 15):
        machine.machine.store_line(number, tokens)
    for line in lines:
        machine.machine.statements_left = STATEMENTS
        machine.feed(*keys)
        with suppress(EndOfInput, TooManyStatements):
            error = machine.type_line(line)
            kinds.add(error.kind if error else "")
        machine.take_output()
    assert machine.machine.strend <= 49152
    machine.screen_text()
    machine.source()
    return kinds


def main() -> None:
    """Run as many cases as asked for, naming the first that fails."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    cases = Cases(seed)
    for n in range(count):
        case = cases.case()
        try:
            survive(case)
        except BaseException:
            print(f"case {n} of seed {seed}:", *case, sep="\n")
            raise
    print(f"{count} cases of seed {seed}: only Applesoft errors and output")


if __name__ == "__main__":
    main()
