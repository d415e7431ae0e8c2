"""The kit: 1,000 frozen test vectors under an id, starter programs, and a judge of answers."""

import gzip
import hashlib
import json
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from ..errors import UserError, quoted
from ..files import packaged_bytes, write_folder
from .agreement import COMPARED, Bools
from .numbers import EMPTY, numbers, units
from .spellings import COLUMNS, VELOCITIES

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


def check_kit(kit: str) -> None:
    """Raise UserError unless a kit is the frozen set."""
    if kit != FROZEN_ID:
        raise UserError(f"{quoted(kit)} is not a kit; expected its id, {FROZEN_ID}")


class Answers:
    """A table's answers in the order of the vectors, and the vectors that fail for want of one."""

    def __init__(self, columns: Mapping[str, Any]) -> None:
        if absent := [name for name in ("id", *VELOCITIES) if name not in columns]:
            raise UserError(f"missing columns: {' '.join(absent)}; a kit's answers have them")
        self.vectors = frozen_vectors()
        self.reasons: dict[str, str] = {}
        rows: dict[str, list[int]] = {}
        for row, label in enumerate(np.asarray(columns["id"]).tolist()):
            rows.setdefault(str(label).strip(), []).append(row)
        self.stray = sorted(rows.keys() - {vector["id"] for vector in self.vectors})
        self.places = np.zeros(len(self.vectors), int)
        for place, vector in enumerate(self.vectors):
            found = rows.get(vector["id"], [])
            if len(found) != 1:
                self.reasons[vector["id"]] = REPEATED if found else MISSING
            self.places[place] = found[0] if found else -1
        self.scene = {
            name: numbers([vector["scene"][name] for vector in self.vectors]) for name in COLUMNS
        }
        self.results = {
            name: self._in_order(column) for name, column in columns.items() if name in COMPARED
        }
        self._check(columns)

    def _in_order(self, column: Any) -> Any:
        """Return a column in the order of the vectors, empty where there is no row."""
        cells = [*(str(cell).strip() for cell in np.asarray(column).tolist()), ""]
        return np.array([cells[place] for place in self.places])

    def _check(self, columns: Mapping[str, Any]) -> None:
        """Find inputs that were changed, and cells that are neither empty nor a number."""
        inputs = {
            name: numbers(self._in_order(columns[name])) for name in COLUMNS if name in columns
        }
        values = {name: numbers(self.results[name]) for name in VELOCITIES}
        for place, vector in enumerate(self.vectors):
            label = vector["id"]
            if label in self.reasons:
                continue
            if any(inputs[name][place] != self.scene[name][place] for name in inputs):
                self.reasons[label] = CHANGED
            cells = [self.results[name][place].lower() for name in VELOCITIES]
            texts = [cell for cell in cells if cell not in EMPTY]
            finite = sum(bool(np.isfinite(values[name][place])) for name in VELOCITIES)
            if len(texts) > finite:
                self.reasons[label] = NO_NUMBER
            elif 0 < finite < len(VELOCITIES):
                self.reasons[label] = PARTIAL
            elif not finite and vector["expect"] == ANSWER:
                self.reasons[label] = NO_ANSWER
            elif finite and vector["expect"] == REFUSE:
                self.reasons[label] = SURPLUS

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
        if any(self._is_coarse(name) for name in VELOCITIES):
            self.reasons = {v["id"]: self.reasons.get(v["id"], COARSE) for v in self.vectors}
        for place in np.flatnonzero(wrong):
            self.reasons.setdefault(self.vectors[place]["id"], DISAGREES)
        failures: dict[str, list[str]] = {}
        for label, reason in self.reasons.items():
            failures.setdefault(reason, []).append(label)
        total = len(self.vectors)
        return {
            "id": FROZEN_ID,
            "vectors": total,
            "passed": total - len(self.reasons),
            "failed": failures,
            "stray": self.stray,
        }
