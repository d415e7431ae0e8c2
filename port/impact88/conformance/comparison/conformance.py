"""Check the conformance of a program: its answer to every vector of the kit, by id.

The vectors are those generated from the kit's seed; a kit with other vectors is refused. Every id
must occur once, its inputs must be the vector's doubles, and its expectation is enforced: an answer
where one is due, no number where there is none. Missing rows and cells count as failures.
"""

import hashlib
import io
import json
import os
import shutil
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, NamedTuple
from zipfile import BadZipFile, ZipFile

import numpy as np

from ...collision.doubles import doubles_of
from ...errors import UserError, one_line, quoted
from ...files import display_name, open_bytes, read_bytes
from ...messages.plaintable import plain
from ...messages.schemas import NUMBERS
from ...names import FINAL_VELOCITIES, SCENE
from ...tables.cells import TableUnits, numbers
from ...tables.rows import Rows
from .agreement import DIFFER, LOST, Floats
from .compare import Block, compare_block, open_table, read_blocks, result_columns
from .junit import Test, write
from .kit import csv_lines
from .vectors import (
    ANSWER,
    EITHER,
    FROZEN_COUNT,
    FROZEN_ID,
    FROZEN_SEED,
    REFUSE,
    expectation,
    frozen,
    scenes,
)

ABOUT = "KIT.json"
SCENES = "vectors.csv"
MAX_VECTORS = 10**7
MAX_STRAYS = 1000  # rows without a vector that are listed
REASONS = {
    "missing": "no row has this id",
    "repeated": "the id comes more than once",
    "inputs": "the inputs are not the vector's",
    "no answer": "an answer is missing where one is due",
    "no solution": "a number stands where there is none",
    "malformed": "a cell is neither a number nor left empty",
    "partial": "some results are given, others are not",
    "no digit": "a number shares no digit with ours",
    "differs": "a number differs",
}
"""Reason for which a vector fails -> message."""


class Vector(NamedTuple):
    """A vector of the kit: id, class (``kind``), label, the expected behaviour, the scene's
    texts."""

    id: str
    kind: str
    label: str
    expect: str
    scene: Mapping[str, str]


class Verdict(NamedTuple):
    """Verdict on a vector. ``reason``: key of `REASONS`, "" where it passes; ``row``: of the table,
    counted from 1; 0 where it has none."""

    vector: Vector
    reason: str
    detail: str
    row: int


@dataclass
class Kit:
    """A kit: its place, its seed, the hash of its vectors, and the vectors."""

    place: str
    seed: int
    sha256: str
    vectors: Sequence[Vector]


