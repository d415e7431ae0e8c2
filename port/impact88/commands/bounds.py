"""A value of the scene may be known only within limits. In the file, as text, or with --range:

  0.7 .. 0.9             between two values, none preferred
  0.8 +- 0.1             the same by middle and half width; also 143.5 +- 5%
  +- 0.1, +- 5%          the same around the file's value (--range only)
  uniform 0.7 0.9        the same as 0.7 .. 0.9
  triangular 0.7 0.75 0.9          lower limit, most likely value, upper limit
  normal 0.8 0.05                  mean and standard deviation
  normal 0.8 0.05 within 0.7 .. 1  the same, cut off at limits

In a file: MU = "0.7 .. 0.9". Correlated values, in the file: correlations = "UX,VX 0.5; MA,IA 0.9"
(the correlation of a Gaussian copula); they shape the draws, not the bounds.

The bounds are the extremes over all inputs within their limits (a normal without limits: --sigmas
standard deviations), sought at the corners, on faces and inside. Every bound is attained: --json
gives the inputs that do. The true bound lies no closer; that it lies no farther is not proven.
Share of draws with a warning: see impact88.status. Units are those of the scene; angles in degrees.

CX and CY move the contact point along x and y, in both vehicles at once: --range CX="+- 1". (DA PA
DB PB varied apart would tear it in two.)

--reconstruct goes from final to initial velocities: the file (or --range) gives VAX VAY VBX VBY WAF
WBF and MUP, the signed P_t/P_n; if it gives none, those of the scene's forward solution are taken.

examples:
  impact88 bounds --sample 1 --range MU="0.7 .. 1" --range UX="+- 10%"
  impact88 bounds crash.toml --outputs DVA DVB LOSS --samples 1000000 --seed 7
  impact88 bounds --sample 3 --reconstruct --range VAX="+- 2" --range VBY="normal 41.5 1.5"
  impact88 bounds crash.toml --range UX="+- 3" --range VX="+- 3" --correlation UX,VX=0.8 --json
"""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING

from ..errors import UserError
from ..files import called
from ..scene import file_values, in_base_units, sample, toml_file
from ..schemas import stamped
from ..talk import tell
from ..uncertainty.ranges import Inputs, read_correlations, read_inputs
from .options import (
    add_json_argument,
    add_names_argument,
    add_output_argument,
    add_scene_argument,
    pairs,
    tell_estimates,
)

if TYPE_CHECKING:
    from ..uncertainty.bounds import Bounds


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 bounds`."""
    add_scene_arguments(parser)
    add_names_argument(parser, "--outputs", "NAMES", "the results wanted")
    add_json_argument(parser, "everything as one JSON object")
    add_output_argument(parser)


def add_scene_arguments(parser: argparse.ArgumentParser) -> None:
    """The options that say what is uncertain, and how it is explored."""
    add_scene_argument(parser)
    parser.add_argument(
        "--range",
        action="append",
        default=[],
        metavar="NAME=RANGE",
        dest="ranges",
        help="a value or range in place of the scene's; repeatable",
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


def read_scene(args: argparse.Namespace) -> Inputs:
    """The inputs the options describe. Raises UserError."""
    if bool(args.scene) == bool(args.sample):
        raise UserError("expected one scene: a file, or --sample 1, 2 or 3")
    if args.scene:
        source = called(args.scene)
        texts, units, estimated = file_values(toml_file(args.scene), source)
        tell_estimates(estimated, texts)
    else:
        texts, source = dict(sample(args.sample)), f"sample {args.sample}"
        units = None
    changes = pairs(args.ranges, "--range", "NAME=RANGE, such as MU='.7 .. .9'")
    changes, own = in_base_units(changes, "--range", units)
    if units or own:
        from ..units import base_of, system_of

        tell("bounds", f"results are in {base_of(system_of(units or own))}")
    problem = "reconstruction" if args.reconstruct else "forward"
    inputs = read_inputs(texts, changes, problem, source)
    correlations = dict(inputs.correlations)
    for text in args.correlations:
        names, equals, number = text.partition("=")
        if not equals:
            raise UserError(f"--correlation {text}: expected A,B=R, such as UX,VX=0.5")
        correlations |= read_correlations(f"{names} {number.strip()}", "--correlation")
    return Inputs(inputs.values, correlations, inputs.derived)


def explored(args: argparse.Namespace, outputs: list[str] | None, keep: bool = False) -> Bounds:
    """The bounds the options ask for, with progress on a terminal. Raises UserError."""
    from ..uncertainty.bounds import bounds

    inputs = read_scene(args)
    if args.seed < 0:
        raise UserError(f"seed {args.seed}; expected 0 or more")
    if not any(item.varies for item in inputs.values.values()):
        raise UserError(
            "nothing varies; give ranges in the file or with --range, such as MU='.7 .. .9'"
        )
    if inputs.derived:
        print(f"from the forward solution: {' '.join(inputs.derived)}", file=sys.stderr)
    done = 0

    def progress(draws: int) -> None:
        nonlocal done
        done += draws
        if sys.stderr.isatty() and args.samples > 1_000_000:
            end = "\n" if done >= args.samples else "\r"
            print(f"{done:,} of {args.samples:,} draws", end=end, file=sys.stderr, flush=True)

    return bounds(
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
        progress=progress,
    )


def main(args: argparse.Namespace) -> int:
    """Print bounds, spreads and what drives them."""
    from ..uncertainty.boundstable import as_json, table

    found = explored(args, args.outputs)
    whole = stamped("bounds", as_json(found)) if args.json else None
    print(json.dumps(whole, allow_nan=False) if whole else table(found))
    return 0
