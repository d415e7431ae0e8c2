"""impact88 oracle scenes.jsonl -o answers.jsonl    all that is computed of each scene
echo '{"id": 1, "scene": {"E": ".1", ...}}' | impact88 oracle
impact88 oracle --vectors -o vectors.jsonl       1,000 frozen test vectors with 30 digits
impact88 oracle --kit kit                        vectors, starter programs and hashes in a folder

Answers each line {"id": ..., "scene": {"MA": 143.5, ...}} with one: the printout; each result as
Applesoft prints and stores it, in double precision and to 30 digits; what rounding may change in
it; condition and warnings. A line that cannot be used is answered with what is wrong. The 30 digits
need pip install 'impact88[oracle]'; --no-reference leaves them out. `impact88 compare --kit ID`
judges the answers of another program to the vectors.

exit status: 0 every line answered; 1 some could not be used; 2 no usable input"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator

from ..errors import UserError, note
from ..files import LONGEST_LINE, display_name, open_bytes
from . import options
from .output import plain, progress


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "scenes",
        nargs="?",
        default=options.InputPath("-"),
        type=options.InputPath,
        metavar="SCENES.jsonl",
        help="scenes, one JSON object a line (default: standard input)",
    )
    parser.add_argument("--no-reference", action="store_true", help="leave the 30 digits out")
    parser.add_argument("--vectors", action="store_true", help="write the frozen vectors")
    parser.add_argument("--to", choices=("jsonl", "csv"), default="jsonl", help="their format")
    parser.add_argument("--kit", metavar="FOLDER", help="write the kit into a folder")
    options.add_output(parser)


def main(args: options.Args) -> int:
    """Answer scenes, or write vectors."""
    from ..comparison import kit

    if args.kit:
        print("\n".join(kit.write_kit(args.kit)))
        return 0
    if args.vectors:
        note("oracle", f"vectors of the frozen set {kit.FROZEN_ID}")
        if args.to == "csv":
            sys.stdout.write(kit.vectors_csv())
        else:
            sys.stdout.writelines(_line(vector) for vector in kit.frozen_vectors())
        return 0
    from ..comparison.oracle import answer_lines

    answered = refused = 0
    with progress("oracle") as meter:
        for answer in answer_lines(_lines(args.scenes), not args.no_reference):
            refused += "error" in answer
            answered += "error" not in answer
            sys.stdout.write(_line(answer))
            sys.stdout.flush()  # a program may ask line by line
            meter.update(answered)
    if not answered:
        expected = 'expected lines such as {"id": 1, "scene": {...}}'
        raise UserError(f"no line can be used; {expected}", display_name(args.scenes))
    return int(refused > 0)


def _line(record: object) -> str:
    return json.dumps(plain(record)) + "\n"


def _lines(path: str) -> Iterator[str]:
    """Yield the lines of a file as they arrive."""
    with open_bytes(path) as file:
        while data := file.readline(LONGEST_LINE + 1):
            if len(data) > LONGEST_LINE:
                raise UserError(f"has a line longer than {LONGEST_LINE:,} bytes", path)
            yield data.decode("utf-8-sig", "replace")
