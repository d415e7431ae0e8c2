"""The one table of the printed fields: what lines 620 to 760 print, in the order they print it.

Reading a printout, replaying one over arrays, comparing and qualifying all take a field's line,
places and kind from here.
"""

from __future__ import annotations

from collections import namedtuple


class Field(namedtuple("Field", ("name", "line", "places"), defaults=(None,))):
    """One printed number: its name in the project's table, the listing line that prints it, and
    the decimal places it is floored to (None: printed in full)."""

    __slots__ = ()


FIELDS: dict[str, Field] = {
    field.name: field
    for field in (
        *(Field(name, 620) for name in ("MA", "MB", "IA", "IB")),
        *(Field(name, 630) for name in ("DA", "DB")),
        *(Field(name, 650) for name in ("PA", "PB", "TA", "TB", "GA")),
        *(Field(name, 660) for name in ("UX", "UY", "WA")),
        *(Field(name, 660, 2) for name in ("XA", "YA")),
        *(Field(name, 670) for name in ("VX", "VY", "WB")),
        *(Field(name, 670, 2) for name in ("XB", "YB")),
        *(Field(name, 680) for name in ("E", "MUP", "EM")),
        Field("KI", 690),
        Field("LOSS", 690, 2),
        *(Field(name, 730, 3) for name in ("VAX", "VAY")),
        *(Field(name, 730, 2) for name in ("XAF", "YAF")),
        *(Field(name, 740, 3) for name in ("VBX", "VBY")),
        *(Field(name, 740, 2) for name in ("XBF", "YBF")),
        *(Field(name, 760, 4) for name in ("WAF", "WBF")),
    )
}
"""The printed numbers in the order they are printed."""

ANGLES = tuple(name for name, field in FIELDS.items() if field.line == 650)
"""The angles, in the order of line 650; typed and printed in degrees."""
INPUTS = tuple(name for name, field in FIELDS.items() if field.places is None and name != "KI")
"""Fields that print what was put in; MUP is MU after line 400."""
REPLIES = {"A": ("UX", "UY", "WA"), "B": ("VX", "VY", "WB")}
"""What the prompts of lines 200 and 220 ask for."""
FINAL_SPINS = tuple(name for name, field in FIELDS.items() if field.line == 760)
"""What line 750 leaves out unless M = N."""
ZERO_DETERMINANT = "ZERO DETERMINANT"
"""What line 1160 prints in place of results."""
