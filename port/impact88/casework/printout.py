"""Reading a printout: text that was typed in or came from a scanner, into named fields.

The program prints labelled numbers in a fixed order (`FIELDS`). Blanks, line ends and form feeds
are nothing to rely on, so labels are looked for in the text without them; a number is whatever
stands between two labels. A label that occurs twice (``XA=`` before and after the impact) is told
apart by what came before it. One file may hold several printouts, with anything between them.

Nothing here computes: what the numbers should be is for `impact88.verify` to say.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations, pairwise
from typing import NamedTuple

from .. import files
from ..applesoft.errors import CODES
from ..errors import UserError
from ..fields import ANGLES, FIELDS, FINAL_SPINS, REPLIES, ZERO_DETERMINANT
from . import glyphs

LARGEST_FILE = 2_000_000
"""Bytes of the largest file that is read: some 2,500 printouts."""


_ORDER = [name for name in FIELDS if name not in ANGLES[1:]]
"""Labels in order; PA stands for the heading of the five angles."""
_PLACE = {name: place for place, name in enumerate(_ORDER)}

_A, _B, _I, _O, _S = "[A4]", "[B8]", "[IL1|!]", "[O0Q]", "[S5]"
_LABELS = {
    "MA": f"M{_A}=",
    "MB": f"M{_B}=",
    "IA": f"{_I}{_A}=",
    "IB": f"{_I}{_B}=",
    "DA": f"D{_A}=",
    "DB": f"D{_B}=",
    "PA": f"P{_A}P{_B}[T7]{_A}[T7]{_B}[G6C]{_A}",
    "UX": "UX=",
    "UY": "UY=",
    "WA": f"W{_A}=",
    "XA": f"X{_A}=",
    "YA": f"Y{_A}=",
    "VX": "VX=",
    "VY": "VY=",
    "WB": f"W{_B}=",
    "XB": f"X{_B}=",
    "YB": f"Y{_B}=",
    # not the end of a longer word, unless that is a digit in disguise
    "E": "(?<![A-HJKMNPR-Z])E=",
    "MUP": "MU=",
    "EM": "EM=",
    "KI": f"(?:{_I}N{_I}T{_I}{_A}L)?KE=",
    "LOSS": f"(?:KE)?L{_O}{_S}{_S}=",
    "VAX": f"V{_A}X=",
    "VAY": f"V{_A}Y=",
    "VBX": f"V{_B}X=",
    "VBY": f"V{_B}Y=",
}
_TWICE = {"XA": "XAF", "YA": "YAF", "XB": "XBF", "YB": "YBF", "WA": "WAF", "WB": "WBF"}
"""Labels printed before and after the impact: the first meaning, and the second."""


def _loosely(words: str) -> str:
    """A pattern for printed words without their blanks, letters that look like digits either way"""
    loose = {"I": _I, "L": _I, "O": _O, "S": _S, "B": _B, "Z": "[Z2]", "'": "['’`]?"}
    return "".join(loose.get(letter, letter) for letter in words if letter != " ")


_TOKEN = re.compile(
    "|".join(
        (
            r"(?P<ENTER>ENTER(?:(?!ENTER|M[A4]=).){10,80}?(?:\?|W_?\{?(?P<body>[AB48])\}?)\??)",
            rf"(?P<ERROR>\??(?P<message>{'|'.join(map(_loosely, CODES))})"
            rf"ERR{_O}R(?:{_I}N(?P<at>[0-9{_O[1:-1]}{_I[1:-1]}]{{1,5}}))?)",
            rf"(?P<ZERO>{_loosely(ZERO_DETERMINANT)})",
            r"(?P<STARS>[*X#]?[*]{3,}[*X#]?)",
            *(f"(?P<{name}>{pattern})" for name, pattern in _LABELS.items()),
        )
    )
)


@dataclass(frozen=True)
class Reading:
    """One number as read: ``text`` as it is taken, ``alternatives`` other ways to take it where a
    blank may or may not end it, and the line and column (from 1) where it stands.

    ``text`` may hold ``?`` for illegible characters. ``cut``: the text ends right after it, so more
    digits may have followed."""

    text: str
    line: int
    column: int
    alternatives: tuple[str, ...] = ()
    cut: bool = False

    @property
    def legible(self) -> bool:
        """Whether every character was read."""
        return glyphs.ILLEGIBLE not in self.text


class Remark(NamedTuple):
    """Something about the text worth telling: a field's name or "", what, and where."""

    name: str
    message: str
    line: int
    column: int

    def __str__(self) -> str:
        subject = f"{self.name}: " if self.name else ""
        return f"line {self.line}, column {self.column}: {subject}{self.message}"


