"""Everything that may be written wrong in a statement: generic edits of every node.

An edit knows nothing of mechanics but which names stand for things of one kind.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from .spelling import Kin, Spelling, Statement, names_in, written

_CONSTANTS: dict[float, tuple[float, ...]] = {
    0: (1,),
    1: (0, 2),
    2: (1, 4, 0.5),
    100: (1,),
    180: (360, 200, 90),
}
"""What may be written for a constant."""
_FUNCTIONS = {"sin": ("cos", "tan"), "cos": ("sin", "tan"), "hypot": ("added", "abs", "squared")}
CONDITIONS = ("point", "pivot", "stick")
"""Names that are true or false."""
_LIKELY, _LESS, _RARE = 1, 2, 3
"""How likely an edit is: of those that compute the same, the likeliest is named."""


class Edit(NamedTuple):
    """Statements of a spelling written otherwise: place among its statements -> its sides; how
    likely that is; what is said of it where the statements do not say enough."""

    spelling: Spelling
    sides: Mapping[int, tuple[ast.expr, ...]]
    rank: int = _LIKELY
    says: str = ""

    def text(self, right: Spelling | None = None) -> str:
        """Place, what is written, what should be (as ``right`` has it), and what it is about."""
        if self.says:
            return self.says
        parts = []
        for index, sides in self.sides.items():
            one = (right or self.spelling).statements[index]
            now, should = written(one.target, sides), one.text.removeprefix(f"{one.target} = ")
            parts.append(f"{one.place}: {now}, should be {should}; {one.subject}")
        return "; and ".join(parts)


def name(text: str) -> ast.expr:
    """A name as a node."""
    return ast.Name(text, ast.Load())


def number(value: float) -> ast.expr:
    """A constant as a node."""
    return ast.Constant(value)


def negative(node: ast.expr) -> ast.expr:
    """The node with the other sign."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return node.operand
    return ast.UnaryOp(ast.USub(), node)


def call(function: str, *arguments: ast.expr) -> ast.expr:
    """A call as a node."""
    return ast.Call(name(function), list(arguments), [])


def _sum(left: ast.expr, op: ast.operator, right: ast.expr) -> ast.expr:
    return ast.BinOp(left, op, right)


def is_condition(node: ast.expr) -> bool:
    """Whether an expression is true or false."""
    return isinstance(node, ast.Compare) or (isinstance(node, ast.Name) and node.id in CONDITIONS)


def statement_edits(spelling: Spelling, places: range | None = None) -> Iterator[Edit]:
    """Every edit of one node of one statement. ``places``: of these statements only."""
    for index in places or range(len(spelling.statements)):
        one, kin = spelling.statements[index], spelling.kin_at(index)
        for place, side in enumerate(one.sides):
            for rank, other in variations(side, kin):
                sides = (*one.sides[:place], other, *one.sides[place + 1 :])
                yield Edit(spelling, {index: sides}, rank)


def variations(node: ast.expr, kin: Kin, whole: bool = True) -> Iterator[tuple[int, ast.expr]]:
    """An expression with one of its nodes edited, and how likely that is; ``whole``: it is all of
    its side."""
    yield from _here(node, kin)
    if (whole or isinstance(node, ast.Name)) and not is_condition(node):
        yield from _rarely(node)
    if isinstance(node, ast.BinOp):
        for rank, left in variations(node.left, kin, False):
            yield rank, ast.BinOp(left, node.op, node.right)
        for rank, right in variations(node.right, kin, False):
            yield rank, ast.BinOp(node.left, node.op, right)
    elif isinstance(node, ast.UnaryOp):
        for rank, operand in variations(node.operand, kin, False):
            yield rank, ast.UnaryOp(node.op, operand)
    elif isinstance(node, ast.Compare):
        for rank, left in variations(node.left, kin, False):
            yield rank, ast.Compare(left, node.ops, node.comparators)
        for rank, right in variations(node.comparators[0], kin, False):
            yield rank, ast.Compare(node.left, node.ops, [right])
    elif isinstance(node, ast.Call):
        for place, argument in enumerate(node.args):
            for rank, other in variations(argument, kin, False):
                arguments = [*node.args[:place], other, *node.args[place + 1 :]]
                yield rank, ast.Call(node.func, arguments, [])


