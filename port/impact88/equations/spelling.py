"""The planar impact as statements (``mechanics.txt``), parsed: five spellings of one program."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import NamedTuple

from ..files import packaged_text
from ..names import SCENE

Kin = Mapping[str, tuple[str, ...]]

FIRST, LAST = "reading", "results"
LISTING, IMPULSES = "listing", "contact impulses"


class Statement(NamedTuple):
    """A statement: where it stands, what it is about, the name it computes ("" of an equation), and
    its expression, or the two sides of the equation."""

    place: str
    subject: str
    target: str
    sides: tuple[ast.expr, ...]

    @property
    def text(self) -> str:
        """As it is written."""
        return written(self.target, self.sides)


@dataclass(frozen=True)
class Spelling:
    """One way to write the whole program. ``unknown``: what its equations are solved for; ``kin``:
    name -> the names it may be mistaken for; ``own``, ``results``: where what is its own begins,
    and where its results."""

    title: str
    statements: tuple[Statement, ...]
    unknown: tuple[str, ...]
    kin: Kin
    own: int
    results: int

    @cached_property
    def reads(self) -> tuple[frozenset[str], ...]:
        """The names that each statement reads."""
        return tuple(
            frozenset().union(*map(names_in, statement.sides)) for statement in self.statements
        )

    @cached_property
    def equations(self) -> tuple[int, ...]:
        """Which statements are equations."""
        return tuple(i for i, one in enumerate(self.statements) if not one.target)

    def kin_at(self, index: int) -> Kin:
        """The kin that are known already where a statement stands."""
        known = {*SCENE, *(one.target for one in self.statements[:index])}
        if self.equations and index >= self.equations[0]:
            known.update(self.unknown)
        return {
            name: tuple(one for one in others if one in known) for name, others in self.kin.items()
        }

    def where(self, target: str) -> int:
        """Which statement computes a name."""
        return next(i for i, one in enumerate(self.statements) if one.target == target)


def names_in(expression: ast.expr) -> frozenset[str]:
    """The names of values in an expression."""
    calls = {id(node.func) for node in ast.walk(expression) if isinstance(node, ast.Call)}
    return frozenset(
        node.id
        for node in ast.walk(expression)
        if isinstance(node, ast.Name) and id(node) not in calls
    )


def written(target: str, sides: tuple[ast.expr, ...]) -> str:
    """A statement as text: ``target = side``, or ``side = side`` for an equation."""
    texts = [ast.unparse(side).replace(" * ", "*").replace(" / ", "/") for side in sides]
    return " = ".join([target, *texts] if target else texts).replace(" ** ", "**")


def expression(text: str) -> ast.expr:
    """An expression parsed."""
    return ast.parse(text.strip(), mode="eval").body


def statement(line: str, place: str = "") -> Statement:
    """``place | name = expression | subject``, or an equation, parsed."""
    where, text, subject = (part.strip() for part in line.split("|"))
    if " = " not in text:
        left, right = text.split("==")
        return Statement(where or place, subject, "", (expression(left), expression(right)))
    target, value = text.split(" = ", 1)
    return Statement(where or place, subject, target.strip(), (expression(value),))


@cache
def spellings() -> dict[str, Spelling]:
    """All spellings by title."""
    sections: dict[str, list[str]] = {}
    for line in table("mechanics.txt"):
        if line.startswith("["):
            lines = sections.setdefault(line.strip("[]"), [])
        else:
            lines.append(line)
    middle = [title for title in sections if title not in (FIRST, LAST)]
    return {title: _spelling(title, sections) for title in middle}


def table(name: str) -> list[str]:
    """The lines of a packaged table, without comments and blank ones."""
    text = packaged_text("impact88.equations", name)
    return [line for line in text.splitlines() if line.strip() and not line.startswith("#")]


def _spelling(title: str, sections: Mapping[str, list[str]]) -> Spelling:
    unknown: tuple[str, ...] = ()
    kin: dict[str, set[str]] = {}
    statements: list[Statement] = []
    begins = []
    for section in (FIRST, title, LAST):
        begins.append(len(statements))
        known = {one.target for one in statements if one.target} | set(unknown)
        for line in sections[section]:
            word, *names = line.split()
            if word == "kin":
                for name in names:
                    kin.setdefault(name, set()).update(other for other in names if other != name)
            elif word == "unknown":
                unknown = tuple(names)
            else:
                one = statement(line, f"{title} form")
                if section != LAST or one.target not in known:
                    statements.append(one)
    return Spelling(
        title,
        tuple(statements),
        unknown,
        {name: tuple(sorted(others)) for name, others in kin.items()},
        *begins[1:],
    )
