"""Write the kit for other implementations: test vectors, what each expects of a program,
conventions, and programs in several languages that answer them. A seed always gives the same
bytes, so that a kit whose vectors are not those of its seed is refused when it is read."""

import hashlib
import io
import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from importlib import resources
from typing import Any, NamedTuple
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from ...equations.spelling import IMPULSES, NEGATIVE, SHOWN, Expression, spellings
from ...errors import UserError, one_line
from ...files import MAX_FILE_BYTES, read_bytes, replacing, write_folder
from ...messages import schemas
from ...names import RESULTS, SCENE
from ...version import __version__
from .vectors import FROZEN_COUNT, FROZEN_ID, FROZEN_SEED, frozen, scenes, vectors

HEAD = ("id", "class", "expect", "flags")
KIT = "KIT.json"
VECTORS = "vectors.csv"
FORM = f"vectors/{schemas.NUMBERS['vectors']}"


class Vector(NamedTuple):
    """A vector of a kit: id, class (``kind``), label, the scene's texts."""

    id: str
    kind: str
    label: str
    scene: Mapping[str, str]


class Kit(NamedTuple):
    """A kit: its seed, the hash of its vectors.csv, and the vectors."""

    seed: int
    sha256: str
    vectors: Sequence[Vector]


def csv_lines(vectors: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Yield the scenes as lines of CSV, the header first; no field needs quotes."""
    yield ",".join([*HEAD, *SCENE, "comment"]) + "\n"
    for vector in vectors:
        scene = [vector["scene"][name] for name in SCENE]
        yield ",".join([*_head(vector), *scene, vector["comment"].replace(",", " -")]) + "\n"


def _head(vector: dict[str, Any]) -> list[str]:
    return [vector["id"], vector["class"], vector["expect"], " ".join(vector["flags"])]


def write_kit(place: str, count: int, seed: int | None = None, reference: bool = True) -> list[str]:
    """Write the kit into a folder, which is created if needed, or into an archive (.zip).

    Returns the names of its files, sorted. ``seed``: of fresh vectors; by default they are those of
    the frozen set. ``reference``: include results to 30 digits. Raises UserError where the place
    cannot be written to, and where 30 digits of fresh vectors need mpmath.
    """
    rows = frozen(count) if seed is None else list(vectors(count, seed, reference))
    texts = {
        VECTORS: "".join(csv_lines(rows)),
        "vectors.jsonl": "".join(json.dumps(row, ensure_ascii=False) + "\n" for row in rows),
        "vectors.schema.json": schemas.text("vectors"),
        "conventions.md": schemas.text(schemas.CONVENTIONS),
    }
    for runner in resources.files(__package__).joinpath("kit").iterdir():
        texts[runner.name.removesuffix(".txt")] = runner.read_text(encoding="utf-8")
    files = {name: text.encode() for name, text in texts.items()}
    with suppress(ImportError):
        files["impact.xlsx"] = workbook(rows)
    about = {
        "kit": FORM,
        "impact88": __version__,
        "set": FROZEN_ID if seed is None else "",
        "seed": FROZEN_SEED if seed is None else seed,
        "vectors": len(rows),
        "sha256": {name: hashlib.sha256(data).hexdigest() for name, data in files.items()},
    }
    files[KIT] = (json.dumps(about, indent=1) + "\n").encode()
    if place.lower().endswith(".zip"):
        with replacing(place, "wb") as file, ZipFile(file, "w", ZIP_DEFLATED) as archive:
            for name, data in files.items():
                archive.writestr(ZipInfo(name, _ARCHIVE_DATE), data, ZIP_DEFLATED)
    else:
        write_folder(place, files)
    return sorted(files)


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
        digest = hashlib.sha256("".join(csv_lines(frozen())).encode()).hexdigest()
        return Kit(FROZEN_SEED, digest, _vectors(FROZEN_COUNT, FROZEN_SEED))
    record = _kit_file(place, KIT)
    try:
        about = json.loads(record)
    except (ValueError, RecursionError):
        about = None
    if not isinstance(about, dict):
        raise UserError("is not a JSON object", os.path.join(place, KIT))
    if about.get("kit") != FORM:
        says = f"is of {one_line(str(about.get('kit')), 40)}, and this version judges {FORM}"
        raise UserError(f"{says}; expected a kit that it wrote", os.path.join(place, KIT))
    seed, data = about.get("seed"), _kit_file(place, VECTORS)
    if type(seed) is not int:
        raise UserError("has no seed of vectors", os.path.join(place, KIT))
    rows = [line.split(",") for line in data.decode("utf-8", "replace").splitlines()[1:]]
    scenes_given = [(*row[:2], *row[len(HEAD) : len(HEAD) + len(SCENE)]) for row in rows]
    vectors = _vectors(len(rows), seed)
    scenes_expected = [(vector.id, vector.kind, *vector.scene.values()) for vector in vectors]
    if not rows or about.get("vectors") != len(rows) or scenes_given != scenes_expected:
        says = f"does not hold the vectors of seed {seed} that {KIT} counts"
        raise UserError(f"{says}; expected a kit as it was written", os.path.join(place, VECTORS))
    return Kit(seed, hashlib.sha256(data).hexdigest(), vectors)


def _kit_file(place: str, name: str) -> bytes:
    """Return a file of a kit. Raises UserError."""
    if os.path.isdir(place):
        return read_bytes(os.path.join(place, name))
    data = read_bytes(place)
    try:
        with ZipFile(io.BytesIO(data)) as archive:
            if archive.getinfo(name).file_size > MAX_FILE_BYTES:
                raise OverflowError(f"{name} is too large")
            return archive.read(name)
    except KeyError:
        raise UserError(f"holds no {name}; expected a kit", place) from None
    except Exception as error:  # zlib's own among them
        raise UserError(f"is no kit: {error}; expected a folder or a .zip", place) from None


def _vectors(count: int, seed: int) -> list[Vector]:
    """Return the vectors of a seed."""
    return [Vector(f"{seed}-{index:06d}", *row) for index, row in enumerate(scenes(count, seed))]


# every file in an archive has the same date, so that the same kit gives the same bytes
_TIMESTAMP = rb"\d{4}-\d\d-\d\dT[\d:]{8}Z"
_ARCHIVE_DATE = (1988, 1, 1, 0, 0, 0)


def workbook(vectors: Sequence[dict[str, Any]]) -> bytes:
    """Return the vectors as a spreadsheet (xlsx) whose formulas answer them.

    The formulas are the spelling by contact impulses, a column for each statement: scenes and
    results on one sheet, intermediate values on another. Raises ImportError where openpyxl is
    missing.
    """
    from openpyxl import Workbook
    from openpyxl.utils import get_column_letter

    book = Workbook()
    statements = [
        statement
        for statement in spellings()[IMPULSES].statements
        if statement.target not in SCENE and not statement.target.startswith(SHOWN)
    ]
    results = [statement.target for statement in statements if statement.target in RESULTS]
    between = [statement.target for statement in statements if statement.target not in RESULTS]
    sheets = {"vectors": [*HEAD, *SCENE, *results], "between": between}
    places: dict[str, tuple[str, str]] = {}
    for title, heads in sheets.items():
        sheet = book.create_sheet(title)
        sheet.append(heads)
        places.update((name, (title, get_column_letter(i))) for i, name in enumerate(heads, 1))
    book.remove(book.worksheets[0])
    for row, vector in enumerate(vectors, 2):
        cells = {name: f"{title}!{letter}{row}" for name, (title, letter) in places.items()}
        cells["pi"] = "PI()"
        book["vectors"].append([*_head(vector), *(float(vector["scene"][n]) for n in SCENE)])
        bodies = ",".join(cells[name] for name in ("MA", "MB", "ia", "ib"))
        for statement in statements:
            text = _formula(statement.sides[0], cells)
            if statement.target == "Pn":
                text = f"IF(MIN({bodies})<=0,NA(),{text})"
            elif statement.target in results:  # an error wherever Pn is one
                text += f"+0*{cells['Pn']}"
            title, letter = places[statement.target]
            book[title][f"{letter}{row}"] = f"={text}"
    whole, out = io.BytesIO(), io.BytesIO()
    book.save(whole)
    with ZipFile(whole) as pages, ZipFile(out, "w") as archive:
        for name in pages.namelist():
            data = re.sub(_TIMESTAMP, b"1988-01-01T00:00:00Z", pages.read(name))
            archive.writestr(ZipInfo(name, _ARCHIVE_DATE), data, ZIP_DEFLATED)
    return out.getvalue()


def _formula(node: Expression, cells: Mapping[str, str]) -> str:
    if isinstance(node, tuple):
        return _FORMULAS[node[0]].format(*(_formula(part, cells) for part in node[1:]))
    return cells[node] if isinstance(node, str) else repr(node)


_FORMULAS = {
    **{sign: f"({{}}{sign}{{}})" for sign in "+-*/<>"},
    "**": "({}^{})",
    "==": "({}={})",
    NEGATIVE: "(-{})",
    "where": "IF({},{},{})",
    "hypot": "SQRT({0}*{0}+{1}*{1})",
    "sin": "SIN({})",
    "cos": "COS({})",
}
