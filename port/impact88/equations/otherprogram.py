"""Programs that have something wrong: what they read, compute and show otherwise."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from .edits import Edit
from .evaluation import Columns, Run, value
from .spelling import IMPULSES, LISTING, Spelling, expression, spellings, table

Expressions = Mapping[str, ast.expr]


class Reading(NamedTuple):
    """A scene read otherwise, results shown otherwise: column -> expression in the columns.
    ``common``: it is looked for together with others, too."""

    says: str
    scene: Expressions
    results: Expressions
    common: bool

    def read(self, scene: Columns) -> dict[str, Any]:
        """The columns that are read otherwise."""
        return {name: value(made, {**scene, "x": scene[name]}) for name, made in self.scene.items()}

    def show(self, results: Mapping[str, Any], scene: Columns) -> dict[str, Any]:
        """The results that are shown otherwise; ``scene`` as the program had it."""
        names = {**scene, **results}
        return {
            name: value(made, {**names, "x": results[name]})
            for name, made in self.results.items()
            if name in results
        }


class Program(NamedTuple):
    """A spelling with edits, a reading and one more."""

    edits: tuple[Edit, ...] = ()
    readings: tuple[Reading, ...] = ()

    @property
    def says(self) -> str:
        """What is wrong with it."""
        said = [reading.says for reading in self.readings]
        for place, edit in enumerate(self.edits):
            later = {index for other in self.edits[place + 1 :] for index in other.sides}
            if edit.says or not later.issuperset(edit.sides):
                said.append(edit.text(spellings().get(edit.spelling.title)))
        return "; and ".join(said)

    @property
    def spelling(self) -> Spelling:
        """The spelling its edits are of."""
        whole = self.edits[0].spelling if self.edits else spellings()[LISTING]
        for edit in self.edits:
            whole = with_edit(whole, edit)
        return whole

    def read(self, scene: Columns) -> dict[str, Any]:
        """The scene as the program takes it."""
        seen = dict(scene)
        for reading in self.readings:
            seen |= reading.read(seen)
        return seen

    def results(self, scene: Columns) -> dict[str, Any]:
        """All that the program computes for scenes (columns of n), by name."""
        with np.errstate(all="ignore"):
            seen = self.read(scene)
            names = Run(self.spelling, seen).names
            shown = dict(names)
            for reading in self.readings:
                shown |= reading.show(shown, {**names, **scene})
        return shown


def with_edit(spelling: Spelling, edit: Edit) -> Spelling:
    """A spelling with an edit made. An edit of another spelling is found by what it computes."""
    statements = list(spelling.statements)
    for index, sides in edit.sides.items():
        one = edit.spelling.statements[index]
        place = index if edit.spelling.title == spelling.title else spelling.where(one.target)
        statements[place] = statements[place]._replace(sides=sides)
    return replace(spelling, statements=tuple(statements))


@cache
def readings() -> tuple[Reading, ...]:
    """All readings of ``readings.txt``."""
    tables: dict[str, list[tuple[str, str]]] = {}
    found = []
    for line in table("readings.txt"):
        if line.startswith("table "):
            name, entries = line.removeprefix("table ").split(":", 1)
            pairs = (one.rsplit("=", 1) for one in entries.split(", "))
            tables[name] = [(says.strip(), factor.strip()) for says, factor in pairs]
            continue
        word = re.search(r"\{(?!factor)(\w+)\}", line)
        for says, factor in tables[word[1]] if word else [("", "")]:
            filled = line.replace("{factor}", factor)
            found.append(_reading(filled.replace(word[0], says) if word else filled))
    return tuple(found)


def _reading(line: str) -> Reading:
    says, rest = line.split(" | ", 1)
    scene, _, results = rest.partition(";;")
    common = not says.startswith("~")
    return Reading(says.lstrip("~ "), dict(_assigned(scene)), dict(_assigned(results)), common)


def _assigned(text: str) -> Iterator[tuple[str, ast.expr]]:
    for part in filter(str.strip, text.split(";")):
        names, made = part.split("=", 1)
        for name in names.split():
            yield name, expression(made)


@cache
def variants() -> tuple[Edit, ...]:
    """All edits of ``variants.txt``."""
    found = []
    spelling = spellings()[IMPULSES]
    for line in table("variants.txt"):
        if line.startswith("["):
            spelling = spellings()[line.strip("[]")]
        else:
            found.append(_variant(line, spelling))
    return tuple(found)


def _variant(line: str, spelling: Spelling) -> Edit:
    says, rest = line.split(" | ", 1)
    sides: dict[int, tuple[ast.expr, ...]] = {}
    new: dict[str, ast.expr] = {}
    for part in rest.split(";"):
        text, _, subject = part.partition("@")
        if subject:
            left, right = text.split("==")
            place = next(
                i for i in spelling.equations
                if spelling.statements[i].subject.startswith(subject.strip())
            )  # fmt: skip
            sides[place] = expression(left), expression(right)
            continue
        target, made = text.split(" = ", 1)
        known = any(one.target == target.strip() for one in spelling.statements)
        whole = substituted(expression(made), new)
        if known:
            sides[spelling.where(target.strip())] = (whole,)
        else:
            new[target.strip()] = whole
    return Edit(spelling, sides, 0, says)


def substituted(node: ast.expr, names: Expressions) -> ast.expr:
    """An expression with names replaced by expressions."""
    from .edits import renamed

    return renamed(node, names.get)
