"""Small mistakes: the first-order mutants of a spelling, and named laws and conventions.

A site is an expression in a statement, all equal expressions of it, or the expressions at one place
in several statements of one form. Its options are what may be written there by mistake.
"""

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import resources
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from .evaluation import Edit, Program, evaluate, stack, statement_of
from .spellings import COLUMNS, COMPARED, VELOCITIES, Statement, names_in, parse, spelling

SLOT = re.compile(r"SLOT\d+")
RANK_MODEL = 0  # a law or a convention with a name
RANK_NEAR = 2  # an operator, a sign, a name of one other letter
RANK_FAR = 4  # any other name
RANK_TWIN = 3  # the same in several statements

EXCHANGES = (
    ("abAB", "baBA", "UX:VX VX:UX UY:VY VY:UY D1:D3 D3:D1 D2:D4 D4:D2"),
    ("xyXY", "yxYX", "c:s s:c D1:D2 D2:D1 D3:D4 D4:D3"),
    ("nt", "tn", "c:s s:c"),
    ("", "", "UX:VAX VAX:UX UY:VAY VAY:UY VX:VBX VBX:VX VY:VBY VBY:VY WA:WAF WAF:WA WB:WBF WBF:WB"),
)
"""A and B, x and y, normal and tangent, after and before: letters of names, and pairs of names."""
ANY = (
    "-a; 0; 1; 2; 2 * a; a / 2; a * a; abs(a); 1 / a; sqrt(abs(a)); 1 - a; 1 + a; "
    "a * pi / 180; a * 180 / pi"
)
LINEAR = "-a; 0; 2 * a; a / 2"
WITH_READING = ("impulses", "trial")  # spellings in which a mistake of the reading is looked for
CONDITIONS = ("point", "pivot", "stick")
CONSTANTS = "0; 1; 2; 3; 4; -1; 0.5; 10; 100; 90; 360"
"""Alternatives of any expression, of one with unknowns, of a number."""

unparse = cache(ast.unparse)


class _Parts(dict[str, Any]):
    """Values of names, and of expressions in them, each computed once."""

    def __init__(self, scope: Mapping[str, Any]) -> None:
        super().__init__(scope)
        self.scope = scope

    def __missing__(self, text: str) -> Any:
        value = self[text] = evaluate(text, self.scope)
        return value


class Option(NamedTuple):
    """An expression: a template, and what its letters stand for."""

    template: str
    parts: Mapping[str, str]
    rank: int = RANK_NEAR

    @property
    def text(self) -> str:
        """The expression written out."""
        text = re.sub(r"\b[a-z]\b", lambda letter: f"({self.parts[letter[0]]})", self.template)
        return unparse(parse(text))

    def value(self, values: _Parts) -> Any:
        """Return its value; ``values``: those of its parts."""
        if self.template == "a":
            return values[self.parts["a"]]
        return evaluate(self.template, {k: values[part] for k, part in self.parts.items()})


class Site(NamedTuple):
    """Expressions in statements (``targets``), with what may be written there.

    ``holes`` are the statements with a slot, "SLOT0", "SLOT1" ..., in place of each of the
    ``expressions``; ``options`` has a row for each alternative, with an option for each slot.
    """

    targets: tuple[str, ...]
    holes: tuple[str, ...]
    expressions: tuple[str, ...]
    options: tuple[tuple[Option, ...], ...]

    def values(self, program: Program) -> dict[str, Any]:
        """Return the statements' values, one alternative for each option."""
        values = {}
        for target, hole in zip(self.targets, self.holes, strict=True):
            scope = program.scope(target, program.computed)
            parts = _Parts(scope)
            slots = {
                slot: stack([row[place].value(parts) for row in self.options], program.size)
                for place, slot in enumerate(map(slot_name, range(len(self.expressions))))
                if slot in hole
            }
            unknowns = (len(program.basis) + 1,) if target in program.linear else ()
            value = evaluate(hole, {**scope, **slots})
            values[target] = np.broadcast_to(value, (*unknowns, len(self.options), program.size))
        return values

    def edit(self, place: int) -> Edit:
        """Return an option as an edit."""
        options = self.options[place]
        slots = {slot_name(k): f"({option.text})" for k, option in enumerate(options)}
        changes = {
            target: SLOT.sub(lambda match: slots[match[0]], hole)
            for target, hole in zip(self.targets, self.holes, strict=True)
        }
        rank = max(option.rank for option in options) + (RANK_TWIN if len(options) > 1 else 0)
        return Edit("", changes, rank)


