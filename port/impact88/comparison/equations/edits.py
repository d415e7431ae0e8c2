"""What may be wrong in a program: a statement written otherwise (``rules.txt``, at every node), the
same throughout one equation, columns read or shown otherwise (``readings.txt``), and other models
(``variants.txt``)."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from ...names import SCENE
from .evaluation import BESIDE
from .spelling import (
    COMPARISONS,
    IMPULSES,
    LISTING,
    NEGATIVE,
    SHOWN,
    TYPED,
    Expression,
    Kin,
    Sides,
    Spelling,
    expression,
    nodes,
    operands,
    renamed,
    spellings,
    table,
    written,
)

MODEL, CONVENTION, RARE_CONVENTION, LIKELY, LESS, RARE = range(6)
"""How likely an edit is: of those that compute the same, the likeliest is named."""
CONDITIONS = ("point", "pivot", "stick")
"""Names that are true or false."""
TRUTHS = (*COMPARISONS, "either")
"""Operations that are: they have no sign and no size."""
_SECTIONS = {"[likely]": LIKELY, "[less likely]": LESS, "[rare]": RARE}


class Edit(NamedTuple):
    """Statements written otherwise: key -> sides; how likely that is; what is said of it where the
    statements do not say enough. ``title``: the spelling that it is of, "" if of any."""

    title: str
    sides: Mapping[str, Sides]
    rank: int = LIKELY
    says: str = ""

    @property
    def shows(self) -> bool:
        """Whether results are shown otherwise."""
        return any(key.startswith(SHOWN) for key in self.sides)

    @property
    def text(self) -> str:
        """Place, what is written, what should be, and what it is about."""
        if self.says:
            return self.says
        said = []
        right = spellings()[self.title]
        for key, sides in self.sides.items():
            statement = right.statements[right.where[key]]
            now = written(statement.target, sides)
            should = statement.text.removeprefix(f"{statement.target} = ")
            said.append(f"{statement.place}: {now}, should be {should}; {statement.subject}")
        return "; and ".join(said)


def _node_edits(spelling: Spelling, places: range) -> Iterator[Edit]:
    """Every edit of one node of statements, of each statement the likeliest first: of those that
    compute the same it stays."""
    for index in places:
        line, kin = spelling.statements[index], spelling.kin_at(index)
        found = [
            Edit(spelling.title, {line.key: (*line.sides[:at], other, *line.sides[at + 1 :])}, rank)
            for at, side in enumerate(line.sides)
            for rank, other in _variations(side, kin)
        ]
        yield from sorted(found, key=lambda edit: edit.rank)


def _variations(node: Expression, kin: Kin, whole: bool = True) -> Iterator[tuple[int, Expression]]:
    """An expression with one of its nodes edited, and how likely that is; ``whole``: it is all of
    its side."""
    rules, kind = _rules(), _kind(node)
    for rank, pattern, alternatives in rules.get(kind, ()):
        bound: dict[str, Expression] = {}
        if _matches(pattern, node, bound):
            yield from ((rank, _filled(made, bound)) for made in alternatives)
    if node in CONDITIONS:
        yield LIKELY, False
        yield LIKELY, True
        return
    is_name = isinstance(node, str)
    if is_name:
        yield from ((LIKELY, twin) for twin in kin.get(node, ()))
        yield LESS, 0
    for pattern in ("any", "whole") if whole or is_name else ("any",):
        for rank, _, alternatives in rules[pattern]:
            if kind not in TRUTHS and (rank == LIKELY or isinstance(node, str | tuple)):
                yield from ((rank, _filled(made, {pattern: node})) for made in alternatives)
    for place, part in enumerate(operands(node), 1):
        for rank, other in _variations(part, kin, False):
            yield rank, (*node[:place], other, *node[place + 1 :])


@cache
def _rules() -> dict[object, list[tuple[int, Expression, list[Expression]]]]:
    rules: dict[object, list[tuple[int, Expression, list[Expression]]]] = {}
    rank = LIKELY
    for line in table("rules.txt"):
        if line in _SECTIONS:
            rank = _SECTIONS[line]
            continue
        pattern, made = line.split("->")
        node, others = expression(pattern), list(map(expression, made.split(";")))
        rules.setdefault(_kind(node), []).append((rank, node, others))
    return rules


def _kind(node: Expression) -> object:
    """What a node has in common with the patterns that may match it."""
    return node[0] if isinstance(node, tuple) else node


def _matches(pattern: Expression, node: Expression, bound: dict[str, Expression]) -> bool:
    """Whether a node is of a pattern; what its letters stand for goes to ``bound``."""
    if isinstance(pattern, str) and len(pattern) == 1:
        bound[pattern] = node
        return True
    return _kind(pattern) == _kind(node) and all(
        _matches(wanted, other, bound)
        for wanted, other in zip(operands(pattern), operands(node), strict=True)
    )


def _filled(made: Expression, bound: Mapping[str, Expression]) -> Expression:
    """A template with its letters replaced; minus minus is nothing."""
    if _kind(made) == NEGATIVE and _kind(inner := bound[made[1]]) == NEGATIVE:
        return inner[1]
    return renamed(made, bound)


def _equation_edits(spelling: Spelling) -> Iterator[Edit]:
    """The same edit throughout one statement, or all that share a subject up to a comma."""
    groups: dict[str, list[int]] = {}
    for index in range(spelling.own, spelling.results):
        statement = spelling.statements[index]
        subjects = statement.subject.split(", ")
        for count in range(1, len(subjects) + 1):
            groups.setdefault(", ".join(subjects[:count]), []).append(index)
        groups[f"{statement.text}; {statement.subject}"] = [index]
    for subject, places in groups.items():
        if len(places) == 1 and ";" not in subject:
            continue
        sides = (side for index in places for side in spelling.statements[index].sides)
        names = Counter(x for side in sides for x in nodes(side) if isinstance(x, str))
        kin = spelling.kin_at(places[0])
        for name in [word for word in names if word not in (*CONDITIONS, "pi", *spelling.unknown)]:
            for says, changes in _throughout(name, kin.get(name, ()), names):
                touched = [
                    spelling.statements[index]
                    for index in places
                    if not changes.keys().isdisjoint(spelling.reads[index])
                ]
                made = {
                    line.key: tuple(renamed(x, changes) for x in line.sides) for line in touched
                }
                where = ", ".join(dict.fromkeys(line.place for line in touched))
                yield Edit(spelling.title, made, LESS, f"{where}: {says} in {subject}")


def _throughout(
    name: str, kin: Sequence[str], names: Counter[str]
) -> Iterator[tuple[str, dict[str, Expression]]]:
    """What may be done to a name, or to two of one kind, wherever they stand."""
    for other in kin:
        if other > name and other in names:
            both = (name, other)
            yield f"{name} and {other} exchanged", {name: other, other: name}
            yield f"{name} and {other} left out", dict.fromkeys(both, 0)
            yield f"{name} and {other} with the wrong sign", {n: (NEGATIVE, n) for n in both}
    if names[name] > 1:
        yield f"{name} with the wrong sign", {name: (NEGATIVE, name)}
        yield f"{name} left out", {name: 0}
        yield f"{name} halved", {name: ("/", name, 2)}
        for other in kin:
            yield f"{other} for {name}", {name: other}


@cache
def edits_of(title: str) -> tuple[Edit, ...]:
    """The edits of a spelling as it stands; what all share is edited in the listing's alone."""
    spelling = spellings()[title]
    own = _node_edits(spelling, range(spelling.own, spelling.results))
    return (*(edits_on(spelling) if title == LISTING else own), *_equation_edits(spelling))


