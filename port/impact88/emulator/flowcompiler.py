"""Compiling the statements that say what comes next: GOTO, GOSUB, IF, ON, FOR and their kin."""

from __future__ import annotations

from .linecompiler import LineCompiler
from .operand import COMMA, NUMBER, Operand
from .reader import is_digit
from .symbols import STRING
from .tokens import TOKENS

IF_AT = 4
"""How deep the stack is when IF begins its formula; likewise below."""
ON_AT = 8
LIMIT_AT = 8
STEP_AT = 13
TOO_LARGE = -1
TO, THEN, STEP, GOTO, GOSUB = (TOKENS[word] for word in ("TO", "THEN", "STEP", "GOTO", "GOSUB"))


class FlowCompiler(LineCompiler):
    """A method for each keyword, called when the keyword has been read."""

    def _statement(self) -> None:
        """The statement that comes next."""
        raise NotImplementedError

    def _scan(self) -> None:
        """The ROM looks for the end of the statement or the line."""
        if self.formulas.careful:
            self._emit("scan()")

    def _goto(self) -> None:
        number = self._line_number()
        if number is not None:
            self._scan()
            self._leave(f"enter(first[{number}])" if self.direct else f"first[{number}]")

    def _gosub(self) -> None:
        self._scan()
        self._emit(f"return gosub(pc, {self.reader.line_number()})")
        self.reader.skip_statement()

    def _on(self) -> None:
        reader = self.reader
        number = self.formulas.byte(ON_AT)
        if number.dead:
            self._stop(number)
            return
        command = reader.peek()
        if command not in (GOTO, GOSUB):
            self._fail("SYNTAX", number)
            return
        reader.skip()
        self._emit(f"n = {number.code}")
        targets: list[int] = []
        bad = False
        while True:
            target = reader.line_number()
            bad = target is None
            if target is None:
                break
            targets.append(target)
            if not reader.take(COMMA):
                break
        table = f"({', '.join(map(str, targets))},)[n - 1]"
        if targets:
            to = f"first[{table}]" if command == GOTO else f"gosub(pc, {table})"
            if self.direct and command == GOTO:
                to = f"enter({to})"
            self._emit(f"if 0 < n <= {len(targets)}: return {to}")
        if bad:
            self._fail("SYNTAX")

    def _if(self) -> None:
        reader, formulas = self.reader, self.formulas
        value = formulas.formula(IF_AT)
        if value.dead:
            self._stop(value)
            return
        if reader.peek() != GOTO and not reader.take(THEN):
            self._fail("SYNTAX", value)
            return
        # of a string the ROM sees the accumulator's number, and leaves a temporary in its place
        number = value if value.kind == NUMBER else formulas.residue(value)
        scan = "scan(); " if formulas.careful else ""
        self._emit(f"if not {number.condition}: {scan}return after[pc]")
        if is_digit(reader.peek()):
            self._goto()
        else:
            self._statement()

    def _for(self) -> None:
        reader, formulas = self.reader, self.formulas
        variable = self._let(simple=True)
        if variable is None:
            self._over = True
            return
        kind, slot = variable
        self._emit(f"begin_for({slot})")
        if not reader.take(TO):
            self._fail("SYNTAX")
            return
        if kind == STRING:
            self._fail("TYPE MISMATCH")
            return
        limit = formulas.number(LIMIT_AT)
        if limit.dead:
            self._stop(limit)
            return
        self._emit(f"limit = {limit.stored}")
        by = "ONE"
        if reader.take(STEP):
            step = formulas.number(STEP_AT)
            if step.dead:
                self._stop(step)
                return
            by = step.stored
        self._scan()
        self._emit(f"return push_for({slot}, pc + 1, limit, {by})")

    def _next(self) -> None:
        if self.reader.at_end():
            self._emit("return next_(pc, -1)")
            return
        while True:
            target = self._target()
            if isinstance(target, Operand):
                self._stop(target)
                return
            place = target[1]
            if not place.startswith("place("):
                self._fail("NEXT WITHOUT FOR", Operand(place))
                return
            self._emit(f"return next_(pc, {place[6:-1]})")
            if not self.reader.take(COMMA):
                return
            self._end_step()
            self._begin(False)

    def _return(self) -> None:
        if self.reader.at_end():
            self._scan()
            self._leave("return_(pc)")

    def _run(self) -> None:
        if self.reader.at_end():
            self._leave("run(None)")
            return
        self._emit("rerun()")
        number = self.reader.line_number()
        self._leave(f"run({TOO_LARGE if number is None else number}, pc)")

    def _onerr(self) -> None:
        if not self.reader.take(GOTO):
            self._fail("SYNTAX")
            return
        self._emit(f"onerr(pc, {self.reader.line_number()})")
        self.reader.skip_line()
