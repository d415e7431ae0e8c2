"""Print the functions of `formulas` as C, each a loop over a strip of scenes.

It is run when the package is built: ``python -m impact88.mechanics.translate`` writes to standard
output what `machine.c` includes as ``formulas.h``. Every operation keeps its place and gets
brackets, so that the compiled library has numpy's bits.
"""

import ast
import hashlib
from functools import cache

from .plan import COLUMNS, COMPILED, FUNCTIONS, HELPERS, ROWS, SOURCE, Formula

SYMBOLS: dict[type[ast.AST], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.BitAnd: "&",
    ast.BitOr: "|",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
    ast.USub: "-",
    ast.Invert: "!",
}


def _constants() -> dict[str, float]:
    """Return the constants that `formulas` defines, by name."""
    values: dict[str, float] = {}
    for line in SOURCE.body:
        if isinstance(line, ast.Assign) and isinstance(line.targets[0], ast.Name):
            text = ast.unparse(line.value)
            values[line.targets[0].id] = eval(text, {"float": float})
    return values


CONSTANTS = _constants()


def expression(tree: ast.expr) -> str:
    """Return an expression in C. Raises TypeError for what formulas may not contain."""
    match tree:
        case ast.Constant(value=float() | int() as number):
            return repr(float(number))
        case ast.Name(id=name) if name in CONSTANTS:
            value = CONSTANTS[name]
            return "INFINITY" if value == float("inf") else f"({value!r})"
        case ast.Name(id=name):
            return name
        case ast.BinOp(left=left, op=operator, right=right):
            return f"({expression(left)} {SYMBOLS[type(operator)]} {expression(right)})"
        case ast.UnaryOp(op=operator, operand=operand):
            return f"({SYMBOLS[type(operator)]}{expression(operand)})"
        case ast.Compare(left=left, ops=[operator], comparators=[right]):
            return f"({expression(left)} {SYMBOLS[type(operator)]} {expression(right)})"
        case ast.Call(func=ast.Name(id="where"), args=[condition, yes, no]):
            return f"({expression(condition)} ? {expression(yes)} : {expression(no)})"
        case ast.Call(func=ast.Name(id="fabs" | "sqrt" as name), args=[operand]):
            return f"{name}({expression(operand)})"
    raise TypeError(f"no C for {ast.unparse(tree)}")


def is_condition(tree: ast.expr) -> bool:
    """Return whether an expression is true or false."""
    inner = tree.operand if isinstance(tree, ast.UnaryOp) else tree
    return isinstance(inner, ast.Compare) or (
        isinstance(inner, ast.BinOp) and isinstance(inner.op, ast.BitAnd | ast.BitOr)
    )


def statements(formula: Formula) -> list[str]:
    """Return a function's assignments in C; a name that is assigned again keeps its variable."""
    lines: list[str] = []
    declared = set(formula.takes)

    def assign(name: str, value: ast.expr) -> None:
        kind = "int64_t " if is_condition(value) else "double "
        lines.append(f"{'' if name in declared else kind}{name} = {expression(value)};")
        declared.add(name)

    for line in formula.tree.body:
        match line:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                assign(name, value)
            case ast.Assign(targets=[ast.Tuple(elts=targets)], value=ast.Tuple(elts=values)):
                for target, value in zip(targets, values, strict=True):
                    assign(ast.unparse(target), value)
            case ast.Assign(
                targets=[ast.Tuple(elts=targets)], value=ast.Call(func=helper, args=[operand])
            ):
                names = [ast.unparse(target) for target in targets]
                declared.update(names)
                lines += [f"double {name};" for name in names]
                places = ", ".join(f"&{name}" for name in names)
                lines.append(f"{ast.unparse(helper)}({expression(operand)}, {places});")
            case ast.Expr(value=ast.Constant()) | ast.Return():
                pass
            case _:
                raise TypeError(f"{formula.name}: no C for {ast.unparse(line)}")
    return lines


def place(name: str) -> str:
    """Return the place of a quantity: in a column, or in a row of the strip."""
    number = ROWS[name]
    return f"in[{number}][i]" if name in COLUMNS else f"row[{number - len(COLUMNS)}][i]"


def helper_text(formula: Formula) -> str:
    """Return a helper as a C function of one number."""
    outputs = ", ".join(f"double *to_{name}" for name in formula.gives)
    head = f"static inline void {formula.name}(double {formula.takes[0]}, {outputs})"
    body = [*statements(formula), *(f"*to_{name} = {name};" for name in formula.gives)]
    return "\n    ".join([f"{head}\n{{", *body]) + "\n}"


def formula_text(formula: Formula) -> str:
    """Return a formula as a C loop over a strip."""
    body = [f"double {name} = {place(name)};" for name in formula.takes]
    body += [*statements(formula), *(f"{place(name)} = {name};" for name in formula.gives)]
    head = f"CLONES void {formula.name}(const double *const *in, ROW *row)\n{{\n    EACH {{"
    return "\n        ".join([head, *body]) + "\n    }\n}"


@cache
def functions() -> str:
    """Return all functions in C, and the table of the formulas."""
    table = "static void (*const functions[])(const double *const *, ROW *)"
    sizes = {"ROWS": len(ROWS) - len(COLUMNS), "COLUMNS": len(COLUMNS), "AT_MU": ROWS["MU"]}
    parts = [
        "\n".join(f"#define {name} {size}" for name, size in sizes.items()),
        *(helper_text(FUNCTIONS[name]) for name in HELPERS),
        *map(formula_text, COMPILED.values()),
        f"{table} = {{{', '.join(COMPILED)}}};",
    ]
    return "\n\n".join(parts) + "\n"


def digest() -> str:
    """Return a digest of the functions: a library that has it was built from these."""
    return hashlib.sha256(functions().encode()).hexdigest()[:16]


def header() -> str:
    """Return the text of ``formulas.h``."""
    return f'/* printed by translate.py */\n\n#define FORMULAS "{digest()}"\n{functions()}'


if __name__ == "__main__":
    print(header(), end="")
