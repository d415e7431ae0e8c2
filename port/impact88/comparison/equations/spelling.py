"""The planar impact as statements (``mechanics.txt``), parsed: several spellings of one program."""

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property
from operator import is_not
from typing import Any, NamedTuple

from ...files import packaged_text
from ...names import RESULTS, SCENE

Kin = Mapping[str, tuple[str, ...]]
Expression = Any
"""A name, a number, or an operation and its operands: ``("*", "MA", ("cos", "ga"))``."""
Sides = tuple[Expression, ...]

NEGATIVE = "minus"
_SYMBOLS: dict[type, str] = {
    **{ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**", ast.Eq: "=="},
    **{ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="},
}
COMPARISONS = ("<", "<=", ">", ">=", "==")

FIRST, LAST = "reading", "results"
LISTING, IMPULSES, A_IMPULSE = "listing", "contact impulses", "equations with A's impulse"
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
        every = ([node for side in line.sides for node in nodes(side)] for line in self.statements)
        return tuple(frozenset(node for node in found if isinstance(node, str)) for found in every)

    @cached_property
    def equations(self) -> tuple[int, ...]:
        """Which statements are equations."""
        return tuple(i for i, statement in enumerate(self.statements) if not statement.target)

    @cached_property
    def where(self) -> dict[str, int]:
        """Key -> which statement."""
        return {statement.key: i for i, statement in enumerate(self.statements)}

    def kin_at(self, index: int) -> Kin:
        """The kin that are known already where a statement stands."""
        known = {*SCENE, *(statement.target for statement in self.statements[:index])}
        if self.equations and index >= self.equations[0]:
            known.update(self.unknown)
        return {
            name: tuple(other for other in others if other in known)
            for name, others in self.kin.items()
        }

    @cached_property
    def otherwise(self) -> dict[str, Expression]:
        """What is read for each column as typed, and shown for each result."""
        return {
            f"{TYPED}{line.target}"
            if line.target in SCENE
            else line.target.removeprefix(SHOWN): side
            for line in self.statements
            for side in line.sides[:1]
            if line.target in SCENE or line.target.startswith(SHOWN)
        }

    def composed(self, sides: Mapping[str, Sides]) -> Mapping[str, Sides]:
        """Statements written otherwise in this program: what is read or shown otherwise takes what
        it reads or shows already."""
        again = {key for key in sides if key in SCENE or key.startswith(SHOWN)}
        return {
            key: tuple(renamed(x, self.otherwise) for x in made) if key in again else made
            for key, made in sides.items()
        }

    def edited(self, sides: Mapping[str, Sides]) -> "Spelling":
        """The spelling with statements written otherwise."""
        made = self.composed(sides)
        statements = (
            line._replace(sides=made.get(line.key, line.sides)) for line in self.statements
        )
        return replace(self, statements=tuple(statements))


def operands(node: Expression) -> Sides:
    """What an operation is of; nothing of a name or a number."""
    return node[1:] if isinstance(node, tuple) else ()


def nodes(node: Expression) -> Iterator[Expression]:
    """An expression and all in it."""
    yield node
    for part in operands(node):
        yield from nodes(part)


def renamed(node: Expression, names: Mapping[str, Expression]) -> Expression:
    """An expression with names replaced by expressions."""
    if isinstance(node, str):
        return names.get(node, node)
    found = tuple(renamed(part, names) for part in operands(node))
    return (node[0], *found) if any(map(is_not, found, operands(node))) else node


def written(target: str, sides: Sides) -> str:
    """A statement as text: ``target = side``, or ``side = side`` for an equation."""
    trees = (ast.parse(_in_brackets(side), mode="eval") for side in sides)
    texts = [ast.unparse(tree).replace(" * ", "*").replace(" / ", "/") for tree in trees]
    return " = ".join([target, *texts] if target else texts).replace(" ** ", "**")


def _in_brackets(node: Expression) -> str:
    if not isinstance(node, tuple):
        return str(node)
    name, texts = node[0], list(map(_in_brackets, operands(node)))
    if name == NEGATIVE:
        return f"(-{texts[0]})"
    return f"{name}({','.join(texts)})" if name.isidentifier() else f"({f' {name} '.join(texts)})"


def expression(text: str) -> Expression:
    """An expression parsed."""
    return _expression(ast.parse(text.strip(), mode="eval").body)


def _expression(tree: ast.expr) -> Expression:
    match tree:
        case ast.Name(name):
            return name
        case ast.UnaryOp(ast.USub(), operand):
            return NEGATIVE, _expression(operand)
        case ast.BinOp(left, operator, right) | ast.Compare(left, [operator], [right]):
            return _SYMBOLS[type(operator)], _expression(left), _expression(right)
        case ast.Call(ast.Name(name), arguments):
            return name, *map(_expression, arguments)
        case ast.Constant(number):
            return number
    raise ValueError(f"{ast.unparse(tree)} is no expression")


def _statement(line: str, place: str) -> Statement:
    """``place | name = expression | subject``, or an equation, parsed."""
    where, text, subject = (part.strip() for part in line.split("|"))
    target, _, made = text.rpartition(" = ")
    sides = [made] if target else made.split("==")
    return Statement(where or place, subject, target, tuple(map(expression, sides)))


@cache
def spellings() -> dict[str, Spelling]:
    """All spellings by title."""
    return {title: spelling_of(title) for title in _sections() if title not in (FIRST, LAST)}


@cache
def _sections() -> dict[str, list[str]]:
    """Return the lines of the mechanics by section."""
    sections: dict[str, list[str]] = {}
    for line in table("mechanics.txt"):
        if line.startswith("["):
            lines = sections.setdefault(line.strip("[]"), [])
        else:
            lines.append(line)
    return sections


def table(name: str) -> list[str]:
    """The lines of a packaged table, without comments and blank ones."""
    text = packaged_text("impact88.comparison.equations", name)
    return [line for line in text.splitlines() if line.strip() and not line.startswith("#")]


@cache
def spelling_of(title: str) -> Spelling:
    """Return the spelling of that title; parsing one takes 5 ms."""
    unknown: tuple[str, ...] = ()
    kin: dict[str, set[str]] = {}
    statements = [_statement(f"| {n} = {TYPED}{n} | {n} as typed", "input") for n in SCENE]
    begins = []
    for section in (FIRST, title, LAST):
        begins.append(len(statements))
        known = {statement.target for statement in statements}.union(unknown)
        for line in _sections()[section]:
            word, *names = line.split()
            if word == "kin":
                for name in names:
                    kin.setdefault(name, set()).update(names)
            elif word == "unknown":
                unknown = tuple(names)
            else:
                statement = _statement(line, f"{title} form")
                if section != LAST or statement.target not in known:
                    statements.append(statement)
    known = {statement.target for statement in statements}.union(unknown)
    results = [name for name in RESULTS if name in known]
    statements += [_statement(f"| {SHOWN}{n} = {n} | {n} shown", "output") for n in results]
    others = {name: tuple(sorted(alike - {name})) for name, alike in kin.items()}
    return Spelling(title, tuple(statements), unknown, others, *begins[1:])
