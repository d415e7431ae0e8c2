"""A printout held against an office's own copy of the listing.

The scene is recovered as always, from what the restored listing prints. The copy may print another
sign of MU or an angle otherwise, so the few texts that may have been typed are tried in it, and the
scene whose page is nearest counts. Numbers are compared by name, in whatever order the copy prints;
lines that only the copy prints, such as prompts and the replies to them, are compared whole.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import product
from typing import Any

import numpy as np

from ...collision.doubles import double
from ...collision.fields import ANGLES, INPUTS, ZERO_DETERMINANT, outcome_fields, scene_name
from ...errors import UserError
from ...program.emulated import ListingCopy
from ...program.run import run
from ...program.scene import sample
from ..reading.fieldlabels import LabelState
from ..reading.numerals import value_of
from ..reading.printout import Printout, read_printouts
from ..recovery.recovered import Recovered
from ..recovery.replays import Outcome
from ..recovery.typedtext import opposite, texts_that_print, with_opposite_mu
from .judgement import FieldCheck, Judged, Status, judge

_TEXTS = 4
"""Texts that are tried for an angle: as printed, rounded, and two that the Apple prints so."""
_CONVERTED = 1e-3
"""Relative difference from which on a copy prints another number than was typed."""
_TYPED_DIGITS = 9
"""Digits that are tried for what was typed."""
_OPTIONAL = re.compile(r"ENTER THE INITIAL|\*+$")
"""Lines that a page on a picture may lack: prompts, and rows of asterisks."""
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:E[-+]?[0-9]+)?")


class CopyPages:
    """The pages of a copy of the listing. Raises UserError where the copy asks for other input than
    a scene's, or does not end."""

    def __init__(self, copy: ListingCopy) -> None:
        self.copy = copy
        copy.check_variables()
        restored, own = run(sample(1)).page, copy.run(sample(1)).page
        self._order, self._own_order = _labelled(restored), _labelled(own)
        kinds = [{_plain(line, "#") for line in page.split("\n")} for page in (restored, own)]
        self._besides = kinds[1] - kinds[0]
        text, *_ = self.prepared(own)
        printed = read_printouts(text, copy.file)[0]
        self._labels = {label.name: label.read for label in printed.labels}
        self._as_listed = _texts(printed) == outcome_fields(text)

    def prepared(self, text: str) -> tuple[str, list[int], dict[int, str]]:
        """A text as `read_printouts` takes it: its lines in the restored listing's order, those
        left empty that only the copy prints; for every line the number, from 1, that it had; and
        the lines left empty, by their numbers now."""
        lines = text.split("\n")
        besides = {at for at, line in enumerate(lines) if _plain(line, "#") in self._besides}
        order = list(range(len(lines)))
        groups: list[list[int]] = [[]]
        for at, line in enumerate(lines if self._own_order != self._order else ()):
            words = _letters(line)
            if words in self._order and at not in besides:
                if any(_letters(lines[other]) == words for other in groups[-1]):
                    groups.append([])
                groups[-1].append(at)
        for group in groups:
            by_order = sorted(group, key=lambda at: self._order.index(_letters(lines[at])))
            for place, at in zip(group, by_order, strict=True):
                order[place] = at
        kept = "\n".join("" if at in besides else lines[at] for at in order)
        return kept, [at + 1 for at in order], {at + 1: lines[at] for at in besides}

    def run_columns(
        self, scenes: Sequence[Mapping[str, str]], names: Sequence[str]
    ) -> tuple[list[str], dict[str, Any]]:
        """What the copy prints for each scene, as `replays.run_columns` has it."""
        found = [self._run(scene)[0] for scene in scenes]
        columns = {
            name: np.array([outcome.fields.get(name, "") for outcome in found]) for name in names
        }
        return [outcome.ending or "" for outcome in found], columns

    def _run(self, scene: Mapping[str, str]) -> tuple[Outcome, list[str]]:
        """What the copy prints for a scene: by field, and its lines."""
        done = self.copy.run(scene)
        text, *_ = self.prepared(done.page)
        if self._as_listed:
            fields = outcome_fields(text)
        else:
            try:
                fields = _texts(read_printouts(text)[0])
            except UserError:  # it ended before it printed any
                fields = {}
        ending = ZERO_DETERMINANT if ZERO_DETERMINANT in done.printout else done.error
        return Outcome(fields, ending), done.page.split("\n")

    def outcomes(self, scenes: Sequence[Mapping[str, str]]) -> list[Outcome]:
        """Return what the copy prints for each scene, by field."""
        return [self._run(scene)[0] for scene in scenes]

    def check_layout(self) -> None:
        """Raise UserError where a line of the listing's page stands otherwise on the copy's, on
        which no picture is divided into labels and numbers; its prompts, rows of asterisks and
        lines of the copy's own may."""
        for spins in ("6", "4"):
            scene = {**sample(1), "M": spins}
            own = iter([*_layout(self.copy.run(scene).page)])
            for line in _layout(run(scene).page):
                if _OPTIONAL.match(line) or line in own:
                    continue
                lines = [*_layout(self.copy.run(scene).page)]
                said = (
                    f"prints its lines in another order than the listing: {line!r}"
                    if line in lines
                    else f"prints no line laid out like the listing's {line!r}"
                )
                raise UserError(
                    f"{said}; expected for a picture the listing's layout (pages as text may have "
                    "another)",
                    self.copy.file,
                )

    def prints(self, line: str, scene: Mapping[str, str]) -> bool:
        """Return whether a line is one that only the copy prints, and for this scene. Blanks do not
        count, and a question mark in the copy's may be unread (``?``)."""
        read = "".join(line.split())
        for own in self._run(scene)[1] if read else ():
            if _plain(own, "#") in self._besides:
                expected = "".join(own.split())
                if len(expected) == len(read) and all(
                    a == b or a == "?" for a, b in zip(expected, read, strict=True)
                ):
                    return True
        return False

    def judged(self, paper: Printout, recovered: Recovered, besides: Mapping[int, str]) -> Judged:
        """The printout judged by the copy's page for the scene that comes nearest. ``besides``: its
        lines that only the copy prints."""

        def wrong(found: Judged) -> int:
            return sum(check.status != Status.READ for check in [*found.fields, *found.replies])

        best = None
        printed = {name: text for name in INPUTS if (text := paper.text(name)) is not None}
        replies = {name: reply.text for name, reply in paper.replies.items() if reply.clean}
        for scene in self.typed_scenes(recovered.scene, printed, replies):
            found = self._judged(paper, recovered, scene, besides)
            if best is None or wrong(found) < wrong(best):
                best = found
            if not wrong(best):
                break
        assert best is not None
        return best

    def put_right(self, found: Judged, right: Mapping[str, str]) -> Judged | None:
        """A printout, judged before, judged again with other inputs printed, by field; None where
        the copy prints them for no text that is tried."""
        choices = [_typed_texts(name, text) for name, text in right.items()]
        for texts in product(*choices):
            typed = dict(zip(map(scene_name, right), texts, strict=True))
            scene = {**found.recovered.scene, **found.recovered.typed, **typed}
            own = [check for check in found.replies if check.name.startswith("line ")]
            besides = {check.line or 0: check.printed or "" for check in own}
            other = self._judged(found.paper, found.recovered, scene, besides)
            printed = other.recovered.outcome.fields
            if all(printed.get(name) == text for name, text in right.items()):
                return other
        return None

    def typed_scenes(
        self, scene: Mapping[str, str], printed: Mapping[str, str], replies: Mapping[str, str]
    ) -> Iterator[dict[str, str]]:
        """Yield what may have been typed for a page: the scene as recovered, with MU typed with
        either sign; what a copy that converts it was given; then angles as the page has them, and
        others that print so, where the copy prints those otherwise. ``printed``: inputs on the
        page, by field; ``replies``: those to its prompts, by scene name."""
        scene = {**scene}
        either = [scene, *with_opposite_mu(scene)]
        yield from either
        yield from self._converted(scene, printed, replies)
        for typed in either:
            fields = self._run(typed)[0].fields
            angles = {
                name: printed[name]
                for name in ANGLES
                if name in printed and fields.get(name) != printed[name]
            }
            for rank in range(_TEXTS if angles else 0):
                texts = {name: _typed_texts(name, text)[rank:] for name, text in angles.items()}
                yield {**typed, **{name: some[0] for name, some in texts.items() if some}}

    def _converted(
        self, scene: dict[str, str], inputs: Mapping[str, str], replies: Mapping[str, str]
    ) -> Iterator[dict[str, str]]:
        """The scene with what was typed where the copy converts it before it prints it: the replies
        on the page, and numbers of few digits that print as the page has them."""
        fields = self._run(scene)[0].fields
        printed = {
            scene_name(name): text
            for name, text in inputs.items()
            if name != "MUP" and _is_converted(scene[scene_name(name)], fields.get(name))
        }
        if not printed:
            return
        typed = {name: text for name, text in replies.items() if name in printed}
        if len(typed) == len(printed):
            yield from ({**other, **typed} for other in (scene, *with_opposite_mu(scene)))
        scales = {
            name: double(scene[name]) / double(fields[name]) for name in printed if fields.get(name)
        }
        for digits in range(1, _TYPED_DIGITS + 1):
            trial = {
                name: f"{float(f'{double(text) * scales[name]:.{digits}g}'):.{_TYPED_DIGITS}G}"
                for name, text in printed.items()
                if name not in typed and name in scales
            }
            shown = self._run({**scene, **typed, **trial})[0].fields
            typed |= {
                name: text for name, text in trial.items() if shown.get(name) == printed[name]
            }
        yield from ({**other, **typed} for other in (scene, *with_opposite_mu(scene)))

    def _judged(
        self,
        paper: Printout,
        recovered: Recovered,
        scene: dict[str, str],
        besides: Mapping[int, str],
    ) -> Judged:
        """The printout judged by what the copy prints for a scene. The copy's own labels are exact;
        a line that only the copy prints must have its numbers, too."""
        outcome, lines = self._run(scene)
        labels = [
            label._replace(state=LabelState.EXACT, doubt=False)
            if self._labels.get(label.name, label.printed) == label.read
            else label
            for label in paper.labels
        ]
        paper = replace(paper, labels=labels)
        own = set(map(_plain, lines))
        of_kind = {_plain(line, "#"): line.strip() for line in lines}
        wrong = [
            FieldCheck(
                f"line {number}", line.strip(), of_kind.get(_plain(line, "#"), "nothing"),
                Status.CONTRADICTED, line=number,
            )
            for number, line in besides.items()
            if _plain(line) not in own
        ]  # fmt: skip
        typed = converted_inputs(scene, outcome.fields)
        scene = as_printed(scene, outcome.fields)
        judged = replace(recovered, scene=scene, outcome=outcome, typed=typed)
        return judge(paper, judged, wrong)


