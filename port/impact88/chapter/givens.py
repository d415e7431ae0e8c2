"""What is known of a problem: values by name, from a TOML file and from NAME=VALUE settings.

The file is flat TOML keyed by the listing's names, like a scene's; what is not known is left out
(or left empty, as in a template). Numbers are the decimal texts the program's INPUT takes, read as
doubles.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from ..applesoft.errors import ApplesoftError
from ..errors import UserError
from ..files import called
from ..names import CHAPTER, RESULTS, SCENE
from ..program.arithmetics import FLOAT64
from ..scene import toml_file


def givens(path: str | None, settings: Sequence[str], allowed: Collection[str]) -> dict[str, float]:
    """The values given, by name. Settings replace the file's values; an empty one removes them.

    Raises UserError, naming file and key, for names not ``allowed`` and texts that are no numbers.
    """
    values: dict[str, float] = {}
    if path is not None:
        source = called(path)
        texts = toml_file(path)
        texts.pop("title", None)
        for name, text in texts.items():
            _put(values, name, text, allowed, source)
    seen: set[str] = set()
    for pair in settings:
        name, equals, text = pair.partition("=")
        name = name.strip().upper()
        if not equals:
            raise UserError(f"{pair!r} is no setting; expected NAME=VALUE, such as E=.1")
        if name in seen:
            raise UserError(f"{name} is given twice", "--set")
        seen.add(name)
        _put(values, name, text.strip(), allowed, "--set")
    return values


def template(names: Sequence[str]) -> str:
    """A file to fill in with what is known of ``names``."""
    lines = ["# Fill in what is known; what stays empty is solved for. Any consistent units."]
    for name in names:
        quantity = SCENE.get(name) or RESULTS.get(name) or CHAPTER[name]
        meaning = "signed P_t/P_n, in place of MU" if name == "MUP" else quantity.meaning
        entry = f'{name} = "6"' if name == "M" else f'{name} = ""'
        lines.append(f"{entry:<12} # {quantity.symbol}: {meaning} [{quantity.unit}]")
    return "\n".join(lines)


def _put(
    values: dict[str, float], name: str, text: str, allowed: Collection[str], where: str
) -> None:
    if name not in allowed:
        hint = f"; did you mean {name.upper()}?" if name.upper() in allowed else ""
        raise UserError(f"{name!r} has no place here{hint} (expected {' '.join(allowed)})", where)
    if not text:
        values.pop(name, None)
        return
    values[name] = _number(name, text, where)


def _number(name: str, text: str, where: str) -> float:
    quantity = SCENE.get(name) or RESULTS.get(name) or CHAPTER.get(name)
    meaning = f"{quantity.meaning} [{quantity.unit}]" if quantity else "a number"
    try:
        value, end = FLOAT64.read(text.upper(), 0)
    except ApplesoftError:
        end = -1
    if end < len(text):
        raise UserError(f"{name} = {text!r} is no number; expected {meaning}", where)
    return float(value)
