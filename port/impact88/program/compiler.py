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
from collections.abc import Iterable, Iterator, Mapping, Sequence
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
CODES = {name: code for code, name in enumerate(OPERATIONS)}

MAX_DEPTH = 15  # numbers on the stack of applesoft.c
MAX_VARIABLES = 64  # bits that tell which are assigned
MAX_STRINGS = 8
MAX_TEXTS = 256  # one byte of STRING's number
FUNCTIONS = frozenset("INT ABS SGN SQR EXP LOG SIN COS TAN ATN".split())
COMPARISONS = {">": 1, "=": 2, "<": 4}
"""Bits of COMPARE's number."""
BINARY = {
    "OR": "OR",
    "AND": "AND",
    "+": "ADD",
    "-": "SUBTRACT",
    "*": "MULTIPLY",
    "/": "DIVIDE",
    "^": "POWER",
}
PRECEDENCE = {
    operator: level
    for level, operators in enumerate(("OR", "AND", "> = <", "+ -", "* /", "^"), 1)
    for operator in operators.split()
}

GIVEN = re.compile(
    r'"[^"\n]*"?| REM .*| IF .*'  # a text; what is done at times only
    r"|(?<![^:\n])(?: LET )?(?P<name>[A-Z][A-Z0-9]*) = "
    r"(?P<number>(?: [-+] )*[0-9.](?:[0-9.E]| [-+] )*)(?=[:\n]|$)"
    r'| (?P<verb>READ|INPUT) (?:"[^"]*";)?(?P<list>[A-Z0-9,$%]+)'
)
"""The statements of a line that give numbers to variables: constants, READ and INPUT."""
_TOKEN = re.compile(
    r"(?: REM .*| DATA [^:]*)?(?:(?P<end>:|$)"
    r'|(?P<text>"[^"]*"?)'
    r"|\0(?P<typed>[0-9]+)"
    r"|(?P<number>(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]*)(?:E(?: [-+] )?[0-9]*)?)"
    r"| (?P<word>\S+) "
    r"|(?P<name>[A-Z][A-Z0-9]*[$%]?)"
    r"|(?P<sign>.))",
    re.S,
)


class NotCompiled(ValueError):
    """The program uses something that `applesoft.c` does not have."""


class Token(NamedTuple):
    """A token of a line: its kind (a group of the pattern) and its text."""

    kind: str
    text: str


class Steps(NamedTuple):
    """A compiled program.

    ``steps``: operation and number of each; ``constants``, ``texts``, ``variables``: those that the
    numbers count; ``inputs``: the names, in order, of values that a run is given."""

    steps: list[tuple[str, int]]
    constants: list[str]
    texts: list[str]
    variables: list[str]
    inputs: list[str]


def spell(tokens: bytes) -> str:
    """Return the bytes of a line as text: keywords between blanks, no other blanks but in texts."""
    return "".join(map(list_text, tokens))


def program_lines(text: str) -> Iterator[tuple[int, str]]:
    """Yield number and text, as `spell` writes it, of each line of a listing."""
    for row in text.splitlines():
        number, statements = split_number(row) or (0, "")
        yield number, spell(tokenise(statements))


def key_of(name: str) -> str:
    """Return the part of a variable's name that Applesoft distinguishes."""
    return name[:2] + name[-1] if name[2:] and name[-1] in "$%'" else name[:2]


def with_values(line: str, values: Mapping[str, str]) -> str:
    """Return a line with values, by `key_of` their variables, in place of the constants assigned
    to these variables. READ becomes such assignments."""

    def replace(match: re.Match[str]) -> str:
        names = (match["name"] or match["list"] or "").split(",")
        if match["verb"] == "INPUT" or not {*map(key_of, names)} <= {*values}:
            return match[0]
        return ":".join(f"{name} = {values[key_of(name)]}" for name in names)

    return GIVEN.sub(replace, line)


