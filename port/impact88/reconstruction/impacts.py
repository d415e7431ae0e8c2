"""Impacts of a reconstruction, over arrays: every quantity by name.

An impact is determined by six velocities, each before or after it, and for each of the three laws
(restitution, friction, moment) either its coefficient or its impulse (`mechanics.inverse`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanics.formulas import sine_and_cosine
from ..mechanics.inverse import complete
from ..mechanics.solve import evaluate
from ..names import COEFFICIENTS as COEFFICIENTS
from ..names import FINAL_STATE, RESULTS, VELOCITIES
from ..names import IMPULSES as IMPULSES
from ..names import PIVOT as PIVOT

Array = NDArray[np.float64]

BEFORE = VELOCITIES
AFTER = FINAL_STATE
VEHICLES = ("MA", "MB", "IA", "IB", "DA", "DB", "PA", "PB", "TA", "TB", "GA")
SPEEDS = {"SA": ("UX", "UY"), "SB": ("VX", "VY"), "SAF": ("VAX", "VAY"), "SBF": ("VBX", "VBY")}
COURSES = {"HA": "SA", "HB": "SB", "HAF": "SAF", "HBF": "SBF"}
FORCES = ("PDOFA", "PDOFB")
_ORDERED = (
    *BEFORE,
    *AFTER,
    *"SA HA SB HB SAF HAF SBF HBF E MUP EM PN PT PM P DVA DVB DVAF DVAR DVBF DVBR".split(),
    *"PDOFA PDOFB VC VS KI KF EL LOSS DT MUC RR0 ELN ELT ELM EESA EESB".split(),
    *"XA YA XB YB XAF YAF XBF YBF CAX CAY CBX CBY".split(),
)
EVERY = (*_ORDERED, *(name for name in RESULTS if name not in (*_ORDERED, "COND", "STATUS")))
"""Results of an impact, in the order shown; those of `names` without a place here come last."""


class Impacts(dict[str, Any]):
    """Impacts with all that follows from them.

    Parameters
    ----------
    known : mapping of str to float or array
        M and `VEHICLES`; each velocity before or after; each law's coefficient or impulse.
    """

    def __init__(self, known: Mapping[str, Any]) -> None:
        completed = complete(known)
        # points are bodies without arms and spins, and keep their headings
        super().__init__(completed.values, M=6.0)
        self.log_volume = completed.log_volume

    def compute(self, names: Sequence[str]) -> None:
        """Compute several quantities in one pass; they are NaN where they do not follow."""
        absent = tuple(name for name in names if name not in self)
        if absent:
            values, missing = evaluate(self, absent)
            self.update(values, **dict.fromkeys(missing, np.nan))

    def __missing__(self, name: str) -> Any:
        """Return a quantity by name; the first that is not there is computed with all results."""
        self.compute((*EVERY, name))
        return self[name]


def components(size: Any, direction: Any) -> tuple[Any, Any]:
    """Return the components along x and y of a size in a direction in degrees."""
    sine, cosine = sine_and_cosine(np.asarray(direction, np.float64))
    return size * cosine, size * sine
