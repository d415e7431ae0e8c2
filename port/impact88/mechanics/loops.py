"""Generator of `native/loops.h`: the impact as C, every formula once.

The formulas of all four kinds of scene (`KINDS`) are one graph of operations. Operations that the
same results need make a loop over a strip of scenes; a result, or a set of them, is a set of loops.
What a loop leaves for another, or for a result, is kept in a row as long as a strip. In a checkout,
``python -m impact88.mechanics.loops`` writes the file and ``pip install -e .`` compiles it;
tests/mechanics/test_loops.py checks that file and formulas agree.
"""

from __future__ import annotations

import hashlib
import math
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from ..names import FINAL_VELOCITIES
from . import native
from .closedform.impact import impact
from .closedform.impactprograms import ALL, COLUMNS
from .native import QUANTITIES
from .native.expressiontable import Expression, ExpressionTable
from .native.schedule import in_order

KINDS = {
    "FRICTION": (False, False),
    "PIVOT": (True, False),
    "POINT": (False, True),
    "POINT_PIVOT": (True, True),
}
"""Kind of scene -> whether MU is that of a pivot, and whether bodies are points (M = 4)."""
LEAVES = ("column", "constant")
HALVES = ("sine", "cosine")
CONDITIONS = ("equal", "less", "less_or_equal", "either", "both", "not")
"""Operations whose value is a condition."""
ARITHMETIC = ("add", "subtract", "multiply")
"""Operations that take a condition as the number 1 or 0."""

MOST_LOOPS = 128
"""A set of loops is two words of 64 bits."""
SPARE = 1.4
"""Loops are joined only as long as no result takes more than this many times the operations that it
needs when it is asked for alone."""
SPARE_OF_COMMON = 1.15
"""`SPARE` for the six velocities together, and for LOSS."""
COST_OF_A_LOOP = 30
"""Cost of starting a loop, in operations; one of reading or keeping a row is 1."""
SHARES = {"FRICTION": 4, "PIVOT": 2, "POINT": 1, "POINT_PIVOT": 1}
"""Share of the calls that have scenes of a kind."""
SHARE_OF_SIX = 16  # share of the calls that want the six velocities
SHARE_OF_ALL = 8  # share of those that want all results
SHARE_OF_ONE = 1  # share of those that want a result alone, for each result


class Question(NamedTuple):
    """Results that are asked for together, of one kind of scene; how often, and how many times the
    operations that they need they may take."""

    kind: str
    results: tuple[str, ...]
    share: float
    spare: float


def _questions() -> Iterator[Question]:
    for kind, share in SHARES.items():
        yield Question(kind, FINAL_VELOCITIES, share * SHARE_OF_SIX, SPARE_OF_COMMON)
        yield Question(kind, ALL, share * SHARE_OF_ALL, SPARE)
        for name in QUANTITIES:
            spare = SPARE_OF_COMMON if name == "LOSS" else SPARE
            yield Question(kind, (name,), share * SHARE_OF_ONE, spare)


def _operations(roots: Iterable[Expression]) -> list[Expression]:
    """Return the operations that values need, each after its operands."""
    return [e for e in in_order(list(roots)) if e.operation not in LEAVES]


def _count(operations: Iterable[Expression]) -> int:
    """Return how many there are; a sine with its cosine is one."""
    return sum(e.operation not in HALVES for e in operations)


class Graph:
    """The formulas of all kinds: ``results``, kind -> name -> value; ``operations``, each after
    its operands; ``needed``, operation -> the questions that need it, a bit for each."""

    def __init__(self) -> None:
        table = ExpressionTable()
        scene = {name: table.column(name, varies=True) for name in COLUMNS}
        self.results = {
            kind: impact(table, scene, pivot, point, infinite=True)
            for kind, (pivot, point) in KINDS.items()
        }
        self.roots = [self.results[kind][name] for kind in KINDS for name in QUANTITIES]
        self.operations = _operations(self.roots)
        self.questions = list(_questions())
        self.needed = dict.fromkeys(self.operations, 0)
        for number, question in enumerate(self.questions):
            for e in self.needs(question.kind, question.results):
                self.needed[e] |= 1 << number

    def needs(self, kind: str, names: Sequence[str]) -> list[Expression]:
        """Return the operations that results of a kind need."""
        return _operations(self.results[kind][name] for name in names)


