"""The arguments that several commands take, and what they print as JSON, each in one place.

A command declares ``ARGUMENTS``, which `declare` adds to its parser.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial

from ...collision.case import (
    OWN_AXES,
    OWN_NAMES,
    Case,
    check_value,
    in_base_units,
    remark_lines,
    share_of,
)
from ...collision.casescene import SAMPLES, Scene, sample
from ...collision.doubles import double
from ...collision.scenefile import case_in
from ...errors import UserError, note, quoted
from ...files import check_apart, display_name
from ...names import SCENE, check_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from ...casework.reconstruction.answer import Answer
    from ...casework.uncertainty.boundstable import Bounds
    from ...collision.uncertain import Uncertain
    from ...collision.units import System


class InputPath(str):
    """The type of an argument that names a file or folder to read; ``-`` is standard input."""


class OutputPath(str):
    """A file to write, or a folder to write into; ``-`` is standard output."""


Args = argparse.Namespace
"""A parsed command line."""
Argument = tuple[tuple[str, ...], dict[str, "Any"]]
"""Names and keywords for argparse's ``add_argument``."""


def value(names: str, metavar: str | None, meaning: str, **keywords: Any) -> Argument:
    """An argument with a value; ``names``: of an option, between blanks, or of what has no dash."""
    return tuple(names.split()), {"metavar": metavar, "help": meaning, **keywords}


reads = partial(value, type=InputPath)
writes = partial(value, type=OutputPath)


def choice(names: str, choices: Sequence[Any], meaning: str, **keywords: Any) -> Argument:
    return value(names, None, meaning, choices=choices, **keywords)


def count(
    name: str,
    least: int,
    most: int,
    meaning: str,
    metavar: str = "N",
    default: int | None = None,
    **keywords: Any,
) -> Argument:
    """An option whose value is a whole number within limits, which the message says."""

    def read(text: str) -> int:
        if not least <= (number := int(text)) <= most:
            raise ValueError
        return number

    read_or_refuse = _reader(read, f"a whole number from {least:,} to {most:,}")
    return value(name, metavar, meaning, type=read_or_refuse, default=default, **keywords)


