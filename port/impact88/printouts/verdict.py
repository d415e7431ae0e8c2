"""The verdict on a printout, from the comparison of all that was read with the page of its scene.

Everything that was not read as the program prints it is a `Finding` of one kind, at one place of
the text. The verdict follows from the findings by `findings.VERDICTS`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from types import MappingProxyType
from typing import Any

from ..program.replay import FINAL_SPINS
from .findings import Finding, Kind, Number, Verdict, Verification, verdict_of
from .glyphs import LOOKALIKES, Glyph, chars_of, plain_char
from .numerals import PRINTED, TYPED, as_printed, is_same_value, readings
from .page import (
    ANGLE_ROW,
    ASTERISKS,
    CELLS,
    INPUTS,
    NAMES,
    PARTNERS,
    PROMPTS,
    REPLIES,
    ROW_OF,
    ROWS,
    SLOT_CELLS,
    TITLES,
    WORD_CELLS,
    print_page,
    printed_rows,
)
from .programs import Listing
from .reader import CUT_NUMBER, Reading, read_printouts
from .search import Recovered, find_scenes, scene_name, unseen_digits

MAX_ALTERED = 2
"""Numbers that differ, beyond which a doubtful input, or the reader, explains them as well."""
MIN_LETTERS = 2
"""Letters in which another word differs: one may be a misprint."""
WORDS = {*re.findall("[A-Z]+", re.sub("{.*?}", "", " ".join(ROWS)))}
"""The words of the page's labels."""


def judge(
    text: str, given: Mapping[str, str] | None = None, program: Listing | None = None
) -> list[Verification]:
    """Return the verdict on each printout in a text.

    Parameters
    ----------
    text : str
        Any text.
    given : mapping of str to str, optional
        Inputs known from elsewhere, as typed, for a page that has only results.
    program : Listing, optional
        The program that may have printed it, by default the restored listing.

    Returns
    -------
    list of Verification
        Empty if the text has no printout.

    Examples
    --------
    >>> import impact88
    >>> judge(impact88.run(impact88.sample(1)).page)[0].verdict
    <Verdict.IDENTICAL: 'identical'>
    """
    program = program or Listing()
    return [judge_reading(reading, given or {}, program) for reading in read_printouts(text)]


def judge_reading(reading: Reading, given: Mapping[str, str], program: Listing) -> Verification:
    """Return the verdict on one printout. Parameters as for `judge`."""
    scenes, missing = find_scenes(reading, given, program)
    recovered: dict[str, Any] = {}
    if scenes:
        best = scenes[0]
        findings, comparison = _compare(reading, best, given, program)
        if len(scenes) > 1:
            findings = _either(findings, comparison, scenes)
        recovered["scene"] = best.scene
        recovered["unseen"] = unseen_digits(best, program)
        recovered["page"] = tuple(print_page(best.fields, comparison.typed_replies()))
    else:
        due = [name for name in NAMES if name not in FINAL_SPINS or name in reading.slots]
        comparison = PageComparison(reading, dict.fromkeys(due, ""), {}, reading.ending)
        findings = [comparison.number_finding(Kind.UNREAD, name) for name in missing]
        findings += comparison.text_findings()
    verification = Verification(
        verdict_of(findings),
        findings=tuple(sorted(findings, key=lambda finding: finding.start)),
        numbers={name: n for name, n in comparison.numbers.items() if n.read or n.printed},
        text=reading.text,
        span=reading.span(),
        **recovered,
    )
    if verification.verdict is not Verdict.DIFFERS:
        return verification
    from .explain import explain  # runs the port, which other verdicts do not need

    return replace(verification, explanation=explain(verification))


def _either(
    findings: Sequence[Finding], comparison: PageComparison, scenes: Sequence[Recovered]
) -> list[Finding]:
    """Return the findings with the inputs of scenes, each of which alone explains the page: as one
    of several if they were read cleanly and to their ends, else as open."""
    reading = comparison.reading
    printed = {scene.changed: scene.fields[scene.changed] for scene in scenes}
    is_cut = any(reading.is_cut(n, text) or reading.is_apart(n) for n, text in printed.items())
    is_sure = any(f.kind is Kind.NUMBER and f.name in printed for f in findings)
    kind = Kind.EITHER if is_sure and not is_cut else Kind.OPEN
    return [finding for finding in findings if finding.name not in printed] + [
        comparison.number_finding(kind, name)._replace(printed=text)
        for name, text in printed.items()
    ]