class Loop:
    """Operations that are computed together. ``needed``: the questions that one of them is for;
    ``given``: the values from elsewhere that they take; ``kept``: those of theirs that others
    take, or that are results; ``cost``: of all questions together."""

    def __init__(self, layout: Layout, operations: Iterable[Expression]) -> None:
        self.operations = sorted(operations, key=layout.position.__getitem__)
        self.is_sine = self.operations[0].operation == "sine_and_cosine"
        mine = set(self.operations)
        operands = (x for e in self.operations for x in e.operands)
        outside = (x for x in operands if x not in mine and x.operation != "constant")
        self.given = list(dict.fromkeys(outside))
        self.kept = [
            e
            for e in self.operations
            if e.operation != "sine_and_cosine"
            and (e in layout.roots or not layout.users[e] <= mine)
        ]
        self.needed = 0
        for e in self.operations:
            self.needed |= layout.graph.needed[e]
        self.size = _count(self.operations)
        once = self.size + len(self.given) + len(self.kept) + COST_OF_A_LOOP
        self.cost = layout.share_of(self.needed) * once


class Layout:
    """The graph's operations in ``loops``, in an order in which each finds what it takes.

    ``row``: where a loop keeps a value; ``rows``: how many there are.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.position = {e: number for number, e in enumerate(graph.operations)}
        self.roots = set(graph.roots)
        self.users: dict[Expression, set[Expression]] = {e: set() for e in graph.operations}
        for e in graph.operations:
            for x in e.operands:
                if x in self.users:
                    self.users[x].add(e)
        self._shares: dict[int, float] = {}
        self.loops = self._in_order(self._join(self._smallest_loops()))
        if len(self.loops) > MOST_LOOPS:
            raise ValueError(f"{len(self.loops)} loops; expected {MOST_LOOPS} at most")
        self.row, self.rows = self._find_rows()

    def share_of(self, questions: int) -> float:
        """Return how often one of some questions is asked."""
        if questions not in self._shares:
            shares = (q.share for k, q in enumerate(self.graph.questions) if questions >> k & 1)
            self._shares[questions] = sum(shares)
        return self._shares[questions]

    def needs(self, kind: str, names: Sequence[str]) -> list[int]:
        """Return the numbers of the loops that compute results of a kind."""
        operations = set(self.graph.needs(kind, names))
        return [k for k, loop in enumerate(self.loops) if operations & set(loop.operations)]

    def _smallest_loops(self) -> list[Loop]:
        """Return a loop for the operations that the same questions need, before and after the
        sines; a sine, with its cosine, has its own."""
        groups: dict[object, list[Expression]] = {}
        depth: dict[Expression, int] = {}
        for e in self.graph.operations:
            depth[e] = max((depth.get(x, 0) for x in e.operands), default=0)
            depth[e] += e.operation in HALVES
            pair = e.operands[0] if e.operation in HALVES else e
            of_a_sine = pair.operation == "sine_and_cosine"
            key = pair if of_a_sine else (self.graph.needed[e], depth[e])
            groups.setdefault(key, []).append(e)
        return [Loop(self, operations) for operations in groups.values()]

    def _join(self, loops: list[Loop]) -> list[Loop]:
        """Join the pair of loops that saves most, again and again, while one saves anything."""
        questions = self.graph.questions
        numbers = range(len(questions))
        takes = [sum(x.size for x in loops if x.needed >> k & 1) for k in numbers]
        most = [q.spare * _count(self.graph.needs(q.kind, q.results)) for q in questions]

        def more_takes(a: Loop, b: Loop) -> Iterator[tuple[int, int]]:
            """Yield the questions that need one of two loops, and the size of the other."""
            for k in numbers:
                if (a.needed ^ b.needed) >> k & 1:
                    yield k, b.size if a.needed >> k & 1 else a.size

        savings: dict[tuple[Loop, Loop], float] = {}

        def note_saving(a: Loop, b: Loop) -> None:
            least = self.share_of(a.needed | b.needed) * (a.size + b.size + COST_OF_A_LOOP)
            if a.is_sine or b.is_sine or least >= a.cost + b.cost:
                return
            saving = a.cost + b.cost - Loop(self, a.operations + b.operations).cost
            if saving > 0:
                savings[a, b] = saving

        for at, a in enumerate(loops):
            for b in loops[at + 1 :]:
                note_saving(a, b)
        while savings:
            a, b = max(savings, key=savings.__getitem__)
            del savings[a, b]
            if any(takes[k] + extra > most[k] for k, extra in more_takes(a, b)):
                continue
            if self._is_between(loops, a, b):
                continue
            for k, extra in more_takes(a, b):
                takes[k] += extra
            union = Loop(self, a.operations + b.operations)
            savings = {pair: x for pair, x in savings.items() if a not in pair and b not in pair}
            loops = [loop for loop in loops if loop is not a and loop is not b]
            for loop in loops:
                note_saving(loop, union)
            loops.append(union)
        return loops

    def _before(self, loops: Sequence[Loop]) -> dict[Loop, set[Loop]]:
        """Return the loops that each loop takes values from."""
        maker = {e: loop for loop in loops for e in loop.operations}
        return {loop: {maker[x] for x in loop.given if x in maker} for loop in loops}

    def _is_between(self, loops: Sequence[Loop], a: Loop, b: Loop) -> bool:
        """Return whether one of two loops takes what a third has made of the other's values."""
        before = self._before(loops)
        for start, end in ((a, b), (b, a)):
            waiting, seen = list(before[end] - {start}), set[Loop]()
            while waiting:
                loop = waiting.pop()
                if loop is start:
                    return True
                if loop not in seen:
                    seen.add(loop)
                    waiting += before[loop]
        return False

    def _in_order(self, loops: Sequence[Loop]) -> list[Loop]:
        """Return the loops, each after those whose values it takes."""
        before = self._before(loops)
        order: list[Loop] = []
        waiting = sorted(loops, key=lambda loop: self.position[loop.operations[-1]])
        while waiting:
            loop = next(x for x in waiting if before[x].issubset(order))
            waiting.remove(loop)
            order.append(loop)
        return order

    def _find_rows(self) -> tuple[dict[Expression, int], int]:
        """Return the row of each value that a loop keeps, and the number of rows.

        A row is used again once no loop takes its value any more, and by values of other kinds of
        scenes. Those of results stay, and those of sines, which may be left out.
        """
        last: dict[Expression, int] = {}
        for k, loop in enumerate(self.loops):
            last |= dict.fromkeys([*loop.given, *loop.kept], k)
        stays = {e for loop in self.loops if loop.is_sine for e in loop.kept} | self.roots
        row: dict[Expression, int] = {}
        taken_until: list[dict[str, int]] = []
        for k, loop in enumerate(self.loops):
            questions = enumerate(self.graph.questions)
            kinds = {q.kind for number, q in questions if loop.needed >> number & 1}
            for e in loop.kept:
                free = (
                    r for r, until in enumerate(taken_until) if all(until[x] < k for x in kinds)
                )
                row[e] = next(free, len(taken_until))
                if row[e] == len(taken_until):
                    taken_until.append(dict.fromkeys(KINDS, -1))
                until = len(self.loops) if e in stays else last[e]
                taken_until[row[e]] |= dict.fromkeys(kinds, until)
        return row, len(taken_until)


