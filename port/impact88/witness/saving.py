"""Writing what the ROM did in the captures' own form: a folder laid out as golden/ is."""

import gzip
import json
import os
from collections.abc import Iterable

from ..checking.captured import ARITHMETIC, ENDINGS, FUZZ, PROGRAMS, SCENES, golden
from ..errors import UserError
from ..files import replacing
from .hearing import Heard
from .packaged import OWN


def save(folder: str, heard: Iterable[Heard]) -> None:
    """Write captures into a folder, which is made; each file holds those of this call only.

    Raises UserError when a place cannot be written to.
    """
    files: dict[str, list[str]] = {}
    index: dict[str, str] = {}
    for one in heard:
        if one.kind in (SCENES, FUZZ):
            files.setdefault(f"{one.kind}.jsonl.gz", []).append(json.dumps(one.capture))
        elif one.kind == ARITHMETIC:
            name = os.path.join(ARITHMETIC, f"{one.capture[0]}.tsv.gz")
            files.setdefault(name, []).append("\t".join(one.capture))
        else:
            for ending in ENDINGS:
                if one.capture.get(ending):
                    name = os.path.join(PROGRAMS, f"{one.name}.{ending}")
                    files[name] = [one.capture[ending]]
            if one.kind != OWN:
                index[one.name] = str(one.capture["instructions"])
    if index:
        text = golden().joinpath(PROGRAMS, "index.tsv").read_text("utf-8")
        heading, *rows = (line.split("\t") for line in text.splitlines())
        kept = [[*row[:-1], index[row[0]]] for row in rows if row[0] in index]
        files[os.path.join(PROGRAMS, "index.tsv")] = ["\t".join(r) + "\n" for r in (heading, *kept)]
    for name, lines in files.items():
        path = os.path.join(folder, name)
        try:
            os.makedirs(os.path.dirname(path), exist_ok=True)
        except OSError as error:
            raise UserError(f"cannot be made: {error.strerror or error}", folder) from None
        data = "".join(lines).encode("latin-1")
        if name.endswith(".gz"):  # the same lines give the same bytes on every day
            data = gzip.compress("".join(f"{line}\n" for line in lines).encode(), mtime=0)
        with replacing(path, "wb") as file:
            file.write(data)
