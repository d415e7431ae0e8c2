"""Comparison of a printout with an office's own copy of the listing.

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

from ...decimals import negated as opposite
from ...decimals import to_double as double
from ...errors import UserError
from ...program.copies import ListingCopy
from ...program.run import run
from ...program.scene import sample
from ..fields import ANGLES, INPUTS, ZERO_DETERMINANT, outcome_fields, scene_name
from ..reading.numerals import NUMBER, value_of
from ..reading.printout import Printout, read_printouts
from ..recovery.recovered import Recovered
from ..recovery.replays import Outcome
from ..recovery.typedtext import texts_that_print, with_opposite_mu
from .judgement import FieldCheck, Judged, Status, judge

MAX_ANGLE_TEXTS = 4
"""Texts tried for an angle: as printed, rounded, and two that the Apple prints so."""
CONVERSION_RTOL = 1e-3
"""Relative difference above which a copy counts as printing another number than was typed."""
MAX_TYPED_DIGITS = 9  # digits tried for a typed number
_OPTIONAL = re.compile(r"ENTER THE INITIAL|\*+$")
"""Lines that a page on a picture may lack: prompts, and rows of asterisks."""


class CopyPages:
    """The pages of a copy of the listing. Raises UserError where the copy asks for other input than
    a scene's, or does not end."""

    def __init__(self, copy: ListingCopy) -> None:
        self.copy = copy
        copy.check_variables()
        restored, own = run(sample(1)).page, copy.run(sample(1)).page
        self._order, self._own_order = _label_lines(restored), _label_lines(own)
        kinds = [{_plain(line, "#") for line in page.split("\n")} for page in (restored, own)]
        self._besides = kinds[1] - kinds[0]
        text, *_ = self.prepare(own)
        printed = read_printouts(text, copy.file)[0]
        self._labels = {(label.name, label.printed): label.read for label in printed.labels}
        self._as_listed = _texts(printed) == outcome_fields(text)

    def prepare(self, text: str) -> tuple[str, list[int], dict[int, str]]:
        """Return a text for `read_printouts`: its lines in the restored listing's order, with
        blanks for those that only the copy prints; the original number, from 1, of each line; and
        the lines left out, by their new numbers."""
        lines = text.split("\n")
        besides = {at for at, line in enumerate(lines) if _plain(line, "#") in self._besides}
        order = list(range(len(lines)))
        groups: list[list[int]] = [[]]
        for at, line in enumerate(lines if self._own_order != self._order else ()):
            words = _letters(line)
            if words in self._order and at not in besides:
                if any(_letters(lines[member]) == words for member in groups[-1]):
                    groups.append([])
                groups[-1].append(at)
        for group in groups:
            by_order = sorted(group, key=lambda at: self._order.index(_letters(lines[at])))
            for place, at in zip(group, by_order, strict=True):
                order[place] = at
        reordered = "\n".join("" if at in besides else lines[at] for at in order)
        return reordered, [at + 1 for at in order], {at + 1: lines[at] for at in besides}

    def run_columns(
        self, scenes: Sequence[Mapping[str, str]], names: Sequence[str]
    ) -> tuple[list[str], dict[str, Any]]:
        """Run the copy on scenes and return what `replays.run_columns` does."""
        outcomes = [self._run(scene)[0] for scene in scenes]
        columns = {
            name: np.array([outcome.fields.get(name, "") for outcome in outcomes]) for name in names
        }
        return [outcome.ending or "" for outcome in outcomes], columns

    def _run(self, scene: Mapping[str, str]) -> tuple[Outcome, list[str]]:
        """Run the copy on a scene; return the outcome and the lines of its page."""
        copy_run = self.copy.run(scene)
        text, *_ = self.prepare(copy_run.page)
        if self._as_listed:
            fields = outcome_fields(text)
        else:
            try:
                fields = _texts(read_printouts(text)[0])
            except UserError:  # it ended before it printed any
                fields = {}
        ending = ZERO_DETERMINANT if ZERO_DETERMINANT in copy_run.printout else copy_run.error
        return Outcome(fields, ending), copy_run.page.split("\n")

    def outcomes(self, scenes: Sequence[Mapping[str, str]]) -> list[Outcome]:
        """Return what the copy prints for each scene, by field."""
        return [self._run(scene)[0] for scene in scenes]

    def check_layout(self) -> None:
        """Raise UserError where a line of the listing's page is laid out otherwise on the copy's.

        A picture of such a page cannot be divided into labels and numbers. Prompts, rows of
        asterisks and lines of the copy's own may differ.
        """
        for spins in ("6", "4"):
            scene = {**sample(1), "M": spins}
            all_lines = [*_layout(self.copy.run(scene).page)]
            following = iter(all_lines)
            for line in _layout(run(scene).page):
                if _OPTIONAL.match(line) or line in following:
                    continue
                problem = (
                    f"prints its lines in another order than the listing: {line!r}"
                    if line in all_lines
                    else f"prints no line laid out like the listing's {line!r}"
                )
                raise UserError(
                    f"{problem}; expected for a picture the listing's layout (pages as text may "
                    "have another)",
                    self.copy.file,
                )

    def prints(self, line: str, scene: Mapping[str, str]) -> bool:
        """Return whether a line is one that only the copy prints, and for this scene. Blanks do not
        count, and a question mark in the copy's may be unread (``?``)."""
        squeezed = "".join(line.split())
        for copy_line in self._run(scene)[1] if squeezed else ():
            if _plain(copy_line, "#") in self._besides:
                letters = "".join(copy_line.split())
                if len(letters) == len(squeezed) and all(
                    a == b or a == "?" for a, b in zip(letters, squeezed, strict=True)
                ):
                    return True
        return False

    def judge(self, paper: Printout, recovered: Recovered, besides: Mapping[int, str]) -> Judged:
        """Judge the printout by the copy's page for the scene that comes nearest. ``besides``:
        lines of the printout that only the copy prints, by number."""

        def count_wrong(judgement: Judged) -> int:
            checks = [*judgement.fields, *judgement.replies]
            return sum(check.status != Status.READ for check in checks)

        best = None
        input_texts = {name: text for name in INPUTS if (text := paper.text(name)) is not None}
        replies = {name: reply.text for name, reply in paper.replies.items() if reply.clean}
        for scene in self.typed_scenes(recovered.scene, input_texts, replies):
            candidate = self._judge_scene(paper, recovered, scene, besides)
            if best is None or count_wrong(candidate) < count_wrong(best):
                best = candidate
            if not count_wrong(best):
                break
        assert best is not None
        return best

    def rejudge(self, found: Judged, right: Mapping[str, str]) -> Judged | None:
        """Judge a printout again with corrected inputs (printed texts by field). Return None if no
        text that is tried makes the copy print them."""
        choices = [_typed_texts(name, text) for name, text in right.items()]
        for texts in product(*choices):
            typed_texts = dict(zip(map(scene_name, right), texts, strict=True))
            scene = {**found.recovered.scene, **found.recovered.typed, **typed_texts}
            copy_checks = [check for check in found.replies if check.name.startswith("line ")]
            besides = {check.line or 0: check.printed or "" for check in copy_checks}
            judgement = self._judge_scene(found.paper, found.recovered, scene, besides)
            printed_fields = judgement.recovered.outcome.fields
            if all(printed_fields.get(name) == text for name, text in right.items()):
                return judgement
        return None

    def typed_scenes(
        self, scene: Mapping[str, str], printed: Mapping[str, str], replies: Mapping[str, str]
    ) -> Iterator[dict[str, str]]:
        """Yield what may have been typed for a page: the scene as recovered, with MU typed with
        either sign; what a copy that converts it was given; then angles as the page has them, and
        others that print so, where the copy prints those otherwise. ``printed``: inputs on the
        page, by field; ``replies``: those to its prompts, by scene name."""
        scene = {**scene}
        both_signs = [scene, *with_opposite_mu(scene)]
        yield from both_signs
        yield from self._unconverted_scenes(scene, printed, replies)
        for variant in both_signs:
            fields = self._run(variant)[0].fields
            angles = {
                name: printed[name]
                for name in ANGLES
                if name in printed and fields.get(name) != printed[name]
            }
            for rank in range(MAX_ANGLE_TEXTS if angles else 0):
                texts = {name: _typed_texts(name, text)[rank:] for name, text in angles.items()}
                yield {
                    **variant,
                    **{name: options[0] for name, options in texts.items() if options},
                }

    def _unconverted_scenes(
        self, scene: dict[str, str], inputs: Mapping[str, str], replies: Mapping[str, str]
    ) -> Iterator[dict[str, str]]:
        """Yield the scene with typed texts for inputs that the copy converts before printing: the
        replies on the page, or numbers of few digits that print as on the page."""
        fields = self._run(scene)[0].fields
        converted = {
            scene_name(name): text
            for name, text in inputs.items()
            if name != "MUP" and _is_converted(scene[scene_name(name)], fields.get(name))
        }
        if not converted:
            return
        typed_texts = {name: text for name, text in replies.items() if name in converted}
        if len(typed_texts) == len(converted):
            yield from ({**variant, **typed_texts} for variant in (scene, *with_opposite_mu(scene)))
        scales = {
            name: double(scene[name]) / double(fields[name])
            for name in converted
            if fields.get(name)
        }
        for digits in range(1, MAX_TYPED_DIGITS + 1):
            trial = {
                name: f"{float(f'{double(text) * scales[name]:.{digits}g}'):.{MAX_TYPED_DIGITS}G}"
                for name, text in converted.items()
                if name not in typed_texts and name in scales
            }
            trial_fields = self._run({**scene, **typed_texts, **trial})[0].fields
            typed_texts |= {
                name: text
                for name, text in trial.items()
                if trial_fields.get(name) == converted[name]
            }
        yield from ({**variant, **typed_texts} for variant in (scene, *with_opposite_mu(scene)))

    def _judge_scene(
        self,
        paper: Printout,
        recovered: Recovered,
        scene: dict[str, str],
        besides: Mapping[int, str],
    ) -> Judged:
        """Judge the printout by the copy's page for one scene. The copy's own labels are no
        differences; the numbers of a line that only the copy prints are compared, too."""
        outcome, lines = self._run(scene)
        labels = [
            label
            for label in paper.labels
            if self._labels.get((label.name, label.printed)) != label.read
        ]
        paper = replace(paper, labels=labels)
        plain_lines = set(map(_plain, lines))
        of_kind = {_plain(line, "#"): line.strip() for line in lines}
        wrong = [
            FieldCheck(
                f"line {number}", line.strip(), of_kind.get(_plain(line, "#"), "nothing"),
                Status.CONTRADICTED, line=number,
            )
            for number, line in besides.items()
            if _plain(line) not in plain_lines
        ]  # fmt: skip
        conversions = converted_inputs(scene, outcome.fields)
        scene = as_printed(scene, outcome.fields)
        copy_recovered = replace(recovered, scene=scene, outcome=outcome, typed=conversions)
        return judge(paper, copy_recovered, wrong)


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
"""Cached `CopyPages`: many files are compared with one copy."""


