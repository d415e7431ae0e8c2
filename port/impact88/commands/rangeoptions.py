"""A scene some of whose values are uncertain, as bounds and figure take it: its options, its
inputs, and the exploration they ask for."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from ..errors import UserError
from ..files import called
from ..progress import progress
from ..scene import entries_in, sample
from ..stderr import note
from ..uncertainty.ranges import Inputs, read_correlations, read_inputs
from .options import (
    add_names_argument,
    add_scene_argument,
    add_set_argument,
    changes_in_base,
    note_remarks,
    pairs,
)

if TYPE_CHECKING:
    from ..uncertainty.boundstable import Bounds


def add_range_arguments(parser: argparse.ArgumentParser) -> None:
    """The options that say what is uncertain, and how it is explored."""
    add_scene_argument(parser)
    add_set_argument(parser, "change a value of the scene")
    parser.add_argument(
        "--range",
        action="append",
        default=[],
        metavar="NAME=RANGE",
        dest="ranges",
        help="a range in place of the scene's value; repeatable",
    )
    parser.add_argument(
        "--correlation",
        action="append",
        default=[],
        metavar="A,B=R",
        dest="correlations",
        help="the correlation of two inputs; repeatable",
    )
    add_names_argument(
        parser,
        "--exclude",
        "WARNINGS",
        "leave out scenes that carry a warning, such as ENERGY_GAINED",
    )
    parser.add_argument(
        "--reconstruct", action="store_true", help="from final to initial velocities"
    )
    parser.add_argument(
        "--samples",
        type=int,
        default=100_000,
        metavar="N",
        help="random draws (default: %(default)s)",
    )
    parser.add_argument(
        "--seed", type=int, default=0, help="which random draws (default: %(default)s)"
    )
    parser.add_argument(
        "--sigmas",
        type=float,
        default=3.0,
        metavar="K",
        help="where a normal without limits ends for the bounds (default: %(default)s)",
    )


def inputs_given(args: argparse.Namespace) -> tuple[Inputs, str | None]:
    """The inputs the options describe, in base units, and the system they were written in. Raises
    UserError."""
    if bool(args.scene) == bool(args.sample):
        raise UserError("expected one scene: a file, or --sample 1, 2 or 3")
    entries, units, source = None, args.units, f"sample {args.sample}"
    if args.scene:
        entries = entries_in(args.scene, units)
        note_remarks(entries)
        units, source = entries.units, called(args.scene)
    texts = entries.values if entries else dict(sample(args.sample))
    changes = pairs([*args.set, *args.ranges], "--range", "NAME=RANGE, such as MU='.7 .. .9'")
    changes, units = changes_in_base(changes, "--range", units, args.scene)
    problem = "reconstruction" if args.reconstruct else "forward"
    inputs = read_inputs(texts, changes, problem, source)
    correlations = dict(inputs.correlations)
    for text in args.correlations:
        names, equals, number = text.partition("=")
        if not equals:
            raise UserError(f"--correlation {text}: expected A,B=R, such as UX,VX=0.5")
        correlations |= read_correlations(f"{names} {number.strip()}", "--correlation")
    return Inputs(inputs.values, correlations, inputs.derived), units


def explored(args: argparse.Namespace, outputs: list[str] | None, keep: bool = False) -> Bounds:
    """The bounds the options ask for, in the units the inputs came in; with progress on a terminal.
    Raises UserError."""
    from ..uncertainty.bounds import bounds
    from ..uncertainty.boundsunits import in_units

    inputs, units = inputs_given(args)
    if args.seed < 0:
        raise UserError(f"seed {args.seed}; expected 0 or more")
    if not any(item.varies for item in inputs.values.values()):
        raise UserError(
            "nothing varies; give ranges in the file or with --range, such as MU='.7 .. .9'"
        )
    if inputs.derived:
        note(None, f"from the forward solution: {' '.join(inputs.derived)}")
    with progress(args.samples, "draws") as meter:
        found = bounds(
            inputs.values,
            [name.upper() for text in outputs for name in text.replace(",", " ").split()]
            if outputs
            else None,
            problem="reconstruction" if args.reconstruct else "forward",
            samples=args.samples,
            seed=args.seed,
            correlations=inputs.correlations,
            sigmas=args.sigmas,
            exclude=[name.upper() for name in args.exclude],
            keep_draws=keep,
            progress=meter.update,
        )
    return in_units(found, units)