def _reader(read: Callable[[str], float], expected: str) -> Callable[[str], float]:
    """The type of an argument that ``read`` reads, or refuses by a ValueError."""

    def read_or_refuse(text: str) -> float:
        try:
            return read(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{quoted(text)} is not {expected}") from None

    return read_or_refuse


def format_option(names: str, meaning: str, **keywords: Any) -> Argument:
    """Return an option that takes the name of a table format."""
    from ...tables.formats import FORMATS

    return choice(names, tuple(FORMATS), meaning, **keywords)


def flag(name: str, meaning: str) -> Argument:
    return (name,), {"action": "store_true", "help": meaning}


def repeatable(name: str, metavar: str, meaning: str, **keywords: Any) -> Argument:
    meaning += "; repeatable"
    return value(name, metavar, meaning, action="append", default=[], **keywords)


def names_option(name: str, meaning: str, metavar: str = "NAMES") -> Argument:
    """An option that takes names, see `names_given`."""
    text = f"{meaning}; separated by commas, or repeated"
    return value(name, metavar, text, action="append", default=[])


setting = partial(repeatable, "--set", "NAME=VALUE")
sample_option = partial(choice, "--sample", SAMPLES, type=int)


def draws(default: int, meaning: str = "random draws") -> tuple[Argument, Argument]:
    meaning += " (default: %(default)s)"
    return count("--samples", 0, 10**8, meaning, default=default), seed()


def seed(meaning: str = "random seed", default: int = 0) -> Argument:
    text = f"{meaning} (default: %(default)s)"
    return count("--seed", 0, 2**63, text, default=default, metavar="S")


JSON = flag("--json", "print one JSON object")
SAMPLE = sample_option("the scene of a published run")
OUTPUT = writes("-o --output", "FILE", "write here (default: stdout)")
"""Option of a command whose result is what it prints; others write files of their own."""
UNITS = value(
    "--units",
    "SYSTEM",
    "units of bare numbers: us (lb, mph, ft), chapter (slug, ft/s, ft), metric (kg, km/h, m) "
    "or si (kg, m/s, m), unless the file names its own",
)
CONVENTION = (
    UNITS,
    choice(
        "--axes",
        ("listing", "sae"),
        "directions of the file's numbers, unless it names its own: listing (y to the left of x, "
        "angles counterclockwise) or sae (y to the right, angles clockwise)",
    ),
    choice(
        "--headings",
        ("listing", "compass"),
        "headings and courses, unless the file names its own: listing (from the x axis) or compass "
        "(clockwise from north, which is y, or x of the sae axes)",
    ),
)
"""Options for the units and directions of a file's numbers."""
ENCODING = value("--encoding", "NAME", "encoding of a text that is not UTF-8, such as cp1252")
SWEEP = repeatable(
    "--sweep", "NAME=LOW:HIGH:COUNT", "run a value of a scene file through COUNT values"
)
MOVE = value(
    "--move-contact",
    "DX,DY",
    "move the contact point along the scene's x and y, in both vehicles (write "
    "--move-contact=-1,0 where DX is negative)",
)
ONE_SCENE = (
    reads("scene", "FILE.toml", "a scene file (- is stdin)", nargs="?"),
    SAMPLE,
    *CONVENTION,
)
"""A scene: a file, or ``--sample``."""
KNOWN = (
    reads("scene", "FILE.toml", "what is known (- is stdin)", nargs="?"),
    setting("give or change a value; an empty one makes it unknown"),
    *CONVENTION,
)
"""Options that give the known values of a problem."""
SOLUTION = (
    *KNOWN,
    value(
        "--contact-time",
        "T",
        "duration of contact (usually .1 to .2 s): average and peak force",
        type=_reader(
            lambda text: double(in_base_units({"TF": text}, "--contact-time")[0]["TF"]),
            "a duration; expected one such as 0.12 or '120 ms'",
        ),
    ),
    flag("--template", "print a file to fill in"),
    JSON,
    OUTPUT,
)
"""Options of the commands that solve for unknowns and print the solution."""


def declare(
    parser: argparse.ArgumentParser, arguments: Sequence[Argument | list[Argument]]
) -> None:
    """Add a command's arguments to a parser; those in a list exclude each other."""
    for item in arguments:
        group = parser.add_mutually_exclusive_group() if isinstance(item, list) else parser
        for names, keywords in item if isinstance(item, list) else [item]:
            group.add_argument(*names, **keywords)


def check_files(parser: argparse.ArgumentParser, args: Args) -> None:
    """Expand patterns such as ``*.txt`` for shells that do not, and raise UserError when a file to
    write is also read or written twice. The types say which arguments are files."""
    inputs: list[str] = ["-"]
    outputs: dict[str, str | None] = {}
    for action in parser._actions:
        value = getattr(args, action.dest, None)
        if action.type is InputPath and isinstance(value, list):
            if not all(map(os.path.exists, value)):
                value[:] = [path for name in value for path in _paths_of(name)]
            inputs += value
        elif action.type is InputPath and value is not None:
            inputs.append(value)
        elif action.type is OutputPath:
            outputs[action.option_strings[0]] = value
    check_apart(inputs, outputs)


def _paths_of(name: str) -> list[str]:
    """Return the files that a name stands for: itself, or those that match a pattern."""
    from glob import glob

    return (not os.path.exists(name) and sorted(glob(name))) or [name]


@contextmanager
def output_of(args: Args, arguments: Sequence[object]) -> Iterator[None]:
    """Send what is printed in the block to the file ``-o`` names, whole or not at all, for commands
    that declare `OUTPUT`. Raises UserError when the place cannot be written to."""
    if OUTPUT not in arguments or args.output in (None, "-"):
        yield
        return
    from contextlib import redirect_stdout

    from ...files import replacing

    with replacing(args.output) as file, redirect_stdout(file):
        yield


def show(
    args: Args,
    form: str,
    record: Callable[[], Mapping[str, Any]],
    lines: Callable[[], Iterable[str]],
    indent: int | None = None,
) -> None:
    """Print a result: as an object of a published form with ``--json``, else as lines."""
    if args.json:
        print_json(form, record(), indent)
    else:
        print("\n".join(lines()))


def answers_of(args: Args, solve: Callable[[], list[Answer]]) -> list[Answer]:
    """Return the answers that ``solve`` returns; its errors name the file."""
    try:
        return solve()
    except UserError as error:
        raise UserError(str(error), source_of(args)) from None


def show_answers(args: Args, found: Sequence[Answer], units: System, full: bool = True) -> int:
    """Print answers as text, the first lines and remarks alone unless ``full``, or as JSON. Return
    the exit status: 1 where no impact agrees, or no velocity before it was found."""
    from ...casework.reconstruction.answerjson import json_of
    from ...casework.reconstruction.answertable import join_texts

    def record() -> dict[str, Any]:
        return {"solutions": [json_of(answer, units) for answer in found]}

    show(args, "reconstruct", record, lambda: [join_texts(found, units, full)])
    return int(found[0].is_adverse)


def print_json(form: str, found: Mapping[str, Any], indent: int | None = None) -> None:
    """Print an object of a published form on one line; what is not finite is null."""
    from ...messages.plaintable import plain
    from ...messages.schemas import with_schema

    record = with_schema(form, plain(found))
    print(json_text(record, indent), flush=True)


def json_text(record: Mapping[str, Any], indent: int | None = None) -> str:
    """Return an object as JSON; characters that do not print, which may turn what a terminal shows
    round, are escaped."""
    import json

    text = json.dumps(record, ensure_ascii=False, allow_nan=False, indent=indent)
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c == "\n" else json.dumps(c)[1:-1] for c in text)


