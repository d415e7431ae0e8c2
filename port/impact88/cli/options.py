"""Options that several commands take, each declared once, and the case that they give."""

from __future__ import annotations

import argparse
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stdout

from ..errors import UserError
from ..files import check_apart, replacing
from ..names import check_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from ..cases.case import Case

Args = argparse.Namespace
Parser = argparse.ArgumentParser
SAMPLES = (1, 2, 3)
SYSTEMS = ("us", "chapter", "metric", "si")


class InputPath(str):
    """Type of an argument that names a file to read; ``-`` is standard input."""


class OutputPath(str):
    """Type of an argument that names a file to write; ``-`` is standard output."""


def check_files(args: Args) -> None:
    """Raise UserError if a file to write is also read, or written twice."""
    inputs: list[str] = ["-"]
    outputs: dict[str, str | None] = {}
    for name, value in vars(args).items():
        for path in value if isinstance(value, list) else [value]:
            if isinstance(path, InputPath):
                inputs.append(path)
            elif isinstance(path, OutputPath):
                outputs["-o" if name in ("output", "target") else f"--{name}"] = path
    check_apart(inputs, outputs)


def add_case(parser: Parser, what: str = "FILE.toml") -> None:
    """Add the options that give one case: a file or a published run, changes, and its view."""
    parser.add_argument(
        "file", nargs="?", type=InputPath, metavar=what, help="the collision; - is standard input"
    )
    add_sample(parser)
    add_set(parser)
    add_view(parser)


def add_sample(parser: Parser) -> None:
    """Add ``--sample``."""
    parser.add_argument("--sample", type=int, choices=SAMPLES, help="the scene of a published run")


def add_set(parser: Parser, meaning: str = "change an entry; nothing removes it") -> None:
    """Add ``--set``."""
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help=f"{meaning}; may be repeated",
    )


def add_view(parser: Parser) -> None:
    """Add the options for units, axes and headings of a file that names none."""
    for option, choices, meaning in (
        ("--units", SYSTEMS, "units of numbers without one"),
        ("--axes", ("listing", "sae"), "axes"),
        ("--headings", ("listing", "compass"), "headings"),
    ):
        parser.add_argument(option, choices=choices, help=f"{meaning}, if the file names none")


def add_json(parser: Parser) -> None:
    """Add ``--json``."""
    parser.add_argument("--json", action="store_true", help="print JSON")


def add_output(parser: Parser) -> None:
    """Add ``-o`` for what is printed: written whole or not at all."""
    parser.add_argument(
        "-o", "--output", type=OutputPath, metavar="FILE", help="write here (default: stdout)"
    )


def add_target(parser: Parser) -> None:
    """Add ``-o`` for a file that the command writes itself."""
    parser.add_argument(
        "-o",
        "--output",
        dest="target",
        type=OutputPath,
        default=OutputPath("-"),
        metavar="FILE",
        help="write here (default: stdout)",
    )


@contextmanager
def printing_to(path: str) -> Iterator[None]:
    """Context in which what is printed goes to a file, whole or not at all; ``-`` is stdout."""
    if path == "-":
        yield
        return
    with replacing(path) as file, redirect_stdout(file):
        yield


def add_names(parser: Parser, option: str, meaning: str) -> None:
    """Add an option that takes names, see `names_of`."""
    parser.add_argument(
        option, action="append", default=[], metavar="NAMES", help=f"{meaning}; A,B,..."
    )


def whole_number(least: int, most: int) -> type[int]:
    """Return the type of an argument that is a whole number within limits."""

    def read(text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            number = least - 1
        if not least <= number <= most:
            raise argparse.ArgumentTypeError(f"expected a whole number from {least:,} to {most:,}")
        return number

    return read  # type: ignore[return-value]


def add_seed(parser: Parser) -> None:
    """Add ``--seed``."""
    parser.add_argument(
        "--seed", type=whole_number(0, 2**63), default=0, metavar="S", help="random seed"
    )


def names_of(texts: Sequence[str], allowed: Collection[str], option: str) -> tuple[str, ...]:
    """Return the names that an option gives, each once. Raises UserError for another name."""
    words = [word.upper() for text in texts for word in text.replace(",", " ").split()]
    check_names(words, allowed, "result", option)
    return tuple(dict.fromkeys(words))


def pairs_of(texts: Sequence[str], option: str, expected: str) -> dict[str, str]:
    """Return name -> text of an option that takes NAME=TEXT. Raises UserError for a text without
    ``=``, and for a name given twice."""
    pairs: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        name = name.strip()
        name = name.lower() if name.lower() in _LOWER else name.upper()
        if not equals or not name:
            raise UserError(f"{option} {text}: expected {expected}")
        if name in pairs:
            raise UserError(f"{option}: {name} is given twice")
        pairs[name] = value.strip()
    return pairs


def changes_of(args: Args) -> dict[str, str]:
    """Return name -> text of ``--set``."""
    return pairs_of(args.set, "--set", "NAME=VALUE, such as --set MU=.5")


_LOWER = ("title", "case", "examiner", "date", "correlations")
"""Entries of a file whose names are in small letters."""


def view_of(args: Args) -> dict[str, str | None]:
    """Return the words of `add_view`'s options."""
    return {name: getattr(args, name) for name in ("units", "axes", "headings")}


def case_of(args: Args) -> Case:
    """Return the case that the options give: a file or a published run, changed by ``--set``, or
    what ``--set`` gives alone. Raises UserError if none or several are given."""
    from ..cases.case import Case
    from ..cases.units import View

    if args.file and args.sample:
        raise UserError("a file and --sample are both given; expected one of them")
    if args.sample:
        case = sample_case(args)
    elif args.file:
        case = Case.load(args.file, **view_of(args))
    elif args.set:
        case = Case.of({}, "--set", View.of(**view_of(args)))
    else:
        raise UserError("no collision is given; expected a FILE.toml, --sample N, or --set")
    return changed(case, args)


def changed(case: Case, args: Args) -> Case:
    """Return a case with the changes of ``--set``."""
    changes = changes_of(args)
    return case.with_(changes, "--set") if changes else case


def sample_case(args: Args) -> Case:
    """Return the case of a published run, in the units asked for."""
    from ..program.scene import sample

    scene = sample(args.sample)
    return published_case(scene, f"sample {args.sample}", args, scene.title or "")


def published_case(values: Mapping[str, str], source: str, args: Args, title: str = "") -> Case:
    """Return the case of published values, which are in ft, slug and s, in the units asked for."""
    from ..cases.case import Case
    from ..cases.units import View

    system = args.units or "chapter"
    texts = dict(values)
    if system != "chapter":
        units = {name: View("chapter").unit(name) for name in values}
        texts = {name: f"{text} {units[name]}".rstrip() for name, text in texts.items()}
    return Case.of({**texts, "title": title, "units": system}, source)
