"""Parse the mechanics (``mechanics.txt``): the impact as statements, in several spellings."""

import ast
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property
from operator import is_not
from typing import Any, NamedTuple

from ..files import packaged_text
from ..names import RESULTS, SCENE

Kin = Mapping[str, tuple[str, ...]]
"""Name -> the names it may be mistaken for."""
KinOf = Callable[[str], tuple[str, ...]]
"""Function of a name that returns the names it may be mistaken for."""
Expression = Any
"""A name, a number, or an operation and its operands: ``("*", "MA", ("cos", "ga"))``."""
Sides = tuple[Expression, ...]

NEGATIVE = "minus"
_SYMBOLS: dict[type, str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "**",
    ast.Eq: "==",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
}
COMPARISONS = ("<", "<=", ">", ">=", "==")

# sections that every spelling begins and ends with
FIRST = "reading"
LAST = "results"

# titles of spellings
LISTING = "listing"
IMPULSES = "contact impulses"
IMPULSE_MATRIX = "impulse matrix"
A_IMPULSE = "equations with A's impulse"
TRIAL_IMPULSES = "trial impulses"

TYPED = "typed_"  # prefix of a column's name: its value in the table
SHOWN = "shown_"  # prefix of a result's name: its value as the program shows it


class Statement(NamedTuple):
    """A statement: its place in the listing, its subject, the name it computes ("" for an
    equation), and its expression, or the two sides of the equation."""

    place: str
    subject: str
    target: str
    sides: Sides

    @property
    def key(self) -> str:
        """Key of the statement, the same in every spelling that has it."""
        return self.target or f"== {self.subject}"

    @property
    def text(self) -> str:
        """The statement as it is written."""
        return format_statement(self.target, self.sides)


@dataclass(frozen=True)
class Spelling:
    """One way to write the whole program, from the scene as typed to the results as shown.

    ``unknown``: the names its equations are solved for; ``own_start``, ``results_start``: indices
    of the first statement of its own section and of the first of the results'.
    """

    title: str
    statements: tuple[Statement, ...]
    unknown: tuple[str, ...]
    kin: Kin
    own_start: int
    results_start: int

    @cached_property
    def reads(self) -> tuple[frozenset[str], ...]:
        """The names that each statement reads."""
        return tuple(
            frozenset(x for side in line.sides for x in nodes(side) if isinstance(x, str))
            for line in self.statements
        )

    @cached_property
    def equations(self) -> tuple[int, ...]:
        """Indices of the statements that are equations."""
        return tuple(i for i, statement in enumerate(self.statements) if not statement.target)

    @cached_property
    def index_of(self) -> dict[str, int]:
        """Key -> index of the statement."""
        return {statement.key: i for i, statement in enumerate(self.statements)}

    def kin_at(self, index: int) -> KinOf:
        """Return a function of a name: its kin among the names that a statement may read."""
        defined = {*SCENE, *(statement.target for statement in self.statements[:index])}
        if self.equations and index >= self.equations[0]:
            defined.update(self.unknown)
        return lambda name: tuple(twin for twin in self.kin.get(name, ()) if twin in defined)

    @cached_property
    def input_output(self) -> dict[str, Expression]:
        """Expressions of the input and output statements: what is read in place of each column as
        typed (by its prefixed name), and shown in place of each result (by its plain name)."""
        return {
            f"{TYPED}{line.target}"
            if line.target in SCENE
            else line.target.removeprefix(SHOWN): side
            for line in self.statements
            for side in line.sides[:1]
            if line.target in SCENE or line.target.startswith(SHOWN)
        }

    def compose(self, sides: Mapping[str, Sides]) -> Mapping[str, Sides]:
        """Return new sides as they act on top of this spelling: an edit of what is read or shown
        applies to what the spelling already reads or shows there."""
        return {
            key: tuple(substitute(x, self.input_output) for x in expressions)
            if key in SCENE or key.startswith(SHOWN)
            else expressions
            for key, expressions in sides.items()
        }

    def with_edits(self, sides: Mapping[str, Sides]) -> "Spelling":
        """Return the spelling with some statements rewritten."""
        new_sides = self.compose(sides)
        statements = (
            line._replace(sides=new_sides.get(line.key, line.sides)) for line in self.statements
        )
        return replace(self, statements=tuple(statements))


def operands(node: Expression) -> Sides:
    """Return the operands of an operation; () for a name or a number."""
    return node[1:] if isinstance(node, tuple) else ()


def nodes(node: Expression) -> Iterator[Expression]:
    """Yield an expression and all of its subexpressions, from the outside in."""
    yield node
    for part in operands(node):
        yield from nodes(part)


def substitute(node: Expression, names: Mapping[str, Expression]) -> Expression:
    """Return an expression with names replaced by expressions; itself where none occurs."""
    if isinstance(node, str):
        return names.get(node, node)
    if not isinstance(node, tuple):
        return node
    parts = [substitute(part, names) for part in node[1:]]
    return (node[0], *parts) if any(map(is_not, parts, node[1:])) else node


