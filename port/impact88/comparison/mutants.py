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

from ..names import RESULTS
from .evaluation import FUNCTIONS, Edit, Program, evaluate, stack, statement_of
from .spellings import COLUMNS, VELOCITIES, Statement, parse, spelling

SLOT = re.compile(r"SLOT\d+")
RANK_MODEL = 0  # a law or a convention with a name
RANK_NEAR = 2  # an operator, a sign, a name of one other letter
RANK_FAR = 4  # any other name
MIN_SHARED_WORDS = 6  # at the beginning of an edit and of what should be, that are left out
RANK_TWIN = 3  # the same in several statements

PATTERNS = {
    "a + b": "a; b; a - b; b - a; a * b",
    "a - b": "a; b; a + b; b - a; a * b",
    "a - b * d": "b - a * d",
    "a * b + d * e": "a * e + d * b",
    "a * b - d * e": "a * e - d * b",
    "1 / a + 1 / b": "1 / (a + b)",
    "a * b": "a; b; a / b; a + b; a - b; b / a",
    "a / b": "a; b; a * b; b / a; a - b; a + b",
    "a ** 2": "a; 2 * a; a ** 3; a * abs(a)",
    "-a": "a",
    "1 / a": "1 - a; 1 + a",
    "sin(a)": "cos(a); tan(a); a",
    "cos(a)": "sin(a); tan(a); 1 - 0 * a",
    "hypot(a, b)": "a; b; abs(a); abs(b); abs(a) + abs(b); a * a + b * b",
    "sqrt(a)": "a; a * a",
    "where(p, a, b)": "a; b; where(p, b, a)",
    "a > b": "a >= b; a < b; a == b; a != b",
    "a < b": "a <= b; a > b; a == b; a != b",
    "a == b": "a != b; a < b; a > b; a <= b; a >= b",
}
"""An expression -> what may be written instead; single letters stand for any expression."""
ANY = (
    "-a; 0; 1; 2; 2 * a; a / 2; a * a; abs(a); 1 / a; sqrt(abs(a)); 1 - a; 1 + a; "
    "a * pi / 180; a * 180 / pi"
)
LINEAR = "-a; 0; 2 * a; a / 2"
CONDITIONS = ("point", "pivot", "stick")
CONSTANTS = "0; 1; 2; 3; 4; -1; 0.5; 10; 100; 90; 360"
"""Alternatives of any expression, of one with unknowns, of a number."""


class Option(NamedTuple):
    """An expression: a template, and what its letters stand for."""

    template: str
    parts: Mapping[str, str]
    rank: int = RANK_NEAR

    @property
    def text(self) -> str:
        """The expression written out."""
        text = re.sub(r"\b[a-z]\b", lambda letter: f"({self.parts[letter[0]]})", self.template)
        return ast.unparse(parse(text))

    def value(self, names: dict[str, Any]) -> Any:
        """Return its value."""
        if self.template == "a":
            return evaluate(self.parts["a"], names)
        letters = {letter: evaluate(part, names) for letter, part in self.parts.items()}
        return evaluate(self.template, {**FUNCTIONS, **letters})


class Site(NamedTuple):
    """Expressions in statements (``targets``), with what may be written there.

    ``holes`` are the statements with a slot, "SLOT0", "SLOT1" ..., in place of each of the
    ``expressions``; ``options`` has a row for each alternative, with an option for each slot.
    """

    targets: tuple[str, ...]
    holes: tuple[str, ...]
    expressions: tuple[str, ...]
    options: tuple[tuple[Option, ...], ...]

    def run(self, program: Program, chosen: Sequence[int] | None = None) -> dict[str, Any]:
        """Return a program's values, one alternative for each option (that is chosen)."""
        rows = self.options if chosen is None else [self.options[k] for k in chosen]
        values = {}
        for target, hole in zip(self.targets, self.holes, strict=True):
            scope = program.scope(target)
            slots = {
                slot: stack([row[place].value(scope) for row in rows], program.size)
                for place, slot in enumerate(map(slot_name, range(len(self.expressions))))
                if slot in hole
            }
            values[target] = evaluate(hole, {**scope, **slots})
        return program.propagate(values)

    def edit(self, place: int) -> Edit:
        """Return an option as an edit."""
        options = self.options[place]
        texts = [option.text for option in options]
        slots = {slot_name(k): f"({text})" for k, text in enumerate(texts)}
        changes = {
            target: SLOT.sub(lambda match: slots[match[0]], hole)
            for target, hole in zip(self.targets, self.holes, strict=True)
        }
        rank = max(option.rank for option in options) + (RANK_TWIN if len(options) > 1 else 0)
        return Edit("", changes, rank, tuple(texts), self.expressions)


