"""Which formulas lead to a result: the data flow of `formulas` and `consequences`, from their text.

A formula's parameters name the quantities it takes, its last line those it returns. Nothing here
imports numpy: the build step that prints the formulas as C reads them through this module.
"""

import ast
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from ..names import SCENE

COLUMNS = tuple(SCENE)
"""Names of a scene's columns, in the order of the compiled library."""

HELPERS = ("sine_and_cosine",)
"""Functions of `formulas` that formulas call, and that are no formulas."""

PIVOTS, OTHERS = 1, 2
GUARDS = {
    "pivot_impulse": PIVOTS,
    "pivot_spins": PIVOTS,
    "sliding_impulse": OTHERS,
    "sliding_spins": OTHERS,
}
"""Formulas that only pivots need, or only the other scenes."""
GUARDED_USERS = frozenset(("impulse", "final_spins", *GUARDS))
"""Formulas that look at the guarded ones' results only where these apply."""


class Formula(NamedTuple):
    """A function of `formulas` or `consequences`.

    Parameters
    ----------
    name : str
        The function's name.
    takes, gives : tuple of str
        Names of the quantities that it takes and returns.
    tree : ast.FunctionDef
        Its text.
    """

    name: str
    takes: tuple[str, ...]
    gives: tuple[str, ...]
    tree: ast.FunctionDef


class Plan(NamedTuple):
    """What has to be computed for some quantities.

    Parameters
    ----------
    steps : tuple of (str, int)
        Formulas in an order in which each finds what it takes, with their guards (0: none).
    inputs : tuple of str
        Columns and known quantities that the steps take.
    missing : dict of str to tuple of str
        Wanted quantities that do not follow from what is known -> the columns that they lack.
    """

    steps: tuple[tuple[str, int], ...]
    inputs: tuple[str, ...]
    missing: dict[str, tuple[str, ...]]


def _parse(module: str) -> ast.Module:
    """Return the text of a module beside this one as a tree."""
    return ast.parse(Path(__file__).with_name(module).read_text(encoding="utf-8"))


def _read_formulas(module: ast.Module) -> dict[str, Formula]:
    """Return the public functions of a module by name."""
    formulas = {}
    for tree in module.body:
        if isinstance(tree, ast.FunctionDef) and not tree.name.startswith("_"):
            last = tree.body[-1]
            if not (isinstance(last, ast.Return) and isinstance(last.value, ast.Tuple)):
                raise TypeError(f"{tree.name} does not end with the names that it returns")
            gives = tuple(name.id for name in last.value.elts if isinstance(name, ast.Name))
            takes = tuple(argument.arg for argument in tree.args.args)
            formulas[tree.name] = Formula(tree.name, takes, gives, tree)
    return formulas


SOURCE = _parse("formulas.py")
"""The text of `formulas`."""
FUNCTIONS = _read_formulas(SOURCE)
COMPILED = {name: formula for name, formula in FUNCTIONS.items() if name not in HELPERS}
"""Formulas that the compiled library has, too."""
FORMULAS = COMPILED | _read_formulas(_parse("consequences.py"))
PRINCIPAL = {quantity: f.name for f in COMPILED.values() for quantity in f.gives}
"""Quantity -> the formula of `formulas` that gives it."""
ROWS = {name: row for row, name in enumerate((*COLUMNS, *PRINCIPAL))}
"""Name -> number of the column or quantity in the compiled library."""
NUMBERS = {name: number for number, name in enumerate(COMPILED)}
"""Formula -> its number in the compiled library."""
QUANTITIES = tuple(dict.fromkeys((*ROWS, *(x for f in FORMULAS.values() for x in f.gives))))
"""Names of everything that can be known or asked for."""


@lru_cache(maxsize=1024)
def plan(wanted: tuple[str, ...], known: frozenset[str] = frozenset(COLUMNS)) -> Plan:
    """Return what has to be computed for the quantities ``wanted`` from those that are known.

    A quantity comes from its formula in `formulas`, and only where that needs what is not known,
    from `consequences`.

    Parameters
    ----------
    wanted : tuple of str
        Names of results or of other quantities.
    known : frozenset of str, default all columns
        Names of the columns and quantities that are given. A quantity among them is not computed.

    Returns
    -------
    Plan
        Steps and inputs of all quantities that follow from what is known, and what the others lack.

    Examples
    --------
    >>> plan(("VC",)).inputs
    ('DA', 'DB', 'GA', 'PA', 'PB', 'TA', 'TB', 'UX', 'UY', 'WA', 'VX', 'VY', 'WB', 'M')
    >>> plan(("KI",), frozenset({"MA", "MB", "UX", "UY", "VX", "VY", "WA", "WB", "M"})).missing
    {'KI': ('IA', 'IB')}
    """
    sources = _sources(known)
    missing = {}
    order: dict[str, None] = {}
    inputs: set[str] = set()
    users: dict[str, set[str]] = {}

    def add(quantity: str, user: str) -> None:
        """Add the formulas that lead to a quantity, which ``user`` takes."""
        if quantity in known:
            if user:
                inputs.add(quantity)
            return
        name = sources[quantity]
        users.setdefault(name, set()).add(user)
        if name not in order:
            for operand in FORMULAS[name].takes:
                add(operand, name)
            order[name] = None

    for quantity in wanted:
        if quantity in known or quantity in sources:
            add(quantity, "")
        else:
            missing[quantity] = _lacking_columns(quantity, known)
    steps = tuple(
        (name, GUARDS.get(name, 0) if users[name] <= GUARDED_USERS else 0) for name in order
    )
    return Plan(steps, tuple(name for name in QUANTITIES if name in inputs), missing)


def _sources(known: frozenset[str]) -> dict[str, str]:
    """Return the formula to take for each quantity that follows from what is known.

    A formula is taken once all that it takes is there, so that no quantity leads to itself; one of
    `consequences` is taken when no further one of `formulas` can be."""
    sources: dict[str, str] = {}
    pending = list(FORMULAS.values())
    while True:
        ready = next(
            (f for f in pending if all(name in known or name in sources for name in f.takes)), None
        )
        if ready is None:
            return sources
        pending.remove(ready)
        for quantity in ready.gives:
            if quantity not in known:
                sources.setdefault(quantity, ready.name)


def _lacking_columns(quantity: str, known: frozenset[str]) -> tuple[str, ...]:
    """Return the columns that a quantity needs by `formulas`, or what else gives it, and that are
    not known."""
    lacking: set[str] = set()
    examined: set[str] = set()
    pending = [quantity]
    consequences = {x: f.takes for f in reversed(FORMULAS.values()) for x in f.gives}
    while pending:
        name = pending.pop()
        if name in known or name in examined:
            continue
        examined.add(name)
        if name in PRINCIPAL:
            pending.extend(COMPILED[PRINCIPAL[name]].takes)
        elif name in COLUMNS or name not in consequences:
            lacking.add(name)
        else:
            pending.extend(consequences[name])
    return tuple(name for name in QUANTITIES if name in lacking)
