"""JSON values whose numbers keep their digits: read, and written again.

A number is a `Numeral`, the text it is written as; everything else is what Python's json makes.
"""

import json
import math
import re
from typing import Any

from .. import doubles
from ..applesoft.decimaltext import scan

DEEPEST = 100
"""Lists and objects inside one another that are read."""


class Numeral(str):
    """The text of a JSON number."""

    __slots__ = ()


_CONSTANTS = {name: Numeral(str(float(name))) for name in ("NaN", "Infinity", "-Infinity")}
_decode = json.JSONDecoder(
    parse_float=Numeral, parse_int=Numeral, parse_constant=_CONSTANTS.__getitem__
).decode


def read(text: str) -> Any:
    """The value of a JSON text. Raises ValueError if it is not one, or nested too deeply."""
    try:
        value = _decode(text)
    except RecursionError:
        raise ValueError(f"is nested deeper than {DEEPEST} levels") from None
    except ValueError as error:
        raise ValueError(f"is not JSON: {error}") from None
    if text.count("[") + text.count("{") > DEEPEST and _depth(value) > DEEPEST:
        raise ValueError(f"is nested deeper than {DEEPEST} levels")
    return value


def _depth(value: Any) -> int:
    """How many lists and objects stand inside one another."""
    if not isinstance(value, dict | list):
        return 0
    return 1 + max(map(_depth, value.values() if isinstance(value, dict) else value), default=0)


def written(value: Any) -> str:
    """JSON text of a value as `read` makes it; not ASCII alone."""
    if isinstance(value, Numeral):
        return number(float(value)) if value in ("nan", "inf", "-inf") else str(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)}: {written(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    if isinstance(value, float):
        return number(value)
    return json.dumps(value, ensure_ascii=False, default=str)


def plain(value: Any) -> str:
    """A cell of any kind as a table of texts has it: nothing for None, else text or JSON."""
    if value is None:
        return ""
    return written(value) if isinstance(value, dict | list | bool) else str(value)


_JSON = re.compile(r"-?(?:0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")


def double(text: str) -> str:
    """A number's own digits as JSON writes a double: never as a whole number, so that readers who
    go by what they see give all of a column one type. Raises ValueError for a text that is no
    number."""
    if match := _JSON.fullmatch(text):
        return text if match[1] or match[2] else text + ".0"
    if not doubles.is_number(text):
        raise ValueError(f"{text!r} is not a number")
    sign, whole, decimals, exponent_sign, exponent, _ = scan(text.upper())
    power = f"E{exponent_sign}{exponent}" if exponent else ""
    return f"{sign.strip('+')}{whole.lstrip('0') or '0'}.{decimals or '0'}{power}"


def number(value: float) -> str:
    """A float in the fewest digits that read back to it; null for NaN, which JSON has not, and
    1e999 for infinity, which readers take for it."""
    if math.isfinite(value):
        return repr(value)
    return "null" if math.isnan(value) else ("1e999" if value > 0 else "-1e999")
