"""The one table of names: what each quantity is called, means and is measured in.

A scene's numbers carry the names the 1988 listing gives them, everywhere in this project. Every
template, table heading, help text and error message takes symbol, meaning and unit from here.

Units: the listing is "independent of units" (User's Information): any consistent set will do,
except that angles are typed and printed in degrees and spins are always radians per unit of time.
So a unit here is a rule ("mass·length²"), not a unit.

>>> impact88.names.SCENE["MU"].meaning
'equivalent friction coefficient; -10 makes a pivot'
"""

from collections import namedtuple
from collections.abc import Collection, Iterable, Sequence

from .errors import UserError


class Quantity(namedtuple("Quantity", ("name", "symbol", "meaning", "unit", "line"))):
    """One row of the table. ``name``: the listing's variable, or this project's name for what the
    listing leaves unnamed; ``symbol``: the chapter's symbol (List of Symbols); ``meaning``: in
    words; ``unit``: the unit rule; ``line``: the listing line that sets or asks for it (scene) or
    prints it (results; 0 when the listing has no such value)."""

    __slots__ = ()


_VELOCITY = "length/time"
_SPIN = "rad/time"

SCENE: dict[str, Quantity] = {
    quantity.name: quantity
    for quantity in (
        Quantity("E", "e", "coefficient of restitution", "1", 280),
        Quantity("MU", "μ", "equivalent friction coefficient; -10 makes a pivot", "1", 280),
        Quantity("EM", "e_m", "moment coefficient of restitution", "1", 280),
        Quantity(
            "DA", "d_a", "distance from A's center of gravity to the impact point", "length", 290
        ),
        Quantity(
            "DB", "d_b", "distance from B's center of gravity to the impact point", "length", 290
        ),
        Quantity("GA", "Γ", "angle of the impact surface from the y axis", "degree", 290),
        Quantity("PA", "φ_a", "angle from A's length axis to its impact point", "degree", 290),
        Quantity("PB", "φ_b", "angle from B's length axis to its impact point", "degree", 290),
        Quantity("TA", "θ_a", "heading angle of A from the x axis", "degree", 290),
        Quantity("TB", "θ_b", "heading angle of B from the x axis", "degree", 290),
        Quantity("MA", "m_a", "mass of A", "mass", 310),
        Quantity("MB", "m_b", "mass of B", "mass", 310),
        Quantity("IA", "I_a", "yaw moment of inertia of A", "mass·length²", 310),
        Quantity("IB", "I_b", "yaw moment of inertia of B", "mass·length²", 310),
        Quantity("UX", "v_ax", "initial x velocity of A", _VELOCITY, 210),
        Quantity("UY", "v_ay", "initial y velocity of A", _VELOCITY, 210),
        Quantity("WA", "ω_a", "initial spin of A", _SPIN, 210),
        Quantity("VX", "v_bx", "initial x velocity of B", _VELOCITY, 230),
        Quantity("VY", "v_by", "initial y velocity of B", _VELOCITY, 230),
        Quantity("WB", "ω_b", "initial spin of B", _SPIN, 230),
        Quantity("M", "M", "number of equations: 6, or 4 for point masses", "1", 350),
    )
}
"""What a scene is made of, in the listing's order."""

