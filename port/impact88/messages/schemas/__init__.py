"""The JSON forms of the commands' --json output: a JSON Schema and a version number for each.

A form is a text file with a line for each field; `forms` makes its JSON Schema of it.
An added field does not change the number. A field that is removed or renamed, changes its type,
unit or meaning, or may now be null raises it by one, as does a word added to an enumeration.
Schema, number and output change in the same commit. More accurate digits are not a change of form.
"""

from collections.abc import Mapping

from ...errors import UserError
from ...files import packaged_text
from ...names import RESULTS
from ...version import __version__

NUMBERS = {
    "run": 1,
    "oracle": 1,
    "vectors": 2,
    "compare": 1,
    "verify": 3,
    "selfcheck": 1,
    "witness": 1,
    "bounds": 2,
    "reconstruct": 3,
    "colinear": 1,
    "delta-v": 1,
    "example": 1,
    "staged": 2,
}
"""Name of a form -> its version number. Names are those of the commands, and the oracle's
``vectors``."""
CONVENTIONS = "conventions"


def with_schema(name: str, record: Mapping[str, object]) -> dict[str, object]:
    """Return an object for printing: with name and number of its form, and the package version."""
    return {"schema": f"impact88/{name}/{NUMBERS[name]}", "version": __version__, **record}


def text(name: str) -> str:
    """Return the schema of a form, or the conventions, as text. Raises UserError for other
    names."""
    if name not in (*NUMBERS, CONVENTIONS):
        raise UserError(
            f"there is no schema {name}; expected one of {' '.join(NUMBERS)}, or {CONVENTIONS}"
        )
    if name == CONVENTIONS:
        rows = [
            ("result", "symbol", "meaning", "unit"),
            ("---",) * 4,
            *(row[:4] for row in RESULTS.values()),
        ]
        table = "\n".join(f"| {' | '.join(row)} |" for row in rows)
        return packaged_text(__name__, f"{name}.md").replace("{results}", table)
    import json

    from .forms import expand_form

    schema = expand_form(packaged_text(__name__, f"{name}.txt"), f"impact88/{name}/{NUMBERS[name]}")
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"
