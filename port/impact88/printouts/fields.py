"""The table of printed fields: the numbers that lines 620 to 760 print, in order.

Reading, replaying, comparing and qualifying printouts all take a field's line, decimal places and
kind from here.
"""

import re
from collections import namedtuple
from collections.abc import Mapping

from ..decimals import to_double


class Field(namedtuple("Field", ("name", "line", "places"))):
    """One printed number: its name in `names`, the listing line that prints it, and the decimal
    places it is floored to (None: printed in full)."""

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
"""The printed numbers, in printing order."""

ANGLES = tuple(name for name, field in FIELDS.items() if field.line == 650)
"""The angles, in the order of line 650; typed and printed in degrees."""
INPUTS = tuple(name for name, field in FIELDS.items() if field.places is None and name != "KI")
"""Fields that print an input; MUP is MU after line 400."""


def scene_name(name: str) -> str:
    """Return the scene's name of a printed input: MU for MUP, else the name itself."""
    return "MU" if name == "MUP" else name


REPLIES = {"A": ("UX", "UY", "WA"), "B": ("VX", "VY", "WB")}
"""Values that the prompts of lines 200 and 220 ask for, by vehicle."""
FINAL_SPINS = tuple(name for name, field in FIELDS.items() if field.line == 760)
"""Fields that line 750 skips unless M = N."""
ZERO_DETERMINANT = "ZERO DETERMINANT"
"""The text that line 1160 prints in place of results."""

_LABELS = {
    "MUP": "MU=",
    "KI": "INITIAL KE=",
    "LOSS": "KE LOSS=",
    **{name: f"{name[:-1]}=" for name in ("XAF", "YAF", "XBF", "YBF", *FINAL_SPINS)},
}
"""Labels that differ from the field's name."""
_VALUE = re.compile(r"[ \n]*([^ )\n\0\a?][^ )\n\0\a]*)")
"""A printed value, with the blanks before it."""


def label(name: str) -> str:
    """Return the text printed before a field, such as ``MA=``; the angles share one heading."""
    return "PA PB TA TB GA" if name in ANGLES else _LABELS.get(name, f"{name}=")


def outcome_fields(printed: str) -> dict[str, str]:
    """Return the fields that one run printed, by name; empty if it stopped before the first.

    For the program's own output, whose layout is known to the last blank; old printouts are read by
    `printouts.reading`."""
    texts: dict[str, str] = {}
    place = printed.find("MA= ")
    for name in FIELDS if place >= 0 else ():
        if name not in ANGLES[1:]:
            text = label(name)
            start = printed.find(text, place)
            if start < 0:
                break
            place = start + len(text)
        value = _VALUE.match(printed, place)
        if value is None:
            break
        texts[name], place = value[1], value.end()
    return texts


def doubles_of(texts: Mapping[str, str]) -> dict[str, float]:
    """Return the double of each text, by name."""
    return {name: to_double(text) for name, text in texts.items()}
