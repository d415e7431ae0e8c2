"""Mistakes that a program may contain, as edits of a spelling.

An edit rewrites one statement at one node (``rules.txt``), makes the same change throughout one
equation, reads or shows a column differently (``readings.txt``), or is another model
(``variants.txt``).
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from ..names import FINAL_VELOCITIES, SCENE
from .evaluation import LAST, NEIGHBOUR_SHIFTS
from .spelling import (
    COMPARISONS,
    IMPULSES,
    LISTING,
    NEGATIVE,
    SHOWN,
    TYPED,
    Expression,
    KinOf,
    Sides,
    Spelling,
    Statement,
    format_statement,
    nodes,
    operands,
    parse_expression,
    read_table,
    spellings,
    substitute,
)
from .wording import change_words, name_words, subject_words

# Rank of an edit, the likeliest first: of edits that compute the same, the likeliest is reported.
MODEL = 0
CONVENTION = 1
RARE_CONVENTION = 2
LIKELY = 3
LESS_LIKELY = 4
RARE = 5
FITTED = 6  # with a number that was fitted

BOOLEAN_NAMES = ("point", "pivot", "stick")
BOOLEAN_OPERATIONS = (*COMPARISONS, "either")  # no sign or size to change
_SECTIONS = {"[likely]": LIKELY, "[less likely]": LESS_LIKELY, "[rare]": RARE}


class Edit(NamedTuple):
    """Statements rewritten: key -> new sides.

    ``title``: the spelling it belongs to, "" if any; ``rank``: how likely it is (the lower, the
    likelier); ``description``: shown in place of the statements, where they do not say enough;
    ``exchange``: of an edit that replaces names throughout an equation, what for what, and the
    equation's subject.
    """

    title: str
    sides: Mapping[str, Sides]
    rank: int = LIKELY
    description: str = ""
    exchange: tuple[Mapping[str, Expression], str] | None = None

    @property
    def changes_output(self) -> bool:
        """True if results are shown differently, not just computed."""
        return any(key.startswith(SHOWN) for key in self.sides)

    @property
    def text(self) -> str:
        """The description, or for each statement its place, what is written there, what should be,
        and its subject."""
        return self.description or "; and ".join(
            f"{statement.place}: {actual}, should be {correct}; {statement.subject}"
            for statement, actual, correct in self._statements()
        )

    def _statements(self) -> Iterator[tuple[Statement, str, str]]:
        """Yield each statement that is rewritten, what is written there, and what should be."""
        spelling = spellings()[self.title]
        for key, sides in self.sides.items():
            statement = spelling.statements[spelling.index_of[key]]
            actual = format_statement(statement.target, sides)
            yield statement, actual, statement.text.removeprefix(f"{statement.target} = ")

    @property
    def sentence(self) -> str:
        """Say in words of mechanics what the program does."""
        if self.exchange:
            return _exchange_words(*self.exchange, spellings()[self.title])
        if self.description:
            return self.description
        spelling = spellings()[self.title]
        subjects: dict[str, list[str]] = {}
        for key, sides in self.sides.items():
            statement = spelling.statements[spelling.index_of[key]]
            change = change_words(statement.sides, sides, spelling)
            subjects.setdefault(change, []).append(subject_words(statement.subject))
        return "; and ".join(
            f"{change} in {' and '.join(dict.fromkeys(parts))}"
            for change, parts in subjects.items()
        )

    @property
    def formula(self) -> str:
        """The statements as written, and as they should be; "" for an edit of no spelling."""
        if not self.title:
            return ""
        return "; ".join(
            f"{actual}, should be {correct}" for _, actual, correct in self._statements()
        )


def _node_edits(spelling: Spelling, places: range) -> Iterator[Edit]:
    """Yield every edit of one node of these statements; for each statement the likeliest first,
    because the first of those that compute the same is kept."""
    for index in places:
        line, kin = spelling.statements[index], spelling.kin_at(index)
        edits = [
            Edit(
                spelling.title,
                {line.key: (*line.sides[:at], variation, *line.sides[at + 1 :])},
                rank,
            )
            for at, side in enumerate(line.sides)
            for rank, variation in _variations(side, kin)
        ]
        yield from sorted(edits, key=lambda edit: edit.rank)


def _variations(
    node: Expression, kin: KinOf, is_whole_side: bool = True
) -> Iterator[tuple[int, Expression]]:
    """Yield an expression with one of its nodes edited, and the edit's rank.

    ``is_whole_side``: the expression is a whole side of its statement (rules for ``whole`` apply).
    """
    rules, head = _rules(), _head(node)
    for rank, pattern, templates in rules.get(head, ()):
        bindings: dict[str, Expression] = {}
        if _matches(pattern, node, bindings):
            yield from ((rank, _fill_template(template, bindings)) for template in templates)
    if node in BOOLEAN_NAMES:
        yield LIKELY, False
        yield LIKELY, True
        return
    is_name = isinstance(node, str)
    if is_name:
        yield from ((LIKELY, twin) for twin in kin(node))
        yield LESS_LIKELY, 0
    for pattern in ("any", "whole") if is_whole_side or is_name else ("any",):
        for rank, _, templates in rules[pattern]:
            if head not in BOOLEAN_OPERATIONS and (rank == LIKELY or isinstance(node, str | tuple)):
                yield from ((rank, _fill_template(t, {pattern: node})) for t in templates)
    for place, part in enumerate(operands(node), 1):
        for rank, variation in _variations(part, kin, False):
            yield rank, (*node[:place], variation, *node[place + 1 :])


@cache
def _rules() -> dict[object, list[tuple[int, Expression, list[Expression]]]]:
    """Return the rules of ``rules.txt`` by the head of their pattern: rank, pattern, templates."""
    rules: dict[object, list[tuple[int, Expression, list[Expression]]]] = {}
    rank = LIKELY
    for line in read_table("rules.txt"):
        if line in _SECTIONS:
            rank = _SECTIONS[line]
            continue
        left, right = line.split("->")
        pattern = parse_expression(left)
        templates = list(map(parse_expression, right.split(";")))
        rules.setdefault(_head(pattern), []).append((rank, pattern, templates))
    return rules


def _head(node: Expression) -> object:
    """Return the operation, or the name or number itself: patterns that match a node share it."""
    return node[0] if isinstance(node, tuple) else node


def _matches(pattern: Expression, node: Expression, bindings: dict[str, Expression]) -> bool:
    """Return whether a node has a pattern's form; bind the pattern's letters in ``bindings``."""
    if isinstance(pattern, str) and len(pattern) == 1:
        bindings[pattern] = node
        return True
    return _head(pattern) == _head(node) and all(
        _matches(subpattern, subnode, bindings)
        for subpattern, subnode in zip(operands(pattern), operands(node), strict=True)
    )


def _fill_template(template: Expression, bindings: Mapping[str, Expression]) -> Expression:
    """Return a template with its letters replaced; a double minus is dropped."""
    if _head(template) == NEGATIVE and _head(inner := bindings[template[1]]) == NEGATIVE:
        return inner[1]
    return substitute(template, bindings)


def _equation_edits(spelling: Spelling, places: range) -> Iterator[Edit]:
    """Yield edits that change a name throughout one of these statements, or throughout all whose
    subjects agree up to a comma."""
    seen = set()
    groups = _subject_groups(spelling, places)
    for subject, group in sorted(groups.items(), key=lambda group: -group[0].count(", ")):
        sides = (side for index in group for side in spelling.statements[index].sides)
        names = Counter(x for side in sides for x in nodes(side) if isinstance(x, str))
        kin = spelling.kin_at(group[0])
        for name in names:
            if name in (*BOOLEAN_NAMES, "pi", *spelling.unknown):
                continue
            for description, changes in _substitutions(name, kin(name), names):
                lines = [
                    spelling.statements[index]
                    for index in group
                    if not changes.keys().isdisjoint(spelling.reads[index])
                ]
                new_sides = {
                    line.key: tuple(substitute(x, changes) for x in line.sides) for line in lines
                }
                key = (tuple(line.key for line in lines), repr(changes))
                if key in seen:  # of fewer statements
                    continue
                seen.add(key)
                where = ", ".join(dict.fromkeys(line.place for line in lines))
                text = f"{where}: {description} in {subject}"
                exchange = changes, subject
                yield Edit(spelling.title, new_sides, LESS_LIKELY, text, exchange)
        yield from _group_edits(spelling, group)


def _subject_groups(spelling: Spelling, places: range) -> dict[str, list[int]]:
    """Return statements by what they are called: each alone ("text; subject"), and those that share
    a subject up to a comma, where there are several."""
    groups: dict[str, list[int]] = {}
    for index in places:
        statement = spelling.statements[index]
        subjects = statement.subject.split(", ")
        for count in range(1, len(subjects) + 1):
            groups.setdefault(", ".join(subjects[:count]), []).append(index)
        groups[f"{statement.text}; {statement.subject}"] = [index]
    return {
        subject: places for subject, places in groups.items() if len(places) > 1 or ";" in subject
    }


def _substitutions(
    name: str, kin: Sequence[str], names: Counter[str]
) -> Iterator[tuple[str, dict[str, Expression]]]:
    """Yield substitutions of a name, or of it and one of its kin, with what they are called."""
    for twin in kin:
        if twin > name and twin in names:
            pair = (name, twin)
            yield f"{name} and {twin} exchanged", {name: twin, twin: name}
            yield f"{name} and {twin} left out", dict.fromkeys(pair, 0)
            yield f"{name} and {twin} with the wrong sign", {n: (NEGATIVE, n) for n in pair}
    if names[name] > 1:
        yield f"{name} with the wrong sign", {name: (NEGATIVE, name)}
        yield f"{name} left out", {name: 0}
        yield f"{name} halved", {name: ("/", name, 2)}
        for twin in kin:
            yield f"{twin} for {name}", {name: twin}


def _exchange_words(changes: Mapping[str, Expression], subject: str, spelling: Spelling) -> str:
    """Return what a change of names throughout an equation, or several, does."""
    text, _, own = subject.partition("; ")
    where = subject_words(own or text) + ("" if own else ", throughout")
    if len(changes) > 1:
        one, other = (name_words(name, spelling) for name in changes)
        (first, value), *_ = changes.items()
        if value == 0:
            return f"{one} and {other} are left out in {where}"
        is_sign = value == (NEGATIVE, first)
        return (
            f"{one} and {other} {'have the wrong sign' if is_sign else 'are exchanged'} in {where}"
        )
    ((name, value),) = changes.items()
    return f"{change_words((name,), (value,), spelling)} in {where}"


def _group_edits(spelling: Spelling, places: Sequence[int]) -> Iterator[Edit]:
    """Yield edits that do the same in several statements of one form: what stands in a function
    that is called for each of them."""
    forms: dict[Expression, list[Statement]] = {}
    for index in places:
        line = spelling.statements[index]
        forms.setdefault(tuple(map(_shape, line.sides)), []).append(line)
    for lines in forms.values():
        if len(lines) > 1:
            yield from _alike_edits(spelling, lines)


def _alike_edits(spelling: Spelling, lines: Sequence[Statement]) -> Iterator[Edit]:
    """Yield edits that do the same in statements of one form."""
    each = [
        [
            (rank, (*line.sides[:at], variation, *line.sides[at + 1 :]))
            for at, side in enumerate(line.sides)
            for rank, variation in _variations(side, lambda name: ())
        ]
        for line in lines
    ]
    if len(set(map(len, each))) > 1:
        return
    for edits in zip(*each, strict=True):
        sides = {line.key: new for line, (_, new) in zip(lines, edits, strict=True)}
        yield Edit(spelling.title, sides, max(LESS_LIKELY, edits[0][0]))


def _shape(node: Expression) -> Expression:
    """Return an expression without its names."""
    if isinstance(node, tuple):
        return (node[0], *map(_shape, node[1:]))
    return "" if isinstance(node, str) and node not in BOOLEAN_NAMES else node


@cache
def spelling_edits(title: str) -> tuple[Edit, ...]:
    """Return the edits of a spelling as it stands. Statements that all spellings share are edited
    in the listing's only."""
    spelling = spellings()[title]
    own = range(spelling.own_start, spelling.results_start)
    if title != LISTING:
        return (*_node_edits(spelling, own), *_equation_edits(spelling, own))
    read = range(len(SCENE), spelling.own_start)
    equations = (*_equation_edits(spelling, read), *_equation_edits(spelling, own))
    return (*node_edits(spelling), *equations)


