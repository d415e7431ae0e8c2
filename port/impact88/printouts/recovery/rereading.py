"""The slips in a page's inputs (`slips`) that, when corrected, make it agree with itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from ..fields import INPUTS, scene_name
from ..reading.numerals import printable
from .recovered import Recovered
from .search import Column, Scored, column_of
from .slips import BITS, DIGIT, NOT_ALIKE, UNLIKE_SHAPE_BITS, Change, slip_penalty, slips_of

MAX_TWO_SLIPS_PENALTY = 2 * slip_penalty(BITS[DIGIT] + NOT_ALIKE * UNLIKE_SHAPE_BITS)
"""Prior penalty of the rarest two slips: two digits misread as those least like them."""
MAX_REREADS = 60  # scenes with corrected inputs that are replayed


class Reread(NamedTuple):
    """A replayed scene with some inputs corrected."""

    changes: tuple[Change, ...]
    scored: Scored


class Rereading:
    """Search for slips in one printout's inputs. With ``apart``, inputs that are not on the page
    but were given separately may have slips, too; their texts are taken as INPUT reads them,
    without blanks and in capitals."""

    def __init__(self, recovered: Recovered, apart: bool = False) -> None:
        self._recovered = recovered
        self._base = {name: recovered.assumed[name] for name in INPUTS if name in recovered.assumed}
        for name in recovered.apart if apart else ():
            self._base[name] = recovered.scene[scene_name(name)].replace(" ", "").upper()

    @cached_property
    def best(self) -> list[Reread]:
        """Scenes with up to two corrected inputs, those of least cost first."""
        return self._nearest(self._columns)

    def with_one(self, exchanged: Mapping[str, str]) -> list[Reread]:
        """Return scenes with one corrected input and ``exchanged`` texts in place of printed ones,
        by field, those of least cost first."""
        columns = [*self._columns]
        for name, text in exchanged.items():
            place = INPUTS.index(name)
            columns[place] = column_of(name, [(text, 0.0)], columns[place].typed)
        return self._nearest(columns, MAX_TWO_SLIPS_PENALTY / 2, 2)

    def _nearest(
        self,
        columns: Sequence[Column],
        limit: float = MAX_TWO_SLIPS_PENALTY,
        most: int = MAX_REREADS,
    ) -> list[Reread]:
        rereads = []
        for pick, scored in self._recovered.search.nearest(columns, limit, most):
            taken = zip(INPUTS, pick, strict=False)
            changes = tuple(self._slips[name][at - 1][1] for name, at in taken if at)
            rereads.append(Reread(changes, scored))
        return rereads

    @cached_property
    def _columns(self) -> list[Column]:
        """Options of every input: its text as it is, then the texts one slip away."""
        scene, columns = self._recovered.scene, []
        for name in INPUTS:
            text = self._base.get(name, scene[scene_name(name)])
            slips = [(slip.would_be, cost) for cost, slip in self._slips.get(name, [])]
            apart = name not in self._recovered.assumed
            columns.append(column_of(name, [(text, 0.0), *slips], apart))
        return [*columns, column_of("M", [(scene["M"], 0.0)], True)]

    def single_changes(self) -> Iterator[Change]:
        """Return every correction of one slip in one input."""
        return (slip for slips in self._slips.values() for _, slip in slips)

    @cached_property
    def _slips(self) -> dict[str, list[tuple[float, Change]]]:
        """Corrections of every input with their prior penalties; printed ones are printable."""
        return {
            name: [
                (cost, change)
                for cost, change in slips_of(name, text)
                if name not in self._recovered.assumed or printable(change.would_be)
            ]
            for name, text in self._base.items()
        }