def edits_on(spelling: Spelling) -> Iterator[Edit]:
    """The edits of one node of a spelling, edited or not, its input and output apart."""
    results = sum(statement.target.startswith(SHOWN) for statement in spelling.statements)
    return _node_edits(spelling, range(len(SCENE), len(spelling.statements) - results))


_OF_A = frozenset("DA PA TA MA IA UX UY WA VAX VAY WAF XA YA XAF YAF DVA".split())


@cache
def readings() -> tuple[Edit, ...]:
    """Columns read or shown otherwise, of ``readings.txt``, for both vehicles, then for one."""
    every = [_reading(line) for line in written_out(table("readings.txt"))]
    for both in every[:]:
        a = {key for key in both.sides if key.removeprefix(SHOWN) in _OF_A}
        b = both.sides.keys() - a
        for vehicle, keys in (("A's", a), ("B's", b)) if len(a) == len(b) else ():
            sides = {key: made for key, made in both.sides.items() if key in keys}
            every.append(Edit("", sides, RARE_CONVENTION, f"{both.says}, {vehicle} only"))
    return tuple(every)


def written_out(lines: Iterable[str]) -> Iterator[str]:
    """The lines of a table of readings, each for every entry of the table it names."""
    tables: dict[str, list[tuple[str, str]]] = {}
    for line in lines:
        if line.startswith("table "):
            name, entries = line.removeprefix("table ").split(":", 1)
            pairs = (entry.rsplit("=", 1) for entry in entries.split(", "))
            tables[name] = [(says.strip(), factor.strip()) for says, factor in pairs]
            continue
        word = re.search(r"\{(?!factor)(\w+)\}", line)
        for says, factor in tables[word[1]] if word else [("", "")]:
            filled = line.replace("{factor}", factor)
            yield filled.replace(word[0], says) if word else filled


def _reading(line: str) -> Edit:
    says, rest = line.split(" | ", 1)
    scene, _, results = rest.partition(";;")
    typed: dict[str, Expression] = {name: f"{TYPED}{name}" for name in SCENE}
    sides: dict[str, Sides] = {}
    for name, made in assigned(scene):
        beside = {row: f"{TYPED}{row}_{name}" for row in BESIDE}
        sides[name] = (renamed(made, {**typed, **beside, "x": typed[name]}),)
    for name, made in assigned(results):
        sides[f"{SHOWN}{name}"] = (renamed(made, {"x": name}),)
    rank = RARE_CONVENTION if says.startswith("~") else CONVENTION
    return Edit("", sides, rank, says.lstrip("~ "))


def assigned(text: str) -> Iterator[tuple[str, Expression]]:
    """Each column of ``A B = expression; C = expression``, with its expression."""
    for part in filter(str.strip, text.split(";")):
        names, made = part.split("=", 1)
        for name in names.split():
            yield name, expression(made)


@cache
def variants() -> tuple[Edit, ...]:
    """Other models, of ``variants.txt``."""
    found = []
    spelling = spellings()[IMPULSES]
    for line in table("variants.txt"):
        if line.startswith("["):
            spelling = spellings()[line.strip("[]")]
            continue
        says, rest = line.split(" | ", 1)
        sides: dict[str, Sides] = {}
        new: dict[str, Expression] = {}
        for text, _, subject in (part.partition("@") for part in rest.split(";")):
            if subject:
                key = next(key for key in spelling.where if key.startswith(f"== {subject.strip()}"))
                sides[key] = tuple(map(expression, text.split("==")))
                continue
            target, made = (part.strip() for part in text.split(" = ", 1))
            whole = renamed(expression(made), new)
            if target in spelling.where:
                sides[target] = (whole,)
            else:
                new[target] = whole
        found.append(Edit(spelling.title, sides, MODEL, says))
    return tuple(found)
