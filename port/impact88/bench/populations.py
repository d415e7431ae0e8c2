"""Populations of scenes to measure on: seeded, named, each with what makes it hard.

Every population is a function of a random generator and a count that returns scene name -> array.
The numbers are given with few decimal digits, as people type them, so that the same scene can be
typed into the 1988 program: `texts` gives the decimal texts.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Columns = dict[str, Floats]
Generator = np.random.Generator


class Population(NamedTuple):
    """``level``: easy, average or hard, by the condition number of its equations."""

    name: str
    level: str
    meaning: str
    make: Callable[[Generator, int], Columns]


def _rounded(columns: Columns, digits: int = 6) -> Columns:
    """To ``digits`` significant decimal digits: what a person types."""
    out: Columns = {}
    for name, values in columns.items():
        values = np.asarray(values, dtype=np.float64)
        if name == "M" or (name == "MU" and np.all(values == -10)):
            out[name] = values
            continue
        with np.errstate(divide="ignore"):
            place = digits - 1 - np.floor(np.log10(np.abs(values)))
        place = np.where(np.isfinite(place), place, 0)
        out[name] = np.array([float(f"{v:.{digits - 1}e}") for v in values.ravel()]).reshape(
            values.shape
        )
    return out


def casework(rng: Generator, count: int) -> Columns:
    """Cars as in the chapter's Table 1, feet and slugs: what the program was written for."""
    uniform = rng.uniform
    return _rounded(
        {
            "E": uniform(0, 0.4, count),
            "MU": uniform(-1, 1, count),
            "EM": uniform(-1, 0, count),
            "DA": uniform(0.5, 9, count),
            "DB": uniform(0.5, 9, count),
            "GA": uniform(-90, 90, count),
            "PA": uniform(-180, 180, count),
            "PB": uniform(-180, 180, count),
            "TA": uniform(-180, 180, count),
            "TB": uniform(-180, 180, count),
            "MA": uniform(60, 200, count),
            "MB": uniform(60, 200, count),
            "IA": uniform(900, 5000, count),
            "IB": uniform(900, 5000, count),
            "UX": uniform(-90, 90, count),
            "UY": uniform(-90, 90, count),
            "WA": np.where(rng.random(count) < 0.5, 0.0, uniform(-2, 2, count)),
            "VX": uniform(-90, 90, count),
            "VY": uniform(-90, 90, count),
            "WB": np.where(rng.random(count) < 0.5, 0.0, uniform(-2, 2, count)),
            "M": np.full(count, 6.0),
        }
    )