@dataclass
class Conformance:
    """The result of `check_conformance`.

    Attributes
    ----------
    kit : Kit
    table : str
        Name of the table of answers.
    sha256 : str
        Hash of the table's bytes.
    results : list of str
        Result columns of the table.
    verdicts : list of Verdict
        One for each vector, in the kit's order.
    strays : list of str
        Rows without a vector: an unknown id, or none.
    unknown : dict of str to str
        Columns that were not recognised, and the name that was probably meant, or "".
    refused : int
        Number of vectors that pass without an answer, which their class permits.
    place : dict
        The table's sheet in a workbook, and the row of its headings.
    remarks : list of str
        Remarks on how the table was read.
    """

    kit: Kit
    table: str
    sha256: str
    results: list[str]
    verdicts: list[Verdict] = field(default_factory=list)
    strays: list[str] = field(default_factory=list)
    unknown: dict[str, str] = field(default_factory=dict)
    refused: int = 0
    place: dict[str, Any] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)

    @property
    def failures(self) -> list[Verdict]:
        """The vectors that fail."""
        return [verdict for verdict in self.verdicts if verdict.reason]

    @property
    def passed(self) -> int:
        """Number of vectors that pass."""
        return len(self.verdicts) - len(self.failures)

    @property
    def conforms(self) -> bool:
        """True if every vector passes and there are no strays."""
        return not self.failures and not self.strays

    @property
    def badge(self) -> str:
        """Summary in one line: the vectors, how many pass, and the hashes of table and kit."""
        state = "conforms" if self.conforms else "does not conform"
        count = f"{self.passed} of {len(self.verdicts)}"
        vectors = f"impact88 vectors/{NUMBERS['vectors']} seed {self.kit.seed}"
        is_frozen = self.kit.seed == FROZEN_SEED and len(self.verdicts) == FROZEN_COUNT
        vectors = f"impact88 vectors {FROZEN_ID}" if is_frozen else vectors
        return f"{vectors}: {state}, {count} (table {self.sha256[:12]}, kit {self.kit.sha256[:12]})"

    def counts(self, attribute: str) -> dict[str, dict[str, int]]:
        """Return the numbers that pass and fail by an attribute of the vectors: kind or label."""
        groups: dict[str, dict[str, int]] = {}
        for verdict in self.verdicts:
            key = getattr(verdict.vector, attribute)
            group = groups.setdefault(key, {"passed": 0, "failed": 0})
            group["failed" if verdict.reason else "passed"] += 1
        return groups

    def write_junit(self, path: str, name: str, strict: bool = True) -> None:
        """Write the JUnit report: a test for each vector, with the vector's class, and one for each
        stray row; all are strict."""
        tests = []
        for vector, reason, detail, _ in self.verdicts:
            message = f"{REASONS[reason]}; {detail}".removesuffix("; ") if reason else ""
            outcome = "failure" if reason else ""
            title = f"{vector.id} {vector.label}"
            tests.append(Test(title, outcome, message, f"kit.{vector.kind}"))
        tests += [Test(stray, "failure", stray, "kit.strays") for stray in self.strays]
        properties = {
            "kit.sha256": self.kit.sha256,
            "table.sha256": self.sha256,
            "kit.vectors": f"vectors/{NUMBERS['vectors']} seed {self.kit.seed}",
        }
        write(path, f"impact88 compare --kit, {name}", tests, **properties)

    def as_json(self) -> dict[str, Any]:
        """Return the object that `impact88 compare --kit DIR --json` prints."""
        full_kit: dict[str, Any] = {
            "summary": self.badge,
            "conforms": self.conforms,
            "kit": {
                "vectors": f"vectors/{NUMBERS['vectors']}",
                "seed": self.kit.seed,
                "count": len(self.verdicts),
                "sha256": self.kit.sha256,
            },
            "table": {
                "name": self.table,
                "sha256": self.sha256,
                "results": self.results,
                **self.place,
            },
            "passed": self.passed,
            "failed": len(self.failures),
            "refused": self.refused,
            "classes": self.counts("kind"),
            "labels": self.counts("label"),
            "reasons": dict(Counter(verdict.reason for verdict in self.failures)),
            "failures": [
                {
                    "id": verdict.vector.id,
                    "class": verdict.vector.kind,
                    "label": verdict.vector.label,
                    "expect": verdict.vector.expect,
                    "row": verdict.row,
                    "reason": verdict.reason,
                    "detail": verdict.detail,
                }
                for verdict in self.failures
            ],
            "strays": self.strays,
            "unknown_columns": list(self.unknown),
            "remarks": self.remarks,
        }
        return {name: plain(value) for name, value in full_kit.items()}


def read_kit(place: str) -> Kit:
    """Return the kit in a folder or an archive (.zip), with its vectors regenerated from its seed;
    or the frozen set by its id.

    Raises
    ------
    UserError
        Where there is no kit, it is of another number than this version's, or its vectors are not
        those of its seed.
    """
    if place == FROZEN_ID and not os.path.exists(place):
        vectors_expected = list(_vectors(FROZEN_COUNT, FROZEN_SEED))
        data = "".join(csv_lines(frozen())).encode()
        return Kit(place, FROZEN_SEED, hashlib.sha256(data).hexdigest(), vectors_expected)
    about = _parse_about(place, _kit_file(place, ABOUT))
    mine = f"vectors/{NUMBERS['vectors']}"
    if about.get("kit") != mine:
        says = f"is of {one_line(str(about.get('kit')), 40)}, and this version judges {mine}"
        raise UserError(f"{says}; expected a kit of impact88 oracle --kit", _in(place, ABOUT))
    seed, count = about.get("seed"), about.get("vectors")
    if type(seed) is not int or type(count) is not int or not 0 < count <= MAX_VECTORS:
        raise UserError("has no seed and count of vectors", _in(place, ABOUT))
    data = _kit_file(place, SCENES)
    digest = hashlib.sha256(data).hexdigest()
    hashes = about.get("sha256")
    if not isinstance(hashes, dict) or hashes.get(SCENES) != digest:
        raise UserError(f"is not the file that {ABOUT} has the hash of", _in(place, SCENES))
    vectors_expected = list(_vectors(count, seed))
    lines = data.decode("utf-8", "replace").splitlines()[1:]
    if len(lines) != count:
        raise UserError(f"has {len(lines)} vectors, not {count}", _in(place, SCENES))
    for number, (line, vector) in enumerate(zip(lines, vectors_expected, strict=True), 2):
        head = [vector.id, vector.kind, vector.expect]
        cells = line.split(",")
        if cells[:3] != head or cells[4 : 4 + len(SCENE)] != list(vector.scene.values()):
            line_place = f"{_in(place, SCENES)}, line {number}"
            raise UserError(f"is not the vector {vector.id} of seed {seed}", line_place)
    return Kit(place, seed, digest, vectors_expected)