def slot_name(place: int) -> str:
    """Return the name of a slot."""
    return f"SLOT{place}"


def _match(pattern: ast.AST, node: ast.AST, parts: dict[str, str]) -> bool:
    """Return whether a node has a pattern's form; note what its letters stand for."""
    if isinstance(pattern, ast.Name) and len(pattern.id) == 1:
        parts[pattern.id] = ast.unparse(node)
        return True
    if pattern.__class__ is not node.__class__:
        return False
    if isinstance(pattern, ast.Name | ast.Constant):
        return ast.unparse(pattern) == ast.unparse(node)
    pairs = zip(ast.iter_child_nodes(pattern), ast.iter_child_nodes(node), strict=False)
    return all(_match(p, n, parts) for p, n in pairs)


@cache
def _patterns() -> list[tuple[ast.expr, list[str]]]:
    return [(parse(pattern), options.split("; ")) for pattern, options in PATTERNS.items()]


def near_names(name: str, scope: Sequence[str]) -> list[str]:
    """Return the names that differ in one letter, in capitals, or as before and after do."""
    pairs = {"VAX": "UX", "VAY": "UY", "VBX": "VX", "VBY": "VY", "WAF": "WA", "WBF": "WB"}
    pairs |= {after: before for before, after in pairs.items()}
    return [
        other
        for other in scope
        if other != name
        and (
            other.lower() == name.lower()
            or other == pairs.get(name)
            or (len(other) == len(name) and sum(map(str.__ne__, other, name)) == 1)
        )
    ]


def _options(node: ast.expr, names: Sequence[str], unknowns: frozenset[str]) -> list[Option]:
    """Return what may be written for a node; ``names`` may be written for a name."""
    text = ast.unparse(node)
    itself = {"a": text}
    if isinstance(node, ast.Constant):
        return [Option(number, {}) for number in CONSTANTS.split("; ") if number != text]
    options = []
    for pattern, templates in _patterns():
        parts: dict[str, str] = {}
        if _match(pattern, node, parts):
            options += [Option(template, parts) for template in templates]
    if isinstance(node, ast.Compare):
        return [*options, Option("a != a", itself), Option("a == a", itself)]
    if isinstance(node, ast.Name) and text != "pi":
        similar = near_names(text, names)
        distant = [n for n in names if n not in similar and n != text]
        options += [Option("a", {"a": name}) for name in similar]
        options += [Option("a", {"a": name}, RANK_FAR) for name in distant]
    inside = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}
    general = ANY if inside.isdisjoint(unknowns) else LINEAR
    return options + [Option(template, itself) for template in general.split("; ")]


def _nodes(tree: ast.expr) -> list[ast.expr]:
    """Return the expressions in a tree, without the names of functions."""
    functions = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    return [n for n in ast.walk(tree) if isinstance(n, ast.expr) and id(n) not in functions]


def _form(node: ast.expr) -> str:
    """Return an expression with all names alike."""
    return re.sub(r"\b[A-Za-z]\w*\b(?!\()", "x", ast.unparse(node))


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
    texts = {slot: ast.unparse(node) for _, node, slot in members}
    return Site(tuple(holes), tuple(holes.values()), tuple(texts.values()), tuple(options))


