"""Cases that differ in a value: some for the default run, the others marked as long."""

from collections.abc import Iterable, Sequence
from typing import Any

import pytest


def long_but(values: Iterable[Any], kept: Sequence[int] = (0,)) -> list[Any]:
    """Return the values of a parameter, all but those at the places ``kept`` marked as long.

    A tuple gives several parameters, as pytest has it.
    """
    found = []
    for place, value in enumerate(values):
        if place in kept:
            found.append(value)
        elif hasattr(value, "marks"):
            found.append(pytest.param(*value.values, marks=(*value.marks, pytest.mark.long)))
        else:
            several = value if type(value) is tuple else (value,)
            found.append(pytest.param(*several, marks=pytest.mark.long))
    return found