def operations(kind: str, names: Sequence[str]) -> tuple[int, int]:
    """Return how many operations are executed for results of a kind of scene, and how many they
    need; a sine with its cosine is one."""
    plan = layout()
    operations = sum(plan.loops[k].size for k in plan.needs(kind, names))
    return operations, _count(plan.graph.needs(kind, names))


# -- the text

HEAD = """\
/* Made from the formulas of closedform/impact.py by mechanics/loops.py: not to be edited. */
"""


@lru_cache(maxsize=1)
def layout() -> Layout:
    """Return the loops of the formulas."""
    return Layout(Graph())


def text() -> str:
    """Return the text of loops.h."""
    body = "\n".join([*_tables(layout()), "", *_function(layout()), ""])
    return f'{HEAD}\n#define FORMULAS "{_digest(body)}"\n{body}'


def digest() -> str:
    """Return the digest of the loops, which shows whether a library was built from them."""
    return text().split('"')[1]


def _digest(text: str) -> str:
    return hashlib.blake2b(text.encode("ascii"), digest_size=8).hexdigest()


def _wrap(text: str) -> list[str]:
    return textwrap.wrap(text, 100, subsequent_indent="    ")


def _tables(plan: Layout) -> list[str]:
    """Write the names of columns, kinds and results, the loops that each result needs, and where
    it then is: a column, a row, or one of `constants`."""
    results = plan.graph.results
    constants = {r.value: r for r in plan.graph.roots if r.operation == "constant"}

    def place(root: Expression) -> str:
        if root.operation == "column":
            return f"AT_{root.value}"
        if root.operation == "constant":
            return f"CONSTANT + {list(constants).index(root.value)}"
        return f"ROW + {plan.row[root]}"

    lines = _wrap(f"enum column {{ {', '.join(f'AT_{name}' for name in COLUMNS)}, COLUMNS }};")
    lines += _wrap(f"enum kind {{ {', '.join(KINDS)}, KINDS }};")
    lines += _wrap(f"enum result {{ {', '.join(f'TO_{name}' for name in QUANTITIES)}, RESULTS }};")
    lines.append("#define NAMES_OF_RESULTS \\")
    names = textwrap.wrap(" ".join(QUANTITIES), 90)
    lines.append(' " \\\n'.join(f'    "{line}' for line in names) + '"')
    lines += [
        f"enum {{ ROWS = {plan.rows}, CONSTANTS = {len(constants)} }};",
        "/* Where a result is: a column, a row, or a constant. */",
        "enum { ROW = COLUMNS, CONSTANT = ROW + ROWS };",
        f"static const double constants[] = {{{', '.join(map(repr, constants))}}};",
    ]
    sines = (k for k, loop in enumerate(plan.loops) if _is_of_arm(loop))
    lines.append(f"static const loop_set sines_of_arms = {_set(sines)};".replace("~", " "))
    arms = [plan.row[e] for loop in plan.loops if _is_of_arm(loop) for e in loop.kept]
    lines.append(f"static const int rows_of_arms[] = {{{', '.join(map(str, arms))}}};")
    lines.append("static const loop_set loops_of[KINDS][RESULTS] = {")
    for kind in KINDS:
        sets = (_set(plan.needs(kind, [name])) for name in QUANTITIES)
        lines += [f"    [{kind}] = {{", *_rows(sets), "    },"]
    lines += ["};", "static const int place_of[KINDS][RESULTS] = {"]
    for kind in KINDS:
        places = (place(results[kind][name]) for name in QUANTITIES)
        lines += [f"    [{kind}] = {{", *_rows(places), "    },"]
    return [*lines, "};"]


