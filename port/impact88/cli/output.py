"""Output of commands: JSON with the version of its form, progress, remarks."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Mapping
from typing import Any

from ..errors import note
from ..version import __version__
from .options import Args

FORMS = {
    "run": 1,
    "answer": 1,
    "verify": 4,
    "compare": 2,
    "selfcheck": 2,
    "chapter": 1,
    "bench": 1,
}
"""Version of each form of JSON. It rises where a field is removed, renamed or changes meaning."""


def show(args: Args, form: str, record: Mapping[str, Any], lines: Iterable[str]) -> None:
    """Print a result: as lines, or for ``--json`` as an object with its form's name and version."""
    if args.json:
        head = {"schema": f"impact88/{form}/{FORMS[form]}", "version": __version__}
        print(to_json({**head, **record}), flush=True)
    else:
        print("\n".join(lines))


def to_json(value: object) -> str:
    """Return JSON on one line: records as objects, arrays as lists, numbers not finite as null."""
    text = json.dumps(value, default=_json_value)
    return json.dumps(json.loads(text, parse_constant=lambda name: None))


def _json_value(value: Any) -> Any:
    """Return an array as a list, a record or a mapping as a dictionary."""
    from dataclasses import asdict

    if hasattr(value, "tolist"):
        return value.tolist()
    return dict(value) if hasattr(value, "keys") else asdict(value)


def show_progress(done: int, fraction: float | None) -> None:
    """Show the steps done, or the fraction if it is known, on a line of stderr that the next one
    replaces; nothing where stderr is no terminal."""
    if sys.stderr.isatty():
        text = f"{done:,}" if fraction is None else f"{fraction:.0%}"
        print(text, end="\r", file=sys.stderr, flush=True)


def say(command: str, remarks: Iterable[str]) -> None:
    """Print remarks on stderr."""
    for remark in remarks:
        note(command, remark)
