"""Runs an Apple II Plus ROM, your own, on py65, an independent 6502 emulator (extra: witness): the
restored listing is typed in at the ROM's prompt, a scene's lines are retyped, RUN. What the ROM
displays, every variable and the array are held against port, emulator and replay; a capture is
held against the ROM too. The ROM is a file of 12,288 bytes, $D000 to $FFFF; this project has none
to give.

examples:
  impact88 witness --rom apple2plus.rom
  impact88 witness --rom apple2plus.rom --captures 50 --random 50 --seed 7
  impact88 witness --rom apple2plus.rom crash.toml --json -o witness.json
  impact88 witness --rom apple2plus.rom --captures all --save again
  impact88 witness --rom apple2plus.rom --programs games   every .bas, with its replies in .in

exit status: 0 no difference; 1 a difference; 2 bad input, or a ROM that does not come to a prompt
"""

import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from ...collision.case import OWN_NAMES
from ...collision.casescene import SAMPLES, Scene, sample
from ...conformance.comparison.vectors import scenes
from ...conformance.qualification.witness import hearing
from ...conformance.qualification.witness.apple import Image, read_image
from ...conformance.qualification.witness.session import Session
from ...errors import UserError
from ...messages.progress import progress
from ...names import SCENE
from . import options

Job = Callable[[Session], hearing.Outcome]

MAX_CASES_SHOWN = 10  # cases with differences
MAX_LINES_SHOWN = 24  # lines of each: an Apple's screen

ARGUMENTS = (
    options.reads("scenes", "SCENE.toml", "scenes to run", nargs="*"),
    options.reads("--rom", "FILE", "the ROM image", required=True),
    options.sample_option("the scene of a published run; all three when nothing else is asked for"),
    options.setting("change a value of these scenes"),
    options.UNITS,
    options.value("--captures", "N", "N random packaged captures of each kind's mix, or all"),
    options.reads(
        "--programs",
        "FOLDER",
        "every .bas of a folder, its replies in a .in beside it, on the ROM and the emulator",
    ),
    options.count("--random", 0, 10**7, "N random scenes", default=0),
    options.seed(),
    options.flag("--any-rom", "accept a ROM that is not known, too"),
    options.writes("--save", "DIR", "write what the ROM did as captures"),
    options.flag("--json", "print the record as one JSON object"),
    options.OUTPUT,
)


def main(args: options.Args) -> int:
    jobs = _jobs(args)
    image = read_image(args.rom, args.any_rom)
    start = time.perf_counter()
    session = Session(image.data)
    heard = []
    with progress(len(jobs), "on the ROM", lines=True) as meter:
        for job in jobs:
            heard.append(job(session))
            meter.update(1)
    record = hearing.record(image, heard, time.perf_counter() - start)
    if args.save:
        hearing.save(args.save, heard)
    options.show(args, "witness", lambda: record, lambda: _report(image, heard, record), indent=2)
    return int(not record["passed"])


def _jobs(args: options.Args) -> list[Job]:
    """Return the jobs to run; all input is read before the machine is started."""
    jobs: list[Job] = []
    changes = options.set_pairs(args.set, (*SCENE, *OWN_NAMES))
    is_anything_asked = args.scenes or args.captures is not None or args.random or args.programs
    for number in [args.sample] if args.sample else () if is_anything_asked else SAMPLES:
        scene = Scene.of(options.change_case(sample(number).case, changes, "--set"))
        job = partial(hearing.hear_scene, name=f"sample {number}", scene=scene)
        jobs.append(job if changes else partial(hearing.hear_sample, number=number))
    for path in args.scenes:
        scene = Scene.from_toml(path, args.units).replaced(changes)
        options.note_remarks(scene)
        jobs.append(partial(hearing.hear_scene, name=path, scene=scene))
    if args.captures is not None:
        if args.captures != "all" and not args.captures.isdecimal():
            raise UserError(f"--captures {args.captures}; expected a number, or all")
        count = None if args.captures == "all" else int(args.captures)
        jobs += [partial(hearing.hear, case=case) for case in hearing.cases(count, args.seed)]
    if args.programs:
        jobs += [partial(hearing.hear, case=case) for case in hearing.own_programs(args.programs)]
    for index, (_, label, texts) in enumerate(scenes(args.random, args.seed)):
        name = f"{args.seed}-{index:06d} ({label})"
        jobs.append(partial(hearing.hear_scene, name=name, scene=Scene(texts)))
    if not jobs:
        raise UserError("nothing to do; expected --captures or --random above 0")
    return jobs


def _report(image: Image, heard: list[hearing.Outcome], record: dict[str, Any]) -> Iterator[str]:
    wrong = [case for case in heard if case.differences]
    for case in wrong[:MAX_CASES_SHOWN]:
        lines = [line for difference in case.differences for line in difference.lines()]
        yield "\n  ".join([f"{case.kind}: {case.name}", *lines[:MAX_LINES_SHOWN]])
        yield (
            f"  and {len(lines) - MAX_LINES_SHOWN} lines more\n"
            if len(lines) > MAX_LINES_SHOWN
            else ""
        )
    if len(wrong) > MAX_CASES_SHOWN:
        yield f"and {len(wrong) - MAX_CASES_SHOWN} cases more with differences\n"
    width = max(map(len, record["comparisons"]))
    for name, tally in record["comparisons"].items():
        yield f"{name:<{width}}  {tally['right']:>6} of {tally['total']:>6} without a difference"
    yield f"\nROM SHA-1         {image.sha1} ({record['rom']})"
    for name, text in record["versions"].items():
        yield f"{name:<17} {text}"
    yield f"time              {record['seconds']} s"
    yield f"result            {'NO DIFFERENCE' if record['passed'] else 'DIFFERENT'}"
