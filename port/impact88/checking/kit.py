"""The kit for other implementations: test vectors, what is asked of a program by each, conventions,
and programs in several languages that read and answer them.

``vectors.csv`` has the scenes, ``vectors.jsonl`` all that is known of them. Both are the same on
any machine for the same seed; ``KIT.json`` tells seed, version and hashes.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
from collections.abc import Iterable, Iterator
from importlib import resources
from random import Random
from typing import Any

from .. import schemas
from ..errors import UserError
from ..files import replacing
from ..names import FINAL_VELOCITIES, SCENE
from ..schemas import stamped
from ..version import __version__
from .oracle import look_up
from .vectors import FAILURE, casework, vectors

VERSION = 2
"""Of the vectors' own form: 2 has flags, expect and comment, and negative masses and inertias."""
ANSWER, REFUSE, EITHER = "answer", "refuse", "either"
HEAD = ("id", "class", "expect", "flags")
_NEGATIVE = ("MA", "MB", "IA", "IB")


def kit_vectors(count: int, seed: int, reference: bool = True) -> Iterator[dict[str, Any]]:
    """``count`` test vectors, and one for each mass and inertia that is negative."""
    yield from map(asked, vectors(count, seed, reference))
    rng = Random(f"{seed} negative")
    for place, name in enumerate(_NEGATIVE):
        scene = casework(rng)
        scene[name] = f"-{scene[name]}"
        head = {"id": f"{seed}-{count + place:06d}", "class": FAILURE, "label": f"{name} negative"}
        (answer,) = look_up([scene], reference)
        yield asked(stamped("vectors", {**head, "scene": scene, **answer}))


def asked(vector: dict[str, Any]) -> dict[str, Any]:
    """A vector with what is asked of a program by it (``expect``), flags, and a comment."""
    solvable = all(vector["results"][name]["double"] is not None for name in FINAL_VELOCITIES)
    expect = ANSWER if vector["class"] != FAILURE else EITHER if solvable else REFUSE
    ending = vector["ending"]
    comment = (
        f"{vector['label']}; the 1988 program {f'ends with {ending}' if ending else 'answers'}"
    )
    head = {name: vector[name] for name in ("id", "class", "label")}
    return {
        **head,
        "expect": expect,
        "flags": vector["status"],
        "comment": comment,
        **{name: value for name, value in vector.items() if name not in head},
    }


def flat(found: Iterable[dict[str, Any]]) -> Iterator[str]:
    """The scenes as CSV, a line each, the header first; no field needs quotes."""
    yield ",".join([*HEAD, *SCENE, "comment"]) + "\n"
    for one in found:
        out = io.StringIO()
        cells = [one["id"], one["class"], one["expect"], " ".join(one["flags"])]
        scene = [one["scene"][name] for name in SCENE]
        csv.writer(out, lineterminator="\n").writerow(
            [*cells, *scene, one["comment"].replace(",", " -")]
        )
        yield out.getvalue()


def write_kit(folder: str, count: int, seed: int) -> list[str]:
    """Write the kit into a folder, which is made where it is not there; the names of its files.
    Raises UserError where the folder cannot be written to."""
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise UserError(f"cannot be made: {error.strerror or error}", folder) from None
    found = list(kit_vectors(count, seed))
    lines = "".join(json.dumps(one, ensure_ascii=False) + "\n" for one in found)
    files = {
        "vectors.csv": "".join(flat(found)),
        "vectors.jsonl": lines,
        "vectors.schema.json": schemas.text("vectors"),
        "conventions.md": schemas.text(schemas.CONVENTIONS),
    }
    for runner in resources.files(__package__).joinpath("kit").iterdir():
        files[runner.name.removesuffix(".txt")] = runner.read_text(encoding="utf-8")
    about = {
        "kit": f"vectors/{VERSION}",
        "impact88": __version__,
        "seed": seed,
        "vectors": len(found),
        "sha256": {name: hashlib.sha256(text.encode()).hexdigest() for name, text in files.items()},
    }
    files["KIT.json"] = json.dumps(about, indent=1) + "\n"
    for name, text in files.items():
        with replacing(os.path.join(folder, name), "wb") as file:
            file.write(text.encode())
    return sorted(files)
