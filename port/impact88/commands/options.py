"""The options that several commands have, each declared and read in one place.

``--set NAME=VALUE``, a scene by file or ``--sample``, names of results, ``-o FILE`` and ``--json``
mean the same everywhere, and what is refused is refused in the same words.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import isfinite

from ..doubles import double
from ..errors import UserError, quoted
from ..files import called, check_apart
from ..names import SCENE, check_names
from ..scene import (
    RANGES,
    SAMPLES,
    Entries,
    Scene,
    check_value,
    entries_in,
    in_base_units,
    is_share,
    sample,
)
from ..stderr import note

TYPE_CHECKING = False
if TYPE_CHECKING:
    from ..uncertainty.uncertain import Uncertain

FORMATS = ("csv", "jsonl", "npz", "parquet", "feather", "xlsx")
"""What ``--from`` and ``--to`` take."""


class InputFile(str):
    """The type of an argument that names a file to read; ``-`` is standard input."""

    __slots__ = ()


class OutputFile(str):
    """The type of an argument that names a file to write; ``-`` is standard output."""

    __slots__ = ()


class OutputFolder(str):
    """The type of an argument that names a folder to write into."""

    __slots__ = ()


def check_files(parser: argparse.ArgumentParser, args: argparse.Namespace) -> None:
    """Expand the patterns among the files to read, and raise UserError when a file to write is also
    read or written twice.

    Which arguments name files is what their types say.
    """
    inputs = ["-"]
    outputs: dict[str, str | None] = {}
    for action in parser._actions:
        value = getattr(args, action.dest, None)
        if action.type is InputFile and isinstance(value, list):
            value[:] = [path for pattern in value for path in _matching(pattern)]
            inputs += value
        elif action.type is InputFile and value is not None:
            inputs.append(value)
        elif action.type in (OutputFile, OutputFolder):
            outputs[action.option_strings[0]] = value
    check_apart(inputs, outputs)


def _matching(pattern: str) -> list[str]:
    """The files that a pattern such as ``*.txt`` matches, for shells that leave it as it is; the
    text itself where it is the name of a file or matches nothing."""
    if not any(mark in pattern for mark in "*?[") or os.path.exists(pattern):
        return [pattern]
    from glob import glob

    return sorted(map(InputFile, glob(pattern))) or [pattern]


def refuse_renamed(parser: argparse.ArgumentParser, old: str, new: str) -> None:
    """Refuse an option that has another name now, and say which."""

    class Renamed(argparse.Action):
        def __call__(self, *ignored: object) -> None:
            raise UserError(f"{old} is not an option here; expected {new}")

    parser.add_argument(old, action=Renamed, help=argparse.SUPPRESS)


def add_set_argument(parser: argparse.ArgumentParser, meaning: str) -> None:
    """The option ``--set NAME=VALUE``; ``meaning`` says what it does for this command."""
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help=f"{meaning}; repeatable"
    )


def pairs(texts: Sequence[str], option: str, example: str) -> dict[str, str]:
    """Name -> text of a repeatable ``option`` that takes NAME=TEXT, names in either case.

    Raises UserError for a text without ``=`` and for a name given twice.
    """
    given: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        name = name.strip().upper()
        if not equals or not name:
            raise UserError(f"{option} {text}: expected {example}")
        if name in given:
            raise UserError(f"{option}: {name} is given twice")
        given[name] = value.strip()
    return given


def settings(
    texts: Sequence[str],
    allowed: Collection[str] = tuple(SCENE),
    others: Collection[str] = (),
    units: str | None = None,
) -> dict[str, str]:
    """What ``--set`` gives: names that are ``allowed``, and the text of a number for each, in base
    units (``units``: the system of bare numbers).

    ``others``: texts that are no numbers and are taken all the same. Raises UserError.
    """
    given = pairs(texts, "--set", "NAME=VALUE, such as --set MU=.5")
    check_names(given, allowed, "value here", "--set")
    given, _ = in_base_units(given, "--set", units)
    for name, text in given.items():
        if text not in others and not (name == "MU" and is_share(text)):
            check_value(name, text, "--set")
    return given


def known_values(
    path: str | None, texts: Sequence[str], allowed: Collection[str], units: str | None = None
) -> tuple[dict[str, float], str | None]:
    """What is known of a problem: the values of a flat TOML file, changed by what ``--set`` gives,
    in base units, and the name of the system they were written in; ``units``: of bare numbers where
    the file names none.

    What is not known is left out of the file, or left empty as in a `template`; an empty setting
    makes a value unknown; of a value within limits the middle is taken. Raises UserError, naming
    file and name, for names not ``allowed`` and texts that are no amounts.
    """
    values, named = known_within_limits(path, texts, allowed, units, single=True)
    return {name: item.nominal for name, item in values.items()}, named


def known_within_limits(
    path: str | None,
    texts: Sequence[str],
    allowed: Collection[str],
    units: str | None = None,
    single: bool = False,
) -> tuple[dict[str, Uncertain], str | None]:
    """The same, but each value a number or known within limits (`uncertainty.uncertain`) unless
    ``single``; a setting's ``+- D`` is around the file's value."""
    values: dict[str, Uncertain] = {}
    named = units
    if path is not None:
        entries = entries_in(path, units, single)
        note_remarks(entries)
        check_names(entries.values, allowed, "value here", called(path))
        named = entries.units
        values = {
            n: _within_limits(n, text, called(path), named)
            for n, text in entries.values.items()
            if text
        }
    changes = pairs(texts, "--set", "NAME=VALUE, such as --set MU=.5")
    check_names(changes, allowed, "value here", "--set")
    given, named = changes_in_base(changes, "--set", named, path)
    for name, text in given.items():
        center = values[name].nominal if name in values else None
        if text:
            values[name] = _within_limits(name, text, "--set", named, center)
        else:
            values.pop(name, None)
    return values, named


def changes_in_base(
    changes: Mapping[str, str], option: str, units: str | None, path: str | None
) -> tuple[dict[str, str], str | None]:
    """What an option changes, in base units, and the system of all: that of the file, or of the
    changes where the file has none, whose bare numbers are then base units, which is said."""
    given, own = in_base_units(changes, option, units)
    if units or own:
        from ..amounts import remarks

        for line in remarks(changes, units or own or "").values():
            note(None, line)
    if own and not units and path:
        from ..units import base_of, system_of

        note(None, f"{called(path)} names no units: taken to be in {base_of(system_of(own))}")
    return given, units or own


def note_remarks(entries: Entries, based: str = "") -> None:
    """Say on stderr how a file's entries were understood: estimates, middles, units; and in one
    line with it what is ``based`` on the base units."""
    lines = list(entries.remarks.values())
    if based and entries.units:
        from ..units import base_of, system_of

        lines = ["; ".join([f"{based} is in {base_of(system_of(entries.units))}", *lines])]
    for line in lines:
        note(None, line)


def _within_limits(
    name: str, text: str, source: str, units: str | None, center: float | None = None
) -> Uncertain:
    from ..uncertainty.uncertain import fixed, read, skid

    if name in ("SAF", "SBF") and text.startswith("skid"):
        from ..units import gravity_in, system_of

        item = skid(text, f"{source}: {name}", gravity_in(system_of(units)))
        if item is not None:
            return item
    if any(mark in text for mark in RANGES) or is_share(text):
        return read(text, f"{source}: {name}", center)
    return fixed(_double(name, text, source))


def _double(name: str, text: str, source: str) -> float:
    value = double(check_value(name, text, source))
    if not isfinite(value):
        raise UserError(f"{name} = {text} is too large for a double", source)
    return value


def add_sweep_argument(parser: argparse.ArgumentParser) -> None:
    """The option ``--sweep NAME=LOW:HIGH:COUNT``."""
    parser.add_argument(
        "--sweep",
        action="append",
        default=[],
        metavar="NAME=LOW:HIGH:COUNT",
        help="let a value of a scene file run through COUNT values; repeatable",
    )


def sweeps(texts: Sequence[str]) -> dict[str, str]:
    """Name -> text of ``--sweep`` (see `tables.sweep`). Raises UserError."""
    return pairs(texts, "--sweep", "NAME=LOW:HIGH:COUNT, such as --sweep MU=0:1:51")


def add_known_arguments(parser: argparse.ArgumentParser) -> None:
    """What is known of a problem: a file, and ``--set``."""
    parser.add_argument(
        "file", nargs="?", type=InputFile, metavar="FILE.toml", help="what is known (- is stdin)"
    )
    add_set_argument(parser, "give or change a value; an empty one makes it unknown")
    add_units_argument(parser)


def _duration(text: str) -> float:
    """An argument's type: a time, in seconds without unit."""
    try:
        given, _ = in_base_units({"TF": text}, "--contact-time")
        return double(given["TF"])
    except (UserError, ValueError):
        raise argparse.ArgumentTypeError(
            f"{quoted(text)} is not a duration; expected one such as 0.12 or '120 ms'"
        ) from None


