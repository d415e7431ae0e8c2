"""Print the functions of `formulas` as C, each with a loop over a strip of scenes.

It is run when the package is built: ``python -m impact88.mechanics.translate`` writes to standard
output what `kernel.c` includes as ``formulas.h``. Expressions are C as they are written (`where`
is a macro there) and keep the order of their operations, so that the compiled library has numpy's
bits.
"""

import ast
import hashlib

from ..names import PIVOT
from ..status import Status
from .plan import COLUMNS, COMPILED, FUNCTIONS, ROWS, SOURCE, Formula


def statements(formula: Formula) -> list[str]:
    """Return a function's statements in C."""
    lines: list[str] = []
    for line in formula.tree.body:
        text = ast.unparse(line)
        target, _, value = text.partition(" = ")
        names = target.strip("()")
        match line:
            case ast.Assign(targets=[ast.Tuple()]):  # by another function, of the places of results
                lines += [f"double {names};", f"{value[:-1]}, &{names.replace(', ', ', &')});"]
            case ast.Assign(value=whole):
                operator = getattr(whole, "op", whole)
                is_condition = isinstance(operator, ast.Compare | ast.BitAnd | ast.BitOr)
                lines.append(f"{'int64_t' if is_condition else 'double'} {text};")
            case ast.Return() if formula.gives:
                lines += [f"*to_{name} = {name};" for name in formula.gives]
            case ast.Return():
                lines.append(f"{text};")
    return lines


def function_text(formula: Formula) -> str:
    """Return a function in C, of numbers and of the places of its results, if it has names for
    them."""
    parameters = [f"double {name}" for name in formula.takes]
    parameters += [f"double *to_{name}" for name in formula.gives]
    kind = "void" if formula.gives else "double"
    head = f"INLINE {kind} {formula.name}({', '.join(parameters)})\n{{"
    return "\n    ".join([head, *statements(formula)]) + "\n}"


def loop_text(formula: Formula) -> str:
    """Return the loop of a function over a strip, whose quantities are columns and rows."""
    operands = [f"in[AT_{n}][i]" if n in COLUMNS else f"row[AT_{n}][i]" for n in formula.takes]
    operands += [f"&row[AT_{name}][i]" for name in formula.gives]
    head = f"CLONES void each_{formula.name}(const double *const *in, ROW *row)"
    return f"{head}\n{{\n    EACH {formula.tree.name}({', '.join(operands)});\n}}"


def header() -> str:
    """Return the text of ``formulas.h``: constants, functions, loops and the table of loops."""
    constants = [line for line in SOURCE.body if isinstance(line, ast.Assign)]
    rows = ", ".join(f"AT_{name}" for name in ROWS)
    bits = " ".join(f"double {bit.name};" for bit in Status)
    values = ", ".join(f"{bit:d}" for bit in Status)
    table = ", ".join(f"each_{name}" for name in COMPILED)
    parts = [
        f"#define PIVOT ({PIVOT})",
        f"enum {{ {rows}, ROWS, COLUMNS = {len(COLUMNS)} }};",
        *(f"#define {ast.unparse(x.targets[0])} ({ast.unparse(x.value)})" for x in constants),
        f"static const struct {{{bits}}} Status = {{{values}}};",
        *map(function_text, FUNCTIONS.values()),
        *map(loop_text, COMPILED.values()),
        f"static void (*const loops[])(const double *const *, ROW *) = {{{table}}};",
    ]
    return "\n\n".join(parts) + "\n"


def digest() -> str:
    """Return a digest of the header: a library that has it was built from these formulas."""
    return hashlib.sha256(header().encode()).hexdigest()[:16]


if __name__ == "__main__":
    print(f'/* printed by translate.py */\n\n#define FORMULAS "{digest()}"\n\n{header()}', end="")