def _single_sites(
    statement: Statement, names: Sequence[str], unknowns: frozenset[str]
) -> Iterator[Site]:
    """Yield the sites of one statement: each expression, and equal ones together."""
    groups: dict[str, list[tuple[Statement, ast.expr]]] = {}
    for node in _nodes(parse(statement.text)):
        groups.setdefault(ast.unparse(node), []).append((statement, node))
    for equal in groups.values():
        options = [(option,) for option in _options(equal[0][1], names, unknowns)]
        for group in [*([pair] for pair in equal), *([equal] if len(equal) > 1 else [])]:
            yield _site([statement], group, [0] * len(group), options)


def _groups(statements: Sequence[Statement]) -> list[tuple[tuple[Statement, ast.expr], ...]]:
    """Return expressions of one form: at one place of statements, or in one statement."""
    trees = [[(s, node) for node in _nodes(parse(s.text))] for s in statements]
    if len(statements) > 1:
        return list(zip(*trees, strict=True))
    forms: dict[str, list[tuple[Statement, ast.expr]]] = {}
    for statement, node in trees[0]:
        if not isinstance(node, ast.Name | ast.Constant):
            forms.setdefault(_form(node), []).append((statement, node))
    groups = [g for members in forms.values() for g in subsets(members)]
    return [g for g in groups if len({ast.unparse(node) for _, node in g}) == len(g)]


def subsets(members: Sequence[Any]) -> list[tuple[Any, ...]]:
    """Return the pairs of members, and all of them together."""
    return [*combinations(members, 2), *([tuple(members)] if len(members) > 2 else [])]


def _twin_sites(
    statements: Sequence[Statement], pairs: Sequence[tuple[str, str]], unknowns: frozenset[str]
) -> Iterator[Site]:
    """Yield the sites with the same mistake in expressions of one form, in one or more statements.

    ``pairs`` of names, such as the parts of a vector, may be written for a pair.
    """
    for group in _groups(statements):
        rows = [_options(node, (), unknowns) for _, node in group]
        if len({tuple(option.template for option in row) for row in rows}) == 1:
            options = list(zip(*rows, strict=True))
            texts = tuple(ast.unparse(node) for _, node in group)
            for pair in pairs if texts in pairs else ():
                if pair != texts:
                    options.append(tuple(Option("a", {"a": name}) for name in pair))
            yield _site(statements, group, range(len(group)), options)


def _pairs(names: Sequence[str]) -> list[tuple[str, str]]:
    """Return the names that are parts of a vector, or the same of A and B."""
    pairs = []
    for name in names:
        for first, second in ("xy", "nt", "ab", "XY", "AB"):
            for place in [k for k, letter in enumerate(name) if letter == first]:
                twin = name[:place] + second + name[place + 1 :]
                if twin in names:
                    pairs.append((name, twin))
    pairs += [("UX", "VX"), ("UY", "VY"), ("c", "s")]
    return list(dict.fromkeys(pairs + [(second, first) for first, second in pairs]))


@cache
def sites(name: str, part: str) -> tuple[Site, ...]:
    """Return the sites of a spelling's "velocities" or "results"."""
    text = spelling(name)
    first, last = (0, text.results) if part == "velocities" else (text.results, None)
    unknowns = frozenset(text.unknowns) if part == "velocities" else frozenset()
    names = [*COLUMNS, *(s.target for s in text.statements[: first or text.own])]
    names += VELOCITIES if part == "results" else []
    all_sites: list[Site] = []
    forms: dict[str, list[Statement]] = {}
    for statement in text.statements[first:last]:
        linear = statement.reads & unknowns
        usable = [n for n in names if n not in CONDITIONS]
        usable += [n for n in text.unknowns if linear]
        all_sites += _single_sites(statement, list(dict.fromkeys(usable)), unknowns)
        all_sites += _twin_sites([statement], (), unknowns)
        forms.setdefault(_form(parse(statement.text)), []).append(statement)
        if not linear:
            names.append(statement.target)
    pairs = _pairs(names)
    for members in forms.values():
        for group in subsets(members):
            all_sites += _twin_sites(group, pairs, unknowns)
    return tuple(site for site in all_sites if site.options)


