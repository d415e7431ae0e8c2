"""The one table of the printed fields: what lines 620 to 760 print, in the order they print it.

Reading a printout, replaying one over arrays, comparing and qualifying all take a field's line,
places and kind from here.
"""

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
_END_OF_NUMBER = frozenset(" )\n\x00\x07")


def label(name: str) -> str:
    """What is printed before a field, ``MA=``; the angles share one heading."""
    return "PA PB TA TB GA" if name in ANGLES else _LABELS.get(name, f"{name}=")


def outcome_fields(printed: str) -> dict[str, str]:
    """The fields of what one run printed, by name, as far as it got; none where it stopped before
    printing any. For the program's own output, whose layout is known to the last blank."""
    found: dict[str, str] = {}
    place = printed.find("MA= ")
    for name in FIELDS if place >= 0 else ():
        if name not in ANGLES[1:]:
            text = label(name)
            start = printed.find(text, place)
            if start < 0:
                break
            place = start + len(text)
        while place < len(printed) and printed[place] in " \n":
            place += 1
        stop = place
        while stop < len(printed) and printed[stop] not in _END_OF_NUMBER:
            stop += 1
        if stop == place or printed[place] == "?":
            break
        found[name], place = printed[place:stop], stop
    return found