def _in(place: str, name: str) -> str:
    return os.path.join(place, name)


def _kit_file(place: str, name: str) -> bytes:
    """Return a file of a kit. Raises UserError."""
    if os.path.isdir(place):
        return read_bytes(_in(place, name))
    try:
        with ZipFile(io.BytesIO(read_bytes(place))) as archive:
            if archive.getinfo(name).file_size > 1 << 30:
                raise UserError("is larger than a kit's", _in(place, name))
            return archive.read(name)
    except KeyError:
        raise UserError(f"holds no {name}; expected a kit", place) from None
    except (BadZipFile, NotImplementedError, RuntimeError, OSError, EOFError) as error:
        raise UserError(f"is no kit: {error}; expected a folder or a .zip", place) from None
    except Exception as error:  # zlib's own
        raise UserError(f"cannot be unpacked: {error}", place) from None


def _parse_about(place: str, data: bytes) -> dict[str, Any]:
    try:
        about = json.loads(data)
    except (ValueError, RecursionError):
        about = None
    if not isinstance(about, dict):
        raise UserError("is not a JSON object", _in(place, ABOUT))
    return about


def _vectors(count: int, seed: int) -> Iterator[Vector]:
    """Yield the vectors of a seed, with the behaviour expected for each."""
    rows = list(scenes(count, seed))
    for index, (kind, label, scene) in enumerate(rows):
        yield Vector(f"{seed}-{index:06d}", kind, label, expectation(kind, scene), scene)


def check_conformance(
    kit: str, theirs: str, format: str, encoding: str | None = None
) -> Conformance:
    """Judge a table of another program's answers to a kit's vectors, vector by vector.

    Parameters
    ----------
    kit : str
        The kit's folder, or its archive.
    theirs : str
        The table; ``-`` is standard input.
    format : str
        Its format, as ``--from`` of `impact88 solve` names it.
    encoding : str, optional
        Encoding of a CSV or JSON Lines file that is not UTF-8.

    Raises
    ------
    UserError
        Where kit or table cannot be read, or the table lacks ids or a final velocity.
    """
    full_kit = read_kit(kit)
    where = display_name(theirs)
    with _on_disk(theirs) as path, open_table(path, format, encoding) as (reader, _):
        results, unknown = result_columns(reader)
        if "id" not in reader.names:
            raise UserError("no column id; expected the kit's ids, one a row", where)
        if missing := [name for name in FINAL_VELOCITIES if name not in results]:
            raise UserError(
                f"no column {' '.join(missing)}; expected all of {' '.join(FINAL_VELOCITIES)}",
                where,
            )
        result = Conformance(full_kit, where, _digest(path), results, unknown=unknown)
        result.place, result.remarks = reader.place, reader.remarks
        judge = _Judge(result)
        for rows, units in read_blocks(reader, results, where):
            judge.add(rows, units)
    judge.finish()
    return result


@contextmanager
def _on_disk(path: str) -> Iterator[str]:
    """Yield the path of the table's file; standard input is copied to a temporary one, so that its
    bytes can be hashed."""
    if path != "-":
        yield path
        return
    with tempfile.TemporaryDirectory() as folder:
        copy = os.path.join(folder, "standard input.csv")
        with open_bytes("-") as source, open(copy, "wb") as file:
            shutil.copyfileobj(source, file)
        yield copy


def _digest(path: str) -> str:
    digest = hashlib.sha256()
    with open_bytes(path) as file:
        while part := file.read(1 << 20):
            digest.update(part)
    return digest.hexdigest()