@cache
def models() -> tuple[Edit, ...]:
    """Return the laws and conventions of ``models.txt``, and those of single columns."""
    edits, section = [], ""
    text = resources.files(__package__).joinpath("models.txt").read_text("utf-8")
    for line in text.splitlines():
        if line.startswith("["):
            section = line
        elif " | " in line and not line.startswith("#"):
            says, assignments = line.split(" | ", 1)
            changes = {}
            for side, part in zip("<>", (assignments + ";;").split(";;"), strict=False):
                for assignment in filter(str.strip, part.split(";")):
                    target, expression = assignment.strip().split(" = ", 1)
                    changes[target if section == "[laws]" else f"{side} {target}"] = expression
            edits.append(Edit(says, changes, RANK_MODEL))
    results = [name for name in RESULTS if name not in ("COND", "STATUS")]
    return (*edits, *_columns("<", COLUMNS[:-1], "as read"), *_columns(">", results, "as shown"))


_FORMS = {
    "{} with the opposite sign": "-@",
    "{} left out (0)": "0 * @",
    "{} squared": "@ * abs(@)",
    "the square root of {}": "sign(@) * sqrt(abs(@))",
    "{} without its sign": "abs(@)",
    "1 - {0} in place of {0}": "1 - @",
    "{} cut to a whole number": "trunc(@)",
    "{} rounded to a whole number": "rint(@)",
    "{} in single precision": "single(@)",
    "negative {} taken as 0": "maximum(@, 0)",
    "positive {} taken as 0": "minimum(@, 0)",
    "{} limited to 1": "maximum(minimum(@, 1), -1)",
    "{} always 1": "0 * @ + 1",
    "1 / {0} in place of {0}": "1 / @",
    "the remainder of {} by 90": "fmod(@, 90)",
    "the remainder of {} by 180": "fmod(@, 180)",
    "{} in radians": "@ * pi / 180",
    "{} in degrees": "@ * 180 / pi",
}


def _columns(side: str, names: Sequence[str], how: str) -> Iterator[Edit]:
    """Yield the conventions of each column by itself, and of two exchanged."""
    for name in names:
        for says, form in _FORMS.items():
            changes = {f"{side} {name}": form.replace("@", name)}
            yield Edit(f"{says.format(name)}, {how}", changes, RANK_MODEL + 1)
        similar = near_names(name, names)
        for other in similar:
            says = f"{other} in place of {name}, {how}"
            yield Edit(says, {f"{side} {name}": other}, RANK_MODEL + 1)
            if other > name:
                swap = {f"{side} {name}": other, f"{side} {other}": name}
                yield Edit(f"{name} and {other} exchanged, {how}", swap, RANK_MODEL + 1)
        for other in names:
            if other not in similar and other != name:
                says = f"{other} in place of {name}, {how}"
                yield Edit(says, {f"{side} {name}": other}, RANK_FAR)


def describe(edit: Edit, name: str) -> str:
    """Return a sentence: what is written in which statement, and what should be."""
    if edit.says:
        return edit.says
    target, *twins = edit.changes
    statement = statement_of(name, target)
    pairs = dict.fromkeys(zip(edit.written, edit.expected, strict=True))
    parts = "; ".join("{}, should be {}".format(*_shorten(*pair)) for pair in list(pairs)[:2])
    sentence = f"{statement.subject}: {parts}, in {target} = {statement.text}"
    return f"{sentence} (likewise in {', '.join(twins)})" if twins else sentence


def _shorten(new: str, old: str) -> tuple[str, str]:
    """Return two texts without the words with which both begin, if those are many."""
    words, expected = new.split(" "), old.split(" ")
    count, last = 0, min(len(words), len(expected)) - 1
    while count < last and words[count] == expected[count]:
        count += 1
    if count < MIN_SHARED_WORDS:
        return new, old
    return " ".join(["...", *words[count:]]), " ".join(["...", *expected[count:]])
