"""Section VII of the chapter, computed: a 90° front-to-side collision reconstructed from estimated
final velocities, by momentum, by Equation 19, and its coefficients estimated. What the chapter
prints stands beside each number. Units: ft, s, slug.

examples:
  impact88 chapter example
  impact88 chapter example --json

exit status: 0 all printed numbers reproduced; 1 not all
"""

from __future__ import annotations

import argparse
import json

from ..schemas import stamped
from .options import add_json_argument, add_output_argument


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 example`."""
    add_json_argument(parser)
    add_output_argument(parser)


def main(args: argparse.Namespace) -> int:
    """Print the steps."""
    from ..chapter.example import steps

    agree = all(number.agrees is not False for step in steps() for number in step.numbers)
    if args.json:
        from dataclasses import asdict

        whole = [
            {**asdict(step), "numbers": [asdict(n) | {"agrees": n.agrees} for n in step.numbers]}
            for step in steps()
        ]
        print(json.dumps(stamped("example", {"steps": whole}), allow_nan=False))
    else:
        print(_text())
    return 0 if agree else 1


def _text() -> str:
    from ..chapter.example import steps
    from ..plaintable import fixed, paragraph, table

    lines = ["Section VII: a reconstruction, step by step", ""]
    for at, step in enumerate(steps()):
        lines += paragraph(f"{at}. {step.title} ({step.equation})")
        rows = []
        for number in step.numbers:
            printed = number.printed or ""
            verdict = "" if number.agrees is None else "agrees" if number.agrees else "DIFFERS"
            rows.append(
                [
                    "  " + number.name.split()[0],
                    fixed(number.value, 3),
                    number.unit,
                    printed,
                    verdict,
                    number.meaning,
                ]
            )
        lines += table(rows, ["  name", "value", "unit", "chapter", "", ""], left=(0, 2, 4, 5))
        lines += paragraph(step.remark, "  ") if step.remark else []
        lines.append("")
    return "\n".join(lines[:-1])
