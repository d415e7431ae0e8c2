"""The planar impact as plain Python statements, one quantity each, its subject after the "#".

A spelling is a way in which programs are written. It consists of the statements of ``reading``,
its own, and those of ``results``. Statements whose names begin with "eq" are equations, linear in
the unknowns that ``solve`` returns: the left side minus the right side.
"""

import ast
from functools import cache
from importlib import resources
from typing import NamedTuple

from ...mechanics.plan import GIVERS
from ...names import FINAL_VELOCITIES, RESULTS, SCENE

NAMES = ("impulses", "frame", "closed", "equations", "bodies", "trial", "engine")
COLUMNS = tuple(SCENE)
VELOCITIES = tuple(FINAL_VELOCITIES)
COMPARED = tuple(name for name in RESULTS if name not in ("COND", "STATUS"))
"""Results that are numbers of the scene, not of its equations."""


class Statement(NamedTuple):
    """``target = text``, about ``subject``."""

    target: str
    text: str
    subject: str

    @property
    def reads(self) -> frozenset[str]:
        """The names in the text."""
        return names_in(self.text)

    @property
    def is_solution(self) -> bool:
        """Whether it solves equations for unknowns, the targets."""
        return self.text.startswith("solve(")


class Spelling(NamedTuple):
    """Statements of a way of computing the impact.

    ``own`` is the place of the first statement after the reading, ``results`` that of the first
    result; ``unknowns`` are solved for after the last of the ``equations``.
    """

    statements: tuple[Statement, ...]
    own: int
    results: int
    equations: tuple[str, ...]
    unknowns: tuple[str, ...]


@cache
def parse(text: str) -> ast.expr:
    """Return the syntax tree of an expression."""
    return ast.parse(text.strip(), mode="eval").body


@cache
def names_in(text: str) -> frozenset[str]:
    """Return the names that an expression reads."""
    return frozenset(node.id for node in ast.walk(parse(text)) if isinstance(node, ast.Name))


def _source(name: str) -> str:
    """Return the text of a file of statements."""
    return resources.files(__name__).joinpath(f"{name}.txt").read_text("utf-8")


def _results_source() -> str:
    """Return the text of ``results``, and for results that are not there that of their formulas,
    which take nothing but columns and results."""
    source = _source("results")
    for name in COMPARED[len(VELOCITIES) :]:
        for line in GIVERS[name].tree.body if f"\n{name} = " not in source else ():
            if isinstance(line, ast.Assign):
                source += f"{ast.unparse(line)}  # {RESULTS[name].meaning}\n"
    return source


def _statements(source: str) -> list[Statement]:
    """Return the statements of a text."""
    lines = source.splitlines()
    statements = []
    for node in ast.parse(source).body:
        assert isinstance(node, ast.Assign)
        target = ast.unparse(node.targets[0]).strip("()")
        text = ast.unparse(node.value)
        subject = lines[(node.end_lineno or 1) - 1].partition("  # ")[2]
        statements.append(Statement(target, text, subject))
    return statements


@cache
def spelling(name: str) -> Spelling:
    """Return the spelling of a name in `NAMES`."""
    sources = (_source("reading"), _source(name), _results_source())
    reading, own, results = map(_statements, sources)
    targets = {statement.target for statement in own}
    results = [s for s in results if s.target != "MUC" or "muc" in targets]
    equations = tuple(s.target for s in own if s.target.startswith("eq"))
    unknowns = tuple(n for s in own if s.is_solution for n in s.target.split(", "))
    statements = (*reading, *own, *results)
    return Spelling(statements, len(reading), len(reading) + len(own), equations, unknowns)
