"""impact88 run --sample 1                        the Appendix's first sample run
impact88 run crash.toml --set MU=.5            a scene file, one value changed
impact88 run                                   the listing's data; it asks for the velocities
impact88 run crash.toml --arithmetic float64   in double precision
impact88 run --sample 1 --json                 every variable with its five stored bytes

Runs the 1988 program and prints what an Apple II Plus prints. Without a scene it asks at the
terminal, or reads two lines of three numbers from standard input.

exit status: 0 the program ended (also with ZERO DETERMINANT), 1 an Applesoft error, 2 bad input"""

from __future__ import annotations

import sys

from ..apple.applesoft.console import Console, EndOfInput
from ..decimals import to_text
from ..errors import UserError, note
from ..files import typed_line
from ..names import SCENE, VELOCITIES
from ..program.run import Run, page, run, start
from ..program.scene import Scene, published_data, sample
from .options import CASE, JSON, OUTPUT, Args, case_of, choice
from .output import say, show

OPTIONS = (
    *CASE,
    choice("--arithmetic", ("applesoft", "float64"), "the numbers to compute with"),
    JSON,
    OUTPUT,
)


def main(args: Args) -> bool:
    """Run the program."""
    arithmetic = args.arithmetic or "applesoft"
    if args.file or args.sample or args.set or args.json:
        record = run(_scene(args), arithmetic)
        if args.json:
            show(args, "run", {**record._asdict(), "floats": record.floats}, ())
        else:
            sys.stdout.write(record.page)
    else:
        record = _ask(arithmetic)
    if record.error and sys.stdout.isatty():
        print()  # the ROM leaves the cursor after the message
    return bool(record.error)


def _scene(args: Args) -> Scene:
    """Return the scene to type; what it lacks is that of the answer to the case."""
    if args.sample and not (args.file or args.set):  # no case need be read
        return sample(int(args.sample))
    case = case_of(args)
    say("run", case.remarks)
    texts = {name: text for name, text in case.texts.items() if name in SCENE}
    found: list[str] = []
    if not SCENE.keys() <= texts.keys():
        from ..report.answers import ask

        impact = ask(case).scene
        if not impact:
            raise UserError("no impact was found, so there is none to run; see solve", case.source)
        given = texts.keys() - {*case.ranges}  # what has limits is as the impact has it
        found = [name for name in SCENE if name in impact and name not in given]
        texts |= {name: to_text(impact[name]) for name in found}
    scene = Scene(texts, None, case.source)
    if found:
        note("run", f"as impact88 solve finds them: {' '.join(found)}")
    if typed := [f"{n} = {case.texts[n]}" for n in case.texts if n not in case.numbers]:
        note("run", f"typed for what is not given: {', '.join(typed)}")
    return scene


def _ask(arithmetic: str) -> Run:
    """Run the program on the listing's data, with the velocities from standard input."""
    echo = not sys.stdin.isatty()
    console = Console(typed_line, lambda text: sys.stdout.write(page(text)), echo=echo)
    try:
        return start(published_data(), console, arithmetic)
    except EndOfInput:
        print(flush=True)
        raise UserError(
            "the input ended at a prompt; expected two lines of three numbers: "
            f"{','.join(VELOCITIES[:3])} and {','.join(VELOCITIES[3:])}"
        ) from None
