"""The side of the contact plane that A is on: the one it approaches from."""

from __future__ import annotations

from ..collision.case import Case
from ..collision.doubles import double, is_number
from ..collision.geometry import GEOMETRY
from ..collision.units import reorient_text
from ..names import VELOCITIES
from .outcome import outcome
from .posed import is_meant_turned, turned, turned_sentence


def approaching(case: Case) -> Case:
    """Return a case whose GA is turned by 180 degrees, with a remark, if A is on the other side of
    the contact plane than GA says: the contact points would separate, and both centers lie beyond
    the plane or, of point masses, have no place. The same impact has GA either way round."""
    texts = case.at_nominal().values
    names = [name for name in ("M", *GEOMETRY, *VELOCITIES) if is_number(texts.get(name, ""))]
    values = {name: double(texts[name]) for name in names}
    if not {"GA", "MA", "MB"} <= {*names} or "GA" not in case.given:
        return case
    plane = values["GA"]
    here, there = (int(outcome({**values, "GA": ga})["STATUS"]) for ga in (plane, turned(plane)))
    if not is_meant_turned(here, there, values["M"] == 4):
        return case
    text = reorient_text("GA", case.values["GA"], 1, int(turned(plane) - plane), case.source)
    result = case.replaced(case.display_texts({"GA": text}))
    result.remarks["GA"] = turned_sentence(plane)
    return result
