"""Print the functions of `formulas` as C, each with a loop over a strip of scenes.

It is run when the package is built: ``python -m impact88.mechanics.translate`` writes to standard
output what `machine.c` includes as ``formulas.h``. Expressions are C as they are written (`where`
is a macro there) and keep the order of their operations, so that the compiled library has numpy's
bits.
"""

import ast
import hashlib

from .plan import COLUMNS, COMPILED, FUNCTIONS, ROWS, SOURCE, Formula


def assignment(name: str, value: ast.expr, variables: set[str]) -> str:
    """Return the assignment of a value in C, with a type where the name is new."""
    operator = getattr(value, "op", value)
    is_condition = isinstance(operator, ast.Compare | ast.BitAnd | ast.BitOr)
    kind = "" if name in variables else "int64_t " if is_condition else "double "
    variables.add(name)
    return f"{kind}{name} = {ast.unparse(value)};"


def statements(formula: Formula) -> list[str]:
    """Return a function's assignments in C; a name that is assigned again keeps its variable."""
    lines: list[str] = []
    variables = set(formula.takes)
    for line in formula.tree.body:
        match line:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                lines.append(assignment(name, value, variables))
            case ast.Assign(targets=[ast.Tuple(elts=targets)], value=ast.Tuple(elts=values)):
                for target, value in zip(targets, values, strict=True):
                    lines.append(assignment(ast.unparse(target), value, variables))
            case ast.Assign(targets=[ast.Tuple(elts=targets)], value=ast.Call() as call):
                names = [ast.unparse(target) for target in targets]
                places = ", ".join(f"&{name}" for name in names)
                lines.append(f"double {', '.join(names)};")
                lines.append(f"{ast.unparse(call).removesuffix(')')}, {places});")
    return lines


def function_text(formula: Formula) -> str:
    """Return a function in C, of numbers and of the places of its results."""
    parameters = [f"double {name}" for name in formula.takes]
    parameters += [f"double *to_{name}" for name in formula.gives]
    body = [*statements(formula), *(f"*to_{name} = {name};" for name in formula.gives)]
    head = f"INLINE void {formula.name}({', '.join(parameters)})\n{{"
    return "\n    ".join([head, *body]) + "\n}"


def loop_text(formula: Formula) -> str:
    """Return the loop of a function over a strip, whose quantities are columns and rows."""
    places = {n: f"in[{k}][i]" if n in COLUMNS else f"row[{k}][i]" for n, k in ROWS.items()}
    operands = [places[name] for name in formula.takes]
    operands += [f"&{places[name]}" for name in formula.gives]
    call = f"EACH {formula.name}({', '.join(operands)});"
    return f"CLONES void each_{formula.name}(const double *const *in, ROW *row)\n{{\n    {call}\n}}"


def header() -> str:
    """Return the text of ``formulas.h``: constants, functions, loops and the table of loops."""
    constants = [line for line in SOURCE.body if isinstance(line, ast.Assign)]
    table = ", ".join(f"each_{name}" for name in COMPILED)
    parts = [
        f'#define FORMULAS "{digest()}"',
        *(f"#define {ast.unparse(x.targets[0])} ({ast.unparse(x.value)})" for x in constants),
        f"#define COLUMNS {len(COLUMNS)}",
        f"#define ROWS {len(ROWS)}",
        f"#define AT_MU {ROWS['MU']}",
        *map(function_text, FUNCTIONS.values()),
        *map(loop_text, COMPILED.values()),
        f"static void (*const loops[])(const double *const *, ROW *) = {{{table}}};",
    ]
    return "/* printed by translate.py */\n\n" + "\n\n".join(parts) + "\n"


def digest() -> str:
    """Return a digest of the functions: a library that has it was built from these."""
    return hashlib.sha256((ast.unparse(SOURCE) + str(ROWS)).encode()).hexdigest()[:16]


if __name__ == "__main__":
    print(header(), end="")