def compile_program(
    lines: Iterable[tuple[int, str]],
    inputs: Iterable[str],
    kept: Mapping[int, Sequence[str]] | None = None,
) -> Steps:
    """Return the steps of a program.

    Parameters
    ----------
    lines : iterable of (int, str)
        Number and text of each line, as `spell` writes it, in order.
    inputs : iterable of str
        The variables whose values a run is given: typed in place of constants assigned to them, and
        replied to INPUT.
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
    compiler = _Compiler(list(inputs))
    for number, text in lines:
        compiler.compile_line(number, text, (kept or {}).get(number, ()))
    return compiler.finish()


class _Compiler:
    """The state of `compile_program`: the steps so far, and the tokens of a line that remain."""

    def __init__(self, inputs: list[str]) -> None:
        self._result = Steps([], [], [""], [], inputs)  # an unset text variable prints text 0
        self._values = {name: f"\0{k}" for k, name in enumerate(inputs)}
        self._lines: dict[int, int] = {}
        self._strings: list[str] = []
        self._array = ""
        self._depth = 0
        self._tokens: list[Token] = []
        self._conditions: list[int] = []  # UNLESS steps of this line, which jump to the next one

    def compile_line(self, number: int, text: str, kept: Sequence[str]) -> None:
        """Append the steps of a line."""
        self._lines[number] = len(self._result.steps)
        self._emit("LINE", number)
        for name in kept:
            self._emit("VARIABLE", self._variable(name))
            self._emit("STORE", self._variable(f"{name}'"))
        self._conditions = []
        matches = _TOKEN.finditer(with_values(text, self._values))
        self._tokens = [Token(m.lastgroup or "", m[m.lastgroup or 0]) for m in matches]
        while self._tokens:
            if not self._next_is("end"):
                self._statement()
            self._take("end")
        for place in self._conditions:
            self._result.steps[place] = ("UNLESS", len(self._result.steps))

    def finish(self) -> Steps:
        """Return the program, in which jumps go to steps instead of lines."""
        self._emit("END")
        for k, (operation, number) in enumerate(self._result.steps):
            if operation in ("GOTO", "GOSUB"):
                if number not in self._lines:
                    raise NotCompiled(f"there is no line {number}")
                self._result.steps[k] = (operation, self._lines[number])
        if (
            len(self._result.variables) > MAX_VARIABLES
            or len(self._strings) > MAX_STRINGS
            or len(self._result.texts) > MAX_TEXTS
        ):
            raise NotCompiled("too many variables or texts")
        return self._result

    # --- tokens and steps ---

    def _next_is(self, *expected: str) -> bool:
        """Return True if the next token is one of these, or of one of these kinds."""
        return not {*expected}.isdisjoint(self._tokens[0])

    def _take(self, *expected: str) -> str:
        """Return the next token's text. Raises NotCompiled if it is none of those expected."""
        if expected and not self._next_is(*expected):
            raise NotCompiled(self._tokens[0].text)
        return self._tokens.pop(0).text

    def _emit(self, operation: str, number: int = 0) -> None:
        """Append a step."""
        pops, pushes = OPERATIONS[operation]
        self._depth += pushes - pops
        if self._depth > MAX_DEPTH:
            raise NotCompiled("too deep a formula")
        self._result.steps.append((operation, number))

    def _emit_text(self, text: str) -> None:
        self._emit("TEXT", self._text(text))

    def _text(self, text: str) -> int:
        """Return the index of a printed text."""
        self._result.texts.append(text)
        return len(self._result.texts) - 1

    def _variable(self, name: str) -> int:
        """Return the index of a real variable."""
        if name[-1] in "$%":
            raise NotCompiled(name)
        return _index(self._result.variables, key_of(name))

    # --- statements ---

    def _statement(self) -> None:
        if self._next_is("LET"):
            self._take()
        is_name = self._next_is("name")
        text = self._take("name", "word")
        statement = getattr(self, f"do_{text.lower()}", None)
        if is_name:
            self._assign(text)
        elif text in ("GOTO", "GOSUB"):
            self._emit(text, self._whole_number())
        elif text in ("RETURN", "END"):
            self._emit(text)
        elif statement:
            statement()
        else:
            raise NotCompiled(text)

    def _assign(self, name: str) -> None:
        """NAME = formula, NAME$ = text or NAME(i,j) = formula."""
        if name.endswith("$"):
            self._take("=")
            text = self._take("text").strip('"')
            while self._next_is("+"):
                self._take()
                text += self._take("text").strip('"')
            string = _index(self._strings, key_of(name))
            self._emit("STRING", string * MAX_TEXTS + self._text(text))
        elif self._next_is("("):
            self._subscripts(name)
            self._emit("PLACE")
            self._take("=")
            self._formula()
            self._emit("STORE_ELEMENT")
        else:
            variable = self._variable(name)
            self._take("=")
            self._emit("TOUCH", variable)
            self._formula()
            self._emit("STORE", variable)

    def do_print(self) -> None:
        """PRINT."""
        newline = True
        while not self._next_is("end"):
            newline = not self._next_is(";")
            if self._next_is("text"):
                self._emit_text(self._take().strip('"'))
            elif self._next_is("CHR$"):
                self._take()
                self._take("(")
                self._emit_text(chr(self._whole_number(255) & 0x7F))
                self._take(")")
            elif self._next_is("name") and self._tokens[0].text.endswith("$"):
                self._emit("SHOW", _index(self._strings, key_of(self._take())))
            elif newline:
                self._formula()
                self._emit("PRINT")
            else:
                self._take()
        if newline:
            self._emit_text("\n")

    def _whole_number(self, largest: int = 63999) -> int:
        text = self._take("number")
        if not text.isdigit() or int(text) > largest:
            raise NotCompiled(text)
        return int(text)

    def do_input(self) -> None:
        """INPUT, of values that a run is given."""
        prompt = "?"
        if self._next_is("text"):
            prompt = self._take().strip('"')
            self._take(";")
        names = [key_of(self._take("name"))]
        while self._next_is(","):
            self._take()
            names.append(key_of(self._take("name")))
        if not {*names} <= {*self._values}:
            raise NotCompiled(f"values of {names}")
        self._emit_text(f"{prompt}\0")
        for place, name in enumerate(names, 1):
            self._emit("ECHO", self._result.inputs.index(name))
            self._emit_text("," if place < len(names) else "\n")
        for name in names:
            self._emit("TOUCH", self._variable(name))
            self._emit("READ", self._result.inputs.index(name))
            self._emit("STORE", self._variable(name))

    def do_if(self) -> None:
        """IF formula THEN statement, or THEN or GOTO line."""
        self._formula()
        self._conditions.append(len(self._result.steps))
        self._emit("UNLESS")
        if self._take("THEN", "GOTO") == "GOTO" or self._next_is("number"):
            self._emit("GOTO", self._whole_number())
        else:
            self._statement()

    def do_for(self) -> None:
        """FOR NAME = formula TO formula."""
        name = self._take("name")
        self._assign(name)
        self._take("TO")
        self._formula()
        self._emit("FOR", self._variable(name))

    def do_next(self) -> None:
        """NEXT NAME."""
        self._emit("NEXT", self._variable(self._take("name")))

    def do_dim(self) -> None:
        """DIM. The first array is kept; others, of the same subscripts or of constants, are not."""
        if self._array:
            raise NotCompiled("a second DIM")
        self._array = key_of(self._take("name"))
        tokens = list(self._tokens)
        self._subscripts(self._array)
        shape = "".join(token.text for token in tokens[: len(tokens) - len(self._tokens)])
        self._emit("DIM")
        arrays = ""
        while not self._next_is("end"):
            arrays += self._take()
        if not re.fullmatch(rf"(,[A-Z0-9]+({re.escape(shape)}|\([0-9,]+\)))*", arrays):
            raise NotCompiled(arrays)

    # --- formulas ---

    def _subscripts(self, array: str) -> None:
        """Emit the two subscripts of an element."""
        if key_of(array) != self._array:
            raise NotCompiled(array)
        self._take("(")
        self._formula()
        self._take(",")
        self._formula()
        self._take(")")

    def _formula(self, level: int = 0) -> None:
        """Emit a formula of operators above a level; the ROM rounds each left operand."""
        self._operand()
        while (precedence := PRECEDENCE.get(self._tokens[0].text, 0)) > level:
            bits = 0
            while self._next_is(*COMPARISONS):
                bits |= COMPARISONS[self._take()]
            operation = "COMPARE" if bits else BINARY[self._take()]
            if self._result.steps[-1][0] not in ("VARIABLE", "ELEMENT"):  # these are round
                self._emit("ROUND")
            self._formula(precedence)
            self._emit(operation, bits)

    def _operand(self) -> None:
        kind, text = self._tokens.pop(0)
        if text == "-":  # binds more than ^: -3 ^ 2 is 9
            self._operand()
            self._emit("NEGATE")
        elif text == "(":
            self._formula()
            self._take(")")
        elif kind == "number":
            self._emit("CONSTANT", _index(self._result.constants, text.replace(" ", "")))
        elif kind == "typed":
            self._emit("TYPED", int(text))
        elif text in FUNCTIONS:
            self._take("(")
            self._formula()
            self._take(")")
            self._emit(text)
        elif kind == "name" and self._next_is("("):
            self._subscripts(text)
            self._emit("ELEMENT")
        elif kind == "name":
            self._emit("VARIABLE", self._variable(text))
        else:
            raise NotCompiled(text)


def _index(items: list[str], item: str) -> int:
    """Return the index of an item, which is appended if it is new."""
    if item not in items:
        items.append(item)
    return items.index(item)
