"""Names: which slot each variable has, the same in every emulated machine.

Two characters count. ``A``, ``A%``, ``A$``, ``FN A`` and the arrays of those names are all apart. A
slot is an index into the machine's list of values (`variables.Variables`), so that running code
needs no look-up by name.
"""

from __future__ import annotations

from typing import NamedTuple

REAL = ""
INTEGER = "%"
STRING = "$"
FUNCTION = "FN"


class Name(NamedTuple):
    """A variable's name as it counts: at most two characters, and the kind."""

    text: str
    kind: str

    def stored(self) -> bytes:
        """The two bytes that stand for it in memory; their top bits tell the kind."""
        first = ord(self.text[0])
        second = ord(self.text[1]) if len(self.text) > 1 else 0
        return bytes(
            (
                first | (0x80 if self.kind in (INTEGER, FUNCTION) else 0),
                second | (0x80 if self.kind in (INTEGER, STRING) else 0),
            )
        )

    def __str__(self) -> str:
        return f"FN {self.text}" if self.kind == FUNCTION else self.text + self.kind


class Table:
    """Slots given out in the order names are met, for the life of the process."""

    def __init__(self) -> None:
        self.slots: dict[Name, int] = {}
        self.names: list[Name] = []

    def __len__(self) -> int:
        return len(self.names)

    def slot(self, text: str, kind: str) -> int:
        """The slot of a name, of which the first two characters count."""
        name = Name(text[:2], kind)
        slot = self.slots.get(name)
        if slot is None:
            # the list first: a slot in the dict must have its name in the list
            self.names.append(name)
            slot = self.slots[name] = len(self.names) - 1
        return slot


SIMPLE = Table()
"""Simple variables and functions."""
ARRAYS = Table()
"""Arrays."""