RESULTS: dict[str, Quantity] = {
    quantity.name: quantity
    for quantity in (
        Quantity("VAX", "V_ax", "final x velocity of A", _VELOCITY, 730),
        Quantity("VAY", "V_ay", "final y velocity of A", _VELOCITY, 730),
        Quantity("VBX", "V_bx", "final x velocity of B", _VELOCITY, 740),
        Quantity("VBY", "V_by", "final y velocity of B", _VELOCITY, 740),
        Quantity("WAF", "Ω_a", "final spin of A", _SPIN, 760),
        Quantity("WBF", "Ω_b", "final spin of B", _SPIN, 760),
        Quantity("XA", "v_Cax", "x velocity of A's contact point before impact", _VELOCITY, 660),
        Quantity("YA", "v_Cay", "y velocity of A's contact point before impact", _VELOCITY, 660),
        Quantity("XB", "v_Cbx", "x velocity of B's contact point before impact", _VELOCITY, 670),
        Quantity("YB", "v_Cby", "y velocity of B's contact point before impact", _VELOCITY, 670),
        Quantity("XAF", "V_Cax", "x velocity of A's contact point after impact", _VELOCITY, 730),
        Quantity("YAF", "V_Cay", "y velocity of A's contact point after impact", _VELOCITY, 730),
        Quantity("XBF", "V_Cbx", "x velocity of B's contact point after impact", _VELOCITY, 740),
        Quantity("YBF", "V_Cby", "y velocity of B's contact point after impact", _VELOCITY, 740),
        Quantity("VC", "-v_rn", "closing speed at C along the normal, before", _VELOCITY, 0),
        Quantity("VS", "V_rn", "separation speed at C along the normal, after", _VELOCITY, 0),
        Quantity("KI", "T", "kinetic energy before impact", "mass·length²/time²", 690),
        Quantity("KF", "T'", "kinetic energy after impact", "mass·length²/time²", 0),
        Quantity("LOSS", "100 ΔT", "kinetic energy lost", "percent", 690),
        Quantity("DVA", "ΔV_a", "size of A's velocity change", _VELOCITY, 0),
        Quantity("DVB", "ΔV_b", "size of B's velocity change", _VELOCITY, 0),
        Quantity("PN", "P_n", "normal impulse on A", "mass·length/time", 0),
        Quantity("PT", "P_t", "tangential impulse on A", "mass·length/time", 0),
        Quantity("PM", "M", "moment impulse on A", "mass·length²/time", 0),
        Quantity("MUP", "μ", "friction coefficient as printed: signed, -10 for a pivot", "1", 680),
        Quantity("MUC", "μ_c", "critical friction coefficient: P_t/P_n of the pivot", "1", 0),
        Quantity("COND", "κ", "condition number of the equilibrated equations, estimated", "1", 0),
        Quantity("STATUS", "", "sum of the warning bits, see impact88.status", "bits", 0),
    )
}
"""What an impact yields, in this project's order: the six final velocities first."""

_LENGTH = "length"
_FORCE = "mass·length/time²"
_ENERGY = "mass·length²/time²"

CHAPTER: dict[str, Quantity] = {
    quantity.name: quantity
    for quantity in (
        Quantity("CAX", "-d4", "x from A's center of gravity to the contact point", _LENGTH, 0),
        Quantity("CAY", "-d3", "y from A's center of gravity to the contact point", _LENGTH, 0),
        Quantity("CBX", "d2", "x from B's center of gravity to the contact point", _LENGTH, 0),
        Quantity("CBY", "d1", "y from B's center of gravity to the contact point", _LENGTH, 0),
        Quantity("CAF", "", "contact point forward of A's center of gravity", _LENGTH, 0),
        Quantity("CAL", "", "contact point to the left of A's center of gravity", _LENGTH, 0),
        Quantity("CBF", "", "contact point forward of B's center of gravity", _LENGTH, 0),
        Quantity("CBL", "", "contact point to the left of B's center of gravity", _LENGTH, 0),
        Quantity("LA", "", "overall length of A", _LENGTH, 0),
        Quantity("BA", "", "overall width of A", _LENGTH, 0),
        Quantity("LB", "", "overall length of B", _LENGTH, 0),
        Quantity("BB", "", "overall width of B", _LENGTH, 0),
        Quantity("CX", "ΔC_x", "move of the contact point along x", _LENGTH, 0),
        Quantity("CY", "ΔC_y", "move of the contact point along y", _LENGTH, 0),
        Quantity(
            *("RR0", "R/R_0", "final over initial relative spin that the moment alone makes"),
            *("1", 0),
        ),
        Quantity("PDOFA", "", "force on A comes from, clockwise from its front", "degree", 0),
        Quantity("PDOFB", "", "force on B comes from, clockwise from its front", "degree", 0),
        Quantity("P", "P", "size of the impulse", "mass·length/time", 0),
        Quantity("TF", "t_f", "duration of contact", "time", 0),
        Quantity("FA", "F_A", "average force during contact", _FORCE, 0),
        Quantity("FM2", "F_M", "peak force, at twice the average", _FORCE, 0),
        Quantity("FM3", "F_M", "peak force, at three times the average", _FORCE, 0),
        Quantity("DT", "ΔT", "fraction of the kinetic energy lost", "1", 0),
        Quantity("ELA", "", "energy lost in A, such as in crush: EL = ELA + ELB", _ENERGY, 0),
        Quantity("ELB", "", "energy lost in B, such as in crush: EL = ELA + ELB", _ENERGY, 0),
        Quantity("EL", "T - T'", "kinetic energy lost, such as in crush", _ENERGY, 0),
        Quantity("SA", "|v_a|", "initial speed of A", _VELOCITY, 0),
        Quantity("SB", "|v_b|", "initial speed of B", _VELOCITY, 0),
        Quantity("HA", "", "course of A before impact, from the x axis", "degree", 0),
        Quantity("HB", "", "course of B before impact, from the x axis", "degree", 0),
        Quantity("SAF", "|V_a|", "final speed of A", _VELOCITY, 0),
        Quantity("SBF", "|V_b|", "final speed of B", _VELOCITY, 0),
        Quantity("HAF", "", "course of A after impact, from the x axis", "degree", 0),
        Quantity("HBF", "", "course of B after impact, from the x axis", "degree", 0),
        Quantity("DVAF", "", "A's velocity change along its length, forward", _VELOCITY, 0),
        Quantity("DVAR", "", "A's velocity change across it, to its right", _VELOCITY, 0),
        Quantity("DVBF", "", "B's velocity change along its length, forward", _VELOCITY, 0),
        Quantity("DVBR", "", "B's velocity change across it, to its right", _VELOCITY, 0),
        Quantity("UN", "v_an", "initial normal velocity of A", _VELOCITY, 0),
        Quantity("UT", "v_at", "initial tangential velocity of A", _VELOCITY, 0),
        Quantity("VN", "v_bn", "initial normal velocity of B", _VELOCITY, 0),
        Quantity("VT", "v_bt", "initial tangential velocity of B", _VELOCITY, 0),
        Quantity("VAN", "V_an", "final normal velocity of A", _VELOCITY, 0),
        Quantity("VAT", "V_at", "final tangential velocity of A", _VELOCITY, 0),
        Quantity("VBN", "V_bn", "final normal velocity of B", _VELOCITY, 0),
        Quantity("VBT", "V_bt", "final tangential velocity of B", _VELOCITY, 0),
    )
}
"""What the chapter's other problems add (Sections III, IV-C and VI), which the listing has no name
for: contact point, direction and size of the force, velocities along n and t."""

