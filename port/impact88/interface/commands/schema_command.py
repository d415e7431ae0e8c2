"""The forms of what the commands print with --json, as JSON Schema (draft 2020-12). Each object
carries the name and number of its form and the version of impact88 that wrote it.

A field that is added leaves the number as it is; anything that could break a reader raises it:
removing or renaming a field, another type, unit or meaning, null where it could not be.

examples:
  impact88 schema                    the names and numbers of all forms
  impact88 schema compare            one schema
  impact88 schema conventions        axes, signs, units, stored bytes, bounds

exit status: 0 done; 2 no such schema
"""

import json

from ...messages.schemas import CONVENTIONS, NUMBERS, text
from . import options

ARGUMENTS = (options.value("name", "NAME", "a form, or conventions", nargs="?"), options.OUTPUT)


def main(args: options.Args) -> None:
    if args.name:
        print(text(args.name), end="")
        return
    for name, number in NUMBERS.items():
        print(f"{name:<12} {number}  {json.loads(text(name))['title']}")
    print(f"{CONVENTIONS:<12}    axes, signs, units, stored bytes, error bounds, vector classes")
