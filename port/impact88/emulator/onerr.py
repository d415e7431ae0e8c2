"""What ONERR keeps."""

from __future__ import annotations

ON = 0x80


class Errors:
    """``flag``: on from 128; ``code`` and ``line`` of the last error; ``handler``: the line ONERR
    names, and ``handler_line`` the one it stands in; ``resume``: where RESUME goes, and ``frames``
    how many loops and subroutines there were then."""

    def __init__(self) -> None:
        self.flag = 0
        self.code = 0
        self.line = 0
        self.handler: int | None = None
        self.handler_line = 0
        self.resume: int | None = None
        self.frames = 0

    @property
    def on(self) -> bool:
        """Whether an error goes to the handler."""
        return self.flag >= ON

    def arm(self, handler: int | None, line: int) -> None:
        """ONERR GOTO."""
        self.flag = ON | self.flag >> 1
        self.handler = handler
        self.handler_line = line

    def catch(self, code: int, line: int, resume: int, frames: int) -> None:
        """An error happened."""
        self.code = code
        self.line = line
        self.resume = resume
        self.frames = frames
