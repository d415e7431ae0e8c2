"""The answers of the Paper view: the verdicts of `impact88 verify`, and its report.

A paper is a name and the bytes of its file, or of its text as edited on the page.
"""

from base64 import b64decode
from collections.abc import Mapping, Sequence
from typing import Any

from ...casework.report.casefile import report as report_page
from ...errors import UserError
from ...files import packaged_bytes
from ...printouts.reading import plaintext as pasted
from ...printouts.reading.printout import LARGEST_FILE
from ...printouts.reporting import verification
from ...printouts.reporting.examination import examine
from ...printouts.reporting.verification import Examined, Verification

LONGEST_NAME = 200  # characters of a file's name
LONGEST_WORDS = 200
"""Characters of a date, a case or a name on the report: two of its lines."""
UNNAMED = "pasted.txt"
WORDS = ("date", "case", "examiner")
"""Texts printed on a report as given."""


def warm() -> None:
    judge("run1", packaged_bytes("impact88.legacy", "run1-as-printed.txt"))


def judge(name: str, data: bytes, seed: str = "") -> dict[str, Any]:
    """Return the verdicts on one paper; ``data`` is its file, ``seed`` a person's reading of a
    picture. ``text``: the paper as text, which places count in, or None; ``problem``: why it cannot
    be judged, or None; ``objects``: what `impact88 verify --json` prints; ``printouts``: the
    verdicts in words."""
    examination = _examine(name, data, seed)
    return {
        "name": examination.file,
        "text": _text(examination, data),
        "problem": examination.error,
        "objects": examination.as_json(),
        "printouts": [_words(result) for result in examination.results],
    }


def _examine(name: str, data: bytes, seed: str = "") -> Examined:
    name = base_name(name)
    if len(data) > LARGEST_FILE:
        raise UserError(f"is larger than {LARGEST_FILE:,} bytes, the limit here", name)
    return examine(name, seed=seed, data=data)


def base_name(name: str) -> str:
    """Return a file's name without folders, of bounded length, never one with a meaning to a
    command."""
    last = name.replace("\\", "/").rpartition("/")[2].strip()
    printable = "".join(character for character in last if character.isprintable())
    return printable[:LONGEST_NAME] if printable.strip(".-") else UNNAMED


def _text(examined: Examined, data: bytes) -> str | None:
    """Return the text that places refer to; for a picture, the reading of its only page."""
    try:
        return pasted.decode(data, examined.file)
    except UserError:
        return examined.results[0].text if len(examined.results) == 1 else None


def _words(result: Verification) -> dict[str, Any]:
    """Return a verdict in words: its title, its meaning, its summary, and the sections under it."""
    says = verification.MEANINGS[result.verdict]
    differing = [check for check in [*result.fields, *result.replies] if check.same is False]
    look = [line for check in differing for line in verification.look(check)]
    parts = {"where to look": look, **verification.sections(result)}
    return {
        "title": verification.TITLES[result.verdict],
        "says": says,
        "summary": [line for line in verification.summary(result) if line != says],
        "parts": [
            {"heading": heading[:1].upper() + heading[1:], "items": items}
            for heading, items in parts.items()
            if items
        ],
    }


def report(papers: Sequence[Mapping[str, str]], words: Mapping[str, str]) -> str:
    """Return the page of `impact88 verify --report` for papers, each with ``name`` and ``data``
    (base 64); ``words``: printed on it as given. Raises UserError."""
    header = {name: str(words.get(name) or "").strip() or None for name in WORDS}
    for name, text in header.items():
        if text and len(text) > LONGEST_WORDS:
            raise UserError(f"has more than {LONGEST_WORDS} characters", name)
    if not papers:
        raise UserError("there is nothing to report on")
    examinations = [_examine(paper.get("name", ""), b64decode(paper["data"])) for paper in papers]
    return report_page(examinations, header["date"], header["case"], header["examiner"])
