"""All slips that are looked for. Of those that fit equally well, the first is named."""

from __future__ import annotations

from .slip import Slip
from .slipsfilling import FILLED, TERMS
from .slipsreading import CONVERTED, INERTIAS, READ
from .slipsshowing import SHOWN

SLIPS: tuple[Slip, ...] = (*READ, *CONVERTED, *FILLED, *SHOWN, *INERTIAS)
"""What is tried first."""
RARE: tuple[Slip, ...] = TERMS
"""What is tried where those do not explain a table."""
READINGS: tuple[Slip, ...] = (*READ, *INERTIAS)
"""What is tried in one equation only, where the results violate that one alone."""
