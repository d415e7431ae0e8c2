"""Captured printouts, and what may happen to them on the way to a reader."""

from __future__ import annotations

import os
import random
import re
from collections.abc import Callable
from typing import Any, NamedTuple

import captures

from impact88.collision.fields import ANGLES, FIELDS
from impact88.printouts.judging.judgement import FieldCheck, Status
from impact88.printouts.reading.plaintext import decode
from impact88.printouts.reading.printout import Printout, read_printouts
from impact88.printouts.reporting.examination import Verification

SWEEP = int(os.environ.get("IMPACT88_SWEEP") or 0)
"""Set to n: every captured scene, and n changes of each; else a sample that takes seconds. A sweep
takes minutes a test: add ``-o faulthandler_timeout=0`` to pytest's options."""

SAMPLE = """\
MA= 143.5 MB= 95.8 IA= 3728 IB= 1961

DA= 7.59 DB= 3.44

 PA PB TA TB GA
 -19.8      -38.7      0      60      -30

UX= -29.04 UY= 0 WA= 0 XA= -29.04 YA= 0

VX= 14.52 VY= 25.15 WB= 0 XB= 14.51 YB= 25.14

 E= 5E-03 MU= .911 EM= -.715

INITIAL KE= 100904.929 KE LOSS= 57.47 %

*****

VAX= -13.263 VAY= 3.449 (XA=-8.78 YA= 15.91)

VBX= -9.114 VBY= 19.982 (XB=-8.09 YB= 17.35)

 WA= -1.745 WB= -.8202

*****
"""
"""A page as an optical reader gives it."""

_NUMBER = re.compile(r"-?[.0-9]+(?:E[+-][0-9]{2})?")
_WORDS = {
    "E": " E=",
    "MUP": "MU=",
    "KI": "INITIAL KE=",
    "LOSS": "KE LOSS=",
    "XAF": "XA=",
    "YAF": "YA=",
    "XBF": "XB=",
    "YBF": "YB=",
    "WAF": "WA=",
    "WBF": "WB=",
}


def doubtful(result: Verification) -> list[FieldCheck]:
    """The numbers that could be neither confirmed nor contradicted."""
    return [check for check in result.fields if check.status is Status.DOUBTFUL]


def from_bytes(data: bytes, where: str) -> list[Printout]:
    """The printouts in a file's bytes."""
    return read_printouts(decode(data, where), where)


class Place(NamedTuple):
    """Where a field's number stands in a printout."""

    name: str
    start: int
    stop: int


def places(printout: str) -> list[Place]:
    """Every number of a captured printout, by the layout of lines 620 to 760 alone."""
    found = []
    at = printout.index("MA=")
    for name in FIELDS:
        if name in ANGLES:
            if name == ANGLES[0]:
                at = printout.index("GA\n", at) + 3
        else:
            word = _WORDS.get(name, f"{name}=")
            start = printout.find(word, at)
            if start < 0:
                break
            at = start + len(word)
        match = _NUMBER.search(printout, at)
        if match is None:
            break
        found.append(Place(name, match.start(), match.end()))
        at = match.end()
    return found


def normal_ends() -> list[dict[str, Any]]:
    """The captured scenes that end normally with a printout."""
    return [row for row in captures.scenes() if "VAX=" in row["printout"]]


def sampled(rows: list[Any], count: int, seed: int = 1) -> list[Any]:
    """``count`` of the rows, or all of them in a sweep."""
    return rows if SWEEP else random.Random(seed).sample(rows, min(count, len(rows)))


def first(cases: list[Any], count: int) -> list[Any]:
    """The first of some cases, or all of them in a sweep."""
    return cases if SWEEP else cases[:count]


def chosen(places: list[Place], rng: random.Random) -> list[Place]:
    """The places of one scene to change: one, or n of them in a sweep."""
    return rng.sample(places, min(SWEEP or 1, len(places)))


def body(printout: str) -> str:
    """The printout from MA= on: without prompts and replies."""
    return printout[printout.index("MA=") :]


def one_digit_changed(text: str, place: Place, rng: random.Random) -> str:
    """``text`` with one digit of a field replaced by another."""
    at = rng.choice([i for i in range(place.start, place.stop) if text[i].isdigit()])
    digit = rng.choice([d for d in "0123456789" if d != text[at]])
    return text[:at] + digit + text[at + 1 :]


def sprinkled(text: str, glyphs: str, chance: float, seed: int) -> str:
    rng = random.Random(seed)
    return "".join(c + (rng.choice(glyphs) if rng.random() < chance else "") for c in text)


def _wrapped(text: str) -> str:
    """As a screen of forty columns breaks it."""
    lines = [
        line[at : at + 40] for line in text.split("\n") for at in range(0, max(1, len(line)), 40)
    ]
    return "\n".join(lines)


MANGLED: dict[str, Callable[[str], str]] = {
    "one line": lambda text: re.sub(r"\s+", " ", text),
    "no blank lines": lambda text: re.sub(r"\n+", "\n", text),
    "forty columns": _wrapped,
    "line breaks anywhere": lambda text: sprinkled(text, "\n", 0.06, 1),
    "blanks and breaks anywhere": lambda text: sprinkled(text, " \n\r\f\t", 0.15, 2),
    "no blanks at all": lambda text: re.sub(r"\s+", "", text),
    "DOS line ends": lambda text: text.replace("\n", "\r\n"),
    "typographic": lambda text: text.replace("-", "−").replace("0", "O").replace("1", "l"),
}
MANGLED_HARMLESSLY = ("one line", "no blank lines", "forty columns", "DOS line ends")
"""Those that leave every number whole."""