class _Judge:
    """Verdicts on the vectors of a kit, by their places in it, as the table's rows are read."""

    def __init__(self, done: Conformance) -> None:
        self._done = done
        self._places = {vector.id: place for place, vector in enumerate(done.kit.vectors)}
        scenes = [doubles_of(vector.scene) for vector in done.kit.vectors]
        # that of a row without a vector is none
        self._scene = {name: np.array([*(g[name] for g in scenes), np.nan]) for name in SCENE}
        self._verdicts: dict[int, Verdict] = {}
        self._rows: dict[int, list[int]] = {}  # of the table, that have a vector's id
        self._empty: set[int] = set()  # vectors without an answer

    def add(self, rows: Rows, units: TableUnits) -> None:
        """Judge a block's rows; those without a vector are strays."""
        ids = [str(cell) for cell in rows.one_per_row("id")]
        places = np.array([self._places.get(name, -1) for name in ids])
        typed = numbers(rows, units)
        scene = {name: column[places] for name, column in self._scene.items()}
        block = compare_block(rows, scene, self._done.results, units)
        for index, place in enumerate(places.tolist()):
            row = rows.first + index
            if place < 0:
                self._add_stray(row, ids[index], [bad for bad in rows.bad if bad[0] == index])
                continue
            self._rows.setdefault(place, []).append(row)
            if len(self._rows[place]) == 1:
                vector = self._done.kit.vectors[place]
                reason, detail = _verdict(vector, typed, block, index)
                self._verdicts[place] = Verdict(vector, reason, detail, row)
                if not np.isfinite(block.case.values[:, index]).any():
                    self._empty.add(place)

    def _add_stray(self, row: int, name: str, bad: Sequence[tuple[int, str, str]]) -> None:
        says = f"id {quoted(name)} is no vector's" if name else "no id"
        for _, column, reason in bad[:1]:
            says = f"{column}: {reason}" if column else reason
        if len(self._done.strays) < MAX_STRAYS:
            self._done.strays.append(f"row {row}: {says}")

    def finish(self) -> None:
        """Add the verdict on every vector to the result."""
        for place, rows in self._rows.items():
            if len(rows) > 1:
                says = f"rows {', '.join(map(str, rows[:5]))}"
                verdict = self._verdicts[place]
                self._verdicts[place] = verdict._replace(reason="repeated", detail=says)
        for place, vector in enumerate(self._done.kit.vectors):
            verdict = self._verdicts.get(place, Verdict(vector, "missing", "", 0))
            self._done.verdicts.append(verdict)
            self._done.refused += int(place in self._empty and not verdict.reason)


def _verdict(
    vector: Vector, typed: Mapping[str, Floats], block: Block, index: int
) -> tuple[str, str]:
    """Return the reason for which a row of a block fails as the answer to a vector, and its
    details; two empty texts if it passes. ``typed``: the inputs in the table."""
    case, grades = block.case, block.grades[:, index]
    scene = doubles_of(vector.scene)
    for name, column in typed.items():
        if column[index] != scene[name]:
            return "inputs", f"{name} is {float(column[index])!r}, not {vector.scene[name]}"
    if malformed := [name for at, name, _ in block.rows.bad if at == index and name in case.names]:
        return "malformed", " ".join(malformed)
    values, ours = case.values[:, index], case.ours[:, index]
    names, theirs, is_due = np.array(case.names), np.isfinite(values), np.isfinite(ours)
    if np.isinf(values).any():
        says = "is infinite; a refusal leaves the cells empty"
        reason = "no answer" if vector.expect == ANSWER else "no solution"
        return reason, f"{' '.join(names[np.isinf(values)])} {says}"
    if vector.expect == REFUSE:
        return ("no solution", " ".join(names[theirs])) if theirs.any() else ("", "")
    if vector.expect == EITHER and not theirs.any():
        return "", ""
    if (theirs & ~is_due).any():
        return "no solution", " ".join(names[theirs & ~is_due])
    if (is_due & ~theirs).any():
        reason = "partial" if theirs.any() else "no answer"
        return reason, f"{' '.join(names[is_due & ~theirs])} missing"
    for grade, reason in ((DIFFER, "differs"), (LOST, "no digit")):
        for at in np.flatnonzero(grades == grade)[:1]:
            return reason, f"{names[at]} is {values[at]:.12g}, here {ours[at]:.12g}"
    return "", ""