def add_solution_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the commands that solve for what is not known and print the solution."""
    add_known_arguments(parser)
    parser.add_argument(
        "--contact-time",
        type=_duration,
        metavar="T",
        help="duration of contact (usually .1 to .2 s): average and peak force",
    )
    parser.add_argument("--template", action="store_true", help="print a file to fill in")
    add_json_argument(parser)
    add_output_argument(parser)


def add_encoding_argument(parser: argparse.ArgumentParser) -> None:
    """The option ``--encoding``."""
    parser.add_argument(
        "--encoding", metavar="NAME", help="of a text that is not UTF-8, such as cp1252"
    )


def add_sample_argument(
    parser: argparse.ArgumentParser, meaning: str = "a published run's scene"
) -> None:
    """The option ``--sample``."""
    parser.add_argument("--sample", type=int, choices=SAMPLES, help=meaning)


def add_scene_argument(parser: argparse.ArgumentParser) -> None:
    """A scene: a file, or ``--sample``."""
    parser.add_argument(
        "scene", nargs="?", type=InputFile, metavar="FILE.toml", help="a scene file (- is stdin)"
    )
    add_sample_argument(parser)
    add_units_argument(parser)


def one_scene(args: argparse.Namespace) -> Scene:
    """The scene that file or sample name, with what ``--set`` changes. Raises UserError unless
    there is exactly one."""
    if bool(args.scene) == bool(args.sample):
        raise UserError("expected one scene: a file, or --sample 1, 2 or 3")
    units = getattr(args, "units", None)
    scene = Scene.from_toml(args.scene, units) if args.scene else sample(args.sample)
    return changed(scene, args.set, getattr(args, "move_contact", None))


def changed(scene: Scene, texts: Sequence[str], move: str | None, based: str = "") -> Scene:
    """A scene as ``--set`` and ``--move-contact`` change it; how its entries were understood is
    said on stderr, and what of the answer is ``based`` on other units than the scene's."""
    changes = settings(texts, units=scene.units)
    scene = scene.replaced(changes) if changes else scene
    note_remarks(scene.entries, based)
    return with_contact_moved(scene, move)