def pairs(texts: Sequence[str], option: str, example: str) -> dict[str, str]:
    """Name -> text of a repeatable ``option`` that takes NAME=TEXT, names in either case. Raises
    UserError for a text without ``=`` and for a name given twice."""
    entries: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        name = name.strip().upper()
        if not equals or not name:
            raise UserError(f"{option} {text}: expected {example}")
        if name in entries:
            raise UserError(f"{option}: {name} is given twice")
        entries[name] = value.strip()
    return entries


def set_pairs(texts: Sequence[str], allowed: Collection[str] | None = None) -> dict[str, str]:
    """Name -> text of ``--set``. Raises UserError for a name that is not ``allowed``."""
    changes = pairs(texts, "--set", "NAME=VALUE, such as --set MU=.5")
    check_names(changes, changes if allowed is None else allowed, "name used here", "--set")
    return changes


def settings(texts: Sequence[str], units: str | None = None) -> dict[str, str]:
    """Return what ``--set`` gives for all rows of a table: the text of a number for each name, in
    base units; ``units``: the system of bare numbers. Raises UserError."""
    changes = set_pairs(texts, tuple(SCENE))
    case = change_case(Case({}, "--set", units), changes, "--set").at_nominal()
    numbers = {name: case.values[name] for name in changes if name in case.given}
    for name, text in numbers.items():
        if not (name == "MU" and share_of(text) is not None):
            check_value(name, text, "--set")
    return numbers


def sweeps(texts: Sequence[str]) -> dict[str, str]:
    """Name -> text of ``--sweep`` (see `tables.sweep`). Raises UserError."""
    return pairs(texts, "--sweep", "NAME=LOW:HIGH:COUNT, such as --sweep MU=0:1:51")


def names_given(
    texts: Sequence[str], known: Collection[str], option: str, what: str = "result"
) -> list[str]:
    """Return the names that an option lists, in either case, each once. Raises UserError for a name
    that is not ``known`` and for an option without a name."""
    in_any_case = {name.lower(): name for name in known}
    words = [word for text in texts for word in text.replace(",", " ").split()]
    names = [in_any_case.get(word.lower(), word) for word in words]
    if texts and not names:
        raise UserError(f"{option}: no name given; expected some of {' '.join(known)}")
    check_names(names, known, what, option)
    return list(dict.fromkeys(names))


ONE_EXPECTED = "expected one scene: a file, or --sample 1, 2 or 3"


