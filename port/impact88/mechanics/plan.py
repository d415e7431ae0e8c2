"""Which formulas lead to a result: the data flow of `formulas` and `consequences`, from their text.

A formula's parameters name the quantities it takes, its last line those it returns. Nothing here
imports numpy: the build step that prints the formulas as C reads them through this module.
"""

import ast
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from ..names import SCENE

COLUMNS = tuple(SCENE)
"""Names of a scene's columns, in the order of the compiled library."""

HELPERS = ("sine_and_cosine", "dot", "cross")
"""Functions of `formulas` that formulas call, and that are no formulas."""

BODIES = (
    "MA IA DA PA TA UX UY WA VAX VAY WAF XA YA XAF YAF DVA EESA CAX CAY D3 D4 SA SAF HA HAF DVAF "
    "DVAR PDOFA ma ia fa ja wa an at ax ay da angle_a part_a own_a given_a wa_s wa_p state_a "
    "free_a front_a",  # B faces along TB
    "MB IB DB PB TB VX VY WB VBX VBY WBF XB YB XBF YBF DVB EESB CBX CBY D1 D2 SB SBF HB HBF DVBF "
    "DVBR PDOFB mb ib fb jb wb bn bt bx by db angle_b part_b own_b given_b wb_s wb_p state_b "
    "free_b TB",
)
"""Quantities of A, and the same ones of B: what gives some of A's alone gives B's, too."""
TIMES = (
    "UX UY WA VX VY WB wa wb SA SB XA YA XB YB KI cn ct gn gt",
    "VAX VAY WAF VBX VBY WBF waf wbf SAF SBF XAF YAF XBF YBF KF cn_after ct_after gn_after "
    "gt_after",
)
"""Quantities before the impact, and the same ones after it, given likewise."""

PIVOTS = 1  # guard of a formula that only pivots need
OTHERS = 2  # of one that only the other scenes need
GUARDS = {
    "pivot_impulse": PIVOTS,
    "pivot_state": PIVOTS,
    "pivot_spin": PIVOTS,
    "sliding_impulse": OTHERS,
    "sliding_spins": OTHERS,
}
"""Formulas that only pivots need, or only the other scenes."""
SELECTING = ("impulse", "final_spin")
"""Formulas that look at the guarded ones' results only where these apply."""


class Formula(NamedTuple):
    """A function of `formulas` or `consequences`, for some quantities.

    Parameters
    ----------
    name : str
        The function's name, with a suffix where it is repeated for other quantities.
    takes, gives : tuple of str
        Names of the quantities that it takes and returns.
    tree : ast.FunctionDef
        The function's text.
    """

    name: str
    takes: tuple[str, ...]
    gives: tuple[str, ...]
    tree: ast.FunctionDef


Step = tuple[Formula, int]
"""A formula and its guard: 0 for none."""


class Plan(NamedTuple):
    """The computation of some quantities.

    Parameters
    ----------
    steps : tuple of (Formula, int)
        Formulas in an order in which each finds what it takes, with their guards.
    inputs : tuple of str
        Columns and known quantities that the steps take, or that are wanted.
    missing : dict of str to tuple of str
        Wanted quantities that do not follow from what is known -> the columns that they lack.
    """

    steps: tuple[Step, ...]
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
            takes = tuple(argument.arg for argument in tree.args.args)
            last: Any = tree.body[-1]  # a return of a tuple of names; of an expression by helpers
            gives = tuple(name.id for name in getattr(last.value, "elts", ()))
            formulas[tree.name] = Formula(tree.name, takes, gives, tree)
    return formulas


def _repeat(
    formulas: Mapping[str, Formula], suffix: str, names: str, others: str
) -> dict[str, Formula]:
    """Return formulas by name, each that gives some of ``names`` alone followed by the same for the
    ``others``."""
    first, second = names.split(), others.split()
    exchange = dict(zip(second + first, first + second, strict=True))
    repeated = {}
    for name, formula in formulas.items():
        repeated[name] = formula
        if {*first}.issuperset(formula.gives):
            takes, gives = (
                tuple(exchange.get(x, x) for x in side) for side in (formula.takes, formula.gives)
            )
            repeated[name + suffix] = Formula(name + suffix, takes, gives, formula.tree)
    return repeated


def _for_all(formulas: Mapping[str, Formula]) -> dict[str, Formula]:
    """Return formulas by name, those of both bodies and both times repeated."""
    return _repeat(_repeat(formulas, "_b", *BODIES), "_after", *TIMES)


SOURCE = _parse("formulas.py")
"""The text of `formulas`."""
FUNCTIONS = _read_formulas(SOURCE)
COMPILED = _for_all({name: f for name, f in FUNCTIONS.items() if name not in HELPERS})
"""Formulas that the compiled library has, too."""
FORMULAS = COMPILED | _for_all(_read_formulas(_parse("consequences.py")))
ROWS = {
    name: row
    for row, name in enumerate((*COLUMNS, *(x for f in COMPILED.values() for x in f.gives)))
}
"""Name -> number of the column or quantity in the compiled library."""
QUANTITIES = dict.fromkeys((*ROWS, *(x for f in FORMULAS.values() for x in f.gives)))
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
    missing = {
        x: tuple(n for n in plan((x,), known.union(COLUMNS)).inputs if n not in known)
        for x in wanted
        if x not in known and x not in sources
    }
    quantities = set(wanted)
    everywhere = set(wanted)  # quantities that all scenes need
    inputs = {*known.intersection(wanted)}
    steps: list[Step] = []
    for formula in reversed(dict.fromkeys(sources.values())):  # users of a formula come before it
        used = {x for x in quantities.intersection(formula.gives) if sources.get(x) is formula}
        if used:
            is_guarded = everywhere.isdisjoint(used) and "MU" in known
            guard = GUARDS.get(formula.tree.name, 0) if is_guarded else 0
            if not guard and formula.tree.name not in SELECTING:
                everywhere.update(formula.takes)
            steps.append((formula, guard))
            inputs |= known.intersection(formula.takes)
            quantities.update(formula.takes)
    return Plan(tuple(steps[::-1]), tuple(x for x in QUANTITIES if x in inputs), missing)


@lru_cache
def _sources(known: frozenset[str]) -> dict[str, Formula]:
    """Return the formula to take for each quantity that follows from what is known.

    A formula is taken once all that it takes is there, so that no quantity leads to itself; one of
    `consequences` is taken when no further one of `formulas` can be."""
    sources: dict[str, Formula] = {}
    pending = list(FORMULAS.values())
    while True:
        available = known.union(sources)
        ready = next((f for f in pending if available.issuperset(f.takes)), None)
        if ready is None:
            return sources
        pending.remove(ready)
        for quantity in ready.gives:
            if quantity not in known:
                sources.setdefault(quantity, ready)


GIVERS = _sources(frozenset(COLUMNS))
"""Quantity -> the formula that gives it where all columns are known."""