def _here(node: ast.expr, kin: Kin) -> Iterator[tuple[int, ast.expr]]:
    """What may stand in a node's place."""
    if isinstance(node, ast.Compare):
        yield from _compared(node)
        return
    if isinstance(node, ast.Name) and node.id in CONDITIONS:
        yield _LIKELY, ast.Constant(False)
        yield _LIKELY, ast.Constant(True)
        return
    yield _LIKELY, negative(node)
    if isinstance(node, ast.Name):
        for other in kin.get(node.id, ()):
            yield _LIKELY, name(other)
        if node.id == "pi":
            for value in (3.14159265, 3.14, 3.1416, 3.1415927, 22 / 7):
                yield _LIKELY, number(value)
        yield _LESS, number(0)
    elif isinstance(node, ast.Constant):
        assert isinstance(node.value, int | float)
        for value in _CONSTANTS.get(node.value, ()):
            yield _LIKELY, number(value)
    elif isinstance(node, ast.BinOp):
        yield from _operated(node)
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        yield from _called(node, node.func.id)
    if not isinstance(node, ast.Constant):
        yield _LESS, _sum(node, ast.Mult(), number(2))
        yield _LESS, _sum(node, ast.Div(), number(2))


def _rarely(node: ast.expr) -> Iterator[tuple[int, ast.expr]]:
    if not isinstance(node, ast.Constant):
        yield _LESS, _sum(node, ast.Pow(), number(2))
        yield _LESS, call("abs", node)
        yield _LESS, call("sqrt", call("abs", node))
        yield _LESS, _sum(number(1), ast.Sub(), node)
        yield _LESS, _sum(number(1), ast.Div(), node)
        yield _RARE, call("single", node)


def _compared(node: ast.Compare) -> Iterator[tuple[int, ast.expr]]:
    for op in (ast.Lt(), ast.LtE(), ast.Gt(), ast.GtE()):
        if not isinstance(op, type(node.ops[0])):
            yield _LIKELY, ast.Compare(node.left, [op], node.comparators)
    yield _LIKELY, ast.Constant(False)
    yield _LIKELY, ast.Constant(True)


def _operated(node: ast.BinOp) -> Iterator[tuple[int, ast.expr]]:
    left, op, right = node.left, node.op, node.right
    yield _LIKELY, left
    if isinstance(op, ast.Sub):
        yield _LIKELY, negative(right)
        yield _LIKELY, _sum(left, ast.Add(), right)
        yield _LIKELY, right
    elif isinstance(op, ast.Add):
        yield _LIKELY, right
        yield _LIKELY, _sum(left, ast.Sub(), right)
    elif isinstance(op, ast.Mult):
        yield _LIKELY, right
        yield _LIKELY, _sum(left, ast.Div(), right)
        yield from _bracketed(left, right)
    elif isinstance(op, ast.Div):
        yield _LIKELY, _sum(right, ast.Div(), left)
        yield _LIKELY, _sum(left, ast.Mult(), right)
        if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add | ast.Sub):
            yield _LIKELY, _sum(left.left, left.op, _sum(left.right, ast.Div(), right))
        if isinstance(right, ast.BinOp):
            if isinstance(right.op, ast.Mult):
                yield _LIKELY, _sum(_sum(left, ast.Div(), right.left), ast.Mult(), right.right)
            elif isinstance(right.op, ast.Add | ast.Sub):
                yield _LIKELY, _sum(_sum(left, ast.Div(), right.left), right.op, right.right)
    elif isinstance(op, ast.Pow):
        yield _LIKELY, _sum(left, ast.Mult(), number(2))
        yield _LESS, _sum(left, ast.Pow(), number(3))
    if isinstance(op, ast.Add | ast.Sub) and _is_inverse(left) and _is_inverse(right):
        yield _LIKELY, _sum(number(1), ast.Div(), _sum(left.right, op, right.right))  # type: ignore[attr-defined]


def _is_inverse(node: ast.expr) -> bool:
    return (
        isinstance(node, ast.BinOp)
        and isinstance(node.op, ast.Div)
        and isinstance(node.left, ast.Constant)
    )


