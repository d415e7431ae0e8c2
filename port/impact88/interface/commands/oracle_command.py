"""Reads JSON Lines {"id": ..., "scene": {"MA": 143.5, ...}} from a file or standard input, numbers
or decimal strings, and answers each line with one: the printout; each result as Applesoft prints
and stores it (text, five bytes, exact decimal), in double precision, to 30 digits; condition, error
bound, STATUS. A line that cannot be used is answered with its number and what is wrong. A scene may
have "units" and amounts with units ("30 mph"); the program is given base units, and so it answers:
"units" in the answer names them.

With --vectors it writes labelled test vectors instead: casework, edge and failure in turn, or one
class. These are the frozen set of this version, at once and without an extra; its id, which is said
on standard error and in a kit, never changes its answers, and golden/README gives its hash, so that
two firms can name the same test. With --seed they are fresh ones, the same on any machine for the
same seed, whose 30 digits need the extra oracle. --validation answers the crash tests of impact88
chapter staged --validation, with what was published of them.

Form: impact88 schema oracle, impact88 schema vectors. Conventions (axes, signs, units, byte order,
bounds, what each class means, and that a program that refuses a failure is right): impact88 schema
conventions.

examples:
  impact88 oracle scenes.jsonl -o answers.jsonl
  echo '{"id": 1, "scene": {"E": 0.1, ...}}' | impact88 oracle
  impact88 oracle --vectors -o vectors.jsonl
  impact88 oracle --vectors 100 --class failure
  impact88 oracle --vectors 5000 --seed 7 -o vectors.jsonl
  impact88 oracle --vectors --to csv | their-program | impact88 compare -
  impact88 oracle --kit kit          then impact88 compare --kit kit theirs.csv

exit status: 0 every line was answered; 1 some lines could not be used; 2 no usable input at all
"""

import codecs
import sys
from collections.abc import Iterable, Iterator
from typing import Any

from ...conformance.comparison import kit, vectors
from ...conformance.comparison.oracle import BATCH, answer, published_tests
from ...errors import UserError, note
from ...files import LONGEST_LINE, display_name, encoding_of, open_bytes
from ...messages.progress import progress
from . import options

ARGUMENTS = (
    options.reads("scenes", "SCENES.jsonl", "", nargs="?", default="-"),
    options.OUTPUT,
    options.flag("--no-reference", "leave out the 30 digits"),
    options.count(
        "--vectors",
        1,
        10**7,
        f"write N test vectors (default: all {vectors.FROZEN_COUNT:,} of the frozen set)",
        nargs="?",
        const=vectors.FROZEN_COUNT,
    ),
    options.count("--seed", 0, 2**63, "make fresh vectors, by this random seed", metavar="S"),
    options.choice("--class", vectors.CLASSES, "vectors of this class only", dest="only"),
    options.choice("--to", ("jsonl", "csv"), "csv: the scenes of --vectors as a flat table"),
    options.writes(
        "--kit",
        "DIR",
        "write vectors, conventions, a README and programs that answer them, in C, in Python and "
        "as a spreadsheet, into a folder or one archive (KIT.zip); the frozen set, unless "
        "--vectors or --seed say otherwise",
    ),
    options.flag(
        "--validation",
        "answer the 25 published crash tests, each with its source and the numbers reported there",
    ),
    options.UNITS,
)


def main(args: options.Args) -> int:
    makes_vectors = args.vectors is not None
    is_fresh = args.seed is not None
    if args.validation and (makes_vectors or args.only or is_fresh or args.kit):
        raise UserError("--validation are published tests; expected no vectors beside it")
    if (makes_vectors or args.validation) and args.scenes != "-":
        raise UserError("vectors have their own scenes; expected no file beside them")
    for option, value in (("--class", args.only), ("--to", args.to)):
        if value and not makes_vectors:
            raise UserError(f"{option} is for test vectors; expected --vectors with it")
    if is_fresh and not makes_vectors and args.kit is None:
        raise UserError("--seed is for test vectors; expected --vectors N or --kit with it")
    if makes_vectors and not is_fresh and args.vectors > vectors.FROZEN_COUNT:
        says = f"the frozen set has {vectors.FROZEN_COUNT:,} vectors, not {args.vectors:,}"
        raise UserError(f"{says}; expected --seed S for fresh ones")
    if args.kit is not None:
        count = args.vectors or vectors.FROZEN_COUNT
        print("\n".join(kit.write_kit(args.kit, count, args.seed, not args.no_reference)))
        return 0
    reference = not args.no_reference
    to = args.to or ("csv" if (args.output or "").lower().endswith(".csv") else "jsonl")
    if makes_vectors and not is_fresh:
        rows = vectors.frozen(args.vectors, args.only)
        note("oracle", f"vectors of the frozen set {vectors.FROZEN_ID}")
        lines = kit.csv_lines(rows) if to == "csv" else map(_line, rows)
        sys.stdout.writelines(lines)
        return 0
    if makes_vectors and to == "csv":
        kit_vectors = vectors.vectors(args.vectors, args.seed, False, args.only)
        sys.stdout.writelines(kit.csv_lines(kit_vectors))
        return 0
    batches: Iterable[Iterator[dict[str, Any]]]
    if args.validation:
        batches = [published_tests(reference)]
    elif makes_vectors:
        batches = [vectors.vectors(args.vectors, args.seed, reference, args.only)]
    else:
        batches = (answer(batch, reference, args.units) for batch in _batches(args.scenes))
    total = refusals = 0
    with progress(args.vectors, "oracle") as meter:
        for answers in batches:
            for line in answers:
                total += 1
                refusals += "error" in line
                sys.stdout.write(_line(line))
                meter.update(1)
            sys.stdout.flush()
    if refusals == total:
        empty_message = 'nothing to answer; expected lines such as {"id": 1, "scene": {...}}'
        raise UserError(
            f"no line could be used ({refusals} refused)" if refusals else empty_message
        )
    return int(refusals > 0)


def _line(entry: dict[str, Any]) -> str:
    return options.json_text(entry) + "\n"


def _batches(path: str) -> Iterator[list[tuple[int, str]]]:
    """The lines that have arrived, some at a time: a program that asks line by line over a pipe
    is answered line by line, a file in larger batches."""
    number, partial_line = 0, ""
    with open_bytes(path) as source:
        encoding = encoding_of(source.peek(3)[:3])
        name = "utf-8-sig" if encoding == "utf-8" else encoding
        decoder = codecs.getincrementaldecoder(name)("replace")
        while True:
            data = source.read1(1 << 16)
            lines = (partial_line + decoder.decode(data, not data)).split("\n")
            partial_line = lines.pop() if data else ""
            if len(partial_line) > LONGEST_LINE:
                raise UserError(
                    f"line {number + len(lines) + 1} is longer than {LONGEST_LINE:,} "
                    "characters; expected one JSON object a line",
                    display_name(path),
                )
            numbered_lines = enumerate(map(str.strip, lines), number + 1)
            batch = [(at, text) for at, text in numbered_lines if text]
            number += len(lines)
            for at in range(0, len(batch), BATCH):
                yield batch[at : at + BATCH]
            if not data:
                return
