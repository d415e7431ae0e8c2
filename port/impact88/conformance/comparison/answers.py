"""Assign the rows of a table to the vectors of a kit, by id, and keep the verdict on each vector.

A kit gives its rows their scenes. Every id must occur once, with the vector's own inputs, bit for
bit; the verdict on a vector is then what `compare` says of its row.
"""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.doubles import doubles_of
from ...errors import one_line
from ...files import open_bytes
from ...names import SCENE
from ...tables.cells import TableUnits, numbers
from ...tables.rows import Rows
from .agreement import Question
from .junit import Test
from .kit import FORM, Kit, Vector
from .reasons import AGREEMENT, CHANGED, HARMLESS, MISSING, REASONS, REPEATED, STRAY
from .vectors import FROZEN_COUNT, FROZEN_ID, FROZEN_SEED

PASSES = (AGREEMENT, *HARMLESS)


class Verdict(NamedTuple):
    """The verdict on a vector: "" or a reason why its row does not agree; the row's number, from 1
    (0 where there is none); the results or the input at fault."""

    vector: Vector
    reason: str
    row: int = 0
    detail: str = ""

    def __str__(self) -> str:
        place = f", row {self.row}" if self.row else ""
        detail = f": {one_line(self.detail, 100)}" if self.detail else ""
        return f"{self.vector.id} ({self.vector.label}){place}{detail}"


@dataclass
class KitAnswers:
    """A table's answers to the vectors of a kit.

    Parameters
    ----------
    kit : Kit
        The vectors, their seed and hash.
    sha256 : str
        Hash of the table's bytes, "" for a data frame.
    strays : int
        Number of rows that are no vector's.
    """

    kit: Kit
    sha256: str = ""
    strays: int = 0

    def __post_init__(self) -> None:
        vectors = self.kit.vectors
        self.verdicts = [Verdict(vector, MISSING) for vector in vectors]
        self._places = {vector.id: place for place, vector in enumerate(vectors)}
        scenes = [doubles_of(vector.scene) for vector in vectors]
        # the last of each column is for rows without a vector
        self._scenes = {name: np.array([*(g[name] for g in scenes), np.nan]) for name in SCENE}
        self._classes = np.array([*(vector.kind for vector in vectors), ""])
        self._labels = np.array([*(vector.label for vector in vectors), ""])
        self._found = np.zeros(0, int)
        self._answered: set[int] = set()
        self._details: dict[int, str] = {}

    @property
    def failures(self) -> list[Verdict]:
        """The verdicts on the vectors that do not pass."""
        return [verdict for verdict in self.verdicts if verdict.reason not in PASSES]

    @property
    def conforms(self) -> bool:
        """True if every vector passes and every row is a vector's."""
        return not self.failures and not self.strays

    @property
    def badge(self) -> str:
        """The vectors, how many pass, and the hashes of table and kit, in one line."""
        kit, count = self.kit, len(self.verdicts)
        name = f"{FORM} seed {kit.seed}"
        if (kit.seed, count) == (FROZEN_SEED, FROZEN_COUNT):
            name = f"vectors {FROZEN_ID}"
        state = "conforms" if self.conforms else "does not conform"
        hashes = f"table {self.sha256[:12]}, " * bool(self.sha256) + f"kit {kit.sha256[:12]}"
        return f"impact88 {name}: {state}, {count - len(self.failures)} of {count} ({hashes})"

    def counts(self, attribute: str) -> dict[str, dict[str, int]]:
        """Return the numbers that pass and fail by an attribute of the vectors: kind or label."""
        groups: dict[str, dict[str, int]] = {}
        for verdict in self.verdicts:
            key = getattr(verdict.vector, attribute)
            group = groups.setdefault(key, {"passed": 0, "failed": 0})
            group["passed" if verdict.reason in PASSES else "failed"] += 1
        return groups

    @contextmanager
    def hash_table(self, path: str) -> Iterator[str]:
        """Keep the hash of a table's file and yield its path; standard input (``-``) is copied to a
        temporary file."""
        with tempfile.TemporaryDirectory() as folder:
            if path == "-":
                path = os.path.join(folder, "standard input.csv")
                with open_bytes("-") as source, open(path, "wb") as file:
                    shutil.copyfileobj(source, file)
            with open_bytes(path) as file:
                self.sha256 = hashlib.file_digest(file, "sha256").hexdigest()
            yield path

    def find(self, rows: Rows, units: TableUnits) -> Question:
        """Return what rows of the table answer."""
        ids = [str(cell) for cell in rows.one_per_row("id")]
        self._found = places = np.array([self._places.get(name, -1) for name in ids])
        scenes = {name: column[places] for name, column in self._scenes.items()}
        refusals = np.where(places < 0, REASONS.index(STRAY), 0)
        for name, column in numbers(rows, units).items():
            is_read = ~np.isnan(column) | (scenes["M"] != 4)  # of point masses not every cell is
            differs = is_read & (column != scenes[name]) & (refusals == 0)
            for index in np.flatnonzero(differs).tolist():
                refusals[index] = REASONS.index(CHANGED)
                vector = self.kit.vectors[places[index]]
                says = f"{name} is {float(column[index])!r}, not {vector.scene[name]}"
                self._details[rows.first + index] = says
        for index, place in enumerate(places.tolist()):
            if place >= 0 and place in self._answered:
                refusals[index] = REASONS.index(REPEATED)
            self._answered.add(place)
        classes, labels = (column[places] for column in (self._classes, self._labels))
        return Question(scenes, classes, labels, refusals)

    def add(self, rows: Rows, reasons: NDArray[np.intp], details: Mapping[int, str]) -> None:
        """Enter the verdicts on the rows that were found last."""
        found = zip(self._found.tolist(), reasons.tolist(), strict=True)
        for row, (place, code) in enumerate(found, rows.first):
            if place < 0:
                self.strays += 1
            elif self.verdicts[place].row:
                first = self.verdicts[place]
                self.verdicts[place] = first._replace(reason=REPEATED, detail=f"and row {row}")
            else:
                detail = self._details.get(row) or details.get(row, "")
                vector = self.kit.vectors[place]
                self.verdicts[place] = Verdict(vector, REASONS[code], row, detail)

    def tests(self) -> Iterator[Test]:
        """Yield a test for each vector, and one for the rows that are no vector's."""
        for vector, reason, _, detail in self.verdicts:
            message = f"{reason}; {detail}".removesuffix("; ")
            outcome = "" if reason in PASSES else "failure"
            yield Test(f"{vector.id} {vector.label}", outcome, message, f"kit.{vector.kind}")
        if self.strays:
            yield Test(f"rows: {self.strays}", "failure", STRAY, "kit.strays")

    @property
    def identity(self) -> dict[str, Any]:
        """Which vectors were answered by which table."""
        return {
            "vectors": FORM,
            "seed": self.kit.seed,
            "count": len(self.verdicts),
            "sha256": self.kit.sha256,
            "table_sha256": self.sha256,
        }

    def as_json(self) -> dict[str, Any]:
        """Return the part of ``compare --json`` that is about the kit."""
        keys = ("id", "class", "label", "reason", "row", "detail")
        failures = [(*verdict.vector[:3], *verdict[1:]) for verdict in self.failures]
        return {
            "badge": self.badge,
            "conforms": self.conforms,
            **self.identity,
            "passed": len(self.verdicts) - len(failures),
            "failed": len(failures),
            "classes": self.counts("kind"),
            "labels": self.counts("label"),
            "failures": [dict(zip(keys, failure, strict=True)) for failure in failures],
        }
