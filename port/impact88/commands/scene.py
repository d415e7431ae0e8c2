"""examples:
impact88 scene > mine.toml        a template to fill in
impact88 scene --sample 2         the scene of the Appendix's second sample run
"""

from __future__ import annotations

import argparse

from ..scene import SAMPLES, sample, template


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 scene`."""
    parser.add_argument("--sample", type=int, choices=SAMPLES, help="a published run's scene")


def main(args: argparse.Namespace) -> int:
    """Print a scene file."""
    print(sample(args.sample).to_toml() if args.sample else template(), end="")
    return 0