def slot_name(place: int) -> str:
    """Return the name of a slot."""
    return f"SLOT{place}"


def _match(pattern: ast.AST, node: ast.AST, parts: dict[str, str]) -> bool:
    """Return whether a node has a pattern's form; note what its letters stand for."""
    if isinstance(pattern, ast.Name) and len(pattern.id) == 1:
        parts[pattern.id] = unparse(node)
        return True
    if pattern.__class__ is not node.__class__:
        return False
    if isinstance(pattern, ast.Name | ast.Constant):
        return unparse(pattern) == unparse(node)
    pairs = zip(ast.iter_child_nodes(pattern), ast.iter_child_nodes(node), strict=False)
    return all(_match(p, n, parts) for p, n in pairs)


def _kind(node: ast.AST) -> tuple[type, type]:
    """Return the class of an expression, and that of its operator."""
    return type(node), type(getattr(node, "op", None))


@cache
def _patterns() -> list[tuple[tuple[type, type], ast.expr, list[str]]]:
    """Return the patterns: kind, expression, and what may be written for it."""
    pairs = entries("patterns")
    return [(_kind(parse(text)), parse(text), templates.split("; ")) for text, templates in pairs]


@cache
def entries(section: str) -> list[tuple[str, ...]]:
    """Return the entries of a section of ``models.txt``: their parts."""
    text = resources.files(__package__).joinpath("models.txt").read_text("utf-8")
    lines = text.partition(f"\n[{section}]\n")[2].partition("\n[")[0].splitlines()
    return [tuple(line.split(" | ", 1)) for line in lines]


@cache
def exchanges(names: tuple[str, ...]) -> list[dict[str, str]]:
    """Return the names that stand for the same of the other body, along the other axis ..."""
    twins = []
    for letters, twin_letters, text in EXCHANGES:
        table = str.maketrans(letters, twin_letters)
        pairs = {n: n.translate(table) for n in names}
        pairs |= dict(pair.split(":") for pair in text.split())
        twins.append({n: twin for n, twin in pairs.items() if n != twin and {n, twin} <= {*names}})
    return twins


def near_names(name: str, scope: tuple[str, ...]) -> list[str]:
    """Return the names that differ in one letter, in capitals, or as before and after do."""
    twin = exchanges(scope)[-1].get(name)
    return [
        other
        for other in scope
        if other != name
        and (
            other.lower() == name.lower()
            or other == twin
            or (len(other) == len(name) and sum(map(str.__ne__, other, name)) == 1)
        )
    ]


def _options(node: ast.expr, names: tuple[str, ...], unknowns: frozenset[str]) -> list[Option]:
    """Return what may be written for a node; ``names`` may be written for a name."""
    text = unparse(node)
    itself = {"a": text}
    if isinstance(node, ast.Constant):
        return [Option(number, {}) for number in CONSTANTS.split("; ") if number != text]
    options = []
    node_kind = _kind(node)
    for kind, pattern, templates in _patterns():
        parts: dict[str, str] = {}
        if kind == node_kind and _match(pattern, node, parts):
            options += [Option(template, parts) for template in templates]
    if isinstance(node, ast.Compare):
        return options
    if isinstance(node, ast.Name) and text != "pi":
        similar = near_names(text, names)
        for name in [n for n in names if n != text]:
            rank = RANK_NEAR if name in similar else RANK_FAR
            options.append(Option("a", {"a": name}, rank))
    inside = names_in(text)
    for twins in exchanges(names):
        if len(inside & twins.keys()) > 1:
            words = (twins.get(word, word) for word in re.split(r"\b", text))
            options.append(Option("a", {"a": "".join(words)}, RANK_TWIN))
    general = ANY if inside.isdisjoint(unknowns) else LINEAR
    return options + [Option(template, itself) for template in general.split("; ")]


