"""The verdict on a printout, from the comparison of all that was read with the page of its scene.

Everything that was not read as the program prints it is a `Finding` of one kind, at one place of
the text. The verdict follows from the findings by `findings.VERDICTS`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import SequenceMatcher
from types import MappingProxyType

from .findings import Finding, Kind, Number, Verdict, Verification, verdict_of
from .glyphs import LOOKALIKES, Glyph, plain_char
from .labels import LABELS
from .numerals import TYPED, as_printed, is_same_value, readings
from .page import (
    ANGLES,
    ASTERISKS,
    CELLS,
    HEADING,
    INPUTS,
    NAMES,
    PROMPTS,
    REPLIES,
    ROW_OF,
    TITLES,
    Cell,
    print_page,
    printed_rows,
)
from .programs import Listing
from .reader import TWINS, Reading, Slot, read_printouts
from .search import FINAL_SPINS, find_scenes, scene_name, unseen_digits

# Fifteen numbers decide a verdict: the three below; `reader.MIN_NUMBERS` and `reader.PAGE_STEP`;
# the nine costs of `costs`; and the half of what differs that a slip must explain (`search`).
MACHINE_READ = 3
"""Misread characters of labels and numbers from which a page counts as read by a machine."""
MAX_ALTERED = 2
"""Numbers that differ, beyond which a doubtful input, or the reader, explains them as well."""
MAX_FOREIGN_DIGITS = 6
"""Digits that belong to nothing, from which it is open whether the numbers were read rightly."""
LEADING_ZERO = re.compile("-?0[0-9]")
"""The beginning of a number that lost digits."""
_NO_NUMBER = re.compile("[^-0-9.E,+]")
_WORDS = frozenset(re.findall("[A-Z]+", " ".join(label.text for label in LABELS if label.row > 1)))


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
    if not scenes:
        return _without_scene(reading, missing)
    recovered, *alternatives = scenes
    page = recovered.fields, recovered.scene, recovered.ending
    layout = program.layout(recovered.scene)
    own = Comparison(layout, *page) if layout else None
    comparison = Comparison(reading, *page, given, own)
    findings = comparison.findings()
    verification = Verification(
        verdict_of(findings),
        recovered.scene,
        comparison.numbers,
        tuple(findings),
        unseen_digits(recovered, program),
        page=tuple(print_page(recovered.fields, comparison.typed_replies())),
        text=reading.text,
        span=reading.span(),
    )
    if verification.verdict is not Verdict.DIFFERS:
        return verification
    from .explain import explain  # runs the port, which other verdicts do not need

    others = [alternative.candidate.printed for alternative in alternatives]
    return replace(verification, explanation=explain(verification, others))


def _without_place(finding: Finding) -> tuple[Kind, str, str]:
    """Return what a finding is, wherever it is."""
    return finding.kind, finding.name, "".join(finding.read.upper().split())


def _without_scene(reading: Reading, missing: Sequence[str]) -> Verification:
    """Return the verdict on a printout that lacks inputs."""
    due = [name for name in NAMES if name not in FINAL_SPINS or name in reading.slots]
    comparison = Comparison(reading, dict.fromkeys(due, ""), {}, reading.ending)
    findings = [comparison.number_finding(Kind.UNREAD, name) for name in missing]
    findings += comparison.text_findings()
    return Verification(
        verdict_of(findings),
        findings=tuple(sorted(findings, key=lambda finding: finding.start)),
        numbers={name: comparison.numbers[name] for name in due if name in reading.slots},
        text=reading.text,
        span=reading.span(),
    )


@dataclass
class Word:
    """A word or mark of the page: its cells, the glyphs that were read for them, and whether the
    equals sign of its label, or the heading that it belongs to, was read; nothing touches a whole
    one."""

    cells: list[int] = field(default_factory=list)
    glyphs: list[Glyph] = field(default_factory=list)
    is_marked: bool = False
    is_whole: bool = False

    @property
    def first(self) -> Cell:
        """The first cell."""
        return CELLS[self.cells[0]]

    @property
    def printed(self) -> str:
        """The printed characters."""
        return "".join(CELLS[j].char for j in self.cells)

    @property
    def label(self) -> str:
        """The letters of all words before the equals sign that the word belongs to."""
        cells = (CELLS[j] for j in range(self.cells[-1] + 1))
        return "".join(c.char for c in cells if c.kind == "word" and c.name == self.first.name)

    @property
    def read(self) -> str:
        """The characters that were read."""
        return "".join(glyph.char for glyph in self.glyphs)

    @property
    def is_other_label(self) -> bool:
        """True if another word is in the place of a label's word, whole and with its "=".

        It is one of the program's words, or has hardly a letter of the label; what is left of a
        label that lost letters is no other one.
        """
        is_word = self.read.isascii() and self.read.isalpha() and self.read != self.printed
        if not (is_word and self.is_marked and self.is_whole and self.first.char.isalpha()):
            return False
        letters = iter(self.label)
        if all(char in letters for char in self.read):
            return False
        alike = self.printed + "".join(LOOKALIKES.get(char, "") for char in self.printed)
        shared = sum(char in alike for char in self.read)
        return self.read in _WORDS or 2 * shared < len(self.printed)


class Comparison:
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
    layout : Comparison, optional
        That of an office's copy's own page for the scene: what it finds is no finding here.
    """

    def __init__(
        self,
        reading: Reading,
        fields: Mapping[str, str],
        scene: Mapping[str, str],
        ending: str,
        given: Mapping[str, str] = MappingProxyType({}),
        layout: Comparison | None = None,
    ) -> None:
        self.layout = layout
        self.reading, self.fields, self.scene = reading, fields, scene
        self.ending = ending.replace(" ", "")
        self.words, self.lost_rows = self._words()
        names = [name for name in NAMES if name in fields or name in reading.slots]
        if given:  # of a page with results only
            names = [name for name in names if name in reading.slots or self._is_due(name, given)]
            self.lost_rows = []
        self.numbers = {name: self._number(name) for name in names}
        damaged = [name for name in names if _NO_NUMBER.search(reading_text(reading, name))]
        others = {j for word in self.words if word.is_other_label for j in word.cells}
        misread = [
            j
            for j, glyph in reading.chars.items()
            if glyph.char != CELLS[j].char and glyph.char.isalnum() and j not in others
        ]
        self.is_machine_read = len(damaged) + len(misread) >= MACHINE_READ

    def _is_due(self, name: str, given: Mapping[str, str]) -> bool:
        return scene_name(name) not in given and ROW_OF[name] not in self.lost_rows

    # --- places -----------------------------------------------------------------------------------

    def _place(
        self, name: str, glyphs: Sequence[Glyph], cell: int | None = None
    ) -> tuple[int, int]:
        """Return the place of glyphs, or the gap where a number's, or a cell's, would be."""
        if glyphs:
            return glyphs[0].offset, glyphs[-1].offset + 1
        slot = "ANGLES" if name in ANGLES else name
        at = (
            cell
            if cell is not None
            else next((j for j, one in enumerate(CELLS) if one.name == slot), 0)
        )
        read = {j: [glyph] for j, glyph in self.reading.chars.items()}
        for j, one in enumerate(CELLS):
            names = ANGLES if one.name == "ANGLES" else (one.name,)
            slots = [self.reading.slots[n] for n in names if n in self.reading.slots]
            if one.kind == "slot" and slots:
                read[j] = [glyph for slot in slots for glyph in slot.glyphs]
        start, stop = self.reading.span()
        before = [j for j in read if j < at]
        behind = [j for j in read if j > at]
        if before:
            start = max(glyph.offset for glyph in read[max(before)]) + 1
        if behind:
            stop = min(glyph.offset for glyph in read[min(behind)])
        return min(start, stop), max(start, stop)

    def finding(
        self, kind: Kind, name: str, glyphs: Sequence[Glyph], printed: str, cell: int | None = None
    ) -> Finding:
        """Return a finding at the place of some glyphs."""
        start, stop = self._place(name, glyphs, cell)
        read = self.reading.text[start:stop] if glyphs else ""
        return Finding(kind, name, start, stop, read, printed)

    def number_finding(self, kind: Kind, name: str) -> Finding:
        """Return a finding at the place of a number."""
        slot = self.reading.slots.get(name)
        return self.finding(kind, name, slot.glyphs if slot else [], self.fields.get(name, ""))

    def _number(self, name: str) -> Number:
        finding = self.number_finding(Kind.UNREAD, name)
        return Number(finding.printed, finding.read, finding.start, finding.stop)

    # --- findings ---------------------------------------------------------------------------------

    def findings(self) -> list[Finding]:
        """Return all that was not read as the program prints it, in the order of the text."""
        findings = [
            self.number_finding(kind, name)
            for name in self.numbers
            if (kind := self._number_kind(name))
        ]
        findings += self._reply_findings()
        findings += self.text_findings()
        findings += self._repeated_findings()
        if self.reading.ending != self.ending:
            kind = Kind.LABEL if self.reading.ending else Kind.UNREAD
            findings.append(self.finding(kind, "message", [], self.ending, len(CELLS)))
        if self.layout:
            expected = {*map(_without_place, self.layout.findings())}
            findings = [finding for finding in findings if _without_place(finding) not in expected]
        findings = self._settle(findings)
        return sorted(findings, key=lambda finding: finding.start)

    def text_findings(self) -> list[Finding]:
        """Return the words, rows and other text that are not as the program prints them."""
        findings = [
            self.finding(
                self._word_kind(word), word.first.name, word.glyphs, word.printed, word.cells[0]
            )
            for word in self.words
            if word.read != word.printed
        ]
        for row in self.lost_rows:
            cell = next(j for j, one in enumerate(CELLS) if one.row == row)
            findings.append(self.finding(Kind.ROW_LOST, TITLES[row], [], TITLES[row], cell))
        findings += [self.finding(Kind.FOREIGN, "", run, "") for run in self.reading.foreign]
        return findings

    def _number_kind(self, name: str) -> Kind | None:
        """Return what a number is that was not read as printed; None for one that was."""
        slot, printed = self.reading.slots.get(name), self.fields.get(name, "")
        if not slot:
            return Kind.UNREAD
        read = slot.text
        if read == printed and slot.is_clean:
            return None
        if printed in (read, as_printed(read), read.strip("()[]{}")) or printed in readings(read):
            return Kind.DOUBT
        if slot.is_clean:
            is_end = slot.is_bounded and not self._is_cut(slot, printed)
            return Kind.NUMBER if is_end else Kind.UNREAD
        return Kind.DOUBT if self.is_machine_read and _is_alike(read, printed) else Kind.UNREAD

    def _is_cut(self, slot: Slot, printed: str) -> bool:
        """Return True for the beginning of a number at the end of its line."""
        behind = self.reading.text[slot.glyphs[-1].offset + 1 :]
        return printed.startswith(slot.text) and bool(re.match(r"[^\S\n]*(\r?\n|$)", behind))

    def is_contradiction(self, name: str, slot: Slot, printed: str) -> bool:
        """Return True if a number that was read again is cleanly another.

        One whose label is on two rows is another only if all of its row was read again.
        """
        row = {other for other in NAMES if ROW_OF[other] == ROW_OF.get(name)}
        is_sure = name not in TWINS or row <= {other for other, _ in self.reading.repeated}
        return is_sure and slot.is_clean and slot.is_bounded and as_printed(slot.text) != printed

    def typed_replies(self) -> dict[str, str]:
        """Return the replies at the prompts that the scene gives."""
        return {
            reply: ",".join(self.scene.get(name, "") for name in names)
            for reply, names in REPLIES.items()
        }

    def _reply_findings(self) -> Iterator[Finding]:
        """Yield the replies that are not the scene's numbers."""
        for reply, printed in self.typed_replies().items():
            if not (slot := self.reading.slots.get(reply)):
                continue
            texts = [self.reading.replies.get(name, "") for name in REPLIES[reply]]
            is_same = all(map(is_same_value, texts, printed.split(",")))
            if is_same and slot.label == "exact":
                continue
            is_clean = slot.label == "exact" and all(map(TYPED.fullmatch, texts))
            is_other = is_clean and not is_same and not self.is_machine_read
            yield self.finding(Kind.NUMBER if is_other else Kind.DOUBT, reply, slot.glyphs, printed)

    def _word_kind(self, word: Word) -> Kind:
        if word.is_other_label and not self.is_machine_read:
            return Kind.LABEL
        return Kind.MISREAD if word.read else Kind.LOST

    def _words(self) -> tuple[list[Word], list[int]]:
        """Return the words and marks that the program prints, and the rows of which none was read.

        Both prompts may be absent, and both rows of asterisks.
        """
        by_row: dict[int, list[Word]] = {}
        rows = printed_rows({**self.fields, **dict.fromkeys(REPLIES, "")})
        for j, cell in enumerate(CELLS):
            is_due = cell.name in self.fields or cell.name not in NAMES
            if cell.kind != "word" or cell.row not in rows or not is_due:
                continue
            words = by_row.setdefault(cell.row, [])
            if cell.first:
                words.append(Word(is_marked=self._is_marked(j)))
            words[-1].cells.append(j)
            if j in self.reading.other_labels:
                words[-1].glyphs = [*self.reading.other_labels[j]]
                first = words[-1].glyphs[0]
                words[-1].is_whole = first.gap > 0 or self.reading.text[first.offset - 1] == "("
            elif j in self.reading.chars and words[-1].cells[0] not in self.reading.other_labels:
                words[-1].glyphs.append(self.reading.chars[j])
                words[-1].is_whole |= words[-1].glyphs[0].gap > 0
        lost = {row for row, words in by_row.items() if not any(word.glyphs for word in words)}
        kept = [word for row, words in by_row.items() if row not in lost for word in words]
        for pair in ({*PROMPTS}, {*ASTERISKS}):
            lost -= pair if pair <= lost else set()
        return kept, sorted(lost)

    def _is_marked(self, j: int) -> bool:
        """Return True if the equals sign of the label that has a cell was read."""
        if CELLS[j].row in PROMPTS:
            return False
        if CELLS[j].row == HEADING:
            return True
        names = CELLS[j].name
        equals = [k for k, cell in enumerate(CELLS) if cell.char == "=" and cell.name == names]
        return any(k in self.reading.chars and self.reading.chars[k].char == "=" for k in equals)

    def _repeated_findings(self) -> Iterator[Finding]:
        """Yield the numbers that were printed twice, and the rows that were, or out of order."""
        by_row: dict[int, list[Finding]] = {}
        for name, slot in self.reading.repeated:
            printed = self.fields.get(name, "")
            is_other = bool(printed) and self.is_contradiction(name, slot, printed)
            finding = self.finding(
                Kind.NUMBER if is_other else Kind.TWICE, name, slot.glyphs, printed
            )
            by_row.setdefault(ROW_OF.get(name, 0), []).append(finding)
        for row, glyph in self.reading.disorder:
            repeated = by_row.get(row, [])
            is_twice = {finding.name for finding in repeated} >= {
                name for name in NAMES if ROW_OF[name] == row
            }
            if is_twice and all(finding.kind is Kind.TWICE for finding in repeated):
                by_row[row] = []
            kind = Kind.ROW_TWICE if is_twice else Kind.DISORDER
            yield self.finding(kind, TITLES[row], [glyph], TITLES[row])
        yield from (finding for repeated in by_row.values() for finding in repeated)

    # --- which contradictions count ---------------------------------------------------------------

    def _settle(self, findings: Sequence[Finding]) -> list[Finding]:
        """Return the findings, with numbers that differ left open where they prove nothing.

        They do not where inputs were not read, where more of them differ than an alteration
        explains while an input is in doubt or a machine read the page, and on such a page unless
        each is one digit for another in which the reader does not err elsewhere.
        """
        if self.is_machine_read:
            findings = [f._replace(kind=Kind.DOUBT) if _is_slight(f) else f for f in findings]
        numbers = [finding for finding in findings if finding.kind is Kind.NUMBER]
        if not numbers:
            return [*findings]
        unread = [finding for finding in findings if finding.kind is Kind.UNREAD]
        digits = sum(map(str.isdigit, "".join(f.read for f in findings if f.kind is Kind.FOREIGN)))
        inputs = [name for name in self.numbers if name in INPUTS]
        is_unsure = digits >= MAX_FOREIGN_DIGITS or any(map(self._is_doubtful, inputs))
        is_open = any(finding.name in INPUTS for finding in unread)
        is_open |= is_unsure and len(numbers) + len(unread) > MAX_ALTERED
        if self.is_machine_read:
            swaps = [swap for finding in [*numbers, *unread] if (swap := _swap(finding))]
            is_sure = len({*swaps}) == len(swaps) and all(map(_swap, numbers))
            is_open |= not is_sure or len(numbers) + len(unread) > MAX_ALTERED
        if not is_open:
            return [*findings]
        return [
            finding._replace(kind=Kind.OPEN) if finding.kind is Kind.NUMBER else finding
            for finding in findings
        ]

    def _is_doubtful(self, name: str) -> bool:
        """Return True for a number that was not read in one piece behind its exact label."""
        slot = self.reading.slots.get(name)
        is_clean = bool(slot and slot.is_clean and slot.is_bounded)
        is_clean = is_clean and not LEADING_ZERO.match(reading_text(self.reading, name))
        return not is_clean and not (self.layout and self.layout._is_doubtful(name))


def reading_text(reading: Reading, name: str) -> str:
    """Return the characters in the place of a number, "" for none."""
    return reading.slots[name].text if name in reading.slots else ""


def _is_alike(read: str, printed: str) -> bool:
    """Return True if at least half of a number's characters were read, in order."""
    matchers = [SequenceMatcher(None, text, printed) for text in (read, *readings(read))]
    shared = [sum(block.size for block in one.get_matching_blocks()) for one in matchers]
    return 2 * max(shared) >= len(printed)


def _is_slight(finding: Finding) -> bool:
    """Return True for a number that differs in nothing but its sign or point."""
    digits = [re.sub("[^0-9E]", "", text) for text in (finding.read, finding.printed)]
    return finding.kind is Kind.NUMBER and digits[0] == digits[1] != ""


def _swap(finding: Finding) -> str:
    """Return the digit printed and the one read in its place; "" for other findings."""
    read = "".join(map(plain_char, "".join(finding.read.split())))
    pairs = [a + b for a, b in zip(finding.printed, read, strict=False) if a != b]
    is_swap = len(pairs) == 1 and len(finding.printed) == len(read) and pairs[0].isdigit()
    return pairs[0] if is_swap else ""
