"""Compile an Applesoft program of numbers to the steps that `applesoft.c` executes.

The source is the program's own tokens, those of `impact.bas` or of an altered copy; the listing is
not restated. Each statement becomes steps of a stack machine, operands from left to right, as the
ROM evaluates them. The values of a scene, which are typed into the program's lines or at its
prompts, are read when their line is reached, so that an error in one has the line it had.

What compiles is a program of real numbers with at most one array, of two subscripts, and with texts
that are only printed. Anything else raises `NotCompiled`, and is for the emulator.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ..apple.emulator.tokens import list_text, split_number, tokenise

OPERATIONS = {
    name: (pops, pushes)
    for pops, pushes, names in (
        (0, 0, "LINE TOUCH TEXT STRING SHOW ECHO GOTO GOSUB RETURN NEXT END"),
        (0, 1, "CONSTANT VARIABLE READ TYPED"),
        (1, 0, "STORE PRINT UNLESS FOR"),
        (1, 1, "NEGATE ROUND INT ABS SGN SQR EXP LOG SIN COS TAN ATN"),
        (2, 0, "STORE_ELEMENT DIM"),
        (2, 1, "ELEMENT PLACE ADD SUBTRACT MULTIPLY DIVIDE POWER COMPARE AND OR"),
    )
    for name in names.split()
}
"""The operations by name: how many numbers each takes from the stack, and leaves there.

TOUCH makes a variable, which Applesoft does before it computes the value; PLACE and STORE_ELEMENT
frame an assignment to an element; STRING and SHOW set and print a text variable; READ takes a
reply, TYPED a value typed into a line; UNLESS jumps when the condition is 0."""
JUMPS = ("UNLESS", "GOTO", "GOSUB", "RETURN", "FOR", "NEXT", "END")
"""Operations that decide which step follows."""
CODES = {name: code for code, name in enumerate(OPERATIONS)}

MAX_DEPTH = 15  # numbers on the stack of applesoft.c
MAX_VARIABLES = 64  # bits that tell which are assigned
MAX_STRINGS = 8
MAX_TEXTS = 256  # one byte of STRING's number
FUNCTIONS = frozenset("INT ABS SGN SQR EXP LOG SIN COS TAN ATN".split())
COMPARISONS = {">": 1, "=": 2, "<": 4}
"""Bits of COMPARE's number."""
LEVELS: tuple[Mapping[str, str], ...] = (
    {"OR": "OR"},
    {"AND": "AND"},
    dict.fromkeys(COMPARISONS, "COMPARE"),
    {"+": "ADD", "-": "SUBTRACT"},
    {"*": "MULTIPLY", "/": "DIVIDE"},
    {"^": "POWER"},
)
"""Binary operators, the loosest first."""

_TOKEN = re.compile(
    r"(?P<remark> REM .*)|(?P<data> DATA [^:]*)"
    r'|(?P<text>"[^"]*"?)'
    r"|(?P<number>(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]*)(?:E(?: [-+] )?[0-9]*)?)"
    r"| (?P<word>\S+) "
    r"|(?P<name>[A-Z][A-Z0-9]*[$%]?)"
    r"|(?P<sign>.)",
    re.S,
)


class NotCompiled(ValueError):
    """The program uses something that `applesoft.c` does not have."""


class Token(NamedTuple):
    """A token of a line: kind (a group of the pattern), text, and its place in the line's text."""

    kind: str
    text: str
    start: int
    stop: int


Statement = list[Token]
NO_TOKEN = Token("", "", 0, 0)


def spell(tokens: bytes) -> str:
    """Return the bytes of a line as text: keywords between blanks, no other blanks but in texts."""
    return "".join(map(list_text, tokens))


def split_statements(text: str) -> Iterator[Statement]:
    """Yield the statements of a line that `spell` wrote; empty ones are left out."""
    statement: Statement = []
    for match in _TOKEN.finditer(text):
        if match[0] != ":":
            kind = match.lastgroup or ""
            statement.append(Token(kind, match[kind], *match.span()))
        elif statement:
            yield statement
            statement = []
    if statement:
        yield statement


def program_lines(text: str) -> Iterator[tuple[int, bytes]]:
    """Yield number and tokens of each line of a listing."""
    for row in text.splitlines():
        number, statements = split_number(row) or (0, "")
        yield number, tokenise(statements)


