"""The one table of the printed fields: what lines 620 to 760 print, in the order they print it.

Reading a printout, replaying one over arrays, comparing and qualifying all take a field's line,
places and kind from here.
"""

import re
from collections import namedtuple


class Field(namedtuple("Field", ("name", "line", "places"))):
    """One printed number: its name in the project's table, the listing line that prints it, and
    the decimal places it is floored to (None: printed in full)."""

    __slots__ = ()


FIELDS: dict[str, Field] = {
    name: Field(name, line, places)
    for line, places, names in (
        (620, None, "MA MB IA IB"),
        (630, None, "DA DB"),
        (650, None, "PA PB TA TB GA"),
        (660, None, "UX UY WA"),
        (660, 2, "XA YA"),
        (670, None, "VX VY WB"),
        (670, 2, "XB YB"),
        (680, None, "E MUP EM"),
        (690, None, "KI"),
        (690, 2, "LOSS"),
        (730, 3, "VAX VAY"),
        (730, 2, "XAF YAF"),
        (740, 3, "VBX VBY"),
        (740, 2, "XBF YBF"),
        (760, 4, "WAF WBF"),
    )
    for name in names.split()
}
"""The printed numbers in the order they are printed."""

ANGLES = tuple(name for name, field in FIELDS.items() if field.line == 650)
"""The angles, in the order of line 650; typed and printed in degrees."""
INPUTS = tuple(name for name, field in FIELDS.items() if field.places is None and name != "KI")
"""Fields that print what was put in; MUP is MU after line 400."""


def scene_name(name: str) -> str:
    """The scene's value that a printed input stands for."""
    return "MU" if name == "MUP" else name


REPLIES = {"A": ("UX", "UY", "WA"), "B": ("VX", "VY", "WB")}
"""What the prompts of lines 200 and 220 ask for."""
FINAL_SPINS = tuple(name for name, field in FIELDS.items() if field.line == 760)
"""What line 750 leaves out unless M = N."""
ZERO_DETERMINANT = "ZERO DETERMINANT"
"""What line 1160 prints in place of results."""

_LABELS = {
    "MUP": "MU=",
    "KI": "INITIAL KE=",
    "LOSS": "KE LOSS=",
    **{name: f"{name[:-1]}=" for name in ("XAF", "YAF", "XBF", "YBF", *FINAL_SPINS)},
}
"""Labels that are not the field's name."""
_VALUE = r"[^ )\n\0\a?][^ )\n\0\a]*"


def label(name: str) -> str:
    """What is printed before a field, ``MA=``; the angles share one heading."""
    return "PA PB TA TB GA" if name in ANGLES else _LABELS.get(name, f"{name}=")


def outcome_fields(printed: str) -> dict[str, str]:
    """The fields of what one run printed, by name, as far as it got; none where it stopped before
    printing any. For the program's own output, whose layout is known to the last blank."""
    found: dict[str, str] = {}
    place = printed.find("MA= ")
    for name in FIELDS if place >= 0 else ():
        before = "" if name in ANGLES[1:] else f".*?{re.escape(label(name))}"
        value = re.compile(f"(?>{before}[ \n]*)({_VALUE})", re.DOTALL).match(printed, place)
        if value is None:
            break
        found[name], place = value[1], value.end()
    return found
