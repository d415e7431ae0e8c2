"""The planar impact as statements (``mechanics.txt``), parsed: several spellings of one program."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any, NamedTuple

from ..files import packaged_text
from ..names import RESULTS, SCENE

Kin = Mapping[str, tuple[str, ...]]
Sides = tuple[ast.expr, ...]

FIRST, LAST = "reading", "results"
LISTING, IMPULSES, A_IMPULSE = "listing", "contact impulses", "equations with A's impulse"
CONTACT_FRAME = "contact frame"
TYPED, SHOWN = "typed_", "shown_"
"""Before a column's name: as the table has it; before a result's: as the program shows it."""


class Statement(NamedTuple):
    """A statement: where it stands, what it is about, the name it computes ("" of an equation), and
    its expression, or the two sides of the equation."""

    place: str
    subject: str
    target: str
    sides: Sides

    @property
    def key(self) -> str:
        """What it is found by in any spelling that has it."""
        return self.target or f"== {self.subject}"

    @property
    def text(self) -> str:
        """As it is written."""
        return written(self.target, self.sides)


@dataclass(frozen=True)
class Spelling:
    """One way to write the whole program: the scene as typed, ``statements``, the results as shown.

    ``unknown``: what its equations are solved for; ``kin``: name -> the names it may be mistaken
    for; ``own``, ``results``: where what is its own begins, and where its results."""

    title: str
    statements: tuple[Statement, ...]
    unknown: tuple[str, ...]
    kin: Kin
    own: int
    results: int

    @cached_property
    def reads(self) -> tuple[frozenset[str], ...]:
        """The names that each statement reads."""
        return tuple(frozenset().union(*map(names_in, one.sides)) for one in self.statements)

    @cached_property
    def equations(self) -> tuple[int, ...]:
        """Which statements are equations."""
        return tuple(i for i, one in enumerate(self.statements) if not one.target)

    @cached_property
    def where(self) -> dict[str, int]:
        """Key -> which statement."""
        return {one.key: i for i, one in enumerate(self.statements)}

    def kin_at(self, index: int) -> Kin:
        """The kin that are known already where a statement stands."""
        known = {*SCENE, *(one.target for one in self.statements[:index])}
        if self.equations and index >= self.equations[0]:
            known.update(self.unknown)
        return {
            name: tuple(one for one in others if one in known) for name, others in self.kin.items()
        }

    @cached_property
    def otherwise(self) -> dict[str, ast.expr]:
        """What stands for a column as typed, or a result, where it is read or shown otherwise."""
        made = {}
        for one in self.statements:
            if one.target in SCENE or one.target.startswith(SHOWN):
                name = one.target.removeprefix(SHOWN)
                usual = name if name != one.target else f"{TYPED}{name}"
                if written("", one.sides) != usual:
                    made[usual] = one.sides[0]
        return made

    def composed(self, sides: Mapping[str, Sides]) -> Mapping[str, Sides]:
        """Statements written otherwise in this program: what is read or shown otherwise takes what
        it reads or shows already."""
        if not self.otherwise:
            return sides
        return {
            key: tuple(renamed(side, self.otherwise) for side in made)
            if key in SCENE or key.startswith(SHOWN)
            else made
            for key, made in sides.items()
        }

    def edited(self, sides: Mapping[str, Sides]) -> Spelling:
        """The spelling with statements written otherwise."""
        made = self.composed(sides)
        return replace(
            self,
            statements=tuple(
                one._replace(sides=made.get(one.key, one.sides)) for one in self.statements
            ),
        )


def parts(node: ast.expr) -> list[tuple[str, int | None, ast.expr]]:
    """The operands of an expression: field, place in it, and expression."""
    if isinstance(node, ast.BinOp):
        return [("left", None, node.left), ("right", None, node.right)]
    if isinstance(node, ast.UnaryOp):
        return [("operand", None, node.operand)]
    if isinstance(node, ast.Compare):
        return [("left", None, node.left), ("comparators", 0, node.comparators[0])]
    if isinstance(node, ast.Call):
        return [("args", place, argument) for place, argument in enumerate(node.args)]
    return []


def with_part(node: ast.expr, field: str, place: int | None, other: ast.expr) -> ast.expr:
    """An expression with another operand."""
    made: Any = other
    if place is not None:
        made = [*getattr(node, field)]
        made[place] = other
    return type(node)(**{**vars(node), field: made})


def rebuilt(node: ast.expr, change: Callable[[ast.expr], ast.expr | None]) -> ast.expr:
    """An expression with nodes replaced by what ``change`` gives for them."""
    found = change(node)
    if found is not None:
        return found
    for field, place, part in parts(node):
        other = rebuilt(part, change)
        if other is not part:
            node = with_part(node, field, place, other)
    return node


def renamed(node: ast.expr, names: Mapping[str, ast.expr]) -> ast.expr:
    """An expression with names replaced by expressions."""
    return rebuilt(node, lambda one: names.get(one.id) if isinstance(one, ast.Name) else None)


def nodes(node: ast.expr) -> Iterator[ast.expr]:
    """An expression and all in it, names of functions left out."""
    yield node
    for _, _, part in parts(node):
        yield from nodes(part)


def names_in(node: ast.expr) -> frozenset[str]:
    """The names of values in an expression."""
    return frozenset(one.id for one in nodes(node) if isinstance(one, ast.Name))


def written(target: str, sides: Sides) -> str:
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
    statements = [statement(f"input | {name} = {TYPED}{name} | {name} as typed") for name in SCENE]
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
    known = {one.target for one in statements} | set(unknown)
    shown = [name for name in RESULTS if name in known]
    statements += [statement(f"output | {SHOWN}{name} = {name} | {name} shown") for name in shown]
    return Spelling(
        title,
        tuple(statements),
        unknown,
        {name: tuple(sorted(others)) for name, others in kin.items()},
        *begins[1:],
    )