def key_of(name: str) -> str:
    """Return the part of a variable's name that Applesoft distinguishes."""
    return name[:2] + name[-1] if name[2:] and name[-1] in "$%" else name[:2]


def typed_constant(statement: Sequence[Token], inputs: Collection[str]) -> str | None:
    """Return the input that a statement sets to a constant; None for another statement.

    A scene's value is typed in place of that constant."""
    tokens = [token for token in statement if token.text != "LET"]
    if len(tokens) < 3 or tokens[1].text != "=":
        return None
    is_constant = all(token.kind == "number" or token.text in ("+", "-") for token in tokens[2:])
    key = key_of(tokens[0].text)
    return key if is_constant and key in inputs else None


class Steps(NamedTuple):
    """A compiled program.

    ``steps``: operation and number of each; ``constants``, ``texts``, ``variables``: those that the
    numbers count; ``inputs``: the names, in order, of values that a run is given."""

    steps: list[tuple[str, int]]
    constants: list[str]
    texts: list[str]
    variables: list[str]
    inputs: list[str]


def compile_program(
    lines: Iterable[tuple[int, bytes]],
    inputs: Iterable[str],
    kept: Mapping[int, Sequence[str]] | None = None,
) -> Steps:
    """Return the steps of a program.

    Parameters
    ----------
    lines : iterable of (int, bytes)
        Number and tokens of each line, in order.
    inputs : iterable of str
        The variables whose values a run is given: typed in place of constants assigned to them, and
        replied to INPUT and READ.
    kept : mapping of int to sequence of str, optional
        Variables whose values at the beginning of a line are kept as NAME', for those that the
        program uses again.

    Returns
    -------
    Steps
        The compiled program.

    Raises
    ------
    NotCompiled
        For a program with anything else than real numbers, one array and printed texts.
    """
    return _Compiler(list(inputs), kept or {}).compile(lines)


