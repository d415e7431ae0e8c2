"""Check the conformance of a program: its answer to every vector of the kit, by id.

The vectors are those generated from the kit's seed; a kit with other vectors is refused. Every id
must occur once, its inputs must be the vector's doubles, and its expectation is enforced: an answer
where one is due, no number where there is none. Missing rows and cells count as failures.
"""

import hashlib
import io
import json
import math
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
from numpy.typing import NDArray

from ...collision.doubles import doubles_of
from ...errors import UserError, one_line, quoted
from ...files import display_name, open_bytes, read_bytes
from ...messages.plaintable import plain
from ...messages.schemas import NUMBERS
from ...names import FINAL_VELOCITIES, RESULTS, SCENE
from ...tables.cells import TableUnits, numbers
from ...tables.rows import Rows
from . import agreement
from .agreement import DIFFER, ELIMINATION, LOST, Case, Floats
from .compare import CARRIED, NOT_COMPARED, open_table
from .junit import Suite
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
    unknown : list of str
        Columns that were not recognised.
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
    unknown: list[str] = field(default_factory=list)
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
        which = f"impact88 vectors/{NUMBERS['vectors']} seed {self.kit.seed}"
        is_frozen = self.kit.seed == FROZEN_SEED and len(self.verdicts) == FROZEN_COUNT
        which = f"impact88 vectors {FROZEN_ID}" if is_frozen else which
        return f"{which}: {state}, {count} (table {self.sha256[:12]}, kit {self.kit.sha256[:12]})"

    def counts(self, attribute: str) -> dict[str, dict[str, int]]:
        """Return the numbers that pass and fail by an attribute of the vectors: kind or label."""
        groups: dict[str, dict[str, int]] = {}
        for verdict in self.verdicts:
            key = getattr(verdict.vector, attribute)
            group = groups.setdefault(key, {"passed": 0, "failed": 0})
            group["failed" if verdict.reason else "passed"] += 1
        return groups

    def as_json(self) -> dict[str, Any]:
        """Return the object that `impact88 compare --kit DIR --json` prints."""
        whole: dict[str, Any] = {
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
            "unknown_columns": self.unknown,
            "remarks": self.remarks,
        }
        return {name: plain(value) for name, value in whole.items()}


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
        expected = list(_vectors(FROZEN_COUNT, FROZEN_SEED))
        data = "".join(csv_lines(frozen())).encode()
        return Kit(place, FROZEN_SEED, hashlib.sha256(data).hexdigest(), expected)
    about = _parsed(place, _kit_file(place, ABOUT))
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
    expected = list(_vectors(count, seed))
    lines = data.decode("utf-8", "replace").splitlines()[1:]
    if len(lines) != count:
        raise UserError(f"has {len(lines)} vectors, not {count}", _in(place, SCENES))
    for number, (line, vector) in enumerate(zip(lines, expected, strict=True), 2):
        head = [vector.id, vector.kind, vector.expect]
        cells = line.split(",")
        if cells[:3] != head or cells[4 : 4 + len(SCENE)] != list(vector.scene.values()):
            where = f"{_in(place, SCENES)}, line {number}"
            raise UserError(f"is not the vector {vector.id} of seed {seed}", where)
    return Kit(place, seed, digest, expected)


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


def _parsed(place: str, data: bytes) -> dict[str, Any]:
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


class _Cell(NamedTuple):
    """A result as written: its value (NaN where there is none), the unit of its last digit, and
    its ``fault``: malformed, infinite, or ""."""

    value: float
    unit: float
    fault: str


_EMPTY = _Cell(math.nan, 0.0, "")


@dataclass
class _Table:
    """Answers by place of the vector: the numbers of its ``rows`` in the table, and the inputs
    (``scenes``) and results (``cells``) of the first of them."""

    rows: dict[int, list[int]] = field(default_factory=dict)
    scenes: dict[int, dict[str, float]] = field(default_factory=dict)
    cells: dict[int, dict[str, _Cell]] = field(default_factory=dict)


def check_conformance(kit: str, theirs: str, form: str, encoding: str | None = None) -> Conformance:
    """Judge a table of another program's answers to a kit's vectors, vector by vector.

    Parameters
    ----------
    kit : str
        The kit's folder, or its archive.
    theirs : str
        The table; ``-`` is standard input.
    form : str
        Its format: csv, jsonl, npz, parquet or xlsx.
    encoding : str, optional
        Encoding of a CSV or JSON Lines file that is not UTF-8.

    Raises
    ------
    UserError
        Where kit or table cannot be read, or the table lacks ids or a final velocity.
    """
    whole = read_kit(kit)
    where = display_name(theirs)
    with _on_disk(theirs) as path, open_table(path, form, encoding) as (reader, _):
        results = [n for n in reader.names if n in RESULTS and n not in NOT_COMPARED]
        if "id" not in reader.names:
            raise UserError("no column id; expected the kit's ids, one a row", where)
        if missing := [name for name in FINAL_VELOCITIES if name not in results]:
            raise UserError(
                f"no column {' '.join(missing)}; expected all of {' '.join(FINAL_VELOCITIES)}",
                where,
            )
        done = Conformance(whole, where, _digest(path), [str(name) for name in results])
        known = {*SCENE, *RESULTS, *CARRIED}
        done.unknown = [str(name) for name in reader.names if name not in known]
        done.place, done.remarks = reader.place, reader.remarks
        table = _Table()
        places = {vector.id: place for place, vector in enumerate(whole.vectors)}
        units: TableUnits | None = None
        for rows in reader:
            units = units or TableUnits(reader.names, None, rows, results, where)
            _add_answers(rows, results, units, places, table, done)
    _judge(whole, results, table, done)
    return done


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


