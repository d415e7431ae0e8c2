"""Generator of `native/kernels.h`: the impact as C, one body for each kind of scene.

A body computes every result; each kernel made of it keeps some, and the compiler drops the rest. In
a checkout, ``python -m impact88.mechanics.kernelsource`` writes the file and ``pip install -e .``
compiles it; test_native checks that file and formulas agree.
"""

from __future__ import annotations

import hashlib
import math
import textwrap
from pathlib import Path

from . import native
from .closedform.impactprograms import (
    ALL,
    BODIES,
    COLUMNS,
    FILTERS,
    KERNELS,
    program_for,
)
from .closedform.statusfilter import UNDECIDED
from .native.program import Program

HEAD = """\
/* Made from the formulas of closedform/impact.py by mechanics/kernelsource.py: not to be edited. */

#define COLUMN(name) const double *restrict name = in[AT_##name];
#define RESULT_AT(name, p) double *restrict to_##name = out[p];
"""
ARITHMETIC = ("ADD", "MULTIPLY", "PRODUCT_PLUS", "PRODUCTS_PLUS")
CONDITIONS = ("EQUAL", "LESS", "LESS_OR_EQUAL", "EITHER", "BOTH", "NOT")

COSTS = {
    **dict.fromkeys(("PRODUCT_PLUS", "PRODUCT_MINUS", "MINUS_PRODUCT"), 2),
    **dict.fromkeys(("PRODUCTS_PLUS", "PRODUCTS_MINUS"), 3),
    **{"SINE_AND_COSINE": 24, "DIVIDE": 8, "SQRT": 16},
}
"""Operation -> how many additions it takes as long as, where that is not one."""


def text() -> str:
    """Return the text of kernels.h."""
    bodies = [_body(name, program) for name, program in programs().items()]
    return "\n".join([HEAD, *_places(), *bodies, _table(), ""])


def programs() -> dict[str, Program]:
    """Return the program of every body, of the results that its kernels keep."""
    kept: dict[str, set[str]] = {name: set() for name in BODIES}
    for name, results in KERNELS:
        kept[name].update(results)
    return {
        name: _program(name, tuple(result for result in ALL if result in kept[name]))
        for name in BODIES
    }


def _program(name: str, results: tuple[str, ...]) -> Program:
    """Return the program of a body for some results."""
    source = FILTERS[name][1] if name in FILTERS else "results"
    return program_for(BODIES[name], results, status_from=source)


def digest() -> str:
    """Return the digest of the formulas, which shows whether a library was built from them."""
    text = " ".join(f"{program.digest:016x}" for program in programs().values())
    return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()


def _places() -> list[str]:
    """Return the places of columns and results, and the digest of the formulas."""
    columns = ", ".join([*(f"AT_{name}" for name in COLUMNS), "COLUMNS"])
    return [
        *textwrap.wrap(f"enum column {{ {columns} }};", 96, subsequent_indent="    "),
        f"#define RESULTS {len(ALL)}",
        f"#define STATUS_AT {ALL.index('STATUS')}",
        f"#define UNDECIDED {UNDECIDED} /* of STATUS */",
        f'#define FORMULAS "{digest()}"',
        "",
    ]


def _cost(name: str, results: tuple[str, ...]) -> int:
    """Return the cost of a kernel in operations."""
    return sum(COSTS.get(operation, 1) for operation, _ in _program(name, results).steps)


def _table() -> str:
    """Return the kernels: number and name of the body, the results each keeps, as bits, and its
    cost."""
    rows = []
    for place, (name, results) in enumerate(KERNELS):
        mask = sum(1 << ALL.index(result) for result in results)
        number, cost = list(BODIES).index(name), _cost(name, results)
        rows.append(f"X({place}, {number}, {name}, {mask:#x}, {cost})")
    return " \\\n    ".join(["#define KERNELS(X)", *rows])


def _body(name: str, program: Program) -> str:
    sines, angles, lines = _lines(program)
    return "\n".join(
        [
            f"static inline ALWAYS_INLINE void {name}(",
            "    const double *const *in, double *const *out, const circle *circle,",
            "    const double *const *ahead, int64_t eights, const uint64_t wanted)",
            "{",
            *(f"    {line}" for line in _pointers(program)),
            f"    double {', '.join(f'{x}[STRIP]' for x in sines)};",
            *_loop([], angles),
            *_loop([f"FETCH({column})" for column in program.columns], lines),
            "}\n",
        ]
    )


