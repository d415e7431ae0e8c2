"""Options that several commands have."""

from __future__ import annotations

import argparse


def add_set_argument(parser: argparse.ArgumentParser, meaning: str) -> None:
    """The option ``--set NAME=VALUE``; ``meaning`` says what it does for this command."""
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help=f"{meaning}; repeatable"
    )