def _compare(
    reading: Reading, scene: Recovered, given: Mapping[str, str], program: Listing
) -> tuple[list[Finding], PageComparison]:
    """Return what was not read as the program prints it for a scene, and the comparison."""
    page = scene.fields, scene.scene, scene.ending
    comparison = PageComparison(reading, *page, given)
    findings = comparison.findings()
    if layout := program.layout(scene.scene):
        own_findings = {*map(_without_place, PageComparison(layout, *page).findings())}
        findings = [finding for finding in findings if _without_place(finding) not in own_findings]
    return comparison.settle(findings), comparison


def _without_place(finding: Finding) -> tuple[Kind, str, str]:
    """Return what a finding is, wherever it is."""
    return finding.kind, finding.name, "".join(finding.read.upper().split())


class PageComparison:
    """Comparison of a reading with the page of a scene.

    Parameters
    ----------
    reading : Reading
        What was read.
    fields : mapping of str to str
        The numbers that the program prints.
    scene : mapping of str to str
        The scene as typed.
    ending : str
        The message that ends the program.
    given : mapping of str to str
        Inputs that the page need not have.
    """

    def __init__(
        self,
        reading: Reading,
        fields: Mapping[str, str],
        scene: Mapping[str, str],
        ending: str,
        given: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self.reading, self.fields, self.scene = reading, fields, scene
        self.places = reading.places()
        self.ending = ending.replace(" ", "")
        rows = {*printed_rows({**fields, **dict.fromkeys(REPLIES, "")})}
        self.read_rows = {CELLS[j].row for j in reading.chars} & rows
        self.words = [
            word
            for word in WORD_CELLS
            if (cell := CELLS[word[0]]).row in self.read_rows
            and (cell.name in fields or cell.name not in NAMES)
        ]
        lost = rows - self.read_rows - {ANGLE_ROW}
        for pair in ({*PROMPTS}, {*ASTERISKS}):  # both may be absent
            lost -= pair if pair <= lost else set()
        self.lost_rows = lost
        self.numbers = {
            name: self._number(name)
            for name in NAMES
            if name in reading.slots
            or (
                name in fields
                and not (given and (scene_name(name) in given or ROW_OF[name] in lost))
            )
        }
        if given:  # a page with results only
            self.lost_rows = set()

    def finding(
        self, kind: Kind, name: str, glyphs: Sequence[Glyph], printed: str, cell: int
    ) -> Finding:
        """Return a finding at the place of some glyphs, or in the gap where a cell would be."""
        if glyphs:
            start, stop = glyphs[0].offset, glyphs[-1].offset + 1
            return Finding(kind, name, start, stop, self.reading.text[start:stop], printed)
        start, stop = self.reading.span()
        start = max((place[1] for j, place in self.places.items() if j < cell), default=start)
        stop = min((place[0] for j, place in self.places.items() if j > cell), default=stop)
        return Finding(kind, name, start, max(start, stop), "", printed)

    def number_finding(self, kind: Kind, name: str) -> Finding:
        """Return a finding at the place of a number."""
        slot = self.reading.slots.get(name)
        printed = self.fields.get(name, "")
        return self.finding(kind, name, slot.glyphs if slot else [], printed, SLOT_CELLS[name])

    def _number(self, name: str) -> Number:
        finding = self.number_finding(Kind.UNREAD, name)
        return Number(finding.printed, finding.read, finding.start, finding.stop)

    def findings(self) -> list[Finding]:
        """Return all that was not read as the program prints it."""
        findings = [
            self.number_finding(kind, name)
            for name in self.numbers
            if (kind := self._number_kind(name))
        ]
        findings += self._reply_findings()
        findings += self.text_findings()
        findings += self._repeated_findings()
        if self.reading.ending != self.ending:
            is_cut = self.ending.startswith(self.reading.ending)
            kind = Kind.UNREAD if is_cut else Kind.LABEL
            findings.append(self.finding(kind, "message", [], self.ending, len(CELLS)))
        return findings

    def text_findings(self) -> list[Finding]:
        """Return the words, rows and other text that are not as the program prints them."""
        chars, findings = self.reading.chars, []
        foreign = [*self.reading.foreign]
        if not self.ending:  # an error leaves the label of the number that it met
            due = {j for word in self.words for j in word}
            foreign += [[chars[j]] for j in sorted(chars.keys() - due)]
        for word in self.words:
            cell, glyphs = word[0], [chars[j] for j in word if j in chars]
            printed = "".join(CELLS[j].char for j in word)
            if chars_of(glyphs) != printed:
                kind = Kind.MISREAD if glyphs else Kind.LOST
                for run in [run for run in foreign if glyphs and _touches(run, glyphs)]:
                    glyphs = sorted([*glyphs, *run], key=lambda glyph: glyph.offset)
                    foreign.remove(run)
                findings.append(self.finding(kind, CELLS[cell].name, glyphs, printed, cell))
        for row in self.lost_rows:
            cell = next(j for j, c in enumerate(CELLS) if c.row == row)
            findings.append(self.finding(Kind.ROW_LOST, TITLES[row], [], TITLES[row], cell))
        return findings + [self.finding(Kind.FOREIGN, "", run, "", 0) for run in foreign]

    def _number_kind(self, name: str) -> Kind | None:
        """Return what a number is that was not read as printed; None for one that was."""
        slot, text = self.reading.slots.get(name), self.fields.get(name, "")
        if not slot:
            return Kind.UNREAD
        read, is_machine_read = slot.text, self.reading.is_machine_read
        if not text and slot.label != "exact":
            return Kind.FOREIGN
        if read == text and slot.is_clean:
            return None
        if text in readings(read) or (is_machine_read and read == text.replace(".", "")):
            return Kind.DOUBT
        if slot.is_clean:
            is_whole = slot.is_bounded and not self.reading.is_cut(name, text)
            return Kind.NUMBER if is_whole else Kind.UNREAD
        return Kind.DOUBT if is_machine_read and _is_alike(read, text) else Kind.UNREAD

    def typed_replies(self) -> dict[str, str]:
        """Return the replies at the prompts that the scene gives."""
        return {
            reply: ",".join(self.scene.get(name, "") for name in names)
            for reply, names in REPLIES.items()
        }

    def _reply_findings(self) -> Iterator[Finding]:
        """Yield the replies that are not the scene's numbers, and those that prompts lack."""
        for reply, reply_text in self.typed_replies().items():
            slot = self.reading.slots.get(reply)
            if not slot:
                if ROW_OF[reply] in self.read_rows:
                    yield self.finding(Kind.LOST, reply, [], reply_text, SLOT_CELLS[reply])
                continue
            texts = [self.reading.replies.get(name, "") for name in REPLIES[reply]]
            is_same = all(map(is_same_value, texts, reply_text.split(",")))
            is_exact = slot.label == "exact" and not slot.is_torn
            if is_same and is_exact:
                continue
            is_clean = is_exact and all(map(TYPED.fullmatch, texts))
            is_cut = any(glyph.gap for glyph in slot.glyphs)  # blanks, perhaps of digits
            is_cut |= self.reading.is_cut(reply, reply_text)
            kind = Kind.UNREAD if is_cut else Kind.NUMBER
            if is_same or not is_clean or self.reading.is_machine_read:
                kind = Kind.DOUBT
            yield self.finding(kind, reply, slot.glyphs, reply_text, 0)

    def _repeated_findings(self) -> Iterator[Finding]:
        """Yield the rows that were printed twice, or out of order, and the numbers that were
        printed once more, cleanly as another: not read if several rows were, which may be those of
        another printout."""
        rows = {ROW_OF[name] for name, _ in self.reading.repeated}
        for row, glyph in self.reading.disorder:
            kind = Kind.ROW_TWICE if row in rows else Kind.DISORDER
            yield self.finding(kind, TITLES[row], [glyph], TITLES[row], 0)
        kind = Kind.NUMBER if len(rows) == 1 else Kind.UNREAD
        for name, slot in self.reading.repeated:
            printed = self.fields.get(name, "")
            is_sure = printed and slot.is_clean and slot.is_bounded
            if is_sure and as_printed(slot.text) != printed:
                yield self.finding(kind, name, slot.glyphs, printed, 0)

    def settle(self, findings: Sequence[Finding]) -> list[Finding]:
        """Return the findings, with numbers that differ left open where they prove nothing.

        On a page read exactly elsewhere, another word in a label's place differs. Numbers are open
        where an input was not read, or may have lost digits, or was read otherwise in doubt; where
        a row lost its end; where more of them differ than an alteration explains, while an input is
        in doubt, a number was not read or a machine read the page; and on such a page unless each
        is one digit for another, and not the same in both. An angle is open if that with which it
        enters as a sum is in doubt.
        """
        words = [finding for finding in findings if finding.kind is Kind.MISREAD]
        names = {finding.name for finding in words}
        is_exact = all(f in words or (f.read == f.printed and f.name in names) for f in findings)
        if is_exact and all(map(_is_other_word, words)):
            findings = [f._replace(kind=Kind.LABEL) if f in words else f for f in findings]
        is_machine_read = self.reading.is_machine_read
        numbers = [finding for finding in findings if finding.kind is Kind.NUMBER]
        unread = [finding for finding in findings if finding.kind is Kind.UNREAD]
        unsure = {
            f.name: f.read != f.printed
            for f in findings
            if f.kind is Kind.DOUBT and self._is_unsure(f.name)
        }
        is_open = bool(is_machine_read or unsure or unread)
        is_open &= len([*numbers, *unread]) > MAX_ALTERED
        is_open |= not is_machine_read and any(unsure.values())
        is_open |= any(f.name in INPUTS for f in unread) or any(map(self.reading.is_apart, INPUTS))
        is_open |= any(f.read and self.reading.extra_blanks[f.name][1] == math.inf for f in unread)
        swaps = [*map(_swap, numbers)]
        is_open |= is_machine_read and ("" in swaps or len({*swaps}) < len(swaps))
        open_numbers = [f for f in numbers if is_open or PARTNERS.get(f.name) in unsure]
        return [f._replace(kind=Kind.OPEN) if f in open_numbers else f for f in findings]

    def _is_unsure(self, name: str) -> bool:
        """Return True for an input read with doubt, other than one that people wrote otherwise."""
        slot = self.reading.slots[name]
        return name in INPUTS and (not slot.is_clean or bool(CUT_NUMBER.match(slot.text)))


def _touches(run: Sequence[Glyph], word: Sequence[Glyph]) -> bool:
    """Return True for glyphs right before or after those of a word."""
    return 1 in (word[0].offset - run[-1].offset, run[0].offset - word[-1].offset)


def _is_other_word(finding: Finding) -> bool:
    """Return True for another word than a label's, not one that lost letters or was misread.

    Another label of the page is one; else a single letter may be a misprint. What the Apple cannot
    print was not read exactly.
    """
    read, printed = finding.read.upper(), finding.printed
    same = _count_same(read, printed)
    if read in WORDS:
        return same < len(read)
    if len(read) == len(printed):
        pairs = zip(printed, read, strict=True)
        read = "".join(a if b in LOOKALIKES.get(a, "") else b for a, b in pairs)
    same = _count_same(read, printed)
    is_word = read.isascii() and read.isalpha() and same < len(read)
    return is_word and max(len(read), len(printed)) - same >= MIN_LETTERS


def _is_alike(read: str, printed: str) -> bool:
    """Return True if at least half of a number's characters were read, in order, and not as
    another number."""
    if PRINTED.fullmatch(read) and read not in printed and printed not in read:
        return False
    return 2 * max(_count_same(text, printed) for text in (read, *readings(read))) >= len(printed)


def _count_same(read: str, printed: str) -> int:
    """Return how many characters two texts have in common, in order."""
    blocks = SequenceMatcher(None, read, printed).get_matching_blocks()
    return sum(block.size for block in blocks)


def _swap(finding: Finding) -> str:
    """Return the digit printed and the one read in its place; "" for other findings."""
    read = "".join(map(plain_char, "".join(finding.read.split())))
    pairs = [a + b for a, b in zip(finding.printed, read, strict=False) if a != b]
    is_swap = len(pairs) == 1 and len(finding.printed) == len(read) and pairs[0].isdigit()
    return pairs[0] if is_swap else ""