class _Compiler:
    """The state of `compile_program`: the steps so far, and the place in the line."""

    def __init__(self, inputs: list[str], kept: Mapping[int, Sequence[str]]) -> None:
        self._result = Steps([], [], [""], [], inputs)  # an unset text variable prints text 0
        self._kept = kept
        self._lines: dict[int, int] = {}
        self._strings: list[str] = []
        self._array = ""
        self._depth = 0
        self._line = 0
        self._tokens: Statement = []
        self._at = 0
        self._conditions: list[int] = []  # UNLESS steps of this line, which jump to the next one

    def compile(self, lines: Iterable[tuple[int, bytes]]) -> Steps:
        """Return the steps of a program's lines."""
        steps = self._result.steps
        for self._line, tokens in lines:
            self._lines[self._line] = len(steps)
            self._emit("LINE", self._line)
            for name in self._kept.get(self._line, ()):
                self._emit("VARIABLE", self._variable(name))
                self._emit("STORE", self._variable(f"{name}'"))
            self._conditions = []
            for self._tokens in split_statements(spell(tokens)):
                self._at = 0
                if self._tokens[0].kind not in ("remark", "data"):
                    self._statement()
                    if self._at < len(self._tokens):
                        raise NotCompiled(f"{self._peek().text!r} in line {self._line}")
            for place in self._conditions:
                steps[place] = ("UNLESS", len(steps))
        self._emit("END")
        for k, (operation, number) in enumerate(steps):
            if operation in ("GOTO", "GOSUB"):
                if number not in self._lines:
                    raise NotCompiled(f"there is no line {number}")
                steps[k] = (operation, self._lines[number])
        if len(self._result.variables) > MAX_VARIABLES or len(self._strings) > MAX_STRINGS:
            raise NotCompiled("too many variables")
        if len(self._result.texts) > MAX_TEXTS:
            raise NotCompiled("too many texts")
        return self._result

    # --- places and steps ---

    def _peek(self) -> Token:
        return self._tokens[self._at] if self._at < len(self._tokens) else NO_TOKEN

    def _take(self, *expected: str) -> Token:
        """Return the next token, one of ``expected`` if any are named. Raises NotCompiled."""
        token = self._peek()
        if expected and token.text not in expected:
            raise NotCompiled(f"{token.text!r} in line {self._line}")
        self._at += 1
        return token

    def _take_kind(self, kind: str) -> str:
        """Return the text of the next token, which must be of a kind. Raises NotCompiled."""
        token = self._take()
        if token.kind != kind:
            raise NotCompiled(f"{token.text!r} in line {self._line}")
        return token.text

    def _emit(self, operation: str, number: int = 0) -> int:
        """Append a step and return its index."""
        pops, pushes = OPERATIONS[operation]
        self._depth += pushes - pops
        if self._depth > MAX_DEPTH:
            raise NotCompiled(f"too deep a formula in line {self._line}")
        self._result.steps.append((operation, number))
        return len(self._result.steps) - 1

    def _variable(self, name: str) -> int:
        """Return the index of a real variable."""
        key, variables = key_of(name) if "'" not in name else name, self._result.variables
        if key[-1] in "$%":
            raise NotCompiled(f"{name} in line {self._line}")
        if key not in variables:
            variables.append(key)
        return variables.index(key)

    def _string(self, name: str) -> int:
        """Return the index of a text variable."""
        if key_of(name) not in self._strings:
            self._strings.append(key_of(name))
        return self._strings.index(key_of(name))

    def _text(self, text: str) -> int:
        """Return the index of a printed text."""
        self._result.texts.append(text)
        return len(self._result.texts) - 1

    # --- statements ---

    def _statement(self) -> None:
        token = self._take()
        if token.text == "LET":
            token = self._take()
        if token.kind == "name":
            self._assign(token.text)
        elif token.kind == "word" and token.text in _STATEMENTS:
            _STATEMENTS[token.text](self)
        else:
            raise NotCompiled(f"{token.text!r} in line {self._line}")

    def _assign(self, name: str) -> None:
        """NAME = formula, NAME$ = text or NAME(i,j) = formula."""
        if name.endswith("$"):
            self._take("=")
            parts = [self._take_text()]
            while self._peek().text == "+":
                self._take()
                parts.append(self._take_text())
            self._emit("STRING", self._string(name) * MAX_TEXTS + self._text("".join(parts)))
        elif self._peek().text == "(":
            self._subscripts(name)
            self._emit("PLACE")
            self._take("=")
            self._formula()
            self._emit("STORE_ELEMENT")
        else:
            self._assign_real(name)

    def _assign_real(self, name: str) -> None:
        variable = self._variable(name)
        inputs = self._result.inputs
        constant = typed_constant(self._tokens, inputs)
        self._take("=")
        self._emit("TOUCH", variable)
        if constant and not self._conditions:
            self._emit("TYPED", inputs.index(constant))
            self._at = len(self._tokens)
        else:
            self._formula()
        self._emit("STORE", variable)

    def _take_text(self) -> str:
        return self._take_kind("text").strip('"')

    def _print(self) -> None:
        newline = True
        while self._at < len(self._tokens):
            token = self._peek()
            newline = token.text != ";"
            if not newline:
                self._take()
            elif token.kind == "text":
                self._emit("TEXT", self._text(self._take_text()))
            elif token.text == "CHR$":
                self._take()
                self._take("(")
                self._emit("TEXT", self._text(chr(self._whole_number() & 0x7F)))
                self._take(")")
            elif token.kind == "name" and token.text.endswith("$"):
                self._emit("SHOW", self._string(self._take().text))
            else:
                self._formula()
                self._emit("PRINT")
        if newline:
            self._emit("TEXT", self._text("\n"))

    def _whole_number(self) -> int:
        text = self._take_kind("number")
        if not text.isdigit() or len(text) > 5:
            raise NotCompiled(f"{text} in line {self._line}")
        return int(text)

    def _input(self) -> None:
        prompt = "?\0"
        if self._peek().kind == "text":
            prompt = self._take_text() + "\0"
            self._take(";")
        indices = self._input_names()
        self._emit("TEXT", self._text(prompt))
        for index in indices:
            self._emit("ECHO", index)
            self._emit("TEXT", self._text("\n" if index == indices[-1] else ","))
        self._store_inputs("READ", indices)

    def _read(self) -> None:
        """READ takes a scene's values as if they were typed into DATA."""
        self._store_inputs("TYPED", self._input_names())

    def _store_inputs(self, operation: str, indices: Sequence[int]) -> None:
        for index in indices:
            variable = self._variable(self._result.inputs[index])
            self._emit("TOUCH", variable)
            self._emit(operation, index)
            self._emit("STORE", variable)

    def _input_names(self) -> list[int]:
        """Return the inputs that a list of variables names. Raises NotCompiled for others."""
        names = [key_of(self._take_kind("name"))]
        while self._peek().text == ",":
            self._take()
            names.append(key_of(self._take_kind("name")))
        if any(names.count(n) > 1 or n not in self._result.inputs for n in names):
            raise NotCompiled(f"values of {', '.join(names)} in line {self._line}")
        return [self._result.inputs.index(name) for name in names]

    def _if(self) -> None:
        self._formula()
        self._conditions.append(self._emit("UNLESS"))
        word = self._take("THEN", "GOTO").text
        if word == "GOTO" or self._peek().kind == "number":
            self._goto()
        else:
            self._statement()

    def _goto(self) -> None:
        self._emit("GOTO", self._whole_number())

    def _gosub(self) -> None:
        self._emit("GOSUB", self._whole_number())

    def _for(self) -> None:
        name = self._take_kind("name")
        self._assign_real(name)
        self._take("TO")
        self._formula()
        self._emit("FOR", self._variable(name))

    def _next(self) -> None:
        self._emit("NEXT", self._variable(self._take_kind("name")))

    def _dim(self) -> None:
        """The first array is kept; others must have its subscripts or constants, and no use."""
        if self._array:
            raise NotCompiled(f"a second DIM in line {self._line}")
        self._array = key_of(self._take_kind("name"))
        start = self._at
        self._subscripts(self._array)
        shape = "".join(token.text for token in self._tokens[start : self._at])
        self._emit("DIM")
        while self._peek().text == ",":
            self._take()
            self._take_kind("name")
            start = self._at
            while self._take().text != ")":
                pass
            bounds = self._tokens[start : self._at]
            is_constant = all(token.kind == "number" or token.text in "(,)" for token in bounds)
            if not is_constant and "".join(token.text for token in bounds) != shape:
                raise NotCompiled(f"DIM of another shape in line {self._line}")

    # --- formulas ---

    def _subscripts(self, array: str) -> None:
        """Emit the two subscripts of an element."""
        if key_of(array) != self._array:
            raise NotCompiled(f"{array}( in line {self._line}")
        self._take("(")
        self._formula()
        self._take(",")
        self._formula()
        self._take(")")

    def _formula(self, level: int = 0) -> None:
        """Emit a formula of operators from a level on; the ROM rounds each left operand."""
        if level == len(LEVELS):
            self._operand()
            return
        self._formula(level + 1)
        while (operation := LEVELS[level].get(self._peek().text)) and self._peek().kind != "text":
            bits = 0
            while operation == "COMPARE" and self._peek().text in COMPARISONS:
                bits |= COMPARISONS[self._take().text]
            if operation != "COMPARE":
                self._take()
            if self._result.steps[-1][0] not in ("VARIABLE", "ELEMENT"):  # these are round
                self._emit("ROUND")
            self._formula(level + 1)
            self._emit(operation, bits)

    def _operand(self) -> None:
        kind, text, *_ = self._take()
        if text == "-":  # binds more than ^: -3 ^ 2 is 9
            self._operand()
            self._emit("NEGATE")
        elif text == "(":
            self._formula()
            self._take(")")
        elif kind == "number":
            constants, number = self._result.constants, text.replace(" ", "")
            if number not in constants:
                constants.append(number)
            self._emit("CONSTANT", constants.index(number))
        elif kind == "word" and text in FUNCTIONS:
            self._take("(")
            self._formula()
            self._take(")")
            self._emit(text)
        elif kind == "name" and self._peek().text == "(":
            self._subscripts(text)
            self._emit("ELEMENT")
        elif kind == "name":
            self._emit("VARIABLE", self._variable(text))
        else:
            raise NotCompiled(f"{text!r} in line {self._line}")


_STATEMENTS: dict[str, Callable[[_Compiler], object]] = {
    "PRINT": _Compiler._print,
    "INPUT": _Compiler._input,
    "READ": _Compiler._read,
    "IF": _Compiler._if,
    "GOTO": _Compiler._goto,
    "GOSUB": _Compiler._gosub,
    "RETURN": lambda compiler: compiler._emit("RETURN"),
    "FOR": _Compiler._for,
    "NEXT": _Compiler._next,
    "DIM": _Compiler._dim,
    "END": lambda compiler: compiler._emit("END"),
}