def _is_converted(typed: str, printed: str | None) -> bool:
    """Return True if a copy prints another number for an input than was typed. Last places do not
    count: a copy with another pi changes them."""
    if not printed or not double(printed):
        return False
    return abs(double(typed) - double(printed)) > CONVERSION_RTOL * abs(double(printed))


def _texts(printed: Printout) -> dict[str, str]:
    return {name: reading.text for name, reading in printed.fields.items()}


def _letters(line: str) -> str:
    return "".join(filter(str.isalpha, NUMBER.sub("", line.upper())))


def _label_lines(printed: str) -> list[str]:
    """Return the letters of each line that holds labels, in the order of the page."""
    body = printed[max(printed.find("MA="), 0) :]
    return [letters for line in body.split("\n") if (letters := _letters(line)) and "=" in line]


def _layout(page: str) -> Iterator[str]:
    """Yield the lines of a page that are not blank, with ``#`` for each number."""
    for line in page.split("\n"):
        if line.strip():
            yield NUMBER.sub("#", line).rstrip()


def _plain(line: str, number: str = "") -> str:
    """Return a line without blanks, its numbers normalized or replaced by ``number``."""

    def replacement(match: re.Match[str]) -> str:
        value = value_of(match[0])
        return number or (f"{value.normalize()}" if value else "0")

    return NUMBER.sub(replacement, "".join(line.split()))


def _typed_texts(name: str, printed: str) -> list[str]:
    """Return texts that may have been typed for a printed text."""
    if name == "MUP":
        return [printed, opposite(printed)]
    if name not in ANGLES:
        return [next(iter(texts_that_print(printed)), printed)]
    short = f"{float(printed):.6g}"
    return list(dict.fromkeys([printed, short, *texts_that_print(printed, True)]))[:MAX_ANGLE_TEXTS]