def _nodes(tree: ast.expr) -> list[ast.expr]:
    """Return the expressions in a tree, without the names of functions."""
    functions = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    return [n for n in ast.walk(tree) if isinstance(n, ast.expr) and id(n) not in functions]


def _form(node: ast.expr) -> str:
    """Return an expression with all names alike."""
    return re.sub(r"\b[A-Za-z]\w*\b(?!\()", "x", unparse(node))


def _site(
    statements: Sequence[Statement],
    group: Sequence[tuple[Statement, ast.expr]],
    slots: Sequence[int],
    options: Sequence[tuple[Option, ...]],
) -> Site:
    """Return the site of expressions in statements, each with its slot."""
    holes = {statement.target: statement.text for statement in statements}
    members = [(s.target, node, slot) for slot, (s, node) in zip(slots, group, strict=True)]
    for target, node, slot in sorted(members, key=lambda member: -member[1].col_offset):
        text = holes[target]
        holes[target] = f"{text[: node.col_offset]}{slot_name(slot)}{text[node.end_col_offset :]}"
    texts = {slot: unparse(node) for _, node, slot in members}
    return Site(tuple(holes), tuple(holes.values()), tuple(texts.values()), tuple(options))


def _single_sites(
    statement: Statement, names: tuple[str, ...], unknowns: frozenset[str]
) -> Iterator[Site]:
    """Yield the sites of one statement: each expression, and equal ones together."""
    groups: dict[str, list[tuple[Statement, ast.expr]]] = {}
    for node in _nodes(parse(statement.text)):
        groups.setdefault(unparse(node), []).append((statement, node))
    for equal in groups.values():
        options = [(option,) for option in _options(equal[0][1], names, unknowns)]
        for group in [*([pair] for pair in equal), *([equal] if len(equal) > 1 else [])]:
            yield _site([statement], group, [0] * len(group), options)


def _groups(
    statements: Sequence[Statement], names: tuple[str, ...]
) -> list[tuple[tuple[Statement, ast.expr], ...]]:
    """Return expressions of one form: at one place of statements, or in one statement.

    Names of one statement are those that stand for the same of A and B, x and y ...
    """
    twins = {pair for twin in exchanges(names) for pair in twin.items()}
    trees = [[(s, node) for node in _nodes(parse(s.text))] for s in statements]
    if len(statements) > 1:
        return list(zip(*trees, strict=True))
    forms: dict[str, list[tuple[Statement, ast.expr]]] = {}
    for statement, node in trees[0]:
        forms.setdefault(_form(node), []).append((statement, node))
    groups = [g for members in forms.values() for g in subsets(members)]
    texts = [tuple(unparse(node) for _, node in g) for g in groups]
    return [
        g
        for g, text in zip(groups, texts, strict=True)
        if text in twins or (len({*text}) == len(text) and not text[0].isalnum())
    ]


def subsets(members: Sequence[Any]) -> list[tuple[Any, ...]]:
    """Return the pairs of members, and all of them together."""
    return [*combinations(members, 2), *([tuple(members)] if len(members) > 2 else [])]


def _twin_sites(
    statements: Sequence[Statement], names: tuple[str, ...], unknowns: frozenset[str]
) -> Iterator[Site]:
    """Yield the sites with the same mistake in expressions of one form."""
    for group in _groups(statements, names):
        rows = [_options(node, (), unknowns) for _, node in group]
        if len({tuple(option.template for option in row) for row in rows}) == 1:
            options = list(zip(*rows, strict=True))
            texts = [unparse(node) for _, node in group]
            for twins in exchanges(names):
                if {*texts} <= twins.keys():
                    options.append(tuple(Option("a", {"a": twins[text]}) for text in texts))
            yield _site(statements, group, range(len(group)), options)


