"""Printouts as a Python caller has them: a text, a file or its bytes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, overload

from .. import files
from ..errors import UserError, quoted
from ..reading.printout import Printout
from . import examination
from .examination import Verification


@overload
def verify(printout: Printout, given: Mapping[str, Any] | None = None) -> Verification: ...
@overload
def verify(
    printout: str | bytes | os.PathLike[str], given: Mapping[str, Any] | None = None
) -> list[Verification]: ...
def verify(
    printout: Printout | str | bytes | os.PathLike[str], given: Mapping[str, Any] | None = None
) -> Verification | list[Verification]:
    """Say of each printout whether it is what the 1988 program prints, and if not, why.

    ``printout``: a text (a str of more than one line), a file's name or its bytes, for all the
    printouts in it; or one of `impact88.read_printouts`, for one verdict. ``given``: inputs known
    from elsewhere than the paper, texts or numbers by the scene's names, with units or without.

    Raises UserError for a file that cannot be read or holds no printout.

    >>> import impact88
    >>> page = impact88.run(impact88.sample(1)).page
    >>> [found.verdict.name for found in impact88.verify(page)]
    ['IDENTICAL']
    """
    known = None
    if given is not None:
        from ..mappings import texts

        known = texts(given)
    if isinstance(printout, Printout):
        return examination.verify(printout, given=known)
    if isinstance(printout, str) and "\n" in printout:
        printout = printout.encode("utf-8", files.ESCAPED)
    if isinstance(printout, bytes):
        found = examination.examine_bytes("text", printout, known)
    elif isinstance(printout, str | os.PathLike):
        found = examination.examine(os.fspath(printout), known)
    else:
        raise UserError(f"{quoted(printout)}: expected a printout's text, a file's name or bytes")
    if found.error:
        raise UserError(found.error)
    return found.results
