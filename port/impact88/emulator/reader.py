"""Reading a line's tokens, once, when the line is compiled: the ROM's CHRGET over bytes.

Blanks are passed over everywhere except where a routine copies text. A colon or the line's end ends
a statement.
"""

from __future__ import annotations

from .tokens import TOKENS

END_OF_LINE = 0
COLON = ord(":")
QUOTE = ord('"')
_BLANK = ord(" ")
_NUMBER_TEXT = bytes(range(128)) + bytes(
    {TOKENS["+"]: ord("+"), TOKENS["-"]: ord("-")}.get(byte, 0) for byte in range(128, 256)
)


def is_letter(byte: int) -> bool:
    """A to Z; a small letter begins no name."""
    return 65 <= byte <= 90


def is_digit(byte: int) -> bool:
    """0 to 9."""
    return 48 <= byte <= 57


class Reader:
    """A position in the tokens of one line."""

    def __init__(self, tokens: bytes) -> None:
        self.tokens = tokens + b"\0"
        self.position = 0
        # where a number is read, + and - are tokens
        self.number_text = self.tokens.translate(_NUMBER_TEXT).decode("ascii")

    def peek(self) -> int:
        """The next byte that is no blank; 0 at the line's end."""
        while self.tokens[self.position] == _BLANK:
            self.position += 1
        return self.tokens[self.position]

    def skip(self) -> None:
        """Past the byte that `peek` showed."""
        self.position += 1

    def take(self, byte: int) -> bool:
        """Past ``byte`` if it is next; whether it was."""
        if self.peek() != byte:
            return False
        self.position += 1
        return True

    def at_end(self) -> bool:
        """Whether the statement ends here."""
        return self.peek() in (END_OF_LINE, COLON)

    def skip_statement(self) -> None:
        """DATAN: to the next colon outside quotes, or the line's end."""
        quoted = False
        while byte := self.tokens[self.position]:
            if byte == COLON and not quoted:
                return
            if byte == QUOTE:
                quoted = not quoted
            self.position += 1

    def skip_line(self) -> None:
        """To the line's end."""
        self.position = len(self.tokens) - 1

    def line_number(self) -> int | None:
        """LINGET: the digits that come next, 0 if none; None past 63999."""
        number = 0
        while is_digit(byte := self.peek()):
            if number >= 6400:
                return None
            number = 10 * number + byte - 48
            self.skip()
        return number

    def name(self) -> str | None:
        """The letters and digits of a name, None if no letter comes next."""
        if not is_letter(self.peek()):
            return None
        start = self.position
        self.skip()
        while is_letter(byte := self.peek()) or is_digit(byte):
            self.skip()
        return self.tokens[start : self.position].replace(b" ", b"").decode("ascii")

    def string(self) -> str:
        """The text of a string after its opening quote, past the closing one if there is one."""
        end = self.tokens.find(b'"', self.position)
        if end < 0:
            text = self.tokens[self.position : -1]
            self.skip_line()
        else:
            text = self.tokens[self.position : end]
            self.position = end + 1
        return text.decode("latin-1")
