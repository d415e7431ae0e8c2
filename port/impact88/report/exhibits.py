"""Verified printouts as pages show them: text and picture with what was marked on each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from typing import TYPE_CHECKING

from ..errors import UserError, library
from ..printouts import VERDICTS, Kind, Verdict, Verification, verify, words

if TYPE_CHECKING:
    from ..pictures.exhibit import Exhibit as Picture
    from ..pictures.verdict import PictureVerification

PICTURE_STARTS = (b"\x89PNG\r\n", b"\xff\xd8\xff", b"II*\0", b"MM\0*", b"%PDF-")
"""First bytes of PNG, JPEG, TIFF (of either byte order) and PDF files."""


@dataclass(frozen=True)
class Exhibit:
    """A verified printout as a page shows it.

    Parameters
    ----------
    file : str
        The name of its file.
    number : int
        The number of the printout in its file.
    result : Verification
        The verdict, and the text, as given or as read from the picture.
    digest : str
        SHA-256 of the file.
    page : PictureVerification or None
        The page, if it was read from a picture.
    """

    file: str
    number: int
    result: Verification
    digest: str
    page: PictureVerification | None = None

    @property
    def picture(self) -> Picture | None:
        """The picture of the page with its marked places, None for a text."""
        if self.page is None:
            return None
        from ..pictures.exhibit import draw_page

        return draw_page(self.page)

    def pieces(self) -> Iterator[tuple[str, str, str]]:
        """Yield the text in pieces: text, look ("" if unmarked) and note."""
        text, (place, end) = self.result.text, self.result.span
        for finding in sorted(self.result.findings, key=lambda finding: finding.start):
            stop = min(finding.stop, end)
            if place <= finding.start <= stop:
                yield text[place : finding.start], "", ""
                look = (
                    "differs"
                    if VERDICTS[finding.kind] is Verdict.DIFFERS
                    else "foreign"
                    if finding.kind is Kind.FOREIGN
                    else "doubt"
                )
                yield text[finding.start : stop] or "‸", look, words.sentence_of(finding)
                place = stop
        yield text[place:end], "", ""


def examine(
    name: str, data: bytes, given: Mapping[str, str] | None = None, listing: str = ""
) -> list[Exhibit]:
    """Verify every printout of a file.

    Parameters
    ----------
    name : str
        Name of the file in messages.
    data : bytes
        A text, a PNG, JPEG or TIFF picture, or a PDF.
    given : mapping of str to str, optional
        Inputs known from elsewhere, for a page with results only.
    listing : str, optional
        A file with an office's own copy of the listing, for texts.

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
        if listing:
            raise UserError("--listing goes with texts, not with pictures", name)
        pictures = library("impact88.pictures", "pictures", "a picture")
        pages = pictures.verify_picture(data, name, scene=given)
        return [
            Exhibit(name, k, page.verification, digest, page) for k, page in enumerate(pages, 1)
        ]
    try:
        results = verify(data, given, listing or None)
    except UserError as error:
        raise UserError(str(error).removeprefix("text: "), name) from None
    return [Exhibit(name, k, result, digest) for k, result in enumerate(results, 1)]
