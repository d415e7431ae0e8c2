"""One scene as a table, with values that run through ranges."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from math import prod

import numpy as np

from ..cases.case import Case
from ..decimals import to_double, to_text
from ..errors import UserError, quoted
from ..names import SCENE, check_names
from .textformats import Table, blocks_of

MAX_SCENES = 10_000_000  # of one sweep; time and memory grow with them


def sweep_table(case: Case, ranges: Mapping[str, str]) -> Table:
    """Return a table of one scene, a row for each combination of ranges.

    Parameters
    ----------
    case : Case
        The scene.
    ranges : mapping of str to str
        LOW:HIGH:COUNT by name, in the units of the case; the last name runs fastest.

    Returns
    -------
    Table
        The columns of the ranges, in the case's view.

    Raises
    ------
    UserError
        For a text that is no range, and for more than 10 million rows.
    """
    check_names(ranges, tuple(SCENE), "value of a scene", "--sweep")
    values = {case.view.heading(n): _values(n, text) for n, text in ranges.items()}
    if prod(map(len, values.values())) > MAX_SCENES:
        raise UserError(f"--sweep: more than {MAX_SCENES:,} scenes; expected fewer")
    rows = enumerate(product(*values.values()), 1)
    return Table([*values], blocks_of(rows), case.source)


def _values(name: str, text: str) -> list[str]:
    """Return the texts that a value runs through. Raises UserError."""
    try:
        low, high, count = text.split(":")
        if not 1 <= int(count) <= MAX_SCENES:
            raise ValueError
        values = np.linspace(to_double(low), to_double(high), int(count))
    except ValueError:
        raise UserError(
            f"{name}: {quoted(text)} is not LOW:HIGH:COUNT, such as 0:1:51, in units of the file",
            "--sweep",
        ) from None
    return [to_text(value) for value in values.tolist()]
