"""The side of the contact plane that A is on: the one it approaches from."""

from __future__ import annotations

from ..collision.case import Case
from ..collision.doubles import double, is_number
from ..collision.units import reorient_text
from ..names import SCENE
from .closedform.omitted import not_given
from .closedform.solve import solve
from .posed import is_wrong_way, turned, turned_sentence


def approaching(case: Case) -> Case:
    """Return a case whose GA is turned by 180 degrees, with a remark, if A is on the other side of
    the contact plane than GA says: the contact points would separate, and both centers lie beyond
    the plane or, of point masses, have no place. The same impact has GA either way round."""
    values = {n: text for n, text in case.at_nominal().values.items() if is_number(text)}
    scene = {name: double(text) for name, text in values.items() if name in SCENE}
    scene["MU"] = 0.0  # friction does not change which way the vehicles approach
    if "GA" not in case.given or not_given(scene):
        return case
    if not is_wrong_way(int(solve(scene, ("STATUS",))["STATUS"]), scene["M"] == 4):
        return case
    plane = scene["GA"]
    offset = int(turned(plane) - plane)
    text = reorient_text("GA", case.values["GA"], 1, offset, case.source)
    result = case.replaced(case.display_texts({"GA": text}))
    result.remarks["GA"] = turned_sentence(plane)
    return result
