"""impact88 oracle scenes.jsonl -o answers.jsonl    all that is computed of each scene
echo '{"id": 1, "scene": {"E": ".1", ...}}' | impact88 oracle
impact88 oracle --kit kit                        1,000 frozen test vectors with 30 digits, starter
                                                 programs and hashes in a folder

Answers each line {"id": ..., "scene": {"MA": 143.5, ...}} with one: the printout; each result as
Applesoft prints and stores it, in double precision and to 30 digits; what rounding may change in
it; condition and warnings. A line that cannot be used is answered with what is wrong. `impact88
compare --kit ID` judges the answers of another program to the vectors. Needs pip install
'.[oracle]' in the checkout.

exit status: 0 every line answered; 1 some could not be used; 2 no usable input"""

from __future__ import annotations

from ..errors import UserError, library
from ..files import open_bytes
from .options import OUTPUT, Args, input_file, option
from .output import to_json

OPTIONS = (
    input_file(
        "scenes",
        "SCENES.jsonl",
        "scenes, one JSON object a line (default: standard input)",
        nargs="?",
        default="-",
    ),
    option("--kit", metavar="FOLDER", help="write the kit into a folder"),
    OUTPUT,
)


def main(args: Args) -> bool:
    """Answer scenes, or write the kit."""
    if args.kit:
        from ..comparison.kit import write_kit

        print("\n".join(write_kit(args.kit)))
        return False
    from ..comparison.oracle import answer_lines

    library("mpmath", "oracle", "the reference of 30 digits")
    failed = set()  # whether a line could not be used
    with open_bytes(args.scenes) as file:
        lines = (line.decode("utf-8-sig", "replace") for line in file)
        for answer in answer_lines(lines):
            failed.add("error" in answer)
            print(to_json(answer), flush=True)  # a program may ask line by line
    if False not in failed:
        raise UserError('no line can be used; expected lines such as {"id": 1, "scene": {...}}')
    return True in failed