def _set(loops: Iterable[int]) -> str:
    """Write a set of loops."""
    bits = sum(1 << k for k in loops)
    return f"{{{{{bits % 2**64:#x},~{bits >> 64:#x}}}}}"


def _rows(items: Iterable[str]) -> list[str]:
    """Write the items of a table, indented."""
    indent = " " * 8
    lines = textwrap.wrap(", ".join(items), 100, initial_indent=indent, subsequent_indent=indent)
    return [line.replace("~", " ") for line in lines]


def _is_of_arm(loop: Loop) -> bool:
    """Return whether a loop is a sine that only an arm is multiplied with."""
    angles = {"PA", "PB", "TA", "TB"}
    return loop.is_sine and any(e.value in angles for e in in_order(loop.operations))


def _function(plan: Layout) -> list[str]:
    """Write the function of all loops."""
    lines = [
        "/* The results of a strip of scenes, as far as ``loops`` are done. */",
        "static CLONES void compute_loops(",
        "    const double *const *in, const double *const *ahead,",
        "    double (*restrict v)[ROW_LENGTH], const circle *circle, const loop_set loops,",
        "    const int64_t eights)",
        "{",
        "    const int64_t lanes = 8 * eights; /* vectors of any length leave no rest */",
        *_wrap_columns(),
    ]
    columns_fetched = _fetched_columns(plan)
    for number, loop in enumerate(plan.loops):
        lines += _write_loop(plan, number, loop)
        if names := columns_fetched.get(number):
            texts = " ".join(f"FETCH_COLUMN({name})" for name in names)
            lines.append(f"    if (HAS(loops, {number})) {{ {texts} }}")
    return [*lines, "}"]


