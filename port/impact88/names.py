"""The table of names: name, symbol, meaning and unit of each quantity.

A scene's values have the names of the 1988 listing everywhere in this project. Every template,
table heading, help text and error message takes symbol, meaning and unit from here.

The listing is "independent of units" (User's Information): any consistent set works, except that
angles are typed and printed in degrees and spins are in radians per unit of time. So ``unit`` is a
rule ("mass·length²"), not a unit.

>>> impact88.names.SCENE["MU"].meaning
'equivalent friction coefficient; -10 makes a pivot'
"""

from collections import namedtuple
from collections.abc import Collection, Iterable, Sequence

from .errors import UserError


class Quantity(namedtuple("Quantity", "name symbol meaning unit line", defaults=(0,))):
    """One row of the table.

    Parameters
    ----------
    name : str
        The listing's variable, or this project's name for a quantity the listing does not name.
    symbol : str
        The chapter's symbol (List of Symbols), "" without one.
    meaning : str
        The meaning in words.
    unit : str
        The unit rule, such as "length/time".
    line : int, default 0
        The line of the listing that sets or asks for the value (scene) or prints it (results); 0 if
        the listing has no such value.
    """

    __slots__ = ()


def _table(*rows: tuple[str | int, ...]) -> dict[str, Quantity]:
    """Return rows as quantities by name."""
    return {quantity.name: quantity for quantity in (Quantity(*row) for row in rows)}


_LENGTH = "length"
_VELOCITY = "length/time"
_SPIN = "rad/time"
_FORCE = "mass·length/time²"
_ENERGY = "mass·length²/time²"

SCENE = _table(
    ("E", "e", "coefficient of restitution", "1", 280),
    ("MU", "μ", "equivalent friction coefficient; -10 makes a pivot", "1", 280),
    ("EM", "e_m", "moment coefficient of restitution", "1", 280),
    ("DA", "d_a", "distance from A's center of gravity to the impact point", "length", 290),
    ("DB", "d_b", "distance from B's center of gravity to the impact point", "length", 290),
    ("GA", "Γ", "angle of the impact surface from the y axis", "degree", 290),
    ("PA", "φ_a", "angle from A's length axis to its impact point", "degree", 290),
    ("PB", "φ_b", "angle from B's length axis to its impact point", "degree", 290),
    ("TA", "θ_a", "heading angle of A from the x axis", "degree", 290),
    ("TB", "θ_b", "heading angle of B from the x axis", "degree", 290),
    ("MA", "m_a", "mass of A", "mass", 310),
    ("MB", "m_b", "mass of B", "mass", 310),
    ("IA", "I_a", "yaw moment of inertia of A", "mass·length²", 310),
    ("IB", "I_b", "yaw moment of inertia of B", "mass·length²", 310),
    ("UX", "v_ax", "initial x velocity of A", _VELOCITY, 210),
    ("UY", "v_ay", "initial y velocity of A", _VELOCITY, 210),
    ("WA", "ω_a", "initial spin of A", _SPIN, 210),
    ("VX", "v_bx", "initial x velocity of B", _VELOCITY, 230),
    ("VY", "v_by", "initial y velocity of B", _VELOCITY, 230),
    ("WB", "ω_b", "initial spin of B", _SPIN, 230),
    ("M", "M", "number of equations: 6, or 4 for point masses", "1", 350),
)
"""The values of a scene, in the listing's order."""