def converted_inputs(typed: Mapping[str, str], printed: Mapping[str, str]) -> dict[str, str]:
    """Return the values typed that a copy converts before it prints them, by scene name."""
    return {
        name: text
        for name, text in typed.items()
        if name != "MU" and _is_converted(text, printed.get(name))
    }


def as_printed(typed: Mapping[str, str], printed: Mapping[str, str]) -> dict[str, str]:
    """Return a scene with the values that a copy converts as it prints them."""
    return {**typed, **{name: printed[name] for name in converted_inputs(typed, printed)}}


pages_of = lru_cache(maxsize=1)(CopyPages)
"""The pages of the copy that was asked for last: many files are held against one."""


def _is_converted(typed: str, printed: str | None) -> bool:
    """Whether a copy prints another number for an input than was typed; not one in its last
    places, as a copy with another pi does."""
    if not printed or not double(printed):
        return False
    return abs(double(typed) - double(printed)) > _CONVERTED * abs(double(printed))


def _texts(printed: Printout) -> dict[str, str]:
    return {name: reading.text for name, reading in printed.fields.items()}


def _letters(line: str) -> str:
    return "".join(filter(str.isalpha, _NUMBER.sub("", line.upper())))


def _labelled(printed: str) -> list[str]:
    """The letters of each line that holds labels, in the order of the page."""
    body = printed[max(printed.find("MA="), 0) :]
    return [letters for line in body.split("\n") if (letters := _letters(line)) and "=" in line]


def _layout(page: str) -> Iterator[str]:
    """Yield the lines of a page that are not blank, with ``#`` for each number."""
    for line in page.split("\n"):
        if line.strip():
            yield _NUMBER.sub("#", line).rstrip()


def _plain(line: str, number: str = "") -> str:
    """A line without blanks, its numbers by value or as one mark."""

    def said(found: re.Match[str]) -> str:
        value = value_of(found[0])
        return number or (f"{value.normalize()}" if value else "0")

    return _NUMBER.sub(said, "".join(line.split()))


def _typed_texts(name: str, printed: str) -> list[str]:
    """Texts that may have been typed where this is printed."""
    if name == "MUP":
        return [printed, opposite(printed)]
    if name not in ANGLES:
        return [next(iter(texts_that_print(printed)), printed)]
    short = f"{float(printed):.6g}"
    return list(dict.fromkeys([printed, short, *texts_that_print(printed, True)]))[:_TEXTS]
