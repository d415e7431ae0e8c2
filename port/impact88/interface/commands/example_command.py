"""Section VII of the chapter, computed: a 90° front-to-side collision reconstructed from estimated
final velocities, by momentum, by Equation 19, and its coefficients estimated. What the chapter
prints stands beside each number. Units: ft, s, slug.

examples:
  impact88 chapter example
  impact88 chapter example --json

exit status: 0 all printed numbers reproduced; 1 not all
"""

from dataclasses import asdict

from ...casework.chapter.example import steps
from ...messages.plaintable import format_fixed, paragraph, table
from . import options

ARGUMENTS = (options.JSON, options.OUTPUT)


def main(args: options.Args) -> int:
    numbers = [number for step in steps() for number in step.numbers]
    rows = [
        {**asdict(step), "numbers": [asdict(n) | {"agrees": n.agrees} for n in step.numbers]}
        for step in steps()
    ]
    options.show(args, "example", lambda: {"steps": rows}, _lines)
    return int(any(number.agrees is False for number in numbers))


def _lines() -> list[str]:
    verdicts = {None: "", True: "agrees", False: "DIFFERS"}
    lines = ["Section VII: a reconstruction, step by step", ""]
    for at, step in enumerate(steps()):
        rows = [
            [
                "  " + n.name.split()[0],
                format_fixed(n.value, 3),
                n.unit,
                n.printed or "",
                verdicts[n.agrees],
                n.meaning,
            ]
            for n in step.numbers
        ]
        lines += [
            *paragraph(f"{at}. {step.title} ({step.equation})"),
            *table(rows, ["  name", "value", "unit", "chapter", "", ""], left=(0, 2, 4, 5)),
            *(paragraph(step.remark, "  ") if step.remark else []),
            "",
        ]
    return lines[:-1]
