"""Verified printouts as pages show them: text and picture with what was marked on each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from hashlib import sha256
from typing import TYPE_CHECKING, NamedTuple

from ..errors import UserError
from ..printouts import VERDICTS, Kind, Verdict, Verification, judge, words
from ..printouts.sources import read_text

if TYPE_CHECKING:
    from ..pictures.verdict import PictureVerification

PICTURE_STARTS = (b"\x89PNG\r\n", b"\xff\xd8\xff", b"II*\0", b"MM\0*", b"%PDF-")
"""First bytes of PNG, JPEG, TIFF (of either byte order) and PDF files."""
DIFFERS = "differs"  # look of a mark: another number or word
DOUBT = "doubt"  # one not read exactly
FOREIGN = "foreign"  # text that is not the program's


LOOKS = {kind: DIFFERS for kind, verdict in VERDICTS.items() if verdict is Verdict.DIFFERS}
LOOKS[Kind.FOREIGN] = FOREIGN


class Mark(NamedTuple):
    """A marked place of a text: where, how it looks, and a note."""

    start: int
    stop: int
    look: str
    note: str


class Outline(NamedTuple):
    """A marked place of a picture: corners as an SVG polygon has them, look, and a note."""

    points: str
    look: str
    note: str


class Picture(NamedTuple):
    """The picture of a page: data URI, size in px, marked places."""

    uri: str
    width: int
    height: int
    outlines: tuple[Outline, ...]


@dataclass(frozen=True)
class Exhibit:
    """A verified printout as a page shows it.

    Parameters
    ----------
    source : str
        Its file, and which printout of the file it is.
    verdict, meaning : str
        The verdict, and the sentence that explains it.
    is_adverse : bool
        True if the page differs.
    sections : mapping of str to tuple of str
        Sentences by heading, on what was read and compared, findings, explanations, and errors that
        the page could not reveal; those with the empty heading first.
    text : str
        The text, as given or as read from the picture.
    marks : tuple of Mark
        Marked places of the text, in order, apart from each other.
    picture : Picture or None
        The page, if it was read from a picture.
    digest : str
        SHA-256 of the file.
    """

    source: str
    verdict: str
    meaning: str
    is_adverse: bool
    sections: dict[str, tuple[str, ...]]
    text: str
    marks: tuple[Mark, ...] = ()
    picture: Picture | None = field(default=None, repr=False)
    digest: str = ""

    def pieces(self) -> Iterator[tuple[str, str, str]]:
        """Yield the text in pieces: text, look ("" if unmarked) and note."""
        place = 0
        for mark in self.marks:
            if mark.start > place:
                yield self.text[place : mark.start], "", ""
            yield self.text[mark.start : mark.stop] or "‸", mark.look, mark.note
            place = mark.stop
        yield self.text[place:], "", ""


def examine(name: str, data: bytes) -> list[Exhibit]:
    """Verify every printout of a file.

    Parameters
    ----------
    name : str
        Name of the file in messages.
    data : bytes
        A text, a PNG, JPEG or TIFF picture, or a PDF.

    Returns
    -------
    list of Exhibit
        One for each printout.

    Raises
    ------
    UserError
        For a file that cannot be read, and if no printout is found.
    """
    digest = sha256(data).hexdigest()
    if data.startswith(PICTURE_STARTS):
        return _examine_picture(name, data)
    results = judge(read_text(data, name))
    if not results:
        raise UserError("no printout found; expected labels and numbers such as MA= 143.5", name)
    return [of_text(result, f"{name}, printout {k}", digest) for k, result in enumerate(results, 1)]


def of_text(result: Verification, source: str, digest: str = "") -> Exhibit:
    """Return the exhibit of a verified text.

    Parameters
    ----------
    result : Verification
        The verification.
    source : str
        The file, and which printout of it.
    digest : str, optional
        SHA-256 of the file.
    """
    first, end = result.span
    marks: list[Mark] = []
    place = first
    for finding in sorted(result.findings, key=lambda finding: finding.start):
        start, stop = max(finding.start, first), min(finding.stop, end)
        if place <= start <= stop:
            look = LOOKS.get(finding.kind, DOUBT)
            marks.append(Mark(start - first, stop - first, look, words.sentence_of(finding)))
            place = stop
    _, meaning, *sentences = (line.strip() for line in words.write(result, brief=True))
    scene = " ".join(f"{name} = {text}" for name, text in result.scene.items())
    sections = {
        "": tuple(sentences),
        "inputs with which it was compared": (scene,) if scene else (),
        "errors that this page could not reveal": tuple(words.unseen_lines(result)),
    }
    title, is_adverse = words.TITLES[result.verdict], result.verdict is Verdict.DIFFERS
    text = result.text[first:end]
    return Exhibit(source, title, meaning, is_adverse, sections, text, tuple(marks), digest=digest)


def _examine_picture(name: str, data: bytes) -> list[Exhibit]:
    """Verify every printout of a picture or PDF."""
    results = read_picture(name, data)
    digest = sha256(data).hexdigest()
    return [
        of_picture(result, f"{name}, printout {k}", digest) for k, result in enumerate(results, 1)
    ]


def read_picture(
    name: str, data: bytes, scene: Mapping[str, str] | None = None
) -> list[PictureVerification]:
    """Return the printouts of a picture or PDF.

    Raises
    ------
    UserError
        Also if the extra is not installed.
    """
    try:
        from ..pictures import verify_picture
    except ImportError as error:
        raise UserError(
            f"pictures need {error.name}; pip install 'impact88[pictures]'", name
        ) from None
    return verify_picture(data, name, scene=scene)


def of_picture(result: PictureVerification, source: str, digest: str = "") -> Exhibit:
    """Return the exhibit of a verified picture.

    Parameters
    ----------
    result : PictureVerification
        The verification.
    source : str
        The file, and which printout of it.
    digest : str, optional
        SHA-256 of the file.
    """
    from ..pictures.exhibit import draw_page

    page = draw_page(result)
    outlines = tuple(
        Outline(" ".join(f"{x:.0f},{y:.0f}" for x, y in corners), look, note)
        for corners, look, note in page.outlines
    )
    text = of_text(result.verification, source, digest)
    sections = {**text.sections, "the picture": result.remarks} if result.remarks else text.sections
    picture = Picture(page.uri, page.width, page.height, outlines)
    return replace(text, sections=sections, picture=picture)
