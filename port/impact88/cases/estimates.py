"""Estimates of a yaw inertia that was not measured.

``IA = "estimate"`` (also ``"estimate +- 20 %"``) takes one of two rules:

- with the vehicle's length and width given as LA and BA, a uniform rectangle, m (L² + W²)/12. Cars
  carry less of their mass at the corners: it is 6 to 14 % high on seven crash-tested vehicles.
- from the weight alone, a line fitted to passenger cars measured by NHTSA, 1.03 W - 1206 in
  lb-ft-s² for W in lb (Garrott, Monk and Chrstos, SAE paper 881767, 1988, as later texts quote it;
  the paper itself was not at hand). On the same seven vehicles it is 6 to 29 % high, most for sport
  utilities and light trucks. Other weights than passenger cars' are refused.
"""

from __future__ import annotations

from collections.abc import Mapping

from ..decimals import to_text
from ..errors import UserError
from ..names import INERTIA, MASS
from .amounts import Amount
from .units import POUND, View, unit_of

ESTIMATE = "estimate"
SIZES = {"A": ("LA", "BA"), "B": ("LB", "BB")}
"""Length and width of each vehicle: for an estimate of its inertia, and its outline in drawings."""
MIN_WEIGHT = 1500  # lb; cars of the fitted sample lie between these two
MAX_WEIGHT = 6000  # lb
SLOPE = 1.03  # ft-s² for each lb, as published
OFFSET = 1206.0  # lb-ft-s², as published


def is_estimate(entry: tuple[str, str]) -> bool:
    """Return True for name and text of a yaw inertia that is to be estimated."""
    name, text = entry
    return name in ("IA", "IB") and text.startswith(ESTIMATE)


def estimate(name: str, text: str, amounts: Mapping[str, Amount], view: View) -> tuple[str, str]:
    """Return the entry of an estimated yaw inertia, of four digits in units of the view, and a
    remark.

    Parameters
    ----------
    name : {"IA", "IB"}
        The inertia.
    text : str
        The entry as written: what follows its first word, a tolerance, is kept.
    amounts : mapping of str to Amount
        The mass, and the length and width if they are known.
    view : View
        Its units are those of the result.

    Raises
    ------
    UserError
        Without a mass; without length and width, for the weight of no passenger car, and without
        units.
    """
    mass, pair = amounts.get(f"M{name[1]}"), SIZES[name[1]]
    if mass is None or not mass.value > 0:
        raise UserError(f"{name} = {ESTIMATE} needs M{name[1]} above 0")
    sizes = [amounts[size].value for size in pair if size in amounts]
    pounds = round(mass.value * float(view.base_size(MASS) / POUND), 6)  # 1,500 lb from kg
    if len(sizes) == 2:
        value = mass.value * (sizes[0] ** 2 + sizes[1] ** 2) / 12
        rule = "mass (length² + width²)/12, a uniform rectangle; 6 to 14 % high on seven cars"
    elif view.units and not sizes and MIN_WEIGHT <= pounds <= MAX_WEIGHT:
        unit = float(unit_of(INERTIA, "lb-ft-s2").size / view.base_size(INERTIA))
        value = (SLOPE * pounds - OFFSET) * unit
        rule = (
            f"{SLOPE} times the mass in lb, less {OFFSET:.0f} lb-ft-s2, for passenger cars; "
            "6 to 29 % high on seven of them"
        )
    else:
        raise UserError(
            f"{name} = {ESTIMATE} from the weight is for passenger cars of {MIN_WEIGHT:,} to "
            f'{MAX_WEIGHT:,} lb, with units = "us" or another; expected {name}, or '
            f"{' and '.join(pair)}"
        )
    number = f"{to_text(float(f'{value:.4g}'))} {view.unit(name)}"
    return number + text.removeprefix(ESTIMATE), f"{name} = {number} is estimated: {rule}"