def _loop(fetches: list[str], lines: list[str]) -> list[str]:
    """Write a loop over the scenes, eight at a time; ``fetches`` once for each eight."""
    heads = textwrap.wrap(" ".join(fetches), 92, initial_indent=" " * 8, subsequent_indent=" " * 8)
    body = [f"            {line}" for line in lines]
    return ["    EACH_EIGHT {", *heads, "        EACH_OF_EIGHT {", *body, "        }", "    }"]


def _numbers(operation: str, operands: list[str], conditions: set[str]) -> list[str]:
    """Write conditions among the operands of arithmetic as numbers, in floating point."""
    if operation not in ARITHMETIC:
        return operands
    return [f"({x} ? 1.0 : 0.0)" if x in conditions else x for x in operands]


def _pointers(program: Program) -> list[str]:
    columns = [f"COLUMN({column})" for column in program.columns]
    results = [f"RESULT_AT({name}, {ALL.index(name)})" for name in program.results]
    return [
        line.replace("~", " ")
        for line in textwrap.wrap(" ".join([*columns, *results]).replace(", ", ",~"), 92)
    ]


def _lines(program: Program) -> tuple[list[str], list[str], list[str]]:
    """Return the arrays of sines and cosines, the lines that fill them, and all other lines.

    Sines in a loop of their own take a tenth less of the six velocities' time: a processor works on
    several scenes of a short loop at once, and hardly on two of one as long as a body.
    """
    values = {place: f"{column}[i]" for place, column in enumerate(program.columns)}
    first, conditions = len(values), set[str]()
    for place, scalar in enumerate(program.scalars, program.moving):
        assert isinstance(scalar, float)
        values[place] = "INFINITY" if math.isinf(scalar) else scalar.hex()
    sines: list[str] = []
    angles: dict[str, None] = {}
    lines: dict[str, list[str]] = {}
    line_of: dict[str, str] = {}
    operands_of: dict[str, list[str]] = {}

    def move(value: str) -> None:
        """Compute a value among the angles."""
        for operand in operands_of.get(value, ()):
            move(operand)
        if value in line_of:
            angles[line_of[value]] = None

    for number, (operation, places) in enumerate(program.steps):
        if operation == "SINE_AND_COSINE":
            angle, sine, cosine = places
            source = values[angle]
            move(source)
            sines += [f"s{number}", f"c{number}"]
            values[sine], values[cosine] = f"s{number}[i]", f"c{number}[i]"
            angles[f"SINE_AND_COSINE({source}, {values[sine]}, {values[cosine]});"] = None
            continue
        *operands, to = places
        texts = [values[place] for place in operands]
        formula = f"{operation}({', '.join(_numbers(operation, texts, conditions))})"
        if operation == "PRODUCT_PLUS" and texts[0] in conditions:  # that number, or 0
            product, addends = f"({texts[0]} ? {texts[1]} : 0.0)", texts[2:]
            formula = f"ADD({product}, {_numbers('ADD', addends, conditions)[0]})"
        if operation in ("RESULT", "RESULT_OR_INFINITE", "BITS"):
            result = program.results[to - first]
            keeps = formula if operation != "BITS" else texts[0]
            place = ALL.index(result)
            lines[f"if (wanted >> {place} & 1) to_{result}[i] = {keeps};"] = texts
        else:
            kind = "int64_t" if operation in CONDITIONS else "double"
            values[to] = name = f"v{number}"
            if operation in CONDITIONS:
                conditions.add(name)
            line_of[name], operands_of[name] = f"{kind} {name} = {formula};", texts
            lines[line_of[name]] = texts
    # an angle may be used beside its sine, too: then it is computed in both loops
    used: set[str] = set()
    rest: list[str] = []
    for line, texts in reversed(lines.items()):
        if line not in angles or line.split(" = ")[0].split()[-1] in used:
            rest.append(line)
            used.update(texts)
    return sines, list(angles), rest[::-1]


def main() -> None:
    """Write kernels.h, and print the next steps."""
    Path(native.__file__).with_name("kernels.h").write_text(text(), encoding="ascii")
    print(f'FORMULAS = "{digest()}" in mechanics/closedform/impactprograms.py; pip install -e .')


if __name__ == "__main__":
    main()
