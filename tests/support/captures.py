"""Captures of the real ROM: their folder, and functions that read them.

IMPACT88_CAPTURES names a folder laid out as golden/ is (arithmetic/, programs/, corners/,
scenes.jsonl.gz, fuzz.jsonl.gz); without it golden/ itself is read.
"""

from __future__ import annotations

import gzip
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]


def folder() -> Path:
    """The folder of captures."""
    return Path(os.environ.get("IMPACT88_CAPTURES") or ROOT / "golden")


def jsonl(name: str) -> Iterator[dict[str, Any]]:
    """The objects of NAME.jsonl.gz, one a line."""
    with gzip.open(folder() / f"{name}.jsonl.gz", "rt", encoding="utf-8") as file:
        for line in file:
            yield json.loads(line)


def scenes() -> list[dict[str, Any]]:
    """Whole runs of the restored listing: scene, typed_lines, keyboard, printout, reals, A."""
    return list(jsonl("scenes"))


def vectors(path: Path) -> Iterator[list[str]]:
    """The rows of an arithmetic file: operation, first, second, extension, result."""
    with gzip.open(path, "rt", encoding="utf-8", newline="") as file:
        for line in file:
            yield line.rstrip("\n").split("\t")


def arithmetic_files() -> list[Path]:
    """The arithmetic vector files, by name: random calls, then the corners found since."""
    return [
        path
        for part in ("arithmetic", "corners")
        for path in sorted((folder() / part).glob("*.tsv.gz"))
    ]


def vector_file_id(path: Path) -> str:
    """Return the name of a file of vectors in a test's name."""
    return f"{path.parent.name}-{path.name.split('.')[0]}"


def printed(data: bytes) -> str:
    """A `.out`, `.in` or `.bas` of programs/ as text."""
    return data.decode("latin-1")