@dataclass
class Printout:
    """One printout as read.

    ``fields``: name -> reading, for every number found; ``replies``: the velocities typed at the
    prompts, where the transcript shows them; ``angles``: other ways to cut the row of five angles,
    likeliest first; ``ending``: ``ZERO DETERMINANT`` or an Applesoft error as printed, with its
    line; ``ended``: whether the final row of asterisks is there; ``remarks``: what could not be
    read, and where.
    """

    line: int
    column: int
    fields: dict[str, Reading] = field(default_factory=dict)
    replies: dict[str, Reading] = field(default_factory=dict)
    angles: list[tuple[str, ...]] = field(default_factory=list)
    angles_guessed: bool = False
    ending: str | None = None
    ended: bool = False
    remarks: list[Remark] = field(default_factory=list)

    @property
    def has_final_spins(self) -> bool:
        """Whether any of the final WA, WB line is there, read or not: then M = N."""
        noted = {remark.name for remark in self.remarks}
        return any(name in self.fields or name in noted for name in FINAL_SPINS)

    def text(self, name: str) -> str | None:
        """The text of a field, None when it was not read."""
        reading = self.fields.get(name)
        return reading.text if reading else None


def outcome_fields(text: str) -> dict[str, str]:
    """The fields of what one run printed, by name; none where it stopped before printing any."""
    (shown,) = read_printouts(text)
    return {name: reading.text for name, reading in shown.fields.items()}


