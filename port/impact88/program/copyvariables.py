"""Which variable of a copy of the listing takes each value of a scene.

An office may have renamed variables, or may convert what is typed (``INPUT V:UX = V * 1.46667``). A
value's variable is one that the copy gives a number: assigned, read or asked for. It has the
listing's name; or the copy prints it under the value's label; or what is printed there is computed
from it alone; or it stands in the place of the listing's.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ..collision.fields import ANGLES
from ..names import SCENE

Lines = Mapping[int, Sequence[str]]
"""A program: the statements of each line."""
Place = tuple[int, int, int]
"""Line, statement of it, variable of that."""

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
"""A number with an exponent, whose E is no variable."""


def key_of(name: str) -> str:
    """Return what Applesoft knows a variable by: two characters and the type."""
    name = "".join(name.upper().split())
    suffix = name[-1] if name.endswith(("$", "%")) else ""
    return name.removesuffix(suffix)[:2] + suffix


class CopyVariables(NamedTuple):
    """The variables of a copy.

    ``of_value``: for each value of a scene the variable that takes it; ``missing``: the values for
    which there is none; ``unknown``: variables asked for by INPUT that take no value of a scene."""

    of_value: dict[str, str]
    missing: list[str]
    unknown: list[str]


def find_variables(lines: Lines, restored: Lines) -> CopyVariables:
    """Return which variable of a copy takes each value of a scene. ``restored``: the restored
    listing."""
    given = dict(_assigned_variables(lines))
    numbers = {key for key in given.values() if not key.endswith("$")}
    computed = _dependencies(lines)
    printed = _printed_variables(lines)
    places = {key: place for place, key in _assigned_variables(restored)}
    of_value: dict[str, str] = {}
    missing = []
    for name in SCENE:
        shown = printed.get(name, "")
        sources = _sources(shown, computed, numbers)
        key = ""
        if shown in numbers and (name not in numbers or shown not in SCENE):
            key = shown
        elif name in numbers:
            key = name
        elif len(sources) == 1:
            (key,) = sources
        elif given.get(places[name], "") in numbers - SCENE.keys():
            key = given[places[name]]
        if key:
            of_value[name] = key
        elif not (sources and sources <= numbers):
            missing.append(name)
    # what is computed from other values alone needs none of its own
    taken = set(of_value.values())
    for name in SCENE.keys() - of_value.keys() - set(missing):
        if not _sources(printed.get(name, ""), computed, numbers) <= taken:
            missing.append(name)
    asked = [key for key in dict.fromkeys(_input_variables(lines)) if not key.endswith("$")]
    return CopyVariables(
        of_value, [name for name in missing if name != "M"], [k for k in asked if k not in taken]
    )


def _statements(lines: Lines) -> Iterator[tuple[int, int, str]]:
    for line, statements in lines.items():
        for at, statement in enumerate(statements):
            yield line, at, statement


def _assigned_variables(lines: Lines) -> Iterator[tuple[Place, str]]:
    """The variables that are given numbers: assigned a constant, read or asked for."""
    for line, at, statement in _statements(lines):
        if match := _LIST.fullmatch(statement):
            for item, name in enumerate(match[2].split(",")):
                yield (line, at, item), key_of(name)
        elif match := _ASSIGNMENT.fullmatch(statement):
            constant = match[2].strip() and '"' not in match[2] and not _variables(match[2])
            if constant:
                yield (line, at, 0), key_of(match[1])


def _input_variables(lines: Lines) -> Iterator[str]:
    for _, _, statement in _statements(lines):
        match = _LIST.fullmatch(statement)
        if match and match[1].upper() == "INPUT":
            yield from map(key_of, match[2].split(","))


def _variables(expression: str) -> set[str]:
    """The variables of an expression, arrays included."""
    bare = _MANTISSA.sub(" ", re.sub(r'"[^"]*"?', " ", expression))
    names = {key_of(name) for name in _VARIABLE.findall(bare) if name.upper() not in _FUNCTIONS}
    if re.search(r"(?<![A-Z0-9])E(?![A-Z0-9])", bare, re.I):
        names.add("E")
    return names


def _dependencies(lines: Lines) -> dict[str, set[str]]:
    """For each variable those that its formulas use, itself left out."""
    uses: dict[str, set[str]] = {}
    for _, _, statement in _statements(lines):
        if match := _ASSIGNMENT.fullmatch(statement):
            key = key_of(match[1])
            uses.setdefault(key, set()).update(_variables(match[2]) - {key})
    return uses


def _sources(shown: str, computed: Mapping[str, set[str]], numbers: set[str]) -> set[str]:
    """The variables given numbers from which a variable is computed, the listing's constants left
    out."""
    sources: set[str] = set()
    followed: set[str] = set()
    pending = [shown]
    while pending:
        key = pending.pop()
        if key and key not in followed:
            followed.add(key)
            pending += computed.get(key, ())
            if key in numbers and key != shown:
                sources.add(key)
    return sources


def _printed_variables(lines: Lines) -> dict[str, str]:
    """The variable that is printed first under the label of each value; the angles stand below
    their heading."""
    printed: dict[str, str] = {}
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
                elif found := _LABEL.search(literal.rstrip()):
                    label, row = found[1].upper(), []
                continue
            name = row.pop(0) if row else label
            if name in SCENE and _VARIABLE.fullmatch(expression.strip()):
                printed.setdefault(name, key_of(expression))
            label = ""
    return printed