RESULTS = _table(
    ("VAX", "V_ax", "final x velocity of A", _VELOCITY, 730),
    ("VAY", "V_ay", "final y velocity of A", _VELOCITY, 730),
    ("VBX", "V_bx", "final x velocity of B", _VELOCITY, 740),
    ("VBY", "V_by", "final y velocity of B", _VELOCITY, 740),
    ("WAF", "Ω_a", "final spin of A", _SPIN, 760),
    ("WBF", "Ω_b", "final spin of B", _SPIN, 760),
    ("XA", "v_Cax", "x velocity of A's contact point before impact", _VELOCITY, 660),
    ("YA", "v_Cay", "y velocity of A's contact point before impact", _VELOCITY, 660),
    ("XB", "v_Cbx", "x velocity of B's contact point before impact", _VELOCITY, 670),
    ("YB", "v_Cby", "y velocity of B's contact point before impact", _VELOCITY, 670),
    ("XAF", "V_Cax", "x velocity of A's contact point after impact", _VELOCITY, 730),
    ("YAF", "V_Cay", "y velocity of A's contact point after impact", _VELOCITY, 730),
    ("XBF", "V_Cbx", "x velocity of B's contact point after impact", _VELOCITY, 740),
    ("YBF", "V_Cby", "y velocity of B's contact point after impact", _VELOCITY, 740),
    ("VC", "-v_rn", "closing speed at C along the normal, before", _VELOCITY),
    ("VS", "V_rn", "separation speed at C along the normal, after", _VELOCITY),
    ("KI", "T", "kinetic energy before impact", _ENERGY, 690),
    ("KF", "T'", "kinetic energy after impact", _ENERGY),
    ("LOSS", "100 ΔT", "kinetic energy lost", "percent", 690),
    ("ELN", "ΔT_n", "kinetic energy lost along the normal", _ENERGY),
    ("ELT", "ΔT_t", "kinetic energy lost along the contact surface, by friction", _ENERGY),
    ("ELM", "ΔT_M", "kinetic energy lost by the moment impulse", _ENERGY),
    ("EESA", "EES_a", "energy equivalent speed of A, if each takes half of the loss", _VELOCITY),
    ("EESB", "EES_b", "energy equivalent speed of B, if each takes half of the loss", _VELOCITY),
    ("DVA", "ΔV_a", "size of A's velocity change", _VELOCITY),
    ("DVB", "ΔV_b", "size of B's velocity change", _VELOCITY),
    ("PN", "P_n", "normal impulse on A", "mass·length/time"),
    ("PT", "P_t", "tangential impulse on A", "mass·length/time"),
    ("PM", "M", "moment impulse on A", "mass·length²/time"),
    ("MUP", "μ", "friction coefficient as printed: signed, -10 for a pivot", "1", 680),
    ("MUC", "μ_c", "critical friction coefficient: P_t/P_n of the pivot", "1"),
    ("COND", "κ", "condition number of the equilibrated equations, estimated", "1"),
    ("STATUS", "", "sum of the warning bits, see impact88.status", "bits"),
)
"""The results of an impact, in this project's order: the six final velocities first."""

CHAPTER = _table(
    ("CAX", "-d4", "x from A's center of gravity to the contact point", _LENGTH),
    ("CAY", "-d3", "y from A's center of gravity to the contact point", _LENGTH),
    ("CBX", "d2", "x from B's center of gravity to the contact point", _LENGTH),
    ("CBY", "d1", "y from B's center of gravity to the contact point", _LENGTH),
    ("CAF", "", "contact point forward of A's center of gravity", _LENGTH),
    ("CAL", "", "contact point to the left of A's center of gravity", _LENGTH),
    ("CBF", "", "contact point forward of B's center of gravity", _LENGTH),
    ("CBL", "", "contact point to the left of B's center of gravity", _LENGTH),
    ("LA", "", "overall length of A", _LENGTH),
    ("BA", "", "overall width of A", _LENGTH),
    ("LB", "", "overall length of B", _LENGTH),
    ("BB", "", "overall width of B", _LENGTH),
    ("CX", "ΔC_x", "move of the contact point along x", _LENGTH),
    ("CY", "ΔC_y", "move of the contact point along y", _LENGTH),
    ("RR0", "R/R_0", "final over initial relative spin that the moment alone makes", "1"),
    ("PDOFA", "", "force on A comes from, clockwise from its front", "degree"),
    ("PDOFB", "", "force on B comes from, clockwise from its front", "degree"),
    ("P", "P", "size of the impulse", "mass·length/time"),
    ("TF", "t_f", "duration of contact", "time"),
    ("FA", "F_A", "average force during contact", _FORCE),
    ("FM2", "F_M", "peak force, at twice the average", _FORCE),
    ("FM3", "F_M", "peak force, at three times the average", _FORCE),
    ("DT", "ΔT", "fraction of the kinetic energy lost", "1"),
    ("ELA", "", "energy lost in A, such as in crush: EL = ELA + ELB", _ENERGY),
    ("ELB", "", "energy lost in B, such as in crush: EL = ELA + ELB", _ENERGY),
    ("EBSA", "", "equivalent barrier speed of A's crush: ELA = MA EBSA^2 / 2", _VELOCITY),
    ("EBSB", "", "equivalent barrier speed of B's crush: ELB = MB EBSB^2 / 2", _VELOCITY),
    ("EL", "T - T'", "kinetic energy lost, such as in crush", _ENERGY),
    ("SA", "|v_a|", "initial speed of A", _VELOCITY),
    ("SB", "|v_b|", "initial speed of B", _VELOCITY),
    ("HA", "", "course of A before impact, from the x axis", "degree"),
    ("HB", "", "course of B before impact, from the x axis", "degree"),
    ("SAF", "|V_a|", "final speed of A", _VELOCITY),
    ("SBF", "|V_b|", "final speed of B", _VELOCITY),
    ("HAF", "", "course of A after impact, from the x axis", "degree"),
    ("HBF", "", "course of B after impact, from the x axis", "degree"),
    ("DVAF", "", "A's velocity change along its length, forward", _VELOCITY),
    ("DVAR", "", "A's velocity change across it, to its right", _VELOCITY),
    ("DVBF", "", "B's velocity change along its length, forward", _VELOCITY),
    ("DVBR", "", "B's velocity change across it, to its right", _VELOCITY),
    ("UN", "v_an", "initial normal velocity of A", _VELOCITY),
    ("UT", "v_at", "initial tangential velocity of A", _VELOCITY),
    ("VN", "v_bn", "initial normal velocity of B", _VELOCITY),
    ("VT", "v_bt", "initial tangential velocity of B", _VELOCITY),
    ("VAN", "V_an", "final normal velocity of A", _VELOCITY),
    ("VAT", "V_at", "final tangential velocity of A", _VELOCITY),
    ("VBN", "V_bn", "final normal velocity of B", _VELOCITY),
    ("VBT", "V_bt", "final tangential velocity of B", _VELOCITY),
)
"""Quantities of the chapter's other problems (Sections III, IV-C and VI), which have no name in the
listing: contact point, direction and size of the force, velocities along n and t, and others."""

