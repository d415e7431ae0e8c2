"""Print the steps of the 1988 listing as C: python -m impact88.program.generate

The package is built with this header, which `applesoft.c` includes. What each step does is a macro
there, which the interpreter of steps uses, too, so that both give the same bits. Runs without
numpy, from a source tree.
"""

from __future__ import annotations

from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path

from ..apple.applesoft import decimaltext
from ..names import SCENE
from .compiler import OPERATIONS, Steps, compile_program, program_lines

BEFORE = ("XA", "YA", "XB", "YB")
"""Variables of line 340, kept at line 350, that lines 700 and 710 use again."""

_JUMPS = {
    "UNLESS": "if (!t[0].e) goto at{a};",
    "GOTO": "goto at{a};",
    "GOSUB": "call(its, {k}); goto at{a}; after{k}:;",
    "RETURN": "switch (returned(its)) {{ {GOSUB} }} return;",
    "FOR": "loop(its, {a}, {k}, t[0]); after{k}:;",
    "NEXT": "switch (next(its, {a})) {{ {FOR} }}",
    "END": "return;",
}
"""The operations that decide which step follows."""


def compile_listing(text: str) -> Steps:
    """Return the steps of the 1988 listing from the text of ``impact.bas``."""
    return compile_program(program_lines(text), SCENE, {350: BEFORE})


def digest(program: Steps) -> str:
    """Return the text that tells for which steps `applesoft.c` was compiled."""
    return sha256(repr((program, OPERATIONS)).encode()).hexdigest()[:16]


def print_c(program: Steps) -> str:
    """Return the header of `applesoft.c` for a program."""
    counts = ((name, *count) for name, count in OPERATIONS.items() if name not in _JUMPS)
    plain = " ".join(f"DO({name}, {pops}, {pushes})" for name, pops, pushes in counts)
    constants = (decimaltext.read(text)[0] for text in program.constants)
    reals = ", ".join(f"{{0x{m:X}, {e}, {s}}}" for e, m, s in constants)
    rows = (
        f'#define LISTING "{digest(program)}"',
        f"enum operation {{ {', '.join(OPERATIONS)} }};",
        f"#define EACH_PLAIN_STEP(DO) {plain}",
        "CALLED void listing(run *its, const program *p, const char *const *input)",
        "{",
        f"static const real constants[] = {{{reals}}};",
        "real stack[STACK];",
        "#undef OP\n#define OP(f) called_##f",
        *_statements(program.steps),
        "}\n",
    )
    return "\n".join(rows)


def _statements(steps: list[tuple[str, int]]) -> Iterator[str]:
    """Yield the C of each step. Before the first loop operations are called, then inlined."""
    targets = {number for name, number in steps if name in ("GOTO", "GOSUB", "UNLESS")}
    first_loop = next(k for k, (name, _) in enumerate(steps) if name == "FOR")
    returns = {
        jump: " ".join(
            f"case {k}: goto after{k};" for k, (name, _) in enumerate(steps) if name == jump
        )
        for jump in ("GOSUB", "FOR")
    }
    depth = 0
    for k, (name, number) in enumerate(steps):
        pops, pushes = OPERATIONS[name]
        depth -= pops
        label = f"at{k}:;" if k in targets else ""
        step = _JUMPS.get(name, f"DO_{name};").format(a=number, k=k, **returns)
        if k == first_loop:
            yield "#undef OP\n#define OP(f) f"
        yield f"{label} {{ enum {{ a = {number} }}; real *const t = stack + {depth}; {step} }}"
        depth += pushes


if __name__ == "__main__":
    source = Path(__file__).parents[3] / "legacy" / "impact.bas"
    print(print_c(compile_listing(source.read_text("ascii"))), end="")