def source_of(args: Args) -> str | None:
    """Return the name of the given scene or file for messages; None where there is none. Raises
    UserError where both a file and ``--sample`` are given."""
    number = getattr(args, "sample", None)
    if args.scene and number:
        raise UserError(f"a file and --sample {number} are both given; expected one scene")
    return display_name(args.scene) if args.scene else f"sample {number}" if number else None


def case_given(args: Args) -> Case:
    """Return the case that the file or ``--sample`` gives, changed by ``--set``; an empty one where
    neither is given. What ``--set`` may change a command says by the names it takes. Raises
    UserError."""
    chosen = (args.units, getattr(args, "axes", None), getattr(args, "headings", None))
    source = source_of(args)
    if source is None:
        case = Case({}, "--set", *chosen)
    elif args.scene:
        case = case_in(args.scene, *chosen)
    else:
        case = sample(args.sample).case.shown_in(*chosen)
    return change_case(case, set_pairs(args.set, None), "--set")


def change_case(case: Case, changes: Mapping[str, str], option: str) -> Case:
    """Return the case with what an option changes. Raises UserError."""
    return case.replaced(changes, option) if changes else case


def known_values(args: Args, allowed: Collection[str]) -> tuple[dict[str, float], System]:
    """Return the numbers that are known of a problem, in base units, and what they are shown in; of
    values within limits the middle. See `known_within_limits`."""
    values, system = known_within_limits(args, allowed, single=True)
    return {name: item.nominal for name, item in values.items()}, system


def known_within_limits(
    args: Args, allowed: Collection[str], single: bool = False
) -> tuple[dict[str, Uncertain], System]:
    """Return what is known of a problem, each value a number or known within limits in base units,
    and what they are shown in. What is not known is left out of the file, or left empty as in a
    template; an empty setting makes a value unknown. Of a sample the names ``allowed`` are taken.
    Raises UserError, naming file and name, for names not ``allowed``, texts that are not amounts,
    and where nothing is given."""
    case = known_case(args, allowed, single)
    return read_known(case, allowed), case.system


def known_case(args: Args, allowed: Collection[str], single: bool = False) -> Case:
    """Return the case of a problem, see `known_within_limits`; how it was understood is said on
    stderr."""
    source = source_of(args) or ""
    if not source and not args.set:
        raise UserError("nothing is known; expected a file, or --set NAME=VALUE")
    set_pairs(args.set, (*allowed, *OWN_NAMES))
    case = case_given(args)
    case = case.at_nominal() if single else case
    if args.scene:
        for name in set(sum(OWN_AXES.values(), ())).intersection(case.values) - {*allowed}:
            raise UserError(
                f"{name} is known within limits, which impact88 bounds takes; expected a "
                f"number, or limits for D{name[1]} and P{name[1]}",
                source,
            )
        given_names = [name for name in case.values if name != "M" or "M" in case.given]
        check_names(given_names, allowed, "name used here", source)
        if case.correlations:
            check_names(["correlations"], allowed, "name used here", source)
    note_remarks(case)
    return case


def read_known(case: Case, allowed: Collection[str]) -> dict[str, Uncertain]:
    """Return a case's values among the names ``allowed``."""
    from ...collision.uncertain import read

    return {
        name: read(text, f"{case.place(name)}: {name}", units=case.units)
        for name, text in case.values.items()
        if name in allowed
    }


def note_remarks(case: Case | Scene, based: str = "") -> None:
    """Say on stderr how a case's entries were understood: estimates, middles, units; and what is
    ``based`` on the base units."""
    lines = remark_lines(case.remarks)
    if based and case.units in ("us", "metric"):  # the others are shown in their base units
        from ...collision.units import base_of, system_of

        lines.insert(0, f"{based} is in {base_of(system_of(case.units))}")
    for line in lines:
        note(None, line)