def _bracketed(left: ast.expr, right: ast.expr) -> Iterator[tuple[int, ast.expr]]:
    """A product with a sum, its brackets forgotten."""
    for one, other in ((left, right), (right, left)):
        if isinstance(one, ast.BinOp) and isinstance(one.op, ast.Add | ast.Sub):
            yield _LIKELY, _sum(_sum(other, ast.Mult(), one.left), one.op, one.right)
            yield _LIKELY, _sum(one.left, one.op, _sum(other, ast.Mult(), one.right))


def _called(node: ast.Call, function: str) -> Iterator[tuple[int, ast.expr]]:
    for other in _FUNCTIONS.get(function, ()):
        if function == other or other != "abs":
            yield _LIKELY, call(other, *node.args)
    if function == "where":
        condition, there, otherwise = node.args
        yield _LIKELY, call("where", condition, otherwise, there)
        yield _LIKELY, there
        yield _LIKELY, otherwise
    elif function == "hypot":
        for argument in node.args:
            yield _LIKELY, call("abs", argument)
            yield _LIKELY, argument
    elif len(node.args) == 1:
        yield _LESS, node.args[0]


def equation_edits(spelling: Spelling) -> Iterator[Edit]:
    """The same edit throughout one equation (all statements of one subject), or one statement."""
    subjects: dict[str, list[int]] = {}
    for index, one in enumerate(spelling.statements[: spelling.results]):
        if index < spelling.own:
            continue
        if one.subject.startswith("Equation"):
            subjects.setdefault(one.subject, []).append(index)
        subjects[f"{one.text}; {one.subject}"] = [index]
    for subject, places in subjects.items():
        names = Counter(n for i in places for n in _occurring(spelling.statements[i]))
        if len(places) == 1 and subject == spelling.statements[places[0]].subject:
            continue
        for what, often in names.items():
            if what in (*CONDITIONS, *spelling.unknown):
                continue
            kin = spelling.kin_at(min(places)).get(what, ())
            for says, change in _throughout(what, kin, names, often > 1):
                sides = {
                    i: tuple(renamed(side, change) for side in spelling.statements[i].sides)
                    for i in places
                    if any(change(n) is not None for n in spelling.reads[i])
                }
                yield Edit(
                    spelling, sides, _LESS, f"{_places(spelling, sides)}: {says} in {subject}"
                )


def _occurring(one: Statement) -> Iterator[str]:
    for side in one.sides:
        for node in ast.walk(side):
            if isinstance(node, ast.Name) and node.id not in ("sin", "cos", "where", "hypot", "pi"):
                yield node.id


def _throughout(
    what: str, kin: Sequence[str], there: Container[str], everywhere: bool
) -> Iterator[tuple[str, Callable[[str], ast.expr | None]]]:
    """What may be done to a name wherever it stands, and to pairs of those ``there``."""

    def put(node: ast.expr, other: str = "", back: ast.expr | None = None) -> Any:
        return lambda n: node if n == what else back if n == other else None

    for other in kin:
        if other > what and other in there:
            yield f"{what} and {other} exchanged", put(name(other), other, name(what))
    if everywhere:
        yield f"{what} with the wrong sign", put(negative(name(what)))
        yield f"{what} left out", put(number(0))
        yield f"{what} halved", put(_sum(name(what), ast.Div(), number(2)))
        for other in kin:
            yield f"{other} for {what}", put(name(other))


def _places(spelling: Spelling, sides: Mapping[int, object]) -> str:
    where = dict.fromkeys(spelling.statements[i].place for i in sides)
    return ", ".join(place for place in where if place)


def renamed(node: ast.expr, change: Callable[[str], ast.expr | None]) -> ast.expr:
    """An expression with names replaced."""
    if not any(change(one) is not None for one in names_in(node)):
        return node
    if isinstance(node, ast.Name):
        return change(node.id) or node
    if isinstance(node, ast.BinOp):
        return ast.BinOp(renamed(node.left, change), node.op, renamed(node.right, change))
    if isinstance(node, ast.UnaryOp):
        return ast.UnaryOp(node.op, renamed(node.operand, change))
    if isinstance(node, ast.Compare):
        left, right = (renamed(one, change) for one in (node.left, node.comparators[0]))
        return ast.Compare(left, node.ops, [right])
    assert isinstance(node, ast.Call)
    return ast.Call(node.func, [renamed(one, change) for one in node.args], [])
