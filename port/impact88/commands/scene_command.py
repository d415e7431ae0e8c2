"""Axes, sides and signs:

{signs}
A value may have a unit ("-25 mph", "3091 lb", "3.5 ft"), and the file units = "us", "metric", "si"
or "chapter" for those that have none. CAF CAL (forward and to the left of A's center of gravity)
may stand for DA PA, CBF CBL for DB PB. IA = "estimate" has the yaw inertia estimated: from the
vehicle's length and width where LA BA are given (LB BB for IB), else for a car from its weight.

examples:
  impact88 scene -o mine.toml       a template to fill in
  impact88 scene --sample 2         the scene of the Appendix's second sample run
"""

from __future__ import annotations

import argparse

from ..scene import SIGNS, sample, template
from .options import add_output_argument, add_sample_argument

__doc__ = (__doc__ or "").format(signs=SIGNS)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 scene`."""
    add_sample_argument(parser)
    add_output_argument(parser)


def main(args: argparse.Namespace) -> int:
    """Print a scene file."""
    print(sample(args.sample).to_toml() if args.sample else template(), end="")
    return 0
