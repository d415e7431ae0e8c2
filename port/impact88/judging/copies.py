"""A printout held against an office's own copy of the listing.

The scene is recovered as always, from what the restored listing prints. The copy may print another
sign of MU or an angle otherwise, so the few texts that may have been typed are tried in it, and the
scene whose page is nearest counts. Numbers are compared by name, in whatever order the copy prints.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import lru_cache

from ..errors import UserError
from ..fields import ANGLES, FIELDS, ZERO_DETERMINANT
from ..program.listingcopy import ListingCopy
from ..program.run import run
from ..reading.fieldlabels import LabelCheck, LabelState
from ..reading.printout import Printout, read_printouts
from ..recovery.choices import with_opposite_mu
from ..recovery.recovered import Recovered
from ..recovery.replays import Outcome
from ..recovery.typedtext import texts_that_print
from ..scene import sample
from .judgement import Judged, Status, judge


def in_order(copy: ListingCopy, text: str) -> tuple[str, list[int]]:
    """A text with the lines of a page in the order of the restored listing, where the copy prints
    them in another; and for every line the number, from 1, that it had."""
    order, own = _orders(copy)
    lines = text.split("\n")
    numbers = list(range(1, len(lines) + 1))
    if own == order:
        return text, numbers
    groups: list[list[int]] = [[]]
    for number, line in enumerate(lines):
        words = _letters(line)
        if words in order:
            if any(_letters(lines[other]) == words for other in groups[-1]):
                groups.append([])
            groups[-1].append(number)
    for group in groups:
        sorted_group = sorted(group, key=lambda number: order.index(_letters(lines[number])))
        for place, number in zip(group, sorted_group, strict=True):
            numbers[place] = number + 1
    return "\n".join(lines[number - 1] for number in numbers), numbers


@lru_cache(maxsize=8)
def _orders(copy: ListingCopy) -> tuple[list[str], list[str]]:
    """The labelled lines of the restored listing's page, and of the copy's, in order."""
    scene = sample(1)
    return _labelled(run(scene).page), _labelled(copy.run(scene).page)


def _letters(line: str) -> str:
    return "".join(filter(str.isalpha, line.upper()))


def _labelled(printed: str) -> list[str]:
    """The letters of each line that holds labels, in the order of the page."""
    body = printed[max(printed.find("MA="), 0) :]
    return [letters for line in body.split("\n") if (letters := _letters(line)) and "=" in line]


def held_against(
    copy: ListingCopy, shown: Printout, recovered: Recovered, just: bool = False
) -> Judged:
    """The printout judged by the copy's page for the scene that comes nearest, or for ``just`` the
    one recovered."""
    best: Judged | None = None
    least = 10_000
    for scene in [recovered.scene] if just else _scenes(copy, shown, recovered):
        outcome, printed = _outcome(copy, scene)
        labelled = replace(shown, labels=_labels(shown, printed))
        found = judge(labelled, replace(recovered, scene=scene, outcome=outcome))
        wrong = sum(check.status != Status.READ for check in found.fields)
        if wrong < least:
            best, least = found, wrong
        if not wrong:
            break
    assert best is not None
    return best


def _scenes(copy: ListingCopy, shown: Printout, recovered: Recovered) -> Iterator[dict[str, str]]:
    """The scene as recovered, with MU typed with either sign; then with angles as the page has
    them, and as others that print so, where the copy prints those otherwise."""
    for scene in (recovered.scene, *with_opposite_mu(recovered.scene)):
        yield scene
    for scene in (recovered.scene, *with_opposite_mu(recovered.scene)):
        fields = _outcome(copy, scene)[0].fields
        printed = {
            name: text
            for name in ANGLES
            if (text := shown.text(name)) is not None and fields.get(name) != text
        }
        for rank in range(_TEXTS if printed else 0):
            texts = {name: _texts(text)[rank:] for name, text in printed.items()}
            yield {**scene, **{name: some[0] for name, some in texts.items() if some}}


_TEXTS = 4
"""Texts that are tried for an angle: as printed, rounded, and two that the Apple prints so."""


def _texts(printed: str) -> list[str]:
    short = f"{float(printed):.6g}"
    return list(dict.fromkeys([printed, short, *texts_that_print(printed, True)]))[:_TEXTS]


def _outcome(copy: ListingCopy, scene: Mapping[str, str]) -> tuple[Outcome, Printout | None]:
    """What the copy prints, by field, and its page as read."""
    done = copy.run(scene)
    try:
        printed = read_printouts(in_order(copy, done.page)[0])[0]
    except UserError:
        printed = None
    fields = {name: one.text for name, one in printed.fields.items()} if printed else {}
    ending = ZERO_DETERMINANT if ZERO_DETERMINANT in done.printout else done.error
    return Outcome({name: fields[name] for name in FIELDS if name in fields}, ending), printed


def _labels(shown: Printout, printed: Printout | None) -> list[LabelCheck]:
    """The labels of a page, those that are the copy's own exact."""
    own = {one.name: one.read for one in printed.labels} if printed else {}
    return [
        one._replace(state=LabelState.EXACT, doubt=False)
        if own.get(one.name, one.printed) == one.read
        else one
        for one in shown.labels
    ]