@cache
def sites(name: str, part: str) -> tuple[Site, ...]:
    """Return the sites of a spelling's "velocities" or "results"; of the reading in some only."""
    text = spelling(name)
    start = 0 if name in WITH_READING else text.own
    first, last = (start, text.results) if part == "velocities" else (text.results, None)
    unknowns = frozenset(text.unknowns) if part == "velocities" else frozenset()
    names = [*COLUMNS, *(s.target for s in text.statements[: first or text.own])]
    names += VELOCITIES if part == "results" else []
    all_sites: list[Site] = []
    forms: dict[str, list[Statement]] = {}
    for statement in text.statements[first:last]:
        if statement.is_solution:
            continue
        linear = statement.reads & unknowns
        usable = [n for n in names if n not in CONDITIONS]
        usable += [n for n in text.unknowns if linear]
        scope = tuple(dict.fromkeys(usable))
        all_sites += _single_sites(statement, scope, unknowns)
        all_sites += _twin_sites([statement], scope, unknowns)
        forms.setdefault(_form(parse(statement.text)), []).append(statement)
        if not linear:
            names.append(statement.target)
    for members in forms.values():
        for group in subsets(members):
            all_sites += _twin_sites(group, tuple(names), unknowns)
    return tuple(site for site in all_sites if site.options)


@cache
def models() -> tuple[Edit, ...]:
    """Return the laws and conventions of ``models.txt``, and those of single columns."""
    edits = []
    for section, sides in (("laws", ("", "> ")), ("columns", ("< ", "> "))):
        for says, assignments in entries(section):
            changes = {}
            for side, part in zip(sides, (assignments + ";;").split(";;"), strict=False):
                for assignment in filter(str.strip, part.split(";")):
                    target, expression = assignment.strip().split(" = ", 1)
                    changes[side + target] = expression
            edits.append(Edit(says, changes, RANK_MODEL))
    return (*edits, *_columns("<", COLUMNS[:-1], "as read"), *_columns(">", COMPARED, "as shown"))


def _columns(side: str, names: tuple[str, ...], how: str) -> Iterator[Edit]:
    """Yield the conventions of each column by itself, and of two exchanged."""
    for name in names:
        for says, form in entries("forms"):
            changes = {f"{side} {name}": form.replace("@", name)}
            yield Edit(f"{says.format(name)}, {how}", changes, RANK_MODEL + 1)
        similar = near_names(name, names)
        for other in [n for n in names if n != name]:
            says = f"{other} in place of {name}, {how}"
            rank = RANK_MODEL + 1 if other in similar else RANK_FAR
            yield Edit(says, {f"{side} {name}": other}, rank)
            if other > name and other in similar:
                swap = {f"{side} {name}": other, f"{side} {other}": name}
                yield Edit(f"{name} and {other} exchanged, {how}", swap, rank)


def describe(edit: Edit, name: str) -> str:
    """Return a sentence: what is written in which statement, and what should be."""
    if edit.says:
        return edit.says
    target, *twins = edit.changes
    statement = statement_of(name, target)
    new, old = difference(edit, name)
    sentence = (
        f"{statement.subject}: {new}{edit.note}, should be {old}, in {target} = {statement.text}"
    )
    return f"{sentence} (likewise in {', '.join(twins)})" if twins else sentence


def describe_names(edit: Edit, name: str) -> str:
    """Return what the names stand for with which an edit is described."""
    words = re.findall(r"\w+", "" if edit.says else " ".join(difference(edit, name)))
    subjects = {s.target: s.subject for s in spelling(name).statements if s.target in words}
    return "; ".join(map(": ".join, subjects.items()))


def difference(edit: Edit, name: str) -> tuple[str, str]:
    """Return the smallest expression that an edit changes, of those that a statement has once.

    As it is written, and as it should be; terms with which both begin are left out.
    """
    target = next(iter(edit.changes))
    tree = parse(statement_of(name, target).text)
    texts = [unparse(node) for node in _nodes(tree)]
    new: ast.AST = parse(edit.changes[target])
    old: ast.AST = tree
    while type(new) is type(old):
        pairs = zip(ast.iter_child_nodes(new), ast.iter_child_nodes(old), strict=False)
        inner = [(n, o) for n, o in pairs if ast.dump(n) != ast.dump(o)]
        if len(inner) != 1 or texts.count(unparse(inner[0][1])) != 1:
            break
        new, old = inner[0]
    new_text, old_text = unparse(new), unparse(old)
    start = unparse(getattr(old, "left", old))
    if " " in start and new_text.startswith(start) and old_text.startswith(start):
        new_text = f"...{new_text.removeprefix(start) or ' nothing more'}"
        old_text = f"...{old_text.removeprefix(start)}"
    return new_text, old_text