def node_edits(spelling: Spelling) -> Iterator[Edit]:
    """Yield every edit of one node of a spelling, which may be edited already; its input and output
    statements are left alone."""
    results = sum(statement.target.startswith(SHOWN) for statement in spelling.statements)
    return _node_edits(spelling, range(len(SCENE), len(spelling.statements) - results))


_COLUMNS_OF_A = frozenset("DA PA TA MA IA UX UY WA VAX VAY WAF XA YA XAF YAF DVA".split())


@cache
def readings() -> tuple[Edit, ...]:
    """Return the edits of ``readings.txt`` (columns read or shown differently): for both vehicles,
    then for one alone."""
    edits = [_parse_reading(line) for line in expand_lines(read_table("readings.txt"))]
    for edit in edits[:]:
        a = {key for key in edit.sides if key.removeprefix(SHOWN) in _COLUMNS_OF_A}
        b = edit.sides.keys() - a
        for vehicle, keys in (("A's", a), ("B's", b)) if len(a) == len(b) else ():
            sides = {key: expressions for key, expressions in edit.sides.items() if key in keys}
            text = f"{edit.description}, {vehicle} only"
            edits.append(Edit("", sides, RARE_CONVENTION, text))
    return tuple(edits)


def expand_lines(lines: Iterable[str]) -> Iterator[str]:
    """Yield a line of readings for every entry of the table it names; other lines as they are."""
    tables: dict[str, list[tuple[str, str]]] = {}
    for line in lines:
        if line.startswith("table "):
            name, entries = line.removeprefix("table ").split(":", 1)
            pairs = (entry.rsplit("=", 1) for entry in entries.split(", "))
            tables[name] = [(label.strip(), factor.strip()) for label, factor in pairs]
            continue
        word = re.search(r"\{(?!factor)(\w+)\}", line)
        for label, factor in tables[word[1]] if word else [("", "")]:
            text = line.replace("{factor}", factor)
            yield text.replace(word[0], label) if word else text


