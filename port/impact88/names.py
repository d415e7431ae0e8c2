"""The table of names: name, symbol, meaning and unit of each quantity.

A scene's values have the names of the 1988 listing everywhere in this project. Every template,
table heading, help text and error message takes symbol, meaning and unit from here.

The listing is "independent of units" (User's Information): any consistent set works, except that
angles are typed and printed in degrees and spins are in radians per unit of time. So ``unit`` is a
rule ("mass·length²"), of which a system of units (`cases.units`) makes a unit.

>>> impact88.names.SCENE["MU"].meaning
'equivalent friction coefficient; -10 makes a pivot'
"""

from collections import namedtuple
from collections.abc import Collection, Iterable, Sequence
from itertools import starmap

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
    return {quantity.name: quantity for quantity in starmap(Quantity, rows)}


# unit rules
LENGTH = "length"
VELOCITY = "length/time"
MASS = "mass"
SPIN = "rad/time"
INERTIA = "mass·length²"
ENERGY = "mass·length²/time²"
FORCE = "mass·length/time²"
IMPULSE = "mass·length/time"
TURNING = "mass·length²/time"
TIME = "time"
ANGLE = "degree"
NUMBER = "1"
PERCENT = "percent"

SCENE = _table(
    ("E", "e", "coefficient of restitution", NUMBER, 280),
    ("MU", "μ", "equivalent friction coefficient; -10 makes a pivot", NUMBER, 280),
    ("EM", "e_m", "moment coefficient of restitution", NUMBER, 280),
    ("DA", "d_a", "distance from A's center of gravity to the impact point", LENGTH, 290),
    ("DB", "d_b", "distance from B's center of gravity to the impact point", LENGTH, 290),
    ("GA", "Γ", "angle of the impact surface from the y axis", ANGLE, 290),
    ("PA", "φ_a", "angle from A's length axis to its impact point", ANGLE, 290),
    ("PB", "φ_b", "angle from B's length axis to its impact point", ANGLE, 290),
    ("TA", "θ_a", "heading angle of A from the x axis; A faces TA + 180", ANGLE, 290),
    ("TB", "θ_b", "heading angle of B from the x axis", ANGLE, 290),
    ("MA", "m_a", "mass of A", MASS, 310),
    ("MB", "m_b", "mass of B", MASS, 310),
    ("IA", "I_a", "yaw moment of inertia of A", INERTIA, 310),
    ("IB", "I_b", "yaw moment of inertia of B", INERTIA, 310),
    ("UX", "v_ax", "initial x velocity of A", VELOCITY, 210),
    ("UY", "v_ay", "initial y velocity of A", VELOCITY, 210),
    ("WA", "ω_a", "initial spin of A", SPIN, 210),
    ("VX", "v_bx", "initial x velocity of B", VELOCITY, 230),
    ("VY", "v_by", "initial y velocity of B", VELOCITY, 230),
    ("WB", "ω_b", "initial spin of B", SPIN, 230),
    ("M", "M", "number of equations: 6, or 4 for point masses", NUMBER, 350),
)
"""The values of a scene, in the listing's order."""

RESULTS = _table(
    ("VAX", "V_ax", "final x velocity of A", VELOCITY, 730),
    ("VAY", "V_ay", "final y velocity of A", VELOCITY, 730),
    ("VBX", "V_bx", "final x velocity of B", VELOCITY, 740),
    ("VBY", "V_by", "final y velocity of B", VELOCITY, 740),
    ("WAF", "Ω_a", "final spin of A", SPIN, 760),
    ("WBF", "Ω_b", "final spin of B", SPIN, 760),
    ("XA", "v_Cax", "x velocity of A's contact point before impact", VELOCITY, 660),
    ("YA", "v_Cay", "y velocity of A's contact point before impact", VELOCITY, 660),
    ("XB", "v_Cbx", "x velocity of B's contact point before impact", VELOCITY, 670),
    ("YB", "v_Cby", "y velocity of B's contact point before impact", VELOCITY, 670),
    ("XAF", "V_Cax", "x velocity of A's contact point after impact", VELOCITY, 730),
    ("YAF", "V_Cay", "y velocity of A's contact point after impact", VELOCITY, 730),
    ("XBF", "V_Cbx", "x velocity of B's contact point after impact", VELOCITY, 740),
    ("YBF", "V_Cby", "y velocity of B's contact point after impact", VELOCITY, 740),
    ("VC", "-v_rn", "closing speed at C along the normal, before", VELOCITY),
    ("VS", "V_rn", "separation speed at C along the normal, after", VELOCITY),
    ("KI", "T", "kinetic energy before impact", ENERGY, 690),
    ("KF", "T'", "kinetic energy after impact", ENERGY),
    ("LOSS", "100 ΔT", "kinetic energy lost", PERCENT, 690),
    ("ELN", "ΔT_n", "kinetic energy lost along the normal", ENERGY),
    ("ELT", "ΔT_t", "kinetic energy lost along the contact surface, by friction", ENERGY),
    ("ELM", "ΔT_M", "kinetic energy lost by the moment impulse", ENERGY),
    ("EESA", "EES_a", "energy equivalent speed of A, if each takes half of the loss", VELOCITY),
    ("EESB", "EES_b", "energy equivalent speed of B, if each takes half of the loss", VELOCITY),
    ("DVA", "ΔV_a", "size of A's velocity change", VELOCITY),
    ("DVB", "ΔV_b", "size of B's velocity change", VELOCITY),
    ("PN", "P_n", "normal impulse on A", IMPULSE),
    ("PT", "P_t", "tangential impulse on A", IMPULSE),
    ("PM", "M", "moment impulse on A", TURNING),
    ("MUP", "μ", "friction coefficient as printed: signed, -10 for a pivot", NUMBER, 680),
    ("MUC", "μ_c", "critical friction coefficient: P_t/P_n of the pivot", NUMBER),
    ("COND", "κ", "condition number of the equilibrated equations, estimated", NUMBER),
    ("STATUS", "", "sum of the warning bits, see impact88.status", "bits"),
)
"""The results of an impact, in this project's order: the six final velocities first."""