def format_statement(target: str, sides: Sides) -> str:
    """Return a statement as text: ``target = side``, or ``side = side`` for an equation."""
    texts = list(map(format_expression, sides))
    return " = ".join([target, *texts] if target else texts)


def format_expression(node: Expression) -> str:
    """Return an expression as text, without brackets that it does not need."""
    text = ast.unparse(ast.parse(_parenthesize(node), mode="eval"))
    return text.replace(" * ", "*").replace(" / ", "/").replace(" ** ", "**")


def _parenthesize(node: Expression) -> str:
    if not isinstance(node, tuple):
        return str(node)
    name, texts = node[0], list(map(_parenthesize, operands(node)))
    if name == NEGATIVE and isinstance(node[1], tuple) and node[1][0] in "*/":
        operation, left, right = node[1]
        return _parenthesize((operation, (NEGATIVE, left), right))
    if name == NEGATIVE:
        return f"(-{texts[0]})"
    return f"{name}({','.join(texts)})" if name.isidentifier() else f"({f' {name} '.join(texts)})"


def parse_expression(text: str) -> Expression:
    """Parse an expression."""
    return _expression_of(ast.parse(text.strip(), mode="eval").body)


def _expression_of(tree: ast.expr) -> Expression:
    match tree:
        case ast.Name(name):
            return name
        case ast.UnaryOp(ast.USub(), operand):
            return NEGATIVE, _expression_of(operand)
        case ast.BinOp(ast.UnaryOp(ast.USub(), left), ast.Mult() | ast.Div() as operator, right):
            # the sign is that of the whole product, so that a factor can be left out alone
            product = _SYMBOLS[type(operator)], _expression_of(left), _expression_of(right)
            return NEGATIVE, product
        case ast.BinOp(left, ast.Mult() | ast.Div() as operator, right):
            sides = _expression_of(left), _expression_of(right)
            if isinstance(sides[0], tuple) and sides[0][0] == NEGATIVE and _is_product(left):
                return NEGATIVE, (_SYMBOLS[type(operator)], sides[0][1], sides[1])
            return _SYMBOLS[type(operator)], *sides
        case ast.BinOp(left, operator, right) | ast.Compare(left, [operator], [right]):
            return _SYMBOLS[type(operator)], _expression_of(left), _expression_of(right)
        case ast.Call(ast.Name(name), arguments):
            return name, *map(_expression_of, arguments)
        case ast.Constant(number):
            return number
    raise ValueError(f"{ast.unparse(tree)} is not an expression")


def _is_product(tree: ast.expr) -> bool:
    return isinstance(tree, ast.BinOp) and isinstance(tree.op, ast.Mult | ast.Div)


def _parse_statement(line: str, place: str) -> Statement:
    """Parse ``place | name = expression | subject``, or an equation.

    ``place`` is taken where the line leaves its own empty.
    """
    own_place, text, subject = (part.strip() for part in line.split("|"))
    target, _, right = text.rpartition(" = ")
    sides = [right] if target else right.split("==")
    return Statement(own_place or place, subject, target, tuple(map(parse_expression, sides)))


@cache
def spellings() -> dict[str, Spelling]:
    """Return all spellings by title."""
    return {title: spelling_of(title) for title in _sections() if title not in (FIRST, LAST)}


@cache
def _sections() -> dict[str, list[str]]:
    """Return the lines of the mechanics by section."""
    sections: dict[str, list[str]] = {}
    for line in read_table("mechanics.txt"):
        if line.startswith("["):
            lines = sections.setdefault(line.strip("[]"), [])
        else:
            lines.append(line)
    return sections


def read_table(name: str) -> list[str]:
    """Return the lines of a packaged table, without comments and blank lines."""
    text = packaged_text("impact88.equations", name)
    return [line for line in text.splitlines() if line.strip() and not line.startswith("#")]


@cache
def spelling_of(title: str) -> Spelling:
    """Return the spelling of a title. Parsing one takes 5 ms."""
    unknown: tuple[str, ...] = ()
    kin: dict[str, set[str]] = {}
    statements = [_parse_statement(f"| {n} = {TYPED}{n} | {n} as typed", "input") for n in SCENE]
    starts = []
    for section in (FIRST, title, LAST):
        starts.append(len(statements))
        defined = {statement.target for statement in statements}.union(unknown)
        for line in _sections()[section]:
            word, *names = line.split()
            if word == "kin":
                for name in names:
                    kin.setdefault(name, set()).update(names)
            elif word == "unknown":
                unknown = tuple(names)
            else:
                statement = _parse_statement(line, f"{title} form")
                if section != LAST or statement.target not in defined:
                    statements.append(statement)
    defined = {statement.target for statement in statements}.union(unknown)
    results = [name for name in RESULTS if name in defined]
    statements += [_parse_statement(f"| {SHOWN}{n} = {n} | {n} shown", "output") for n in results]
    twins = {name: tuple(sorted(names - {name})) for name, names in kin.items()}
    _, own_start, results_start = starts
    return Spelling(title, tuple(statements), unknown, twins, own_start, results_start)
