"""C text of the programs that `solve` runs most, for `native/kernels.h`: each compiled as a whole.

test_native checks that the file is what the formulas say; ``--force-regen`` writes it anew.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator

from impact88.closedform.impactprograms import KERNELS, program_for
from impact88.native.program import Program

HEAD = """\
/* Made from the formulas of closedform/impact.py by tests/kernels.py: not to be edited. */

#define COLUMN(name, p) const double *restrict name = place[p];
#define RESULTS(name, p) double *restrict to_##name = place[p];
#define STATUSES(name, p) uint16_t *restrict to_##name = (uint16_t *)place[p];
"""
CONDITIONS = ("EQUAL", "LESS", "LESS_OR_EQUAL", "EITHER", "BOTH", "NOT")


def text() -> str:
    """The whole file."""
    programs = {name: program_for(*kernel) for name, kernel in KERNELS.items()}
    kernels = [_kernel(name, program) for name, program in programs.items()]
    found = [f"X({name}, 0x{program.digest:016x})" for name, program in programs.items()]
    return "\n".join([HEAD, *kernels, " \\\n    ".join(["#define KERNELS(X)", *found]), ""])


def _kernel(name: str, program: Program) -> str:
    return "\n".join(
        [
            f"static CLONES void {name}(",
            "    double *const *place, const circle *circle, int64_t eights)",
            "{",
            *(f"    {line}".replace("~", " ") for line in _pointers(program)),
            "    EACH_OF_EIGHTS {",
            *(f"        {line}" for line in _lines(program)),
            "    }",
            "}\n",
        ]
    )


def _pointers(program: Program) -> list[str]:
    columns = [f"COLUMN({column}, {place})" for place, column in enumerate(program.columns)]
    for place, result in enumerate(program.results, len(program.columns)):
        columns.append(f"{'STATUSES' if result == 'STATUS' else 'RESULTS'}({result}, {place})")
    return textwrap.wrap("@".join(columns).replace(", ", ",~").replace("@", " "), 96)


def _lines(program: Program) -> Iterator[str]:
    at = [f"{column}[i]" for column in program.columns]
    at += [f"to_{result}[i]" for result in program.results]
    values = dict(enumerate(at))
    for place, scalar in enumerate(program.scalars, len(at)):
        assert isinstance(scalar, float)
        values[place] = "INFINITY" if math.isinf(scalar) else scalar.hex()
    for number, (operation, places) in enumerate(program.steps):
        if operation == "SINE_AND_COSINE":
            angle, sine, cosine = places
            source = values[angle]
            values[sine], values[cosine] = f"s{number}", f"c{number}"
            yield f"double s{number}, c{number};"
            yield f"SINE_AND_COSINE({source}, s{number}, c{number});"
            continue
        *operands, to = places
        formula = f"{operation}({', '.join(values[place] for place in operands)})"
        if operation in ("RESULT", "RESULT_OR_INFINITE", "BITS"):
            yield f"{values[to]} = {formula};"
        else:
            kind = "int64_t" if operation in CONDITIONS else "double"
            values[to] = f"v{number}"
            yield f"{kind} v{number} = {formula};"


if __name__ == "__main__":
    print(text(), end="")
