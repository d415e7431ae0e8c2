"""With no scene this is the 1988 program: the listing's own data, and the velocities are asked for
on the terminal or read from standard input, two lines of three numbers.

examples:
  impact88 run                            prompts, as in 1988
  impact88 run --sample 1                 the Appendix's first sample run
  impact88 run crash.toml --set MU=.5     a scene file, one value changed
  impact88 run --sample 1 --arithmetic float64
  impact88 run --sample 1 --no-dos --json
  impact88 run --sample 1 --listing office.bas   another copy of the listing
  impact88 run --sample 1 --raw           control characters, too

exit status: 0 the program ended, ZERO DETERMINANT included; 1 an Applesoft error; 2 bad input
"""

import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from itertools import chain, repeat

from ...apple.applesoft.console import PRINTER_SLOT, Console, EndOfInput
from ...collision.case import OWN_NAMES, Case, check_value
from ...collision.casescene import Scene, published_data
from ...errors import UserError, note
from ...files import replacing, typed_line
from ...names import SCENE, VELOCITIES
from ...program.arithmetics import ARITHMETICS
from ...program.run import Run, page, start
from . import options

MOST_REPLIES = 10_000
"""Replies that are read: the program asks twice, and once more for each it refuses. Only a program
types as many, or twice as many."""

MACHINE = (
    options.flag("--no-dos", "no disk operating system: lines that start with control-D are shown"),
    options.value(
        "--slot",
        "N",
        "the output slot in line 190: 0 the screen, 1 the printer",
        choices=range(8),
        default=0,
        type=int,
    ),
    options.writes("--printer", "FILE", "where the printer's output goes (default: stdout)"),
    options.flag(
        "--raw", "every character as the Apple sends it: form feed, bells, NULs and control-D too"
    ),
)
"""Options for the devices plugged into the machine."""

ARGUMENTS = (
    *options.ONE_SCENE,
    options.setting("change a value of the scene"),
    options.MOVE,
    options.choice(
        "--arithmetic",
        tuple(ARITHMETICS),
        "the numbers to compute with (default: %(default)s)",
        default="applesoft",
    ),
    options.flag("--json", "print the run as one JSON object"),
    options.OUTPUT,
    *MACHINE,
    options.reads("--listing", "THEIRS.bas", "run another copy of the listing, in the emulator"),
)


def check_slot(args: options.Args) -> None:
    """Raises UserError for a slot with nothing in it."""
    if args.slot not in (0, PRINTER_SLOT) and not args.no_dos:
        raise UserError(
            f"slot {args.slot} is empty; expected 0 (the screen) or {PRINTER_SLOT} (the printer), "
            "or --no-dos"
        )


def main(args: options.Args) -> int:
    check_slot(args)
    scene = options.scene_given(args, "the program's page", may_omit=tuple(SCENE))
    if scene and scene.omitted:
        names = [n if scene[n] == "0" else f"{n} (1: it divides)" for n in scene.omitted]
        note("run", f"0 is typed for what is not given: {' '.join(names)}")
    data = dict(scene or _published_data(args))
    velocities = [name for name in VELOCITIES if name in data]
    if velocities and len(velocities) < len(VELOCITIES):
        missing = " ".join(name for name in VELOCITIES if name not in data)
        raise UserError(
            f"--set gives {' '.join(velocities)} but not {missing}; expected all six velocities, "
            "or none of them to be asked for, or a scene"
        )
    complete = scene or Scene(dict.fromkeys(VELOCITIES, "0") | data, source="--set")
    if args.listing:
        run = _run_of_copy(args, complete if velocities else None)
    else:
        complete.check_typed()
        run = _run(args, data, complete.keyboard() if velocities else None)
    if args.json:
        options.print_json("run", {**run._asdict(), "floats": run.floats})
    elif args.listing:
        sys.stdout.write(run.printout if args.raw else run.page)
    elif run.error and sys.stdout.isatty():
        print()  # the ROM leaves the cursor there; a shell's prompt wants a line of its own
    return int(bool(run.error))


def _published_data(args: options.Args) -> dict[str, str]:
    """Return the listing's own data, with what ``--set`` changes or adds."""
    data = Case({**published_data(), "units": "chapter"}, "the listing").shown_in(args.units)
    changes = options.set_pairs(args.set, (*SCENE, *OWN_NAMES))
    case = options.change_case(data, changes, "--set").at_nominal()
    options.note_remarks(case, "the program's page" if args.set else "")
    return {n: check_value(n, text, "--set") for n, text in case.values.items() if n in SCENE}


def _run(args: options.Args, data: Mapping[str, str], typed: Sequence[str] | None) -> Run:
    """Run the program on its screen; without what is ``typed`` it asks standard input."""
    output: list[str] = []
    asking = args.json and typed is None and sys.stdin.isatty()

    def show(text: str) -> None:
        if args.json:
            output.append(text)
            if asking:  # the person at the terminal sees the prompts
                print(text, end="", file=sys.stderr, flush=True)
        else:
            sys.stdout.write(text if args.raw else page(text))

    with ExitStack() as stack:
        printer = stack.enter_context(replacing(args.printer)).write if args.printer else None
        replies = _typed_lines() if typed is None else chain(typed, repeat(None))
        echo = typed is not None or args.json or not sys.stdin.isatty()
        console = Console(replies.__next__, show, printer, dos=not args.no_dos, echo=echo)
        try:
            run = start(data, console, args.arithmetic, str(args.slot))
        except EndOfInput:
            if not args.json:
                print(flush=True)
            raise UserError(
                "the input ended at a prompt; expected two lines of three numbers: "
                f"{','.join(VELOCITIES[:3])} and {','.join(VELOCITIES[3:])}"
            ) from None
    return run._replace(printout="".join(output))


def _run_of_copy(args: options.Args, scene: Scene | None) -> Run:
    """Run a copy of the listing on a scene."""
    from ...program.copies import ListingCopy

    if scene is None:
        raise UserError("--listing runs on a scene; expected a scene file or --sample")
    if args.arithmetic != "applesoft":
        raise UserError("--listing runs in the emulator; expected --arithmetic applesoft")
    copy = ListingCopy(args.listing)
    copy.check_variables()
    return copy.run(scene, dos=not args.no_dos)


def _typed_lines() -> Iterator[str | None]:
    """Lines of standard input. Raises UserError when a program that never stops writes them."""
    for _ in range(MOST_REPLIES):
        yield typed_line()
    raise UserError(f"the program refused {MOST_REPLIES:,} replies; expected numbers")