def _add_answers(
    rows: Rows,
    results: Sequence[str],
    units: TableUnits,
    places: Mapping[str, int],
    table: _Table,
    done: Conformance,
) -> None:
    """Add a block's rows to ``table`` by vector; rows without a vector to the strays."""
    ids = [str(cell) for cell in rows.one_per_row("id")]
    scene = numbers(rows, units)
    theirs = {name: agreement.read_theirs(rows, name, units) for name in results}
    wrong: dict[int, str] = {}
    for index, name, reason in rows.bad:
        wrong.setdefault(index, f"{name}: {reason}" if name else reason)
    malformed = {(index, name) for index, name, _ in rows.bad}
    scene = {name: np.broadcast_to(column, (rows.count,)) for name, column in scene.items()}
    for index, name in enumerate(ids):
        row = rows.first + index
        place = places.get(name)
        if place is None:
            if len(done.strays) < MAX_STRAYS:
                says = f"id {quoted(name)} is no vector's" if name else "no id"
                done.strays.append(f"row {row}: {wrong.get(index, says)}")
            continue
        table.rows.setdefault(place, []).append(row)
        if len(table.rows[place]) == 1:
            table.scenes[place] = {n: float(column[index]) for n, column in scene.items()}
            cells = table.cells[place] = {}
            for result, (values, units_of) in theirs.items():
                value = float(values[index])
                fault = "malformed" if (index, result) in malformed else ""
                fault = "infinite" if math.isinf(value) else fault
                cells[result] = _Cell(value, float(units_of[index]), fault)


def _judge(kit: Kit, results: Sequence[str], table: _Table, done: Conformance) -> None:
    """Add a verdict on every vector."""
    count = len(kit.vectors)
    texts = [vector.scene for vector in kit.vectors]
    scene = {name: np.array([doubles_of(text)[name] for text in texts]) for name in SCENE}
    theirs: dict[str, tuple[Floats, Floats]] = {}
    for name in results:
        cells = [table.cells.get(place, {}).get(name, _EMPTY) for place in range(count)]
        theirs[name] = (
            np.array([cell.value for cell in cells]),
            np.array([cell.unit for cell in cells]),
        )
    case = agreement.make_case(scene, theirs)
    grades, relative = case.grade()
    noise, wrong = agreement.TrialNoise(), np.flatnonzero((grades == DIFFER).any(0))
    noise.add(case, wrong, grades, relative)
    if noise.count:
        grades[:, wrong[[is_noise for is_noise, *_ in noise.rows]]] = ELIMINATION
    for place, vector in enumerate(kit.vectors):
        rows = table.rows.get(place, [])
        reason, detail = _verdict(vector, place, rows, table, case, grades)
        done.verdicts.append(Verdict(vector, reason, detail, rows[0] if rows else 0))
        is_empty = not np.isfinite(case.values[:, place]).any()
        done.refused += int(is_empty and not reason)


def _verdict(
    vector: Vector,
    place: int,
    rows: Sequence[int],
    table: _Table,
    case: Case,
    grades: NDArray[np.intp],
) -> tuple[str, str]:
    """Return the reason for which a vector fails and its details; two empty texts if it passes."""
    if not rows:
        return "missing", ""
    if len(rows) > 1:
        return "repeated", f"rows {', '.join(map(str, rows[:5]))}"
    for name, value in table.scenes[place].items():
        if value != doubles_of(vector.scene)[name]:
            return "inputs", f"{name} is {value!r}, not {vector.scene[name]}"
    cells = table.cells[place]
    if malformed := [name for name, cell in cells.items() if cell.fault == "malformed"]:
        return "malformed", " ".join(malformed)
    if infinite := [name for name, cell in cells.items() if cell.fault == "infinite"]:
        says = "is infinite; a refusal leaves the cells empty"
        reason = "no answer" if vector.expect == ANSWER else "no solution"
        return reason, f"{' '.join(infinite)} {says}"
    theirs, ours = np.isfinite(case.values[:, place]), np.isfinite(case.ours[:, place])
    names = np.array(case.names)
    if vector.expect == REFUSE:
        return ("no solution", " ".join(names[theirs])) if theirs.any() else ("", "")
    if vector.expect == EITHER and not theirs.any():
        return "", ""
    if (theirs & ~ours).any():
        return "no solution", " ".join(names[theirs & ~ours])
    if (ours & ~theirs).any():
        reason = "partial" if theirs.any() else "no answer"
        return reason, f"{' '.join(names[ours & ~theirs])} missing"
    for grade, reason in ((DIFFER, "differs"), (LOST, "no digit")):
        for at in np.flatnonzero(grades[:, place] == grade)[:1]:
            value, mine = case.values[at, place], case.ours[at, place]
            return reason, f"{names[at]} is {value:.12g}, here {mine:.12g}"
    return "", ""


def write_junit(path: str, done: Conformance) -> None:
    """Write a JUnit report: a test for each vector, with the vector's class, and one for each
    stray row. Raises UserError when the place cannot be written to."""
    suite = Suite(f"impact88 compare --kit, {done.table}")
    suite.add_property("kit.sha256", done.kit.sha256)
    suite.add_property("table.sha256", done.sha256)
    suite.add_property("kit.vectors", f"vectors/{NUMBERS['vectors']} seed {done.kit.seed}")
    for verdict in done.verdicts:
        vector = verdict.vector
        message = f"{REASONS[verdict.reason]}; {verdict.detail}" if verdict.reason else ""
        suite.test(
            f"{vector.id} {vector.label}",
            "failure" if message else "",
            message.removesuffix("; "),
            f"kit.{vector.kind}",
        )
    for stray in done.strays:
        suite.test(stray, "failure", stray, "kit.strays")
    suite.write(path)
