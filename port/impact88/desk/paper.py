"""The answers of the Paper view: the verdicts of `impact88 verify`, and its report.

A paper is a name and the bytes of its file, or of its text as edited on the page.
"""

from base64 import b64decode
from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import UserError
from ..files import packaged_bytes
from ..report.casefile import report as report_page
from ..verification.reading import plaintext as pasted
from ..verification.reading.printout import LARGEST_FILE
from ..verification.reporting import verification
from ..verification.reporting.examination import examine
from ..verification.reporting.verification import Examined, Verification

LONGEST_NAME = LONGEST_WORDS = 200
"""Characters of a file's name; of a date, a case or a name on the report: two of its lines."""
UNNAMED = "pasted.txt"
WORDS = ("date", "case", "examiner")
"""What stands on a report as given."""


def warm() -> None:
    judged("run1", packaged_bytes("impact88.legacy", "run1-as-printed.txt"))


def judged(name: str, data: bytes, seed: str = "") -> dict[str, Any]:
    """The verdicts on one paper; ``data`` is its file, ``seed`` what a person made of a picture.
    ``text``: the paper as text, which places count in, or None; ``problem``: why it cannot be
    judged, or None; ``objects``: what `impact88 verify --json` prints; ``printouts``: the verdicts
    in words."""
    examined = _examined(name, data, seed)
    return {
        "name": examined.file,
        "text": _text(examined, data),
        "problem": examined.error,
        "objects": examined.as_json(),
        "printouts": [_words(result) for result in examined.results],
    }


def _examined(name: str, data: bytes, seed: str = "") -> Examined:
    name = base_name(name)
    if len(data) > LARGEST_FILE:
        raise UserError(f"is larger than {LARGEST_FILE:,} bytes, the limit here", name)
    return examine(name, seed=seed, data=data)


def base_name(name: str) -> str:
    """A file's name without folders, of bounded length, never one that a command takes for more."""
    last = name.replace("\\", "/").rpartition("/")[2].strip()
    printable = "".join(character for character in last if character.isprintable())
    return printable[:LONGEST_NAME] if printable.strip(".-") else UNNAMED


def _text(examined: Examined, data: bytes) -> str | None:
    """The text that places are counted in: of words with their places, those laid out; of a
    picture, what was read on its only page."""
    try:
        return pasted.lay_out(pasted.decode(data, examined.file), examined.file)
    except UserError:
        return examined.results[0].text if len(examined.results) == 1 else None


def _words(result: Verification) -> dict[str, Any]:
    """A verdict in words: its title, what it says, what it rests on, and what stands under it."""
    says = verification.MEANINGS[result.verdict]
    contradicted = [check for check in [*result.fields, *result.replies] if check.same is False]
    look = [line for check in contradicted for line in verification.look(check)]
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
    """The page of `impact88 verify --report` for papers, each with ``name`` and ``data`` (base 64);
    ``words``: printed on it as given. Raises UserError."""
    given = {name: str(words.get(name) or "").strip() or None for name in WORDS}
    for name, text in given.items():
        if text and len(text) > LONGEST_WORDS:
            raise UserError(f"has more than {LONGEST_WORDS} characters", name)
    if not papers:
        raise UserError("there is nothing to report on")
    examined = [_examined(paper.get("name", ""), b64decode(paper["data"])) for paper in papers]
    return report_page(examined, given["date"], given["case"], given["examiner"])
