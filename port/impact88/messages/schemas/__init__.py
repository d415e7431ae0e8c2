"""The forms of what the commands print with --json: a JSON Schema each, with a number.

The rule for changes: a field that is added leaves the number as it is; one that is removed or
renamed, that changes its type, unit or meaning, or may be null where it could not, raises the
number by one, and so does a word added to an enumeration. Schema, number and output change in the
same commit. Digits that become more accurate are no change of form.
"""

from collections.abc import Mapping

from ...errors import UserError
from ...files import packaged_text
from ...version import __version__

NUMBERS = {
    "run": 1,
    "oracle": 1,
    "vectors": 2,
    "compare": 1,
    "conformance": 1,
    "verify": 2,
    "selfcheck": 1,
    "witness": 1,
    "bounds": 2,
    "reconstruct": 2,
    **dict.fromkeys(("colinear", "delta-v", "example", "staged"), 1),
}
"""Name of a form -> its number. Names are those of the commands, the oracle's ``vectors``, and
``conformance`` for compare --kit."""
CONVENTIONS = "conventions"


def stamped(name: str, found: Mapping[str, object]) -> dict[str, object]:
    """An object as it is printed: with the name and number of its form, and the version."""
    return {"schema": f"impact88/{name}/{NUMBERS[name]}", "version": __version__, **found}


def text(name: str) -> str:
    """The schema of a form, or the conventions, as text. Raises UserError for another name."""
    if name not in (*NUMBERS, CONVENTIONS):
        raise UserError(
            f"there is no schema {name}; expected one of {' '.join(NUMBERS)}, or {CONVENTIONS}"
        )
    return packaged_text(__name__, f"{name}.md" if name == CONVENTIONS else f"{name}.json")
