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
from .numerals import PRINTED, spellings
from .page import ANGLES, INPUTS, NAMES
from .reader import ENDING, Reading, read_printouts

ZERO_DETERMINANT = "ZERO DETERMINANT"
CONVERTED = 1e-3
"""Relative difference from which a copy prints another number than was typed: a copy with another
pi changes last places only."""
MAX_DIGITS = 9
PROBE = "10"
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
        scenes = [{**sample(1), "M": m} for m in ("6", "4")]
        layouts = []
        for scene in scenes:
            page = self.copy.pages(scene)[0]
            readings = read_printouts(page)
            slots = [(s.glyphs, name) for r in readings for name, s in r.slots.items()]
            parts: list[str] = []
            end = 0
            for glyphs, name in sorted(slots, key=lambda slot: slot[0][0].offset):
                if name in NAMES:
                    start, stop = glyphs[0].offset, glyphs[-1].offset + 1
                    parts += [re.escape(page[end:start])] if end else []
                    parts.append(f"(?P<{name}>[-+.E0-9]+)")
                    end = stop
            layouts.append(re.compile("".join(parts)))
        return layouts

    @cached_property
    def _factors(self) -> dict[str, float]:
        """Factor by which the copy converts each input before it prints it."""
        scene = {**dict.fromkeys(sample(1), PROBE), "M": "6"}
        texts = _texts(self.copy.pages(scene)[0])
        numbers = {name: text for name, text in texts.items() if PRINTED.fullmatch(text)}
        factors = {n: float(numbers[n]) / float(PROBE) for n in INPUTS if n in numbers}
        return {name: f for name, f in factors.items() if f and abs(abs(f) - 1) > CONVERTED}

    def spellings(self, name: str, printed: str) -> tuple[str, ...]:
        """Return texts that may have been typed for a printed input, the shortest first."""
        if name not in self._factors:
            return super().spellings(name, printed)
        number = float(printed) / self._factors[name]
        texts = [f"{float(f'{number:.{k}g}'):.{MAX_DIGITS}G}" for k in range(1, MAX_DIGITS + 1)]
        scene = {key: [text] * len(texts) for key, text in sample(1).items()}
        same = self.run({**scene, name: texts}).printed(name) == printed.encode()
        return tuple(text for text, is_same in zip(texts, same, strict=True) if is_same)

    def layout(self, scene: Mapping[str, str]) -> Reading | None:
        """Return what is read of the copy's own page."""
        return next(iter(read_printouts(self.copy.pages(scene)[0])), None)


def _texts(page: str) -> dict[str, str]:
    """Return the numbers of a page by name."""
    readings = read_printouts(page)
    return {name: slot.text for reading in readings[:1] for name, slot in reading.slots.items()}