def _parse_reading(line: str) -> Edit:
    """Parse ``description | columns = expression; ... ;; results = expression; ...``."""
    description, columns = line.split(" | ", 1)
    scene, _, results = columns.partition(";;")
    typed: dict[str, Expression] = {name: f"{TYPED}{name}" for name in SCENE}
    sides: dict[str, Sides] = {}
    for name, expression in parse_assignments(scene):
        neighbours = {row: f"{TYPED}{row}_{name}" for row in NEIGHBOUR_SHIFTS}
        neighbours |= {f"{LAST}{result}": f"{TYPED}{LAST}{result}" for result in FINAL_VELOCITIES}
        sides[name] = (substitute(expression, {**typed, **neighbours, "x": typed[name]}),)
    for name, expression in parse_assignments(results):
        sides[f"{SHOWN}{name}"] = (substitute(expression, {"x": name}),)
    rank = RARE_CONVENTION if description.startswith("~") else CONVENTION
    return Edit("", sides, rank, description.lstrip("~ "))


def parse_assignments(text: str) -> Iterator[tuple[str, Expression]]:
    """Yield each column of ``A B = expression; C = expression`` with its expression."""
    for part in filter(str.strip, text.split(";")):
        names, expression = part.split("=", 1)
        for name in names.split():
            yield name, parse_expression(expression)


@cache
def variants() -> tuple[Edit, ...]:
    """Return the edits of ``variants.txt``: other models."""
    edits = []
    spelling = spellings()[IMPULSES]
    for line in read_table("variants.txt"):
        if line.startswith("["):
            spelling = spellings()[line.strip("[]")]
        else:
            edits.append(_parse_variant(line, spelling))
    return tuple(edits)


def _parse_variant(line: str, spelling: Spelling) -> Edit:
    """Parse ``description | statement; statement ...``. An equation ends in ``@ subject``; names
    that the spelling lacks are definitions, substituted in the statements after them."""
    description, statements = line.split(" | ", 1)
    sides: dict[str, Sides] = {}
    definitions: dict[str, Expression] = {}
    for text, _, subject in (part.partition("@") for part in statements.split(";")):
        if subject:
            start = f"== {subject.strip()}"
            key = next(key for key in spelling.index_of if key.startswith(start))
            sides[key] = tuple(map(parse_expression, text.split("==")))
            continue
        target, right = (part.strip() for part in text.split(" = ", 1))
        expression = substitute(parse_expression(right), definitions)
        if target in spelling.index_of:
            sides[target] = (expression,)
        else:
            definitions[target] = expression
    return Edit(spelling.title, sides, MODEL, description)
