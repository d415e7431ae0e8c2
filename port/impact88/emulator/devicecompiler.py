"""Compiling the statements that reach outside: PRINT and INPUT, memory, and the program as text."""

from __future__ import annotations

from .linecompiler import LineCompiler
from .operand import COMMA, TEXT
from .reader import QUOTE, is_digit
from .tokens import TOKENS

PRINT_AT = 4
"""How deep the stack is when PRINT begins a formula; likewise below."""
BYTE_AT = 8
ADDRESS_AT = 6
TAB_AT = 9
SEMICOLON = ord(";")
TAB, SPC, MINUS = (TOKENS[word] for word in ("TAB(", "SPC(", "-"))


class DeviceCompiler(LineCompiler):
    """A method for each keyword, called when the keyword has been read."""

    def _with_byte(self, function: str) -> None:
        piece = self.formulas.byte(BYTE_AT)
        if piece.dead:
            self._stop(piece)
        else:
            self._emit(f"{function}({piece.code})")

    # --- PRINT, INPUT and their kin -----------------------------------------------------------

    def _print(self) -> None:
        reader, formulas = self.reader, self.formulas
        newline = True
        while not reader.at_end():
            newline = False
            byte = reader.peek()
            if byte in (TAB, SPC):
                reader.skip()
                columns = formulas.byte(TAB_AT)
                if not columns.dead and not reader.take(ord(")")):
                    columns = formulas.fails("SYNTAX", columns)
                if columns.dead:
                    self._stop(columns)
                    return
                self._emit(f"{'tab' if byte == TAB else 'spc'}({columns.code})")
            elif byte == COMMA:
                reader.skip()
                self._emit("zone()")
            elif byte == SEMICOLON:
                reader.skip()
            else:
                value = formulas.formula(PRINT_AT)
                if value.dead:
                    self._stop(value)
                    return
                if value.text is not None and not formulas.careful:
                    self._emit(f"out_literal({value.text!r})")
                    newline = True
                    continue
                self._emit(f"{'out_string' if value.kind == TEXT else 'out_number'}({value.code})")
                newline = True
        if newline:
            self._emit("newline()")

    def _input(self) -> None:
        reader = self.reader
        prompt = "?"
        if reader.take(QUOTE):
            prompt = reader.string()
            if not reader.take(SEMICOLON):
                self._fail("SYNTAX")
                return
        self._emit(f"out({prompt!r})")
        if self.direct:
            self._fail("ILLEGAL DIRECT")
            return
        self._emit(f"if input_(pc, {self._items()}): return reenter(pc)")

    def _get(self) -> None:
        if self.direct:
            self._fail("ILLEGAL DIRECT")
            return
        self._emit(f"get({self._items()})")

    def _read(self) -> None:
        self._emit(f"read({self._items()})")

    # --- the machine --------------------------------------------------------------------------

    def _pair(self, function: str, *, third: bool = False) -> None:
        """POKE and WAIT: an address and bytes, separated by commas."""
        formulas = self.formulas
        pieces = [formulas.address(BYTE_AT)]
        while not pieces[-1].dead and len(pieces) < 2 + third:
            if len(pieces) == 2 and self.reader.at_end():
                break
            if not self.reader.take(COMMA):
                pieces.append(formulas.fails("SYNTAX"))
            else:
                pieces.append(formulas.byte(BYTE_AT))
        if pieces[-1].dead:
            self._stop(formulas.then(*pieces))
        else:
            self._emit(f"{function}({', '.join(piece.code for piece in pieces)})")

    def _poke(self) -> None:
        self._pair("POKE")

    def _wait(self) -> None:
        self._pair("if not WAIT", third=True)
        if not self._over:
            self.steps[-1].code[-1] += ": return pc"

    def _with_address(self, function: str) -> None:
        piece = self.formulas.address(ADDRESS_AT)
        if piece.dead:
            self._stop(piece)
        else:
            self._emit(f"{function}({piece.code})")

    def _call(self) -> None:
        self._with_address("CALL")

    def _himem(self) -> None:
        self._with_address("himem")

    def _lomem(self) -> None:
        self._with_address("lomem")

    # --- the program itself -------------------------------------------------------------------

    def _list(self) -> None:
        reader = self.reader
        byte = reader.peek()
        if not (is_digit(byte) or reader.at_end() or byte in (MINUS, COMMA)):
            return
        first = last = self._line_number()
        if first is None:
            return
        if not reader.at_end():
            if not (reader.take(MINUS) or reader.take(COMMA)):
                return
            last = self._line_number()
            if last is None or not reader.at_end():
                return
        self._emit(f"list_({first}, {last or 0xFFFF})")

    def _del(self) -> None:
        if not is_digit(self.reader.peek()):
            self._fail("SYNTAX")
            return
        first = self._line_number()
        if first is None:
            return
        if not self.reader.take(COMMA):
            self._fail("SYNTAX")
            return
        last = self._line_number()
        if last is not None:
            self._emit(f"delete({first}, {last})")
