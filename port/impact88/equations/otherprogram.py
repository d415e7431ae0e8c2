"""Programs that have something wrong: a spelling with edits."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .edits import Edit
from .evaluation import Columns, Run
from .spelling import LISTING, SHOWN, Spelling, spellings


class Program(NamedTuple):
    """A spelling with edits, each made on top of those before it."""

    edits: tuple[Edit, ...] = ()

    @property
    def says(self) -> str:
        """What is wrong with it."""
        said = []
        for place, edit in enumerate(self.edits):
            later = {key for other in self.edits[place + 1 :] for key in other.sides}
            if edit.says or not later.issuperset(edit.sides):
                said.append(edit.text)
        return "; and ".join(sorted(said, key=lambda one: "should be" in one))

    @property
    def spelling(self) -> Spelling:
        """The spelling its edits are of, with them."""
        whole = spellings()[next((edit.title for edit in self.edits if edit.title), LISTING)]
        for edit in self.edits:
            whole = whole.edited(edit.sides)
        return whole

    def results(self, scene: Columns) -> dict[str, Any]:
        """All that the program shows for scenes (columns of n), by name."""
        names = Run(self.spelling, scene).names
        size = max(np.size(column) for column in scene.values())
        return {
            name.removeprefix(SHOWN): np.broadcast_to(column, (1, size))[0]
            for name, column in names.items()
            if name.startswith(SHOWN)
        }
