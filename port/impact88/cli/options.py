"""Options that several commands take, each declared once, and the case that they give."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout

from ..errors import UserError
from ..files import check_apart, replacing
from ..names import check_names, split_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Collection
    from typing import Any

    from ..cases.case import Case

Args = argparse.Namespace
Option = tuple[tuple[str, ...], dict[str, "Any"]]
"""Names of an option, and what argparse is given with them."""


class InputPath(str):
    """Type of an argument that names a file to read; ``-`` is standard input."""


class OutputPath(str):
    """Type of an argument that names a file to write; ``-`` is standard output."""


def option(*names: str, **keywords: Any) -> Option:
    """Return an option that takes a value, or a positional argument."""
    return names, keywords


def flag(name: str, meaning: str) -> Option:
    """Return an option without a value."""
    return option(name, action="store_true", help=meaning)


def choice(name: str, choices: Sequence[str], meaning: str) -> Option:
    """Return an option that takes one of several words; "" if it is not given."""
    return option(name, default="", choices=choices, help=meaning)


def texts(name: str, metavar: str, meaning: str) -> Option:
    """Return an option that may be repeated."""
    help_text = f"{meaning}; may be repeated"
    return option(name, action="append", default=[], metavar=metavar, help=help_text)


def input_file(name: str, metavar: str, meaning: str, **keywords: Any) -> Option:
    """Return an option or a positional argument that names a file to read."""
    return option(name, type=InputPath, metavar=metavar, help=meaning, **keywords)


FILE = input_file("file", "FILE", "the collision; - is standard input", nargs="?")
SAMPLE = choice("--sample", ("1", "2", "3"), "the scene of a published run")
SET = texts("--set", "NAME=VALUE", "change an entry; an empty VALUE removes it")
UNITS = choice("--units", ("us", "chapter", "metric", "si"), "units of numbers without one")
CASE = (FILE, SAMPLE, SET, UNITS)
"""Options that give one case, see `case_of`."""
JSON = flag("--json", "print JSON")
OUTPUT = option(
    "-o",
    "--output",
    type=OutputPath,
    default="-",
    metavar="FILE",
    help="write here (default: stdout)",
)
"""The file for what a command prints, written whole or not at all; a module with ``WRITES`` writes
it itself."""


def check_files(args: Args) -> None:
    """Raise UserError if a file to write is also read, or written twice."""
    inputs = [
        path
        for value in vars(args).values()
        for path in (value if isinstance(value, list) else [value])
        if isinstance(path, InputPath)
    ]
    outputs = {f"--{n}": path for n, path in vars(args).items() if isinstance(path, OutputPath)}
    check_apart(inputs, outputs)


@contextmanager
def printing_to(path: str) -> Iterator[None]:
    """Context in which what is printed goes to a file, whole or not at all; ``-`` is stdout."""
    if path == "-":
        yield
        return
    with replacing(path) as file, redirect_stdout(file):
        yield


def results_of(args: Args, allowed: Collection[str]) -> tuple[str, ...]:
    """Return the names of ``--results``. Raises UserError for another name."""
    names = split_names(",".join(args.results).upper())
    check_names(names, allowed, "result", "--results")
    return tuple(names)


def pairs_of(texts: Sequence[str], name: str, expected: str) -> dict[str, str]:
    """Return the pairs of an option that takes NAME=TEXT. Raises UserError for a text without
    ``=``, and for a name given twice."""
    pairs: dict[str, str] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or key.strip() in pairs:
            raise UserError(f"{name} {text}: expected {expected}, each name once")
        pairs[key.strip()] = value
    return pairs


def changes_of(args: Args) -> dict[str, str]:
    """Return the changes of ``--set`` by name."""
    return pairs_of(args.set, "--set", "NAME=VALUE, such as --set MU=.5")


def case_of(args: Args, is_required: bool = True) -> Case:
    """Return the case that the options give: a file or a published run, changed by ``--set``, or
    what ``--set`` gives alone. Raises UserError if two are given, and if none is that is required.
    """
    from ..cases.case import Case
    from ..cases.units import View
    from ..program.scene import sample

    if args.file and args.sample:
        raise UserError("a file and --sample are both given; expected one of them")
    view = View.of(units=args.units)
    if args.sample:
        scene = sample(int(args.sample))
        case = Case.of({**scene, "title": scene.title, "units": "chapter"}, scene.source)
    elif args.file:
        case = Case.load(args.file, view)
        if args.units not in ("", case.view.units):
            raise UserError(f"--units {args.units}, but units = {case.view.units}", case.source)
    elif args.set or not is_required:
        case = Case.of({}, "--set", view)
    else:
        raise UserError("no collision is given; expected a FILE.toml, --sample N, or --set")
    return case.with_("--set", **changes_of(args))
