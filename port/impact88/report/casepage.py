"""Pages for a case file: one HTML file each, to be printed and signed.

A page loads nothing from elsewhere, holds no scripts, and is the same for the same input."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import PurePath
from typing import TYPE_CHECKING

from ..errors import UserError
from ..files import replacing
from .answers import Answer
from .drawing import draw, to_png
from .pages import render

if TYPE_CHECKING:
    from .exhibits import Exhibit


def drawing_of(answer: Answer) -> tuple[str, str]:
    """Return the drawing of an answer, or why there is none."""
    try:
        return draw(answer), ""
    except UserError as error:
        return "", str(error)


def case_page(answer: Answer) -> str:
    """Return the report on a case.

    Parameters
    ----------
    answer : Answer
        The answer to the case.

    Returns
    -------
    str
        An HTML page: question, answer, drawing; inputs with their sources, method, what is not
        judged, examiner and date.

    Raises
    ------
    UserError
        If jinja2 is not installed.
    """
    case = answer.case
    digest = sha256(case.toml().encode()).hexdigest()
    drawing = drawing_of(answer)
    return render("case.html", answer=answer, case=case, drawing=drawing, digest=digest)


def verification_page(exhibits: Sequence[Exhibit], headings: Mapping[str, str]) -> str:
    """Return the report on verified printouts.

    Parameters
    ----------
    exhibits : sequence of Exhibit
        The printouts.
    headings : mapping of str to str
        ``case``, its number; ``examiner``, who signs, and ``date``.

    Returns
    -------
    str
        An HTML page: for each printout its verdict, the findings marked in its text and its
        picture, what was examined, and what it could not reveal.

    Raises
    ------
    UserError
        If jinja2 is not installed.
    """
    return render("verification.html", case=headings, exhibits=exhibits)


def write(answer: Answer, path: str) -> None:
    """Write the report or the drawing of a case; the format is the ending of the file's name.

    Parameters
    ----------
    answer : Answer
        The answer to the case.
    path : str
        A name in .html, .svg or .png.

    Raises
    ------
    UserError
        For another ending, a case that cannot be drawn, a missing library, and a place that cannot
        be written to.
    """
    ending = PurePath(path).suffix.lower()
    if ending not in (".html", ".svg", ".png"):
        raise UserError("expected -o FILE.html, FILE.svg or FILE.png")
    text = case_page(answer) if ending == ".html" else draw(answer)
    data = to_png(text) if ending == ".png" else text.encode()
    with replacing(path, "wb") as file:
        file.write(data)