def _fetched_columns(plan: Layout) -> dict[int, list[str]]:
    """Return the columns that are fetched with each loop: with that which most questions need."""
    columns_fetched: dict[int, list[str]] = {}
    for name in COLUMNS:
        users = [k for k, loop in enumerate(plan.loops) if any(x.value == name for x in loop.given)]
        if users:
            largest = max(users, key=lambda k: plan.share_of(plan.loops[k].needed))
            columns_fetched.setdefault(largest, []).append(name)
    return columns_fetched


def _wrap_columns() -> list[str]:
    text = " ".join(f"COLUMN({name})" for name in COLUMNS if name != "M")
    return textwrap.wrap(text, 100, initial_indent="    ", subsequent_indent="    ")


def _write_loop(plan: Layout, number: int, loop: Loop) -> list[str]:
    """Write one loop: a line for each operation."""

    def at(x: Expression) -> str:
        return f"{x.value}[i]" if x.operation == "column" else f"v[{plan.row[x]}][i]"

    guard = f"    if (HAS(loops, {number}))"
    if loop.is_sine:
        pair, angle = loop.operations[0], loop.operations[0].operands[0]
        sine, cosine = (at(pair.table.combine(half, pair)) for half in HALVES)
        return [f"{guard} EACH SINE_AND_COSINE({at(angle)}, {sine}, {cosine});"]
    value = {x: f"({at(x)} != 0.0)" if _is_condition(x) else at(x) for x in loop.given}
    columns_kept = set(loop.kept)
    lines = [f"{guard} EACH {{"]
    for place, e in enumerate(loop.operations):
        operands = (_operand(x, e.operation in ARITHMETIC, value) for x in e.operands)
        formula = f"{e.operation.upper()}({', '.join(operands)})"
        value[e] = name = f"x{place}"
        type_of_value = "int64_t" if _is_condition(e) else "double"
        # a condition that is kept as it is would have to be converted, which AVX2 cannot do
        line = f"        {type_of_value} {name} = {formula};"
        if e in columns_kept:
            line += f" {at(e)} = {name}{' ? 1.0 : 0.0' if _is_condition(e) else ''};"
        lines.append(line)
    return [*lines, "    }"]


def _is_condition(e: Expression) -> bool:
    return e.operation in CONDITIONS


def _operand(x: Expression, as_number: bool, value: dict[Expression, str]) -> str:
    """Write an operand; ``as_number``: a condition as 1 or 0."""
    if isinstance(x.value, float):
        return "INFINITY" if math.isinf(x.value) else x.value.hex()
    return f"({value[x]} ? 1.0 : 0.0)" if as_number and _is_condition(x) else value[x]


def main() -> None:
    """Write loops.h, and print the next steps."""
    Path(native.__file__).with_name("loops.h").write_text(text(), encoding="ascii")
    print(f'FORMULAS = "{digest()}" in mechanics/native/__init__.py; pip install -e .')


if __name__ == "__main__":
    main()