FINAL_VELOCITIES = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")
VELOCITIES = ("UX", "UY", "WA", "VX", "VY", "WB")
"""The six values that lines 210 and 230 ask for, in that order."""
FINAL_STATE = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")
"""The final velocities in the order of `VELOCITIES`; `FINAL_VELOCITIES` is the listing's own."""
IMPULSES = ("PN", "PT", "PM")
COEFFICIENTS = ("E", "MUP", "EM")
"""The coefficients as results: friction as the signed P_t/P_n."""

PIVOT = -10.0  # the MU that makes the contact point a pivot (lines 260, 390 and 510)

DEFAULT_M = "6"  # M of a scene without one, as in line 350 of the published listing


def quantity(name: str) -> Quantity:
    """Return the row of a name in any table. Raises KeyError for an unknown name."""
    return SCENE.get(name) or RESULTS.get(name) or CHAPTER[name]


NO_AMOUNTS = ("title", "case", "examiner", "date", "correlations", "M")
"""Entries of a scene file that are not amounts."""


def split_names(names: Sequence[str] | str) -> Sequence[str]:
    """Return names as a sequence; a text is split at commas and blanks."""
    return names.replace(",", " ").split() if isinstance(names, str) else names


def check_names(
    names: Iterable[str], allowed: Collection[str], what: str, where: str | None = None
) -> None:
    """Raise UserError, with the closest allowed name as a hint, for a name not in ``allowed``."""
    for name in names:
        if not isinstance(name, str):
            raise UserError(f"{name!r} is not a name; expected the text of a {what}", where)
        if name not in allowed:
            hint = did_you_mean(name, allowed)
            raise UserError(f"{name!r} is not a {what}{hint} (expected {' '.join(allowed)})", where)


def did_you_mean(word: str, known: Collection[str]) -> str:
    """Return a hint at the known word closest to ``word``, "" if none is close."""
    import re
    from difflib import get_close_matches

    in_any_case = {name.lower(): name for name in known}
    # short names differ by a single letter anyway; a letter typed twice (MUU) is recognized
    likeness = 0.75 if len(word) > 3 else 1.0
    matches = get_close_matches(word.lower()[:80], in_any_case, 1, likeness)
    spelling = re.sub(r"(.)\1+", r"\1", word.lower()[:80])
    if not matches and spelling in in_any_case:
        matches = [spelling]
    return f"; did you mean {in_any_case[matches[0]]}?" if matches else ""


def missing(names: Sequence[str]) -> str:
    """Return the message that values are missing, the first three with their meaning."""
    examples = "; ".join(f"{name} ({quantity(name).meaning})" for name in names[:3])
    remainder = f" and {len(names) - 3} more" if len(names) > 3 else ""
    return f"missing {examples}{remainder}"
