"""All slips that are looked for. Of those that fit equally well, the first is named."""

from __future__ import annotations

from .slip import Slip
from .slipsfilling import FILLED
from .slipsreading import CONVERTED, INERTIAS, READ
from .slipsshowing import SHOWN

SLIPS: tuple[Slip, ...] = (*READ, *INERTIAS, *CONVERTED, *FILLED, *SHOWN)
