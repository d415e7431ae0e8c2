"""The kit: 1,000 frozen test vectors under an id, starter programs, and a judge of answers."""

import gzip
import hashlib
import json
from collections import Counter
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from ..errors import UserError, quoted
from ..files import packaged_bytes, write_folder
from .agreement import Bools
from .numbers import EMPTY, numbers, units
from .spellings import COLUMNS, COMPARED, VELOCITIES

FROZEN_ID = "1988.1"
"""Under this id no answer changes; other vectors get another id."""
HEAD = ("id", "class", "expect")
REMARKS = ("flags", "comment")
"""Columns in which a program may say more."""
ANSWER = "answer"
REFUSE = "refuse"
EITHER = "either"
MIN_STEPS = 0.99e5  # units of the last digit in a kit's answer: six digits, as single precision has

MISSING = "the table has no row with this id"
REPEATED = "the id is in more than one row"
CHANGED = "an input is not the vector's"
NO_ANSWER = "no result, where there is one"
PARTIAL = "some of the six results are missing"
NO_NUMBER = "text or infinity in place of a number"
SURPLUS = "a number, where there is no answer"
DISAGREES = "a result disagrees"
COARSE = "the results are written with too few digits to judge a program"


@cache
def frozen_vectors() -> tuple[dict[str, Any], ...]:
    """Return the vectors of the frozen set: id, class, label, expect, scene and results."""
    text = gzip.decompress(packaged_bytes("impact88.golden", "vectors.jsonl.gz")).decode("utf-8")
    return tuple(map(json.loads, text.splitlines()))


def vectors_csv() -> str:
    """Return the scenes of the frozen set as CSV, and what is asked of a program."""
    lines = [",".join([*HEAD, *COLUMNS])]
    for vector in frozen_vectors():
        head = [vector[name] for name in HEAD]
        lines.append(",".join([*head, *(vector["scene"][name] for name in COLUMNS)]))
    return "\n".join(lines) + "\n"


def write_kit(folder: str) -> list[str]:
    """Write the kit into a folder, which is created if needed.

    Parameters
    ----------
    folder : str
        Path of the folder.

    Returns
    -------
    list of str
        The names of the files.
    """
    vectors = "".join(json.dumps(v, ensure_ascii=False) + "\n" for v in frozen_vectors())
    texts = {"vectors.csv": vectors_csv(), "vectors.jsonl": vectors}
    for starter in resources.files(__package__).joinpath("starters").iterdir():
        texts[starter.name.removesuffix(".txt")] = starter.read_text("utf-8")
    files = {name: text.encode("utf-8") for name, text in texts.items()}
    hashes = {name: hashlib.sha256(data).hexdigest() for name, data in files.items()}
    about = {"kit": FROZEN_ID, "vectors": len(frozen_vectors()), "sha256": hashes}
    files["KIT.json"] = (json.dumps(about, indent=1) + "\n").encode()
    write_folder(folder, files)
    return sorted(files)


class Answers:
    """A table's answers in the order of the vectors.

    Parameters
    ----------
    columns : mapping of str to array_like
        The table's columns.
    kit : str
        The kit's id.

    Attributes
    ----------
    scene, results : dict of str to ndarray
        The vectors' scenes, and the table's cells beside them.
    lacks : dict of str to ndarray of bool
        A reason for which vectors fail, and those; the first of a vector counts.
    """

    def __init__(self, columns: Mapping[str, Any], kit: str) -> None:
        if kit != FROZEN_ID:
            raise UserError(f"{quoted(kit)} is not a kit; expected its id, {FROZEN_ID}")
        if absent := [name for name in ("id", *VELOCITIES) if name not in columns]:
            raise UserError(f"missing columns: {' '.join(absent)}; a kit's answers have them")
        vectors = frozen_vectors()
        self.ids = [vector["id"] for vector in vectors]
        labels = [str(label).strip() for label in np.asarray(columns["id"]).tolist()]
        self.stray = sorted({*labels} - {*self.ids})
        rows = {label: row for row, label in enumerate(labels)}
        places = [rows.get(label, -1) for label in self.ids]
        cells = {
            name: np.array([*(str(cell).strip() for cell in np.asarray(column).tolist()), ""])[
                places
            ]
            for name, column in columns.items()
            if name in (*COLUMNS, *COMPARED)
        }
        self.scene = {n: numbers([vector["scene"][n] for vector in vectors]) for n in COLUMNS}
        self.results = {name: column for name, column in cells.items() if name in COMPARED}
        answers = np.array([cells[name] for name in VELOCITIES])
        written = (~np.isin(np.char.lower(answers), EMPTY)).sum(0)
        finite = np.isfinite([numbers(column) for column in answers]).sum(0)
        changed = [numbers(c) != self.scene[n] for n, c in cells.items() if n in COLUMNS]
        counts = Counter(labels)
        occurrences = np.array([counts[label] for label in self.ids])
        expected = np.array([vector["expect"] for vector in vectors])
        self.lacks: dict[str, Bools] = {
            MISSING: occurrences == 0,
            REPEATED: occurrences > 1,
            NO_NUMBER: written > finite,
            PARTIAL: (finite > 0) & (finite < len(VELOCITIES)),
            NO_ANSWER: (finite == 0) & (expected == ANSWER),
            SURPLUS: (finite > 0) & (expected == REFUSE),
            CHANGED: np.any(changed, 0),
            COARSE: np.full(len(places), any(map(self._is_coarse, VELOCITIES))),
        }

    def _is_coarse(self, name: str) -> bool:
        """Return whether half of a result's numbers have too few digits."""
        sizes = np.abs(numbers(self.results[name]))
        steps = (sizes / units({name: self.results[name]})[name])[sizes > 0]
        return bool(steps.size and np.median(steps) < MIN_STEPS)

    def verdict(self, wrong: Bools) -> dict[str, Any]:
        """Return the kit's part of a comparison.

        Parameters
        ----------
        wrong : ndarray of bool
            Vectors of which a result disagrees.
        """
        passing = np.ones(wrong.size, bool)
        failures = {}
        for reason, lacking in {**self.lacks, DISAGREES: wrong}.items():
            if ids := np.array(self.ids)[passing & lacking].tolist():
                failures[reason] = ids
            passing &= ~lacking
        return {
            "id": FROZEN_ID,
            "vectors": wrong.size,
            "passed": int(passing.sum()),
            "failed": failures,
            "stray": self.stray,
        }