def read_file(path: str) -> list[Printout]:
    """The printouts in a file (``-``: standard input), UTF-8 or UTF-16.

    Raises UserError when it is too large, is no text or holds no printout."""
    where = files.called(path)
    data = files.read_bytes(path, LARGEST_FILE)
    if data[:2] not in (b"\xff\xfe", b"\xfe\xff") and len(data) > 8:
        # UTF-16 whose byte-order mark was lost: every other byte of such a text is zero
        for encoding, zeros in (("utf-16-le", data[1::2]), ("utf-16-be", data[0::2])):
            if zeros.count(0) > 0.9 * len(zeros):
                data = data[: len(data) // 2 * 2].decode(encoding, "replace").encode()
                break
    return read_printouts(files.decode(data, where), where)


def read_printouts(text: str, where: str = "text") -> list[Printout]:
    """The printouts in a text, in order. Raises UserError (naming ``where``) if there is none."""
    squeezed = glyphs.Squeezed(text)
    found = [_Reader(squeezed, tokens).printout() for tokens in _printouts(squeezed.text)]
    numbers = [sum(reading.legible for reading in one.fields.values()) for one in found]
    kept = [
        one
        for one, count in zip(found, numbers, strict=True)
        if count >= 6 or (one.ending and one.replies)
    ]
    if not kept:
        kept = [one for one, count in zip(found, numbers, strict=True) if count >= 2]
    if not kept:
        raise UserError(
            "no printout of the program in it; expected text with labels such as "
            "MA= ... MB= ... VAX= ... VAY= ...",
            where,
        )
    return kept


class _Token(NamedTuple):
    kind: str
    start: int
    stop: int
    match: re.Match[str]


def _tokens(text: str) -> Iterator[_Token]:
    for match in _TOKEN.finditer(text):
        # the groups "body", "message" and "at" are parts of a kind, never the outermost
        kind = next(name for name, part in match.groupdict().items() if part is not None)
        yield _Token(kind, match.start(), match.end(), match)


def _printouts(text: str) -> Iterator[list[_Token]]:
    """The tokens of each printout, each label under the name it has at its place, and at the end
    a token STOP where the next printout begins."""
    tokens = list(_tokens(text))
    current: list[_Token] = []
    place = -1  # of the last label taken
    closed = False
    for index, token in enumerate(tokens):
        if token.kind in _PLACE:
            here = _place_after(token.kind, place)
            if here is None or closed:
                following = tokens[index + 1] if index + 1 < len(tokens) else None
                stray = (
                    _PLACE[token.kind] > _PLACE["PA"]
                    and not closed
                    and following is not None
                    and following.kind in _PLACE
                    and _place_after(following.kind, place) is not None
                )
                if stray:
                    continue
                yield [*current, token._replace(kind="STOP")]
                current, place, closed = [], -1, False
                here = _place_after(token.kind, place)
            assert here is not None
            place = here
            current.append(token._replace(kind=_ORDER[place]))
            continue
        begins = token.kind == "ENTER" and (
            place >= 0 or closed or sum(old.kind == "ENTER" for old in current) == 2
        )
        if begins:
            yield [*current, token._replace(kind="STOP")]
            current, place, closed = [], -1, False
        current.append(token)
        closed = closed or token.kind in ("ERROR", "ZERO")
    if current:
        last = tokens[-1]
        yield [*current, _Token("STOP", len(text), len(text), last.match)]


def _place_after(label: str, place: int) -> int | None:
    """The first place after ``place`` where a label belongs; None when it has none."""
    for name in (label, _TWICE.get(label)):
        if name and _PLACE[name] > place:
            return _PLACE[name]
    return None


class _Reader:
    """Reads one printout from its tokens."""

    def __init__(self, squeezed: glyphs.Squeezed, tokens: Sequence[_Token]) -> None:
        self._squeezed = squeezed
        self._tokens = tokens
        line, column = squeezed.position(tokens[0].start)
        self._printout = Printout(line, column)

    def printout(self) -> Printout:
        """The printout."""
        stars = 0
        for token, following in pairwise(self._tokens):
            start, stop = token.stop, following.start
            if token.kind == "ENTER":
                self._read_reply(token, start, stop)
            elif token.kind == "ERROR":
                self._printout.ending = _error(token.match)
            elif token.kind == "ZERO":
                self._printout.ending = ZERO_DETERMINANT
            elif token.kind == "STARS":
                stars += 1
            elif token.kind == "PA":
                self._read_angles(start, stop)
            elif start < stop or following.kind != "ERROR":
                # an error leaves the line unfinished, its last label without a number
                self._read_number(token.kind, start, stop, open_end=following.kind == "STOP")
        before_last = self._tokens[-2].kind if len(self._tokens) > 1 else ""
        # the first row of asterisks stands before VAX, the final one after everything
        self._printout.ended = bool(stars) and before_last == "STARS" and self._past("VAX")
        return self._printout

    def _past(self, name: str) -> bool:
        return any(_PLACE.get(token.kind, -1) >= _PLACE[name] for token in self._tokens[:-1])

    def _remark(self, name: str, message: str, index: int) -> None:
        self._printout.remarks.append(Remark(name, message, *self._squeezed.position(index)))

    def _read_number(self, name: str, start: int, stop: int, open_end: bool) -> None:
        region = self._squeezed.text[start:stop]
        ends = re.search(r"[()\[\]{}%*]", region)
        if ends:
            stop = start + ends.start()
            region = region[: ends.start()]
        words = [glyphs.squeeze(word) for word in self._squeezed.original(start, stop).split()]
        words = [word for word in words if word]
        ways = _ways_to_read(words, open_end and not ends)
        line, column = self._squeezed.position(start)
        if not ways:
            ways = [damaged] if (damaged := _damaged(words)) else []
            what = f"{_shown(region)} is taken for {ways[0]}" if ways else _unreadable(region)
            self._remark(name, what, start)
            if not ways:
                return
        elif len(ways[0]) < len(region.lstrip("+")) and not (open_end and not ends):
            self._remark(name, f"{_shown(region)} is taken for {ways[0]}", start)
        if len(ways[0].lstrip("-")) > 40:
            self._remark(name, _unreadable(region), start)
            return
        texts = [glyphs.canonical(way) for way in ways]
        cut = open_end and not ends and self._squeezed.ends_at(stop)
        self._printout.fields[name] = Reading(texts[0], line, column, tuple(texts[1:]), cut)

    def _read_angles(self, start: int, stop: int) -> None:
        original = self._squeezed.original(start, stop)
        ways = _five_numbers(original)
        if not ways:
            region = self._squeezed.text[start:stop]
            self._remark("PA", f"{_shown(region)}: expected five angles, PA PB TA TB GA", start)
            return
        line, column = self._squeezed.position(start)
        for name, text in zip(ANGLES, ways[0], strict=True):
            self._printout.fields[name] = Reading(text, line, column)
        self._printout.angles = ways[1:]
        self._printout.angles_guessed = len(original.split()) < 5

    def _read_reply(self, token: _Token, start: int, stop: int) -> None:
        """The three numbers typed at a prompt, after any that INPUT refused."""
        body = token.match.group("body")
        first = not self._printout.replies and "ENTER" not in [
            earlier.kind for earlier in self._tokens[: self._tokens.index(token)]
        ]
        names = REPLIES["B" if body in ("B", "8") else "A" if body else "A" if first else "B"]
        original = self._squeezed.original(start, stop).split("PR#")[0]
        original = original.upper().split("REENTER")[-1].split("?EXTRA")[0]
        original = re.sub(r"\n\s*\?\?", ",", original)
        parts = glyphs.squeeze(original.replace(",", ";")).lstrip("?").split(";")
        if parts == [""]:
            return
        texts = [glyphs.as_number(part) for part in parts[:3]]
        line, column = self._squeezed.position(start)
        if len(texts) < 3 or None in texts:
            self._remark(
                "", f"reply {_shown(glyphs.squeeze(original))} is not three numbers", start
            )
            return
        for name, text in zip(names, texts, strict=True):
            assert text is not None
            self._printout.replies[name] = Reading(text, line, column)


def _shown(text: str) -> str:
    return repr(text if len(text) <= 30 else text[:27] + "...")


def _unreadable(region: str) -> str:
    return f"{_shown(region)}: expected a number" if region else "no number; expected one"


def _error(match: re.Match[str]) -> str:
    """An error message as Applesoft prints it."""
    found = match.group("message")
    message = next(one for one in CODES if re.fullmatch(_loosely(one), found))
    at = match.group("at")
    return f"?{message} ERROR" + (f" IN {glyphs.as_number(at)}" if at else "")


def _ways_to_read(words: Sequence[str], open_end: bool) -> list[str]:
    """The numbers that words may be: all joined, then fewer and fewer of them.

    With an open end (nothing of the printout follows) what comes after the number may be anything,
    so what stands on the number's own line, one word, comes first."""
    ways = [
        number
        for count in range(min(len(words), 12), 0, -1)
        if (number := glyphs.as_number("".join(words[:count]))) is not None
    ]
    if open_end and len(words) > 1 and len(ways) > 1:
        ways.reverse()
    return list(dict.fromkeys(ways))


def _damaged(words: Sequence[str]) -> str | None:
    """A number with a foreign character or two in it, which count as illegible; one at the very end
    is left out (a bracket misread)."""
    joined = "".join(words)
    if len(joined) > 16:
        return glyphs.leading_number(words[0])
    if (number := glyphs.as_number(joined[:-1])) is not None:
        return number
    for text in (joined, words[0] if words else ""):
        patched = re.sub(r"[^-+.0-9EOQØIL|!?]", glyphs.ILLEGIBLE, text)
        foreign = sum(old != new for old, new in zip(text, patched, strict=True))
        if foreign <= 2 and foreign < sum(map(str.isdigit, patched)):
            return glyphs.as_number(patched)
    return None


# --- the row of angles -------------------------------------------------------------------------

_PRINTED = re.compile(
    r"-?(?:0|[1-9?][0-9?]*|(?=[.])|[1-9?][0-9?]*(?=[.]))(?:[.][0-9?]*[1-9?])?"
    r"(?:E[+-][0-9?]{2})?"
)
_MOST_CUTS = 3000


def _five_numbers(original: str) -> list[tuple[str, ...]]:
    """The ways to cut a text into five numbers, likeliest first.

    Only blanks part the five angles, so where blanks were lost or line ends added the text alone
    does not tell. A cut is likelier the wider the gaps it cuts at, and the fewer blanks it leaves
    inside numbers; numbers the program could not have printed (``05``, ``1.50``) come last.
    """
    words = re.split(r"(\s+)", original.strip("\x00\x04\x07\x0c\r\n\t "))
    pieces = [glyphs.squeeze(word) for word in words[::2]]
    gaps = [len(gap.replace("\n", "").replace("\f", "")) or 1 for gap in words[1::2]]
    if any(not piece for piece in pieces) or len("".join(pieces)) > 80:
        return []
    if len(pieces) == 5:
        numbers = [glyphs.as_number(piece) for piece in pieces]
        if None not in numbers and _plainly_parted(pieces):
            return [tuple(glyphs.canonical(number) for number in numbers if number)]
    joined = "".join(pieces)
    gap_at: dict[int, int] = {}
    end = 0
    for piece, gap in zip(pieces, gaps, strict=False):
        end += len(piece)
        gap_at[end] = gap
    inside = range(1, len(joined))
    forced = [place for place in inside if joined[place] == "-" and joined[place - 1] != "E"]
    if len(forced) > 4:
        return []
    # places without a gap are tried only when there are too few gaps
    free = [place for place in (gap_at if len(gap_at) >= 4 else inside) if place not in forced]
    cuts: list[tuple[int, int, tuple[str, ...]]] = []
    for chosen in combinations(sorted(free), 4 - len(forced)):
        places = sorted((*chosen, *forced))
        bounds = [0, *places, len(joined)]
        numbers = [glyphs.as_number(joined[i:j]) for i, j in pairwise(bounds)]
        if None in numbers:
            continue
        texts = tuple(glyphs.canonical(number) for number in numbers if number)
        unprintable = sum(_PRINTED.fullmatch(text) is None for text in texts)
        merit = sum(gap_at.get(place, -3) for place in places)
        cuts.append((unprintable, -merit, texts))
        if len(cuts) > 60_000:
            break
    cuts.sort(key=lambda cut: cut[:2])
    return [texts for _, _, texts in cuts[:_MOST_CUTS]]


def _plainly_parted(pieces: Sequence[str]) -> bool:
    """Whether five words are the five angles beyond doubt: no word is a sign alone or ends where a
    number cannot."""
    return all(piece.strip("+-") and not piece.endswith(("E", "-", "+")) for piece in pieces)
