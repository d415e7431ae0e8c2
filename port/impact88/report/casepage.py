"""Pages for a case file: one HTML file each, to be printed and signed.

A page loads nothing from elsewhere, holds no scripts, and is the same for the same input."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from hashlib import sha256
from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy

from ..errors import UserError
from ..files import replacing
from ..version import __version__
from .answers import Answer
from .drawing import draw, to_png
from .pages import render

if TYPE_CHECKING:
    from .exhibits import Exhibit

IMPACT = (
    "Planar impact of two rigid bodies: impulse and momentum at the moment of contact, with "
    "coefficients of restitution e, of friction μ and of moment restitution e_m (R. M. Brach, "
    "Vehicle Collision Analysis, 1988, Equations 13 to 18), in double precision."
)
FORWARD = "The velocities after the impact follow in closed form from those before it."
METHODS = {
    "forward": FORWARD,
    "bounds": (
        f"{FORWARD} Intervals hold 90 % of random draws of the inputs within their tolerances."
    ),
    "reconstruct": (
        "The equations hold exactly between the values. What is not given is found by least "
        "squares (Levenberg and Marquardt) from random starts; values known within limits are "
        "adjusted, weighted by their tolerances, and each is tested against the others (Baarda "
        "1968). Intervals hold 90 % of the draws of a sequential Monte Carlo sampler."
    ),
}
"""Method of each question, after the sentence on the equations."""
NOT_JUDGED = (
    "Motion before and after the impact, crush and injury: nothing of them is computed here, but "
    "for skids written as such (v = √(2 μ g d), level road, one friction).",
    "That the impact was planar, at one point, and that its bodies were rigid but for the contact.",
    "The values given: they are taken from the case as they are.",
)
VERIFICATION_METHOD = (
    "The inputs printed on a page are read and typed into R. M. Brach's program of 1988 again, run "
    "bit for bit in the Apple II Plus's own arithmetic as checked against a real ROM. Each label "
    "and number that was read is compared with what the program prints in its place.",
    "An explanation is a change that makes the page agree, not a finding of what happened.",
)
VERIFICATION_NOT_JUDGED = (
    "That a page is what the program prints does not prove that its inputs are those of the "
    "collision, nor that the mechanics apply to it.",
    "Errors that the page could not reveal are listed for each printout.",
)


def _render(template: str, **values: object) -> str:
    """Return a page."""
    python = platform.python_version()
    versions = f"impact88 {__version__}, numpy {numpy.__version__}, Python {python}"
    return render(template, versions=versions, **values)


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
    return _render(
        "case.html",
        title=case.title or "Planar impact of two vehicles",
        case=case,
        paper="a4" if case.view.units in ("metric", "si") else "letter",
        answer=answer,
        drawing=drawing_of(answer),
        exact=[n for n in case.entries if n not in (*case.ranges, *case.derived, "M")],
        method=(IMPACT, METHODS[answer.asked]),
        not_judged=NOT_JUDGED,
        digest=sha256(case.toml().encode()).hexdigest(),
    )


def verification_page(
    exhibits: Sequence[Exhibit], *, case: str = "", examiner: str = "", date: str = ""
) -> str:
    """Return the report on verified printouts.

    Parameters
    ----------
    exhibits : sequence of Exhibit
        The printouts.
    case, examiner, date : str, optional
        Headings: number of the case, and who signs.

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
    return _render(
        "verification.html",
        title="Verification of printouts",
        case={"case": case, "examiner": examiner, "date": date},
        paper="letter",
        exhibits=exhibits,
        method=VERIFICATION_METHOD,
        not_judged=VERIFICATION_NOT_JUDGED,
    )


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
    if ending == ".html":
        data = case_page(answer).encode()
    elif ending == ".svg":
        data = draw(answer).encode()
    elif ending == ".png":
        data = to_png(draw(answer))
    else:
        raise UserError("expected -o FILE.html, FILE.svg or FILE.png")
    with replacing(path, "wb") as file:
        file.write(data)
