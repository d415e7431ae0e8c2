"""The one error a user of this package is shown: input that cannot be used."""

from __future__ import annotations


class UserError(ValueError):
    """Input that cannot be used: one line saying what is wrong, where, and what is expected.

    The command line prints the message on stderr and leaves with status 2; nobody ever sees a
    traceback for it. ``where`` is the place (file, row, field), put in front when given.
    """

    def __init__(self, message: str, where: str | None = None) -> None:
        super().__init__(f"{where}: {message}" if where else message)
        self.where = where
