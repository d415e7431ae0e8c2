"""Applesoft's seventeen error messages, with the codes that ONERR stores in location 222."""

from functools import partial

CODES: dict[str, int] = {
    "NEXT WITHOUT FOR": 0,
    "SYNTAX": 16,
    "RETURN WITHOUT GOSUB": 22,
    "OUT OF DATA": 42,
    "ILLEGAL QUANTITY": 53,
    "OVERFLOW": 69,
    "OUT OF MEMORY": 77,
    "UNDEF'D STATEMENT": 90,
    "BAD SUBSCRIPT": 107,
    "REDIM'D ARRAY": 120,
    "DIVISION BY ZERO": 133,
    "ILLEGAL DIRECT": 149,
    "TYPE MISMATCH": 163,
    "STRING TOO LONG": 176,
    "FORMULA TOO COMPLEX": 191,
    "CAN'T CONTINUE": 210,
    "UNDEF'D FUNCTION": 224,
}
"""Kind -> code; the message is ``?KIND ERROR``."""


class ApplesoftError(Exception):
    """An error of the ROM.

    ``kind``: a key of `CODES`; ``code``: the value of ``PEEK (222)`` after ONERR; ``line``: the
    BASIC line, set by the code that runs the program, None outside a program line."""

    def __init__(self, kind: str, line: int | None = None) -> None:
        super().__init__(kind)
        self.kind = kind
        self.code = CODES[kind]
        self.line = line

    @property
    def message(self) -> str:
        """The message as displayed, without the bell: ``?OVERFLOW ERROR IN 210``."""
        place = "" if self.line is None else f" IN {self.line}"
        return f"?{self.kind} ERROR{place}"

    def __str__(self) -> str:
        return self.message


overflow = partial(ApplesoftError, "OVERFLOW")
"""``?OVERFLOW ERROR``: a result past 1.70141183E+38."""
division_by_zero = partial(ApplesoftError, "DIVISION BY ZERO")
"""``?DIVISION BY ZERO ERROR``, for 0 / 0 too."""
illegal_quantity = partial(ApplesoftError, "ILLEGAL QUANTITY")
"""``?ILLEGAL QUANTITY ERROR``: an argument outside a function's domain."""
