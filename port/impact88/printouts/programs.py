"""The program that may have printed a page: the restored listing, or an office's copy of it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.copies import ListingCopy
from ..program.replay import replay
from ..program.scene import sample
from .numerals import spellings
from .page import ANGLES, INPUTS, NAMES
from .reader import ENDING, Reading, read_printouts

ZERO_DETERMINANT = "ZERO DETERMINANT"
PROBE = "10"
"""A number that copies are given for every input, to see which they convert."""
CONVERTED = 1e-2
"""Difference from which a copy prints another number: one with another pi changes last places."""
Columns = Mapping[str, Sequence[str]]


class Outcomes(NamedTuple):
    """Printed output of a program for scenes: numbers, with a row for each scene and a column for
    each name of `NAMES`, "" for none; and the message that ends each, "" for a normal end."""

    fields: NDArray[np.bytes_]
    endings: NDArray[np.str_]

    def printed(self, name: str) -> NDArray[np.bytes_]:
        """Return a number of each scene."""
        return self.fields[:, NAMES.index(name)]

    def texts(self, row: int) -> dict[str, str]:
        """Return the numbers of a scene, by name."""
        texts = [text.decode() for text in self.fields[row].tolist()]
        return {name: text for name, text in zip(NAMES, texts, strict=True) if text}


class Listing:
    """The restored listing."""

    def run(self, columns: Columns) -> Outcomes:
        """Return what the program prints for scenes.

        Parameters
        ----------
        columns : mapping of str to sequence of str
            The scenes as typed.

        Returns
        -------
        Outcomes
            Numbers and endings.
        """
        results = replay(columns)
        endings = np.where(results.zero_determinant, ZERO_DETERMINANT, results.error)
        return Outcomes(results.fields, endings)

    def spellings(self, name: str, printed: str) -> tuple[str, ...]:
        """Return texts that may have been typed for a printed input, the likeliest first."""
        return spellings(printed, name in ANGLES)

    def layout(self, scene: Mapping[str, str]) -> Reading | None:
        """Return what is read of the program's own page, None if that is the listing's layout."""
        return None


class CopyListing(Listing):
    """An office's copy of the listing.

    Parameters
    ----------
    copy : ListingCopy
        The copy.
    """

    def __init__(self, copy: ListingCopy) -> None:
        self.copy = copy

    def run(self, columns: Columns) -> Outcomes:
        """Return what the copy prints for scenes. Parameters as for `Listing.run`."""
        pages = self.copy.pages(columns)
        rows = []
        for page in pages:
            match = next(filter(None, (layout.search(page) for layout in self._layouts)), None)
            texts = match.groupdict() if match else {}
            rows.append([texts.get(name) or "" for name in NAMES])
        endings = [ending[0] if (ending := ENDING.search(page)) else "" for page in pages]
        return Outcomes(np.array(rows, bytes), np.array(endings))

    @cached_property
    def _layouts(self) -> list[re.Pattern[str]]:
        """The copy's pages with and without final spins, with a group for each number."""
        layouts = []
        for m in ("6", "4"):
            page = self.copy.pages({**sample(1), "M": m})[0]
            slots = {name: slot for r in read_printouts(page) for name, slot in r.slots.items()}
            starts = {slots[name].glyphs[0].offset: name for name in NAMES if name in slots}
            pattern, end = "", min(starts, default=0)
            for start, name in sorted(starts.items()):
                pattern += re.escape(page[end:start]) + f"(?P<{name}>[-+.E0-9]+)"
                end = slots[name].glyphs[-1].offset + 1
            layouts.append(re.compile(pattern))
        return layouts

    @cached_property
    def _converted(self) -> set[str]:
        """Inputs of which the copy prints another number than was typed."""
        page = self.run({**dict.fromkeys(sample(1), PROBE), "M": "6"}).texts(0)
        numbers = {name: abs(float(page[name])) for name in INPUTS if name in page}
        return {name for name, number in numbers.items() if abs(number - float(PROBE)) > CONVERTED}

    def spellings(self, name: str, printed: str) -> tuple[str, ...]:
        """Return texts that may have been typed for a printed input, none if it was converted."""
        return () if name in self._converted else super().spellings(name, printed)

    def layout(self, scene: Mapping[str, str]) -> Reading | None:
        """Return what is read of the copy's own page."""
        return next(iter(read_printouts(self.copy.pages(scene)[0])), None)
