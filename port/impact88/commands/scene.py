"""examples:
impact88 scene > mine.toml        a template to fill in
impact88 scene --sample 2         the scene of the Appendix's second sample run
"""

from __future__ import annotations

import argparse

from ..scene import sample, template
from .options import add_output_argument, add_sample_argument


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 scene`."""
    add_sample_argument(parser)
    add_output_argument(parser)


def main(args: argparse.Namespace) -> int:
    """Print a scene file."""
    print(sample(args.sample).to_toml() if args.sample else template(), end="")
    return 0