CHAPTER = _table(
    ("CAX", "-d4", "x from A's center of gravity to the contact point", LENGTH),
    ("CAY", "-d3", "y from A's center of gravity to the contact point", LENGTH),
    ("CBX", "d2", "x from B's center of gravity to the contact point", LENGTH),
    ("CBY", "d1", "y from B's center of gravity to the contact point", LENGTH),
    ("CAF", "", "contact point forward of A's center of gravity", LENGTH),
    ("CAL", "", "contact point to the left of A's center of gravity", LENGTH),
    ("CBF", "", "contact point forward of B's center of gravity", LENGTH),
    ("CBL", "", "contact point to the left of B's center of gravity", LENGTH),
    ("LA", "", "overall length of A", LENGTH),
    ("BA", "", "overall width of A", LENGTH),
    ("LB", "", "overall length of B", LENGTH),
    ("BB", "", "overall width of B", LENGTH),
    ("CX", "ΔC_x", "move of the contact point along x", LENGTH),
    ("CY", "ΔC_y", "move of the contact point along y", LENGTH),
    ("RR0", "R/R_0", "final over initial relative spin that the moment alone makes", NUMBER),
    ("PDOFA", "", "force on A comes from, clockwise from its front", ANGLE),
    ("PDOFB", "", "force on B comes from, clockwise from its front", ANGLE),
    ("P", "P", "size of the impulse", IMPULSE),
    ("TF", "t_f", "duration of contact", TIME),
    ("FA", "F_A", "average force during contact", FORCE),
    ("FM2", "F_M", "peak force, at twice the average", FORCE),
    ("FM3", "F_M", "peak force, at three times the average", FORCE),
    ("DT", "ΔT", "fraction of the kinetic energy lost", NUMBER),
    ("ELA", "", "energy lost in A, such as in crush: EL = ELA + ELB", ENERGY),
    ("ELB", "", "energy lost in B, such as in crush: EL = ELA + ELB", ENERGY),
    ("EBSA", "", "equivalent barrier speed of A's crush: ELA = MA EBSA^2 / 2", VELOCITY),
    ("EBSB", "", "equivalent barrier speed of B's crush: ELB = MB EBSB^2 / 2", VELOCITY),
    ("EL", "T - T'", "kinetic energy lost, such as in crush", ENERGY),
    ("SA", "|v_a|", "initial speed of A", VELOCITY),
    ("SB", "|v_b|", "initial speed of B", VELOCITY),
    ("HA", "", "course of A before impact, from the x axis", ANGLE),
    ("HB", "", "course of B before impact, from the x axis", ANGLE),
    ("SAF", "|V_a|", "final speed of A", VELOCITY),
    ("SBF", "|V_b|", "final speed of B", VELOCITY),
    ("HAF", "", "course of A after impact, from the x axis", ANGLE),
    ("HBF", "", "course of B after impact, from the x axis", ANGLE),
    ("DVAF", "", "A's velocity change along its length, forward", VELOCITY),
    ("DVAR", "", "A's velocity change across it, to its right", VELOCITY),
    ("DVBF", "", "B's velocity change along its length, forward", VELOCITY),
    ("DVBR", "", "B's velocity change across it, to its right", VELOCITY),
    ("UN", "v_an", "initial normal velocity of A", VELOCITY),
    ("UT", "v_at", "initial tangential velocity of A", VELOCITY),
    ("VN", "v_bn", "initial normal velocity of B", VELOCITY),
    ("VT", "v_bt", "initial tangential velocity of B", VELOCITY),
    ("VAN", "V_an", "final normal velocity of A", VELOCITY),
    ("VAT", "V_at", "final tangential velocity of A", VELOCITY),
    ("VBN", "V_bn", "final normal velocity of B", VELOCITY),
    ("VBT", "V_bt", "final tangential velocity of B", VELOCITY),
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
SPINS = ("WA", "WB", "WAF", "WBF")
UNKNOWNS = (*VELOCITIES, *FINAL_STATE, *COEFFICIENTS)
"""Quantities that an impact can be solved for, from other values."""

PIVOT = -10.0  # the MU that makes the contact point a pivot (lines 260, 390 and 510)

DEFAULT_M = "6"  # M of a scene without one, as in line 350 of the published listing


def quantity(name: str) -> Quantity:
    """Return the row of a name in any table. Raises KeyError for an unknown name."""
    return SCENE.get(name) or RESULTS.get(name) or CHAPTER[name]


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


LIKENESS = 0.75  # of a hint: MUU is like MU (0.8), VAX is not like VAY (0.67)


def did_you_mean(word: str, known: Collection[str]) -> str:
    """Return a hint at the known word closest to ``word``, "" if none is close."""
    from difflib import get_close_matches

    in_any_case = {name.lower(): name for name in known}
    letters = word.lower()[:80]
    matches = [name for name in in_any_case if sorted(name) == sorted(letters)]
    matches += get_close_matches(letters, in_any_case, 1, LIKENESS)
    return f"; did you mean {in_any_case[matches[0]]}?" if matches else ""


def missing(names: Sequence[str]) -> str:
    """Return the message that values are missing, the first three with their meaning."""
    examples = "; ".join(f"{name} ({quantity(name).meaning})" for name in names[:3])
    remainder = f" and {len(names) - 3} more" if len(names) > 3 else ""
    return f"missing {examples}{remainder}"