def add_move_argument(parser: argparse.ArgumentParser) -> None:
    """The option ``--move-contact DX,DY``."""
    parser.add_argument(
        "--move-contact",
        metavar="DX,DY",
        help="move the contact point along the scene's x and y, in both vehicles (write "
        "--move-contact=-1,0 where DX is negative)",
    )


def with_contact_moved(scene: Scene, move: str | None) -> Scene:
    """The scene with the contact point moved as ``--move-contact`` says. Raises UserError."""
    if move is None:
        return scene
    from ..reconstruction.contact import moved_texts

    parts = [part.strip() for part in move.split(",")]
    if len(parts) != 2:
        raise UserError(f"--move-contact {move}: expected DX,DY, such as 1,-0.5")
    given = dict(zip(("CX", "CY"), parts, strict=True))
    texts, _ = in_base_units(given, "--move-contact", scene.units)
    dx, dy = (_double(name, texts[name], "--move-contact") for name in ("CX", "CY"))
    return scene.replaced(moved_texts(scene, dx, dy))


def add_names_argument(
    parser: argparse.ArgumentParser, option: str, metavar: str, meaning: str, old: str = ""
) -> None:
    """An option that takes names: separated by commas, or the option repeated; ``old``: what
    version 0.2 called it."""
    meanings = {option: f"{meaning}; separated by commas, or repeated"}
    if old:
        meanings[old] = argparse.SUPPRESS
    for spelling, text in meanings.items():
        parser.add_argument(
            spelling, action="append", default=[], dest=option[2:], metavar=metavar, help=text
        )


def names_given(
    texts: Sequence[str], known: Collection[str], option: str, what: str = "result"
) -> list[str]:
    """The names an option lists, in either case, each once; empty where the option is not given.

    Raises UserError for a name that is not ``known`` and for an option without a name.
    """
    in_any_case = {name.lower(): name for name in known}
    words = [word for text in texts for word in text.replace(",", " ").split()]
    names = [in_any_case.get(word.lower(), word) for word in words]
    if texts and not names:
        raise UserError(f"{option}: no name given; expected some of {' '.join(known)}")
    check_names(names, known, what, option)
    return list(dict.fromkeys(names))


def add_units_argument(parser: argparse.ArgumentParser) -> None:
    """The option ``--units``."""
    parser.add_argument(
        "--units",
        metavar="SYSTEM",
        help="what bare numbers are in: us (lb, mph, ft), chapter (slug, ft/s, ft), metric (kg, "
        "km/h, m) or si (kg, m/s, m), where the file does not say",
    )


def add_json_argument(parser: argparse.ArgumentParser, what: str = "one JSON object") -> None:
    """The option ``--json``."""
    parser.add_argument("--json", action="store_true", help=f"print {what}")


def add_output_argument(parser: argparse.ArgumentParser) -> None:
    """The option ``-o FILE`` of a command whose result is what it prints."""
    parser.add_argument(
        "-o", "--output", type=OutputFile, metavar="FILE", help="write here (default: stdout)"
    )
    parser.set_defaults(printed_to_output=True)


@contextmanager
def output_of(args: argparse.Namespace) -> Iterator[None]:
    """Send what is printed in the block to the file ``-o`` names, whole or not at all.

    For the commands of `add_output_argument`; others write their own files. Raises UserError when
    the place cannot be written to.
    """
    path = getattr(args, "output", None)
    if path in (None, "-") or not getattr(args, "printed_to_output", False):
        yield
        return
    from contextlib import redirect_stdout

    from ..files import replacing

    with replacing(path) as file, redirect_stdout(file):
        yield


def whole_number(low: int, high: int) -> Callable[[str], int]:
    """An argument's type: a whole number within limits, which the message says."""

    def read(text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            number = low - 1
        if not low <= number <= high:
            raise argparse.ArgumentTypeError(
                f"{quoted(text)} is no whole number from {low:,} to {high:,}"
            )
        return number

    return read
