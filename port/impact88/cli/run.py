"""impact88 run --sample 1                        the Appendix's first sample run
impact88 run crash.toml --set MU=.5            a scene file, one value changed
impact88 run                                   the listing's data; it asks for the velocities
impact88 run crash.toml --arithmetic float64   in double precision
impact88 run --sample 1 --json                 every variable with its five stored bytes
impact88 run --sample 1 --listing office.bas   another copy of the listing

Runs the 1988 program and prints what an Apple II Plus prints. Without a scene it asks at the
terminal, or reads two lines of three numbers from standard input.

exit status: 0 the program ended (also with ZERO DETERMINANT), 1 an Applesoft error, 2 bad input"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from itertools import chain, repeat

from ..apple.applesoft.console import PRINTER_SLOT, Console, EndOfInput
from ..errors import UserError, note
from ..files import replacing, typed_line
from ..names import SCENE, VELOCITIES
from ..program.run import Run, page, start
from ..program.scene import Scene, published_data, sample
from . import options
from .output import print_json, say

MAX_REPLIES = 10_000  # the program asks twice, and again for each reply it refuses
ARITHMETICS = ("applesoft", "float64")


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    options.add_case(parser)
    parser.add_argument(
        "--arithmetic",
        choices=ARITHMETICS,
        default="applesoft",
        help="the numbers to compute with (default: %(default)s)",
    )
    parser.add_argument(
        "--listing",
        type=options.InputPath,
        metavar="FILE.bas",
        help="run another copy of the listing, in the emulator",
    )
    options.add_json(parser)
    options.add_output(parser)
    add_devices(parser)


def add_devices(parser: options.Parser) -> None:
    """Add the options for what is plugged into the Apple."""
    parser.add_argument(
        "--no-dos",
        action="store_true",
        help="no disk system: lines that begin with control-D are shown",
    )
    parser.add_argument(
        "--slot",
        type=int,
        choices=range(8),
        default=0,
        metavar="N",
        help="output slot of line 190: 0 the screen, 1 the printer",
    )
    parser.add_argument(
        "--printer",
        type=options.OutputPath,
        metavar="FILE",
        help="where the printer's output goes (default: stdout)",
    )
    parser.add_argument("--raw", action="store_true", help="print control characters, too")


def check_slot(args: options.Args) -> None:
    """Raise UserError for a slot with nothing in it."""
    if args.slot not in (0, PRINTER_SLOT) and not args.no_dos:
        raise UserError(
            f"slot {args.slot} is empty; expected 0 (the screen) or {PRINTER_SLOT} (the printer), "
            "or --no-dos"
        )


def main(args: options.Args) -> int:
    """Run the program."""
    check_slot(args)
    data, source = _data(args)
    velocities = [name for name in VELOCITIES if name in data]
    is_complete = bool(args.file or args.sample or velocities)
    if is_complete and not args.file and len(velocities) < len(VELOCITIES):
        absent = " ".join(name for name in VELOCITIES if name not in data)
        raise UserError(f"{absent} not given; expected all six velocities, or none to be asked for")
    scene = Scene(data if is_complete else {**dict.fromkeys(VELOCITIES, "0"), **data}, None, source)
    scene.check_typed()
    if args.listing:
        record = _run_copy(args, scene if is_complete else None)
    else:
        record = _run_port(args, scene, scene.keyboard() if is_complete else None)
    if args.json:
        print_json("run", {**record._asdict(), "floats": record.floats})
    elif args.listing:
        sys.stdout.write(record.printout if args.raw else record.page)
    elif record.error and sys.stdout.isatty():
        print()  # the ROM leaves the cursor behind the message
    return int(bool(record.error))


def _data(args: options.Args) -> tuple[Mapping[str, str], str]:
    """Return the values to type, and the name of their source in messages."""
    if not (args.file or args.set or args.units or args.axes or args.headings):
        if args.sample:  # the published texts: no case need be read
            return sample(args.sample), f"sample {args.sample}"
        return published_data(), "the listing"
    if args.file or args.sample:
        case = options.case_of(args)
    else:
        case = options.changed(options.published_case(published_data(), "the listing", args), args)
    say("run", case.remarks)
    if args.file and not {*SCENE} <= {*case.texts}:
        from ..report.answers import ask, scene_case

        absent = [name for name in SCENE if name not in case.texts]
        case = scene_case(ask(case))
        note("run", f"as impact88 solve finds them: {' '.join(absent)}")
    if case.omitted:
        typed = [n if case.texts[n] == "0" else f"{n} (1: it divides)" for n in case.omitted]
        note("run", f"0 is typed for what is not given: {' '.join(typed)}")
    return case.texts, case.source


def _run_port(args: options.Args, data: Mapping[str, str], typed: Sequence[str] | None) -> Run:
    """Run the program; without what is ``typed`` it asks standard input."""
    output: list[str] = []
    is_asking = args.json and typed is None and sys.stdin.isatty()

    def show(text: str) -> None:
        if args.json:
            output.append(text)
            if is_asking:  # the person at the terminal sees the prompts
                print(text, end="", file=sys.stderr, flush=True)
        else:
            sys.stdout.write(text if args.raw else page(text))

    with ExitStack() as stack:
        printer = stack.enter_context(replacing(args.printer)).write if args.printer else None
        replies = _typed_lines() if typed is None else chain(typed, repeat(None))
        echo = typed is not None or args.json or not sys.stdin.isatty()
        console = Console(replies.__next__, show, printer, dos=not args.no_dos, echo=echo)
        try:
            record = start(data, console, args.arithmetic, str(args.slot))
        except EndOfInput:
            if not args.json:
                print(flush=True)
            raise UserError(
                "the input ended at a prompt; expected two lines of three numbers: "
                f"{','.join(VELOCITIES[:3])} and {','.join(VELOCITIES[3:])}"
            ) from None
    return record._replace(printout="".join(output))


def _run_copy(args: options.Args, scene: Scene | None) -> Run:
    """Run a copy of the listing on a scene, in the emulator."""
    from ..program.copies import ListingCopy

    if scene is None:
        raise UserError("--listing runs on a scene; expected a FILE.toml or --sample")
    if args.arithmetic != "applesoft":
        raise UserError("--listing runs in the emulator; expected --arithmetic applesoft")
    copy = ListingCopy(args.listing)
    copy.check_variables()
    return copy.run(scene, dos=not args.no_dos)


def _typed_lines() -> Iterator[str | None]:
    """Yield lines of standard input. Raises UserError for a program that never stops typing."""
    for _ in range(MAX_REPLIES):
        yield typed_line()
    raise UserError(f"the program refused {MAX_REPLIES:,} replies; expected numbers")