FINAL_VELOCITIES = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")
VELOCITIES = ("UX", "UY", "WA", "VX", "VY", "WB")
"""The six values lines 210 and 230 ask for, in that order."""
FINAL_STATE = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")
"""The final velocities in the order of `VELOCITIES`; `FINAL_VELOCITIES` is the listing's own."""
IMPULSES = ("PN", "PT", "PM")
COEFFICIENTS = ("E", "MUP", "EM")
"""The coefficients as they may be asked for: friction as the signed P_t/P_n."""

PIVOT = -10.0
"""MU that makes the contact point a pivot (lines 260, 390 and 510)."""

DEFAULT_M = "6"
"""M where a scene does not give it: the published listing's line 350."""


def quantity(name: str) -> Quantity:
    """Symbol, meaning and unit of a value of any table. Raises KeyError for no name of theirs."""
    return SCENE.get(name) or RESULTS.get(name) or CHAPTER[name]


def listed(names: Sequence[str] | str) -> Sequence[str]:
    """Names given one by one, or in one text between commas or blanks."""
    return names.replace(",", " ").split() if isinstance(names, str) else names


def check_names(
    names: Iterable[str], allowed: Collection[str], what: str, where: str | None = None
) -> None:
    """Raises UserError, with a hint where one is near, for a name that is not ``allowed``."""
    for name in names:
        if name not in allowed:
            hint = did_you_mean(name, allowed)
            raise UserError(f"{name!r} is not a {what}{hint} (expected {' '.join(allowed)})", where)


def did_you_mean(word: str, known: Collection[str]) -> str:
    """A hint at the known word that ``word`` comes near to, or nothing."""
    from difflib import get_close_matches

    in_any_case = {name.lower(): name for name in known}
    # short names differ by one letter anyway
    likeness = 0.75 if len(word) > 3 else 1.0
    near = get_close_matches(word.lower()[:80], in_any_case, 1, likeness)
    return f"; did you mean {in_any_case[near[0]]}?" if near else ""


def missing(names: Sequence[str]) -> str:
    """Says that values are missing, the first three with their meaning."""
    wanted = "; ".join(f"{name} ({quantity(name).meaning})" for name in names[:3])
    more = f" and {len(names) - 3} more" if len(names) > 3 else ""
    return f"missing {wanted}{more}"
