"""Recovering the scene of a printout: the one whose page explains the paper at the least cost.

What each input may have been comes from `choices`, the trying from `search`. Inputs that nothing
tells of are given stand-ins, and only what does not depend on them is kept for comparison.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from ..fields import ANGLES, INPUTS
from ..names import SCENE
from ..reading.glyphs import ILLEGIBLE
from ..reading.printout import Printout
from . import replays
from .choices import choices_of, scene_name
from .search import Scored, Search

_STAND_INS = ("230", "-41000")
"""Values put in place of a missing input, besides the first: a field that prints the same with each
of them does not depend on it."""
_UNCONVINCING = 3
"""What had to be guessed, a row of angles or a number of which no character is legible, counts as
missing when more results than this differ."""


@dataclass
class Recovered:
    """The scene a printout shows. ``scene`` holds stand-ins for the values in ``missing``;
    ``assumed`` the printed texts it goes with, by field; ``outcome`` is what the replay prints,
    without fields that depend on missing values; ``wrong`` names what it leaves unexplained;
    ``m_unknown``: whether M = 4 explains the page as well as 6 does; ``row_in_doubt``: whether the
    row of angles was not read for certain and no way to read it explains the page."""

    scene: dict[str, str]
    assumed: dict[str, str]
    outcome: replays.Outcome
    missing: list[str]
    wrong: frozenset[str]
    search: Search
    m_unknown: bool = False
    row_in_doubt: bool = False

    @property
    def apart(self) -> list[str]:
        """The inputs, by field, that are neither the page's nor missing: they were given apart."""
        return [
            name
            for name in INPUTS
            if name not in self.assumed and scene_name(name) not in self.missing
        ]

    def scene_or_missing(self) -> dict[str, str | None]:
        """The scene in the table's order, None for what is missing."""
        return {name: None if name in self.missing else self.scene[name] for name in SCENE}


def recover(shown: Printout, given: Mapping[str, str] | None = None) -> Recovered:
    """The scene whose page explains the printout best. ``given``: inputs known from elsewhere."""
    choices = choices_of(shown, given)
    search = Search(shown, choices.typed)
    best = search.best(choices.columns)
    lost = set(choices.missing)
    unconvincing = len(best.wrong) > _UNCONVINCING
    if unconvincing:  # how many characters marks for the illegible stand for nobody knows
        lost |= {
            scene_name(name)
            for name in set(INPUTS) & set(shown.fields)
            if all(glyph.char == ILLEGIBLE for glyph in shown.fields[name].region)
        } - set(given or ())
    missing = [name for name in map(scene_name, INPUTS) if name in lost]
    outcome = _independent_of(missing, best.scene, best.outcome) if missing else best.outcome
    return Recovered(
        best.scene,
        best.assumed,
        outcome,
        missing,
        best.wrong,
        search,
        not missing and _other_m_explains(shown, best),
        bool(shown.angles) and unconvincing and not lost & set(ANGLES),
    )


def without_angles(recovered: Recovered) -> Recovered:
    """The same with the row of angles as missing."""
    missing = [*recovered.missing, *ANGLES]
    outcome = _independent_of(missing, recovered.scene, recovered.outcome)
    return replace(recovered, missing=missing, outcome=outcome, m_unknown=False, row_in_doubt=False)


def _other_m_explains(shown: Printout, best: Scored) -> bool:
    """Whether the other M would print the same but for the final spins."""
    if shown.has_final_spins or shown.ending:
        return False
    if not any(name in shown.fields for name in ("VAX", "VAY", "VBX", "VBY")):
        return True
    scene = {**best.scene, "M": "6" if best.scene["M"] == "4" else "4"}
    fields = replays.run_once(scene).fields
    return all(
        fields.get(name) == text
        for name, text in best.outcome.fields.items()
        if name in fields and not name.startswith(("WAF", "WBF"))
    )


def _independent_of(
    missing: list[str], scene: Mapping[str, str], outcome: replays.Outcome
) -> replays.Outcome:
    """The outcome's fields that are the same whatever the missing inputs are."""
    others = [{**scene, **dict.fromkeys(missing, value)} for value in _STAND_INS]
    fields = dict(outcome.fields)
    for other in replays.run_all(others):
        fields = {name: text for name, text in fields.items() if other.fields.get(name) == text}
    for name in missing:
        fields.pop("MUP" if name == "MU" else name, None)
    return replays.Outcome(fields, None)
