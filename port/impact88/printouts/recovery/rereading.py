"""The slips in a page's inputs (`slips`) that, when corrected, make it agree with itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import NamedTuple

from ...collision.fields import INPUTS, scene_name
from ..reading.numerals import printable
from .recovered import Recovered
from .search import Column, Scored, column_of, one_each
from .slips import Change, slips_of

MAX_TWO_SLIPS_PENALTY = 6.05
"""Prior penalty of the rarest two slips: two digits misread as those least like them, 3.02 each."""
MAX_REPLAYED_SLIPS = 60  # combinations of slips that are replayed
MAX_SLIP_COMBINATIONS = 100_000  # combinations of slips that are screened


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

    def best(
        self, single: bool = False, exchanged: Mapping[str, str] | None = None
    ) -> list[Reread]:
        """Return scenes with up to two corrected inputs, those of least cost first.

        ``single``: correct one input only; ``exchanged``: texts that replace printed ones, by
        field, and are not corrected further.
        """
        columns = [*self._columns]
        for name, text in (exchanged or {}).items():
            place = INPUTS.index(name)
            columns[place] = column_of(name, [(text, 0.0)], columns[place].typed)
        search = self._recovered.search
        if single:
            count = 2 if exchanged else MAX_REPLAYED_SLIPS
            picks = search.screen(columns, one_each(columns), count)
        else:
            wrong = self._recovered.wrong
            picks = search.find_candidates(
                columns,
                MAX_SLIP_COMBINATIONS,
                MAX_REPLAYED_SLIPS,
                MAX_TWO_SLIPS_PENALTY,
                wrong,
            )
        rereads = []
        for pick, scored in zip(picks.tolist(), search.replay(columns, picks), strict=True):
            taken = zip(INPUTS, pick, strict=False)
            changes = tuple(self._slips[name][at - 1][1] for name, at in taken if at)
            rereads.append(Reread(changes, scored))
        return sorted(rereads, key=lambda reread: reread.scored.cost)

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