def scene_given(args: Args, based: str = "", may_omit: Collection[str] = ()) -> Scene | None:
    """Return the scene that file or sample name, with what ``--set`` and ``--move-contact`` change;
    None where neither is given. How its entries were understood is said on stderr, and what of the
    answer is ``based`` on other units than the scene's. Names of ``may_omit`` need not be given.
    Raises UserError."""
    if source_of(args) is None:
        return None
    set_pairs(args.set, (*SCENE, *OWN_NAMES))
    scene = Scene.of(case_given(args), may_omit)
    note_remarks(scene, based)
    if (move := getattr(args, "move_contact", None)) is None:
        return scene
    from ...collision.geometry import moved_texts

    parts = [part.strip() for part in move.split(",")]
    if len(parts) != 2:
        raise UserError(f"--move-contact {move}: expected DX,DY, such as 1,-0.5")
    case = scene.case
    moves = Case({"CX": parts[0], "CY": parts[1]}, "--move-contact", case.units).values
    numbers = [double(check_value(name, moves[name], "--move-contact")) for name in ("CX", "CY")]
    texts = case.display_texts(moved_texts(scene, *numbers))
    blanks = {name: "" for pair in OWN_AXES.values() for name in pair if name in case.texts}
    return Scene.of(case.replaced({**blanks, **texts}, "--move-contact"))


def one_scene(args: Args, may_omit: Collection[str] = ()) -> Scene:
    """Return `scene_given`'s scene. Raises UserError where neither file nor sample is given."""
    if (scene := scene_given(args, may_omit=may_omit)) is None:
        raise UserError(ONE_EXPECTED)
    return scene


EXPLORED = (
    *ONE_SCENE,
    setting("change a value of the scene"),
    repeatable("--range", "NAME=RANGE", "a range in place of the scene's value", dest="ranges"),
    repeatable("--correlation", "A,B=R", "the correlation of two inputs", dest="correlations"),
    names_option(
        "--exclude", "leave out scenes that carry a warning, such as ENERGY_GAINED", "WARNINGS"
    ),
    flag("--reconstruct", "from final to initial velocities"),
    *draws(100_000),
    value(
        "--sigmas",
        "K",
        "cut-off for unbounded normal inputs, in standard deviations (default: %(default)s)",
        default=3.0,
        type=float,
    ),
)
"""Options for the uncertain inputs, and for exploring them."""


def explore(args: Args, outputs: list[str]) -> Bounds:
    """Return the bounds that the options ask for, in the units of the inputs. Raises UserError."""
    from ...casework.uncertainty.bounds import bounds
    from ...casework.uncertainty.boundstable import in_units
    from ...casework.uncertainty.ranges import read_correlations, read_inputs
    from ...messages.progress import progress

    if source_of(args) is None:
        raise UserError(ONE_EXPECTED)
    changes = pairs([*args.set, *args.ranges], "--range", "NAME=RANGE, such as MU='.7 .. .9'")
    case = case_given(argparse.Namespace(**(vars(args) | {"set": []})))
    problem = "reconstruction" if args.reconstruct else "forward"
    if problem == "forward" and "GA" not in changes:
        from ...mechanics.approach import approaching

        given, case = case, approaching(case)
        if case is not given:
            note(None, case.remarks["GA"])
    inputs = read_inputs(case, changes, problem)
    note_remarks(inputs.case)
    correlations = dict(inputs.correlations)
    for text in args.correlations:
        names, equals, number = text.partition("=")
        if not equals:
            raise UserError(f"--correlation {text}: expected A,B=R, such as UX,VX=0.5")
        correlations |= read_correlations(f"{names} {number.strip()}", "--correlation")
    if not any(item.varies for item in inputs.values.values()):
        raise UserError(
            "nothing varies; give ranges in the file or with --range, such as MU='.7 .. .9'"
        )
    if inputs.derived:
        note(None, f"from the forward solution: {' '.join(inputs.derived)}")
    words = [name.upper() for text in outputs for name in text.replace(",", " ").split()]
    with progress(args.samples, "draws") as meter:
        result = bounds(
            inputs.values,
            words or None,
            problem=problem,
            samples=args.samples,
            seed=args.seed,
            correlations=correlations,
            sigmas=args.sigmas,
            exclude=[name.upper() for name in args.exclude],
            progress=meter.update,
        )
    return in_units(result, inputs.case.system)
