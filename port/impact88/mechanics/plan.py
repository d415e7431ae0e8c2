"""Which formulas lead to a result: the data flow of `formulas`, read from its text.

A formula's parameters name the quantities it takes, its last line those it returns. Nothing here
imports numpy: the build step that prints the formulas as C reads them through this module.
"""

import ast
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from ..names import RESULTS, SCENE

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
    """A function of `formulas`.

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
    """What has to be computed for some results.

    Parameters
    ----------
    steps : tuple of (str, int)
        Formulas in an order in which each finds what it takes, with their guards (0: none).
    inputs : tuple of str
        Columns and known quantities that the steps read, and wanted ones that are known.
    missing : dict of str to tuple of str
        Wanted quantities that do not follow from what is known -> the columns that they lack.
    """

    steps: tuple[tuple[str, int], ...]
    inputs: tuple[str, ...]
    missing: dict[str, tuple[str, ...]]


SOURCE = ast.parse(Path(__file__).with_name("formulas.py").read_text(encoding="utf-8"))
"""The text of `formulas`."""


def _read_formulas(module: ast.Module) -> dict[str, Formula]:
    """Return the functions of a module by name."""
    formulas = {}
    for tree in module.body:
        if isinstance(tree, ast.FunctionDef):
            last = tree.body[-1]
            if not (isinstance(last, ast.Return) and isinstance(last.value, ast.Tuple)):
                raise TypeError(f"{tree.name} does not end with the names that it returns")
            gives = tuple(name.id for name in last.value.elts if isinstance(name, ast.Name))
            takes = tuple(argument.arg for argument in tree.args.args)
            formulas[tree.name] = Formula(tree.name, takes, gives, tree)
    return formulas


FUNCTIONS = _read_formulas(SOURCE)
FORMULAS = {name: f for name, f in FUNCTIONS.items() if name not in HELPERS}
SOURCE_OF = {quantity: f.name for f in FORMULAS.values() for quantity in f.gives}
"""Quantity -> the formula that gives it."""
ROWS = {name: row for row, name in enumerate((*COLUMNS, *SOURCE_OF))}
"""Name -> number of the column or quantity in the compiled library."""
NUMBERS = {name: number for number, name in enumerate(FORMULAS)}
"""Formula -> its number in the compiled library."""


@lru_cache(maxsize=1024)
def plan(wanted: tuple[str, ...], known: frozenset[str] = frozenset(COLUMNS)) -> Plan:
    """Return what has to be computed for the quantities ``wanted`` from those that are known.

    Parameters
    ----------
    wanted : tuple of str
        Names of results or of any other quantities of `formulas`.
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
    missing = {}
    order: dict[str, None] = {}
    inputs: set[str] = set()
    users: dict[str, set[str]] = {}
    for quantity in wanted:
        lacking = _columns_lacking(quantity, known)
        if lacking:
            missing[quantity] = tuple(name for name in ROWS if name in lacking)
        else:
            _add_steps(quantity, "", known, order, inputs, users)
    steps = tuple(
        (name, GUARDS.get(name, 0) if users[name] <= GUARDED_USERS else 0) for name in order
    )
    return Plan(steps, tuple(name for name in ROWS if name in inputs), missing)


def _columns_lacking(quantity: str, known: frozenset[str]) -> set[str]:
    """Return the columns that a quantity needs and that are not known."""
    lacking: set[str] = set()
    examined: set[str] = set()
    pending = [quantity]
    while pending:
        name = pending.pop()
        if name in known or name in examined:
            continue
        examined.add(name)
        if name in SOURCE_OF:
            pending.extend(FORMULAS[SOURCE_OF[name]].takes)
        else:
            lacking.add(name)
    return lacking


def _add_steps(
    quantity: str,
    user: str,
    known: frozenset[str],
    order: dict[str, None],
    inputs: set[str],
    users: dict[str, set[str]],
) -> None:
    """Add the formulas that lead to a quantity to ``order``, and their ``users``."""
    if quantity in known:
        inputs.add(quantity)
        return
    name = SOURCE_OF[quantity]
    users.setdefault(name, set()).add(user)
    if name not in order:
        for operand in FORMULAS[name].takes:
            _add_steps(operand, name, known, order, inputs, users)
        order[name] = None


def results_in_order(names: Iterable[str]) -> tuple[str, ...]:
    """Return result names in the order of `names.RESULTS`."""
    chosen = set(names)
    return tuple(name for name in RESULTS if name in chosen)
