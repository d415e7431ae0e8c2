"""What the page's template is given: the project's one table of names, grouped for a form."""

import re
from collections.abc import Callable, Mapping
from typing import Any

from markupsafe import Markup, escape

from ..names import DEFAULT_M, quantity
from ..plaintable import number
from ..scene import SAMPLES, SIGNS, sample
from ..version import __version__

GROUPS = {
    "Vehicle A": "MA IA DA PA TA",
    "Vehicle B": "MB IB DB PB TB",
    "Before the impact, A": "UX UY WA",
    "Before the impact, B": "VX VY WB",
    "Contact and coefficients": "GA E MU EM M",
}
"""The form's parts: heading and quantities."""
KNOWN_GROUPS = {
    **dict(list(GROUPS.items())[:4]),
    "After the impact, A": "VAX VAY WAF",
    "After the impact, B": "VBX VBY WBF",
    "Contact": "GA M",
    "Coefficients": "E MU MUP EM",
}
MORE_GROUPS = {
    "Speed and course, A": "SA HA SAF HAF",
    "Speed and course, B": "SB HB SBF HBF",
    "Velocity change, A": "DVA DVAF DVAR",
    "Velocity change, B": "DVB DVBF DVBR",
    "Energy": "KI KF EL LOSS",
}
ALWAYS_KNOWN = frozenset("MA IA DA PA TA MB IB DB PB TB GA M".split())
"""What a reconstruction cannot do without."""

SYSTEMS = (
    ("us", "lb, mph, ft"),
    ("chapter", "slug, ft/s, ft"),
    ("metric", "kg, km/h, m"),
    ("si", "kg, m/s, m"),
)
"""The systems of units (`impact88.units`), and what bare numbers are in them."""
PUBLISHED = ("run1-as-printed.txt", "run2-as-printed.txt", "table3-as-printed.txt")
"""The published printouts, as they stand in the chapter."""


def symbol(text: str) -> Markup:
    """A symbol of the chapter as HTML: what follows ``_`` is a subscript."""
    return Markup(re.sub("_([A-Za-z0-9]+)", r"<sub>\1</sub>", str(escape(text))))


def unit(label: str) -> str:
    """How a unit is written."""
    return {"1": "", "degree": "°", "deg": "°", "percent": "%"}.get(label, label)


def digits(value: float | None, count: int) -> str:
    """A number of a table; nothing for None."""
    return "" if value is None else number(value, count)


def drivers(bound: Mapping[str, Any]) -> str:
    """The two inputs that move a result most, each with how far."""
    swings = {n: (d["highest"] or 0) - (d["lowest"] or 0) for n, d in bound["drives"].items()}
    least = 1e-9 * abs((bound["upper"] or 0) - (bound["lower"] or 0))
    ranked = sorted(swings.items(), key=lambda entry: -entry[1])[:2]
    return ", ".join(f"{name} {number(swing, 3)}" for name, swing in ranked if swing > least)


FILTERS: dict[str, Callable[..., Any]]
FILTERS = {"quantity": quantity, "symbol": symbol, "unit": unit}
FILTERS |= {"digits": digits, "drivers": drivers}


def contents() -> dict[str, Any]:
    """The template's values."""
    return {
        "version": __version__,
        "groups": GROUPS,
        "known_groups": KNOWN_GROUPS,
        "more_groups": MORE_GROUPS,
        "always_known": ALWAYS_KNOWN,
        "report_fields": [("case", "Case"), ("examiner", "Examiner"), ("date", "Date")],
        "published": PUBLISHED,
        "systems": SYSTEMS,
        "default_m": DEFAULT_M,
        "signs": [re.split("   +", line)[-1] for line in SIGNS.splitlines() if line.strip()],
        "samples": [(number, sample(number).title) for number in SAMPLES],
    }
