"""What commands print: JSON with the version of its form, progress, remarks."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, is_dataclass
from typing import Any

from ..errors import note
from ..version import __version__

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
PROGRESS_WIDTH = 40  # columns that progress may take


def show(is_json: bool, form: str, record: Mapping[str, Any], lines: Iterable[str]) -> None:
    """Print a result: as JSON, an object with the name and version of its form, or as lines."""
    if is_json:
        head = {"schema": f"impact88/{form}/{FORMS[form]}", "version": __version__}
        print(to_json({**head, **record}), flush=True)
    else:
        print("\n".join(lines))


def to_json(value: Any) -> str:
    """Return JSON on one line; numbers that are not finite become null."""
    return json.dumps(_plain(value))


def _plain(value: Any) -> Any:
    """Return a value for JSON: records as objects, arrays as lists, numbers not finite as None."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if is_dataclass(value):
        value = asdict(value)  # type: ignore[arg-type]
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


@contextmanager
def progress(what: str) -> Iterator[Callable[[int, float | None], None]]:
    """Context of a function that shows the steps done, or the fraction if it is known, on a line of
    stderr; nothing where stderr is no terminal."""

    def overwrite(text: str) -> None:
        if sys.stderr.isatty():
            print(f"\r{text:<{PROGRESS_WIDTH}}", end="\r", file=sys.stderr, flush=True)

    def update(done: int, fraction: float | None) -> None:
        overwrite(f"{what}: {done:,}" if fraction is None else f"{what}: {fraction:.0%}")

    try:
        yield update
    finally:
        overwrite("")


def say(command: str, remarks: Iterable[str]) -> None:
    """Print remarks on stderr."""
    for remark in remarks:
        note(command, remark)
