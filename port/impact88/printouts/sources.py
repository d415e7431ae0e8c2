"""Texts and files whose printouts are verified."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from .. import files
from ..decimals import to_text
from ..errors import UserError, quoted
from ..names import SCENE, check_names
from ..program.copies import ListingCopy
from .findings import Verification
from .glyphs import decode
from .numerals import TYPED
from .programs import CopyListing
from .search import printed_fields
from .verdict import judge

MAX_BYTES = 2_000_000
"""Bytes of a text: a thousand pages have one million."""


def verify(
    source: str | bytes | os.PathLike[str],
    given: Mapping[str, Any] | None = None,
    listing: str | os.PathLike[str] | None = None,
) -> list[Verification]:
    """Return for each printout in a text whether it is what the 1988 program prints.

    Parameters
    ----------
    source : str, bytes or os.PathLike
        A text (a str of more than one line), a file's name, or its bytes.
    given : mapping of str to str or float, optional
        Inputs known from elsewhere, as typed, by the scene's names: for a page that has only
        results.
    listing : str or os.PathLike, optional
        A file with an office's own copy of the listing, which may have printed the page.

    Returns
    -------
    list of Verification
        The verdict on each printout, with the scene, the numbers and all that was not read as the
        program prints it.

    Raises
    ------
    UserError
        For a file that cannot be read or has no printout, and for a given input of which the page
        has another value.

    Notes
    -----
    Labels read exactly are anchors, and each owns the number after it; only what lies between two
    anchors is aligned. The scene is recovered from the inputs, the listing replayed with it bit for
    bit, and every character compared.

    Examples
    --------
    >>> import impact88
    >>> page = impact88.run(impact88.sample(1)).page
    >>> [result.verdict.name for result in impact88.verify(page)]
    ['IDENTICAL']
    >>> (result,) = impact88.verify(page.replace("25.15", "25.75"))
    >>> result.verdict.name, [finding.name for finding in result.findings]
    ('DIFFERS', ['REPLY_B', 'VY'])
    """
    name = "text"
    if isinstance(source, str) and "\n" in source:
        text = source
    elif isinstance(source, str | os.PathLike) and source:
        name = files.display_name(os.fspath(source))
        text = read_text(files.read_bytes(os.fspath(source), MAX_BYTES), name)
    elif isinstance(source, bytes):
        text = read_text(source, name)
    else:
        raise UserError(f"{quoted(source)}: expected a printout's text, a file's name or bytes")
    program = None
    if isinstance(listing, str | os.PathLike):
        program = CopyListing(ListingCopy(os.fspath(listing)))
    elif listing is not None:
        raise UserError(f"{quoted(listing)}: expected the name of a file with a listing")
    texts = _texts(given)
    if verifications := judge(text, texts, program):
        for verification in verifications:
            _check_given(verification, texts, name)
        return verifications
    raise UserError(
        "no printout found; expected labels and numbers such as MA= 143.5 MB= 95.8", name
    )


def _check_given(verification: Verification, given: Mapping[str, str], name: str) -> None:
    """Raise UserError for an input that is given, and another on the page."""
    for key, text in given.items():
        number = verification.numbers.get({"MU": "MUP"}.get(key, key))
        scene = verification.scene
        if not (scene and number and number.read):
            continue
        if printed_fields({**scene, key: text}) != printed_fields(scene):
            line = verification.line_of(number.start)
            raise UserError(
                f"line {line}: the page has {key} {number.read}, but {text} is given; "
                "give only inputs that the page lacks",
                name,
            )


def _texts(given: Mapping[str, Any] | None) -> dict[str, str]:
    """Return given inputs as typed. Raises UserError."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise UserError(f"{quoted(given)}: expected inputs by name")
    check_names(given, SCENE, "value of a scene")
    texts = {}
    for name, value in given.items():
        try:
            texts[name] = value.replace(" ", "") if isinstance(value, str) else to_text(value)
        except (TypeError, ValueError, AttributeError):
            texts[name] = ""
        if not TYPED.fullmatch(texts[name]):
            raise UserError(f"{quoted(value)} is not a number as typed", name)
    return texts


def read_text(data: bytes, name: str) -> str:
    """Return the text of a file's bytes.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        Its name in messages.

    Returns
    -------
    str
        The text, in the encoding that leaves the fewest foreign characters.

    Raises
    ------
    UserError
        For a file of another kind than text.
    """
    files.check_text(data, name)
    return decode(data)
