"""A scene some of whose values are uncertain, as bounds and figure take it: its options, its
inputs, and the exploration they ask for."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from ..errors import UserError
from ..progress import progress
from ..stderr import note
from . import options

if TYPE_CHECKING:
    from ..uncertainty.boundstable import Bounds
    from ..uncertainty.ranges import Inputs

RANGES = (
    *options.ONE_SCENE,
    options.setting("change a value of the scene"),
    options.repeatable(
        "--range", "NAME=RANGE", "a range in place of the scene's value", dest="ranges"
    ),
    options.repeatable(
        "--correlation", "A,B=R", "the correlation of two inputs", dest="correlations"
    ),
    options.names_option(
        "--exclude", "leave out scenes that carry a warning, such as ENERGY_GAINED", "WARNINGS"
    ),
    options.flag("--reconstruct", "from final to initial velocities"),
    *options.draws(100_000),
    options.value(
        "--sigmas",
        "K",
        "where a normal without limits ends for the bounds (default: %(default)s)",
        default=3.0,
        type=float,
    ),
)
"""What is uncertain, and how it is explored."""


def inputs_given(args: argparse.Namespace) -> tuple[Inputs, str | None]:
    """The inputs the options describe, in base units, and the system they were written in. Raises
    UserError."""
    from ..uncertainty.ranges import Inputs, read_correlations, read_inputs

    if (entries := options.entries_given(args)) is None:
        raise UserError(options.ONE_EXPECTED)
    changes = options.pairs(
        [*args.set, *args.ranges], "--range", "NAME=RANGE, such as MU='.7 .. .9'"
    )
    changes, units = options.changes_in_base(changes, "--range", entries.units, args.scene)
    problem = "reconstruction" if args.reconstruct else "forward"
    inputs = read_inputs(entries.values, changes, problem, options.source_of(args) or "")
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
    if not any(item.varies for item in inputs.values.values()):
        raise UserError(
            "nothing varies; give ranges in the file or with --range, such as MU='.7 .. .9'"
        )
    if inputs.derived:
        note(None, f"from the forward solution: {' '.join(inputs.derived)}")
    words = [name.upper() for text in outputs or () for name in text.replace(",", " ").split()]
    with progress(args.samples, "draws") as meter:
        found = bounds(
            inputs.values,
            words or None,
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
