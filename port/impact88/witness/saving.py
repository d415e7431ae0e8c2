"""Writing what the ROM did in the captures' own form: a folder laid out as golden/ is."""

from __future__ import annotations

import gzip
import json
import os
from collections.abc import Iterable

from ..errors import UserError
from ..files import replacing
from .hearing import Heard
from .packaged import ARITHMETIC, FUZZ, OWN, PROGRAMS, SCENES, program_index

_ENDINGS = ("bas", "in", "out", "scr")


def save(folder: str, heard: Iterable[Heard]) -> None:
    """Write captures into a folder, which is made; each file holds those of this call only.

    Raises UserError when a place cannot be written to.
    """
    kinds: dict[str, list[Heard]] = {}
    for one in heard:
        kinds.setdefault(one.kind, []).append(one)
    _make(folder)
    for kind in (SCENES, FUZZ):
        if kind in kinds:
            lines = [json.dumps(one.capture) for one in kinds[kind]]
            _write_gzip(os.path.join(folder, f"{kind}.jsonl.gz"), lines)
    if ARITHMETIC in kinds:
        _make(os.path.join(folder, ARITHMETIC))
        calls: dict[str, list[str]] = {}
        for one in kinds[ARITHMETIC]:
            calls.setdefault(one.capture[0], []).append("\t".join(one.capture))
        for operation, rows in calls.items():
            _write_gzip(os.path.join(folder, ARITHMETIC, f"{operation}.tsv.gz"), rows)
    if OWN in kinds:
        _write_texts(os.path.join(folder, PROGRAMS), kinds[OWN])
    if PROGRAMS in kinds:
        _save_programs(os.path.join(folder, PROGRAMS), kinds[PROGRAMS])


def _save_programs(folder: str, heard: list[Heard]) -> None:
    _write_texts(folder, heard)
    counts = {one.name: str(one.capture["instructions"]) for one in heard}
    heading, *rows = program_index()
    with replacing(os.path.join(folder, "index.tsv")) as file:
        for row in [heading, *([*row[:-1], counts[row[0]]] for row in rows if row[0] in counts)]:
            file.write("\t".join(row) + "\n")


def _write_texts(folder: str, heard: list[Heard]) -> None:
    _make(folder)
    for one in heard:
        for ending in _ENDINGS:
            if one.capture.get(ending):
                with replacing(os.path.join(folder, f"{one.name}.{ending}"), "wb") as file:
                    file.write(one.capture[ending].encode("latin-1"))


def _make(folder: str) -> None:
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise UserError(f"cannot be made: {error.strerror or error}", folder) from None


def _write_gzip(path: str, lines: list[str]) -> None:
    """Lines, compressed; the same lines give the same bytes on every day."""
    with replacing(path, "wb") as file:
        file.write(gzip.compress("".join(f"{line}\n" for line in lines).encode(), mtime=0))
