"""The variables of a copy of the listing that hold the values of a scene.

An office may have renamed variables, or may convert input (``INPUT V:UX = V * 1.46667``). The
variable of a value is given a number by the copy: assigned a constant, READ or INPUT. It is the one
printed under the value's label; or has the listing's name; or is the only one from which the
printed value is computed; or stands in the same place as in the listing.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ..collision.fields import ANGLES
from ..names import SCENE

Lines = Mapping[int, Sequence[str]]
"""A program: the statements of each line."""
Place = tuple[int, int, int]
"""Line number, index of the statement in it, index of the variable in that."""

_ASSIGNMENT = re.compile(
    r"\s*(?:IF\b.*\bTHEN\s*)?(?:LET\s*)?([A-Z][A-Z0-9]*[$%]?)\s*=\s*(.*)", re.I | re.S
)
_LIST = re.compile(r"\s*(READ|INPUT)\b\s*(?:\"[^\"]*\"\s*;)?\s*(.*)", re.I | re.S)
_PRINT = re.compile(r"\s*PRINT\b(.*)", re.I | re.S)
_ELEMENT = re.compile(r'"([^"]*)"?|([^";,]+)')
_LABEL = re.compile(r"([A-Z]+)\s*[=:]?\s*$", re.I)
_VARIABLE = re.compile(r"[A-Z][A-Z0-9]*[$%]?", re.I)
_FUNCTIONS = frozenset("ABS ATN COS EXP INT LOG RND SGN SIN SQR TAN FN PEEK AND OR NOT E".split())
_MANTISSA = re.compile(r"(?<![A-Z0-9])[0-9.]+\s*E\s*[-+]?\s*[0-9]+", re.I)
"""A number with an exponent, whose E is not a variable."""


def key_of(name: str) -> str:
    """Return the name by which Applesoft distinguishes a variable: two characters and the type."""
    name = "".join(name.upper().split())
    suffix = name[-1] if name.endswith(("$", "%")) else ""
    return name.removesuffix(suffix)[:2] + suffix


class CopyVariables(NamedTuple):
    """The variables of a copy.

    ``of_value``: the variable of each value of a scene; ``missing``: values without a variable;
    ``unknown``: variables of INPUT that hold no value of a scene."""

    of_value: dict[str, str]
    missing: list[str]
    unknown: list[str]


def find_variables(lines: Lines, restored: Lines) -> CopyVariables:
    """Return the variables of a copy that hold a scene's values; ``restored``: the restored
    listing."""
    assigned_at = dict(_assigned_variables(lines))
    numbers = {key for key in assigned_at.values() if not key.endswith("$")}
    dependencies = _dependencies(lines)
    printed_as = _printed_variables(lines)
    restored_places = {key: place for place, key in _assigned_variables(restored)}
    of_value: dict[str, str] = {}
    missing = []
    for name in SCENE:
        printed_variable = printed_as.get(name, "")
        sources = _sources(printed_variable, dependencies, numbers)
        key = ""
        if printed_variable in numbers and (name not in numbers or printed_variable not in SCENE):
            key = printed_variable
        elif name in numbers:
            key = name
        elif len(sources) == 1:
            (key,) = sources
        elif assigned_at.get(restored_places[name], "") in numbers - SCENE.keys():
            key = assigned_at[restored_places[name]]
        if key:
            of_value[name] = key
        elif not (sources and sources <= numbers):
            missing.append(name)
    # a value computed only from others needs no variable of its own
    keys_used = set(of_value.values())
    for name in SCENE.keys() - of_value.keys() - set(missing):
        if not _sources(printed_as.get(name, ""), dependencies, numbers) <= keys_used:
            missing.append(name)
    input_names = [key for key in dict.fromkeys(_input_variables(lines)) if not key.endswith("$")]
    return CopyVariables(
        of_value,
        [name for name in missing if name != "M"],
        [k for k in input_names if k not in keys_used],
    )


def _statements(lines: Lines) -> Iterator[tuple[int, int, str]]:
    """Yield line number, index in the line, and text of each statement."""
    for line, statements in lines.items():
        for at, statement in enumerate(statements):
            yield line, at, statement


def _assigned_variables(lines: Lines) -> Iterator[tuple[Place, str]]:
    """Yield place and name of each variable given a number: by a constant, READ or INPUT."""
    for line, at, statement in _statements(lines):
        if match := _LIST.fullmatch(statement):
            for item, name in enumerate(match[2].split(",")):
                yield (line, at, item), key_of(name)
        elif match := _ASSIGNMENT.fullmatch(statement):
            constant = match[2].strip() and '"' not in match[2] and not _variables(match[2])
            if constant:
                yield (line, at, 0), key_of(match[1])


def _input_variables(lines: Lines) -> Iterator[str]:
    """Yield the variables of INPUT."""
    for _, _, statement in _statements(lines):
        match = _LIST.fullmatch(statement)
        if match and match[1].upper() == "INPUT":
            yield from map(key_of, match[2].split(","))


def _variables(expression: str) -> set[str]:
    """Return the variables of an expression, arrays included."""
    bare = _MANTISSA.sub(" ", re.sub(r'"[^"]*"?', " ", expression))
    names = {key_of(name) for name in _VARIABLE.findall(bare) if name.upper() not in _FUNCTIONS}
    if re.search(r"(?<![A-Z0-9])E(?![A-Z0-9])", bare, re.I):
        names.add("E")
    return names


def _dependencies(lines: Lines) -> dict[str, set[str]]:
    """Return, for each variable, the others that its formulas use."""
    uses: dict[str, set[str]] = {}
    for _, _, statement in _statements(lines):
        if match := _ASSIGNMENT.fullmatch(statement):
            key = key_of(match[1])
            uses.setdefault(key, set()).update(_variables(match[2]) - {key})
    return uses


def _sources(variable: str, dependencies: Mapping[str, set[str]], numbers: set[str]) -> set[str]:
    """Return the other variables that are given numbers (``numbers``) and from which ``variable``
    is computed, directly or not."""
    sources: set[str] = set()
    visited_keys: set[str] = set()
    pending = [variable]
    while pending:
        key = pending.pop()
        if key and key not in visited_keys:
            visited_keys.add(key)
            pending += dependencies.get(key, ())
            if key in numbers and key != variable:
                sources.add(key)
    return sources


def _printed_variables(lines: Lines) -> dict[str, str]:
    """Return the variable first printed under the label of each value; the angles are printed
    below a common heading."""
    variables: dict[str, str] = {}
    label, row = "", []
    for _, _, statement in _statements(lines):
        if not (match := _PRINT.fullmatch(statement)):
            continue
        for literal, expression in _ELEMENT.findall(match[1]):
            if not expression.strip():
                if not literal.strip():
                    continue
                if "".join(literal.upper().split()) == "".join(ANGLES):
                    row = list(ANGLES)
                elif label_match := _LABEL.search(literal.rstrip()):
                    label, row = label_match[1].upper(), []
                continue
            name = row.pop(0) if row else label
            if name in SCENE and _VARIABLE.fullmatch(expression.strip()):
                variables.setdefault(name, key_of(expression))
            label = ""
    return variables
