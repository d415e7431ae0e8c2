"""Rereading: which slips in the printed inputs, put right, make the page agree with itself.

Every slip in every input (`misprints`) is a hypothesis, alone and in pairs; two digits of one
number are another. They are screened in double precision, masses and velocities by the kinetic
energy first, and the best replayed. Nothing here is a verdict: `explain` names what is found, and
`judging` says when a reader's slips may be looked past.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import combinations as pairs_of
from typing import NamedTuple

import numpy as np

from ..closedform.solve import solve
from ..doubles import double
from ..fields import ANGLES, INPUTS
from ..reading.numerals import as_printed, is_number, printable, value_of
from . import misprints
from .choices import Choice, Choices, flipped, scene_name
from .recovered import Recovered
from .search import AGREES, KINETIC, MISMATCH, Picks, Scored, Search, columns, printed_mu
from .typedtext import stored_and_printed, texts_that_print

COSTS = {
    misprints.DIGIT: 2.7,
    misprints.SIGN: 2.6,
    misprints.POINT: 2.8,
    misprints.SWAP: 2.9,
    misprints.COUNT: 3.0,
    misprints.TWO_DIGITS: 4.4,
}
"""What it costs to believe a slip; a result that differs costs `search.MISMATCH`."""
_UNLIKE = 0.05
_SUMS = (("PA", "TA"), ("PB", "TB"))
"""Angles that enter only as their sum."""
_TELLING = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF", "XAF", "YAF", "XBF", "YBF", "LOSS")
_TELLING_MOST = 4
"""Of many pairs so many results are looked at first: those that differ, in this order."""
_BESIDES_ENERGY = 0.1
"""What slips cost, next to whether they give the printed kinetic energy."""
_ALIKE = 1
"""Of three digits misread each is taken for one of so many more than the likeliest."""
_SINGLES_KEPT = 220
_PAIRS = 320_000
_DIGITS = 9
"""Of a number the Apple keeps so many."""
_ENERGIES = 24


class Change(NamedTuple):
    """One input put right: the kind of slip, the field, its text as printed or given apart, the
    true one."""

    kind: str
    field: str
    printed: str
    would_be: str


class Reread(NamedTuple):
    """A scene with some inputs put right."""

    changes: tuple[Change, ...]
    scored: Scored


class Rereading:
    """The slips of one printout's inputs, tried. ``apart``: those in inputs that stand nowhere on
    the page and were given apart, too; they are slips of what was typed there, as INPUT reads it:
    blanks and small letters make no difference."""

    def __init__(self, recovered: Recovered, apart: bool = False) -> None:
        self._search: Search = recovered.search
        self._scene = recovered.scene
        self._printed = recovered.assumed
        self._base = {name: self._printed[name] for name in INPUTS if name in self._printed}
        for name in recovered.apart if apart else ():
            self._base[name] = recovered.scene[scene_name(name)].replace(" ", "").upper()
        self._names = list(INPUTS)
        self._mu = self._names.index("MUP")
        self._wrong = recovered.wrong

    def best(self, deep: bool = False) -> list[Reread]:
        """Scenes with one input put right, or two, or (``deep``) two in the masses and velocities
        and two in the rest, those that explain most first."""
        choices, changes = self._choices()
        kinetic = self._kinetic()
        rest = [
            place
            for place in range(len(choices))
            if place not in kinetic or self._still(self._names[place])
        ]
        picks = [self._singles(choices)]
        picks.append(self._in_energy(choices, kinetic, rest, deep))
        picks.append(self._pairs(choices, rest))
        every = np.unique(np.concatenate(picks), axis=0)
        ranked = [reread for _, reread in self._tried(choices, changes, every, 320)]
        ranked.sort(key=lambda one: one.scored.cost)
        return ranked

    def besides(
        self, exchanges: Sequence[Mapping[str, str]], most: int
    ) -> list[tuple[int, Reread]]:
        """Scenes with some inputs exchanged and one of the others put right, those that explain
        most first: the number of the exchange, and the rest. ``exchanges``: for each the texts
        printed in place of others, by field."""
        choices, changes = self._choices()
        singles = self._singles(choices)
        rows: list[Picks] = []
        numbers: list[int] = []
        for number, exchange in enumerate(exchanges):
            places = [self._names.index(name) for name in exchange]
            block = singles[(singles[:, places] == 0).all(axis=1)][1:]
            for place, (name, text) in zip(places, exchange.items(), strict=True):
                block[:, place] = len(choices[place])
                choices[place].append(self._typed(name, text, 0.0))
                changes[place].append(None)
            rows.append(block)
            numbers += [number] * len(block)
        picks = np.concatenate(rows)
        order = {tuple(row): number for row, number in zip(picks.tolist(), numbers, strict=True)}
        tried = self._tried(choices, changes, picks, most)
        return [(order[pick], reread) for pick, reread in tried]

    def _tried(
        self, choices: Choices, changes: list[list[Change | None]], picks: Picks, most: int
    ) -> Iterator[tuple[tuple[int, ...], Reread]]:
        """The picks that explain most, so many of them, each with its scene replayed."""
        picks = self._search.screened(choices, picks, most)
        scenes = self._search.replayed(self._proper(choices, picks), picks)
        for pick, scored in zip(picks.tolist(), scenes, strict=True):
            made = tuple(
                change
                for place, index in enumerate(pick)
                if (change := changes[place][index]) is not None
            )
            yield tuple(pick), Reread(made, scored)

    def _still(self, name: str) -> bool:
        """Whether an input is an inertia that does not spin: the energy says nothing of it."""
        spin = {"IA": "WA", "IB": "WB"}.get(name)
        return spin is not None and not double(self._scene[spin] or "0")

    def twins(self, rereads: Sequence[Reread]) -> Iterator[Reread]:
        """The same pages by the other angle of a sum: what is wrong in TB may be wrong in PB."""
        for one in rereads:
            for name, twin in (*_SUMS, *((two, one) for one, two in _SUMS)):
                change = next((one for one in one.changes if one.field == name), None)
                if change is None or any(other.field == twin for other in one.changes):
                    continue
                other = self._twin(change, twin)
                if other is not None:
                    yield self._instead(one, change, other)

    def _twin(self, change: Change, twin: str) -> Change | None:
        """The slip in the other angle that gives the same sum."""
        values = [value_of(self._base.get(twin, "")), value_of(change.would_be)]
        printed = value_of(change.printed)
        if None in values or printed is None:
            return None
        total: Decimal = sum(value for value in values if value is not None) - printed
        text = as_printed(f"{total:f}")
        if text is None or not printable(text) or text == self._base[twin]:
            return None
        kind = misprints.slip(self._base[twin], text)
        if kind is None and misprints.differ_in_two(self._base[twin], text):
            kind = misprints.TWO_DIGITS
        return Change(kind, twin, self._base[twin], text) if kind else None

    def _instead(self, one: Reread, change: Change, other: Change) -> Reread:
        scene = {**one.scored.scene, change.field: self._scene[change.field]}
        scene[other.field] = typed_for(other.would_be, True) or other.would_be
        texts = {change.field: change.printed, other.field: other.would_be}
        on_page = {name: text for name, text in texts.items() if name in self._printed}
        assumed = {**one.scored.assumed, **on_page}
        changes = tuple(other if each == change else each for each in one.changes)
        return Reread(changes, self._search.replayed_scene(scene, assumed))

    def double_slips(self) -> list[Reread]:
        """Scenes with two digits of one input put right."""
        pairs: list[Reread] = []
        choices: Choices = []
        rows: list[list[int]] = []
        made: list[Change] = []
        ways: Choices = []
        for place, name in enumerate(self._names):
            options = [self._unchanged(name)]
            for other in _two_digits(self._base.get(name, "")):
                if not self._possible(name, other):
                    continue
                rows.append([0] * place + [len(options)] + [0] * (len(self._names) - place))
                options.append(self._typed(name, other, COSTS[misprints.TWO_DIGITS]))
                made.append(Change(misprints.TWO_DIGITS, name, self._base[name], other))
            ways.append(options)
        choices = [*ways, self._m()]
        if not rows:
            return pairs
        self._add_signs(choices[self._mu])
        # what is wrong may be what gives MU its sign
        picks = self._either_sign(choices, np.array(rows, np.intp))
        best = self._search.screened(choices, picks, 60)
        where = {tuple(row): index for index, row in enumerate(rows)}
        tried = self._search.replayed(self._proper(choices, best), best)
        for pick, scored in zip(best.tolist(), tried, strict=True):
            pick[self._mu] %= len(choices[self._mu]) // 2
            pairs.append(Reread((made[where[tuple(pick)]],), scored))
        pairs.sort(key=lambda one: one.scored.cost)
        return pairs

    # --- the hypotheses ---

    def _choices(self) -> tuple[Choices, list[list[Change | None]]]:
        """For each input the base and every slip, and what each changes."""
        choices: Choices = []
        changes: list[list[Change | None]] = []
        for name in self._names:
            options: list[Choice] = [self._unchanged(name)]
            made: list[Change | None] = [None]
            for change, choice in self._of(name):
                options.append(choice)
                made.append(change)
            choices.append(options)
            changes.append(made)
        self._add_signs(choices[self._mu])
        changes[self._mu] *= 2
        choices.append(self._m())
        changes.append([None])
        return choices, changes

    # --- the sign of MU: every way to take it comes once more with the other sign typed ---

    def _either_sign(self, choices: Choices, picks: Picks) -> Picks:
        """The combinations, and the same with MU typed with the other sign, unless it is 0."""
        options = choices[self._mu]
        count = len(options) // 2
        has_sign = [one != other for one, other in zip(options, options[count:], strict=False)]
        other = picks[np.array(has_sign)[picks[:, self._mu]]]
        other[:, self._mu] += count
        return np.concatenate([picks, other])

    def _signed(self, choices: Choices, picks: Picks) -> Picks:
        """The combinations with MU typed with the sign that line 400 makes the printed one of;
        where double precision does not follow the program (M = 4), with either."""
        if self._scene["M"] != "6":
            return self._either_sign(choices, picks)
        with np.errstate(all="ignore"):
            printed = solve(columns(choices, picks), ["MUP"])["MUP"]
            wrong = printed * printed_mu(choices, picks) < 0
        signed = picks.copy()
        signed[wrong, self._mu] += len(choices[self._mu]) // 2
        return signed

    def _add_signs(self, ways: list[Choice]) -> None:
        """The ways to take MU, and each with the other sign: what was typed where the page prints
        it is not known."""
        ways += map(flipped, ways[:]) if "MUP" in self._printed else ways[:]

    def _one_sign(self, choices: Choices, place: int) -> list[Choice]:
        """The ways to take one input, of MU those with one sign."""
        options = choices[place]
        return options[: len(options) // 2] if place == self._mu else options

    def _m(self) -> list[Choice]:
        return [Choice({"M": self._scene["M"]}, {}, 0.0)]

    def _unchanged(self, name: str) -> Choice:
        printed = {name: self._printed[name]} if name in self._printed else {}
        return Choice({scene_name(name): self._scene[scene_name(name)]}, printed, 0.0)

    def _of(self, name: str) -> Iterator[tuple[Change, Choice]]:
        text = self._base.get(name)
        if text is None:
            return
        for kind, other in misprints.misreadings(text):
            if self._possible(name, other):
                cost = COSTS[kind]
                if kind == misprints.DIGIT:
                    cost += _UNLIKE * misprints.likeness(text, other)
                yield Change(kind, name, text, other), self._typed(name, other, cost)

    def _possible(self, name: str, text: str) -> bool:
        """Whether a text may stand where an input is printed, or was typed apart."""
        return printable(text) if name in self._printed else is_number(text)

    def _typed(self, name: str, text: str, cost: float) -> Choice:
        """What is printed, as if typed so (`_proper` says what was); or what was typed apart."""
        return Choice({scene_name(name): text}, {name: text} if name in self._printed else {}, cost)

    def _proper(self, choices: Choices, picks: Picks) -> Choices:
        """The choices, those that are picked with what must have been typed to print so."""
        proper = [list(options) for options in choices]
        for place, name in enumerate(self._names):
            for index in np.unique(picks[:, place]).tolist():
                choice = choices[place][index]
                printed = choice.printed.get(name)
                if not index or printed is None or printed == self._base.get(name):
                    continue
                typed = typed_for(printed, name in ANGLES)
                if typed is None:
                    proper[place][index] = choice._replace(cost=choice.cost + MISMATCH)
                    continue
                (own, text), *_ = choice.typed.items()
                typed = misprints.opposite(typed) if own == "MU" and text != printed else typed
                proper[place][index] = choice._replace(typed={own: typed})
        return proper

    # --- combinations ---

    def _singles(self, choices: Choices) -> Picks:
        rows = [[0] * len(choices)]
        for place in range(len(choices)):
            for index in range(1, len(self._one_sign(choices, place))):
                row = [0] * len(choices)
                row[place] = index
                rows.append(row)
        return self._either_sign(choices, np.array(rows, np.intp))

    def _in_energy(
        self, choices: Choices, kinetic: list[int], rest: list[int], deep: bool
    ) -> Picks:
        """Up to two slips in masses and velocities, with up to one (or two) in the rest; inertias
        that do not spin are of the rest."""
        first = self._by_energy(choices, kinetic)
        others = [self._one_sign(choices, place) for place in rest]
        second = _one_change(others)
        if deep:
            best = self._best_of_rest(choices, kinetic, rest, first[:4])
            second = np.unique(np.concatenate([second, best]), axis=0)
        picks = np.zeros((len(first) * len(second), len(choices)), np.intp)
        picks[:, kinetic] = np.repeat(first, len(second), axis=0)
        picks[:, rest] = np.tile(second, (len(first), 1))
        return self._screened(choices, picks, _SINGLES_KEPT)

    def _kinetic(self) -> list[int]:
        """Where the masses, inertias and velocities stand."""
        return [place for place, name in enumerate(self._names) if scene_name(name) in KINETIC]

    def _by_energy(
        self, choices: Choices, kinetic: list[int], more: Callable[[Choices], Picks] | None = None
    ) -> Picks:
        """Up to two slips in masses and velocities, and ``more``: those that give the printed
        energy first. An inertia that does not spin says nothing there."""
        own = [
            choices[place][:1] if self._still(self._names[place]) else choices[place]
            for place in kinetic
        ]
        some = _two_changes(own, _PAIRS)
        if more:
            some = np.concatenate([some, more(own)])
        cheaper = [
            [one._replace(cost=_BESIDES_ENERGY * one.cost) for one in options] for options in own
        ]
        return self._search.by_energy(cheaper, some, _ENERGIES)

    def _best_of_rest(
        self, choices: Choices, kinetic: list[int], rest: list[int], first: Picks
    ) -> Picks:
        pairs = _two_changes([self._one_sign(choices, place) for place in rest], _PAIRS)
        parts = []
        for one in first:  # each alone: together they would take four times the memory
            picks = np.zeros((len(pairs), len(choices)), np.intp)
            picks[:, kinetic] = one
            picks[:, rest] = pairs
            parts.append(self._screened(choices, picks, 60))
        best = self._search.screened(choices, np.concatenate(parts), 60)[:, rest]
        mu = rest.index(self._mu)
        best[:, mu] %= len(choices[self._mu]) // 2
        return best

    def _pairs(self, choices: Choices, rest: list[int]) -> Picks:
        """Two slips in what does not enter the kinetic energy, and inertias."""
        wide = sorted({*rest, *(self._names.index(name) for name in ("IA", "IB"))})
        pairs = _two_changes([self._one_sign(choices, place) for place in wide], _PAIRS)
        picks = np.zeros((len(pairs), len(choices)), np.intp)
        picks[:, wide] = pairs
        return self._screened(choices, picks, 60)

    def _screened(self, choices: Choices, picks: Picks, most: int) -> Picks:
        """The combinations that explain most; results that the page's own scene explains say
        little of what is wrong with it, so that the others are looked at first."""
        by_use = sorted(_TELLING, key=lambda name: name not in self._wrong)
        signed = self._signed(choices, picks)
        return self._search.screened(choices, signed, most, by_use[:_TELLING_MOST])


def _one_change(choices: Choices) -> Picks:
    rows = [[0] * len(choices)]
    for place, options in enumerate(choices):
        for index in range(1, len(options)):
            rows.append([*([0] * place), index, *([0] * (len(choices) - place - 1))])
    return np.array(rows, np.intp)


def _two_changes(choices: Choices, most: int) -> Picks:
    """No change, one, or two in different columns; of too many pairs the likeliest."""
    parts = [_one_change(choices)]
    lost = COSTS[misprints.COUNT]
    sizes = [sum(one.cost < lost for one in options[1:]) for options in choices]
    total = sum(one * two for one, two in pairs_of(sizes, 2))
    share = min(1.0, (most / total) ** 0.5) if total else 1.0
    for one, two in pairs_of(range(len(choices)), 2):
        kept = [_cheapest(choices[place], share) for place in (one, two)]
        if not len(kept[0]) or not len(kept[1]):
            continue
        block = np.zeros((len(kept[0]) * len(kept[1]), len(choices)), np.intp)
        block[:, one] = np.repeat(kept[0], len(kept[1]))
        block[:, two] = np.tile(kept[1], len(kept[0]))
        parts.append(block)
    return np.concatenate(parts)


def _cheapest(options: list[Choice], share: float) -> Picks:
    lost = COSTS[misprints.COUNT]
    few = [index for index in range(1, len(options)) if options[index].cost < lost]
    order = sorted(few, key=lambda index: options[index].cost)
    return np.array(order[: max(1, int(share * len(order)))] if order else [], np.intp)


def _two_digits(text: str) -> Iterator[str]:
    """Texts that differ in two of the digits that count."""
    places = [index for index, glyph in enumerate(text) if glyph.isdigit()][:_DIGITS]
    for one, two in pairs_of(places, 2):
        for first in "0123456789":
            for second in "0123456789":
                if first != text[one] and second != text[two]:
                    yield text[:one] + first + text[one + 1 : two] + second + text[two + 1 :]


def typed_for(printed: str, angle: bool) -> str | None:
    """What was typed where this is printed; None when nothing prints so."""
    if len(printed.lstrip("-").replace(".", "")) < 7 and not angle:
        seen = stored_and_printed(printed)
        if seen is not None and seen[1] == printed:
            return printed
    texts = texts_that_print(printed, angle)
    return texts[0] if texts else None


__all__ = ["AGREES", "MISMATCH", "Change", "Reread", "Rereading"]
