"""Write what a tree gives, and say where a later one gives something else.

Before a mechanism is replaced, its results are written down; afterwards every difference is named::

    python tests/support/record.py write RECORD [SECTION ...]     what this tree gives
    python tests/support/record.py compare RECORD [SECTION ...]   this tree against that
    python tests/support/record.py sections                       their names

Run it with the Python in which the tree to be looked at is installed: it imports `impact88` and
starts ``python -m impact88`` from there, and uses public names and commands alone, so that one
script serves every tree. Inputs are written beside the results and read again by ``compare``: both
trees are asked the same. ``compare`` exits 1 where anything differs, keeps what this tree gave in
``--keep FOLDER``, and prints each difference.

Sections (all, unless some are named):

    solve          every result on 12 populations, as they are and with other friction, pivots and
                   points; mixed, singular, barrier and NaN scenes; once on numpy alone
    replay         the Apple's arithmetic over arrays
    runs           whole printouts of `run`, in both arithmetics
    texts          verdicts, open places and the first explanation of texts of printouts
                   (``--texts FOLDER`` with pages.jsonl.gz and cases/)
    pictures       the same of pictures (``--pictures FOLDER``, repeatable; ``--every N`` takes each
                   Nth so that about 120 are read)
    commands       60 command lines: exit status, output, talk
    reconstructions  60 problems: status and table

``--jobs N`` processes (default 1). Texts take some minutes, pictures an hour.
"""

from __future__ import annotations

import argparse
import difflib
import gzip
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

import impact88

SCENES = 1000
"""Scenes of each population."""
REPLAYED = 400
"""Scenes of each population that replay computes."""
TIMEOUT = 600.0
"""Seconds a command may take."""

VELOCITIES = ("UX", "UY", "WA", "VX", "VY", "WB")


def command(arguments: list[str], stdin: str = "", folder: Path | None = None) -> dict[str, Any]:
    """Return what ``python -m impact88`` gives: exit status, output, talk."""
    try:
        done = subprocess.run(
            [sys.executable, "-m", "impact88", *arguments],
            input=stdin.encode(),
            capture_output=True,
            cwd=folder,
            timeout=TIMEOUT,
            env={**os.environ, "COLUMNS": "80", "LC_ALL": "C.UTF-8"},
        )
    except subprocess.TimeoutExpired:
        return {"exit": None, "out": "", "talk": f"no answer in {TIMEOUT:g} s"}
    out, talk = (text.decode("utf-8", "replace") for text in (done.stdout, done.stderr))
    return {"exit": done.returncode, "out": out, "talk": talk}


# -- arrays


def populations() -> dict[str, dict[str, np.ndarray]]:
    """Return the scenes of the benchmark's populations, and what is made of them."""
    try:
        from impact88.mechanics.accuracy.populations import POPULATIONS, scenes
    except ImportError:  # trees of before
        from impact88.bench.populations import POPULATIONS, scenes

    made = {name: scenes(name, SCENES, 1988) for name in POPULATIONS}
    rng = np.random.default_rng(49)
    cars = made["casework"]
    frictions = {"mu0": 0.0, "mu-large": 3.0, "mu-negative": -0.7, "pivot": -10.0, "sign": 10.0}
    for name, mu in frictions.items():
        made[f"casework-{name}"] = {**cars, "MU": np.full(SCENES, mu)}
        made[f"heavy-{name}"] = {**made["heavy"], "MU": np.full(SCENES, mu)}
    made["casework-points"] = {**cars, "M": np.full(SCENES, 4.0)}
    made["casework-no-moment"] = {**cars, "EM": np.ones(SCENES)}
    broken = {name: values.copy() for name, values in cars.items()}
    for values in broken.values():
        chosen = rng.random(SCENES) < 0.03
        values[chosen] = rng.choice([np.nan, np.inf, -np.inf, -1.0, 0.0, -0.0, 1e300], chosen.sum())
    made["broken"] = broken
    columns = {name: np.concatenate([made[p][name] for p in sorted(made)]) for name in cars}
    order = rng.permutation(len(columns["MA"]))[: 4 * SCENES]
    made["mixed"] = {name: values[order] for name, values in columns.items()}
    return made


def solved(scenes: dict[str, dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Return every result of `solve`, POPULATION/RESULT -> values."""
    return {
        f"{population}/{name}": np.asarray(values)
        for population, columns in scenes.items()
        for name, values in impact88.solve(columns).items()
    }


def solved_by_numpy(folder: Path) -> dict[str, np.ndarray]:
    """Return the results of the mixed and broken scenes, without the compiled part."""
    with tempfile.TemporaryDirectory() as work:
        target = Path(work) / "numpy.npz"
        subprocess.run(
            [sys.executable, __file__, "numpy", str(folder), str(target)],
            check=True,
            env={**os.environ, "IMPACT88_ACCELERATED": "0"},
        )
        return dict(np.load(target))


def read_scenes(folder: Path) -> dict[str, dict[str, np.ndarray]]:
    made: dict[str, dict[str, np.ndarray]] = {}
    for key, values in np.load(folder / "scenes.npz").items():
        population, _, name = key.partition("/")
        made.setdefault(population, {})[name] = values
    return made


def decimal_texts(columns: dict[str, np.ndarray], count: int) -> dict[str, list[str]]:
    return {
        name: [repr(x).removesuffix(".0").upper() for x in values[:count].tolist()]
        for name, values in columns.items()
    }


def solve_section(folder: Path) -> dict[str, np.ndarray]:
    return solved(read_scenes(folder)) | {
        f"numpy/{key}": values for key, values in solved_by_numpy(folder).items()
    }


FOR_THE_APPLE = ("casework", "casework-pivot", "heavy", "singular", "tangential", "quarter-turns")


def replay_section(folder: Path) -> dict[str, np.ndarray]:
    results = {}
    scenes = read_scenes(folder)
    for population in FOR_THE_APPLE:
        replayed = impact88.replay(decimal_texts(scenes[population], REPLAYED))
        for name in replayed.names:
            results[f"{population}/{name}"] = np.asarray(replayed.reals(name))
            if name == "KF":
                continue  # the only one that the listing does not print
            results[f"{population}/{name} as printed"] = np.asarray(replayed.printed(name), "U")
        for name in ("code", "line", "zero_determinant"):
            results[f"{population}/{name}"] = np.asarray(getattr(replayed, name))
    return results


# -- texts


def runs_section(folder: Path, jobs: int) -> Iterator[tuple[str, Any]]:
    scenes = read_scenes(folder)
    for population in FOR_THE_APPLE:
        texts = decimal_texts(scenes[population], 12)
        for row in range(12):
            scene = {name: values[row] for name, values in texts.items()}
            for arithmetic in ("applesoft", "float64"):
                ran = impact88.run(scene, arithmetic=arithmetic)
                error = str(ran.error or "")
                page = f"{ran.printout}-- {error}, line {ran.line}"
                yield f"{population} {row} {arithmetic}", page


def read_verdicts(answer: dict[str, Any]) -> Any:
    """Return what matters of ``verify --json``: a list, a printout each."""
    if not answer["out"].strip():
        return {"exit": answer["exit"], "talk": answer["talk"].replace("\r", "\n").strip()[-300:]}
    printouts = []
    for line in answer["out"].splitlines():
        page = json.loads(line)
        places = [*page.get("fields", []), *page.get("replies", []), page.get("ending") or {}]
        first = (page.get("explanations") or [{}])[0]
        printouts.append(
            {
                "verdict": page.get("verdict"),
                "scene": page.get("scene"),
                "open": [
                    [
                        place.get("name"),
                        place.get("status"),
                        place.get("printed"),
                        place.get("same"),
                    ]
                    for place in places
                    if place and (place["status"] != "read" or place["doubts"] or not place["same"])
                ],
                "missing": page.get("missing"),
                "not read": page.get("not_read"),
                "left over": page.get("left_over"),
                "unseen": page.get("unseen"),
                "first explanation": [
                    first.get(key) for key in ("kind", "field", "printed", "would_be", "remaining")
                ],
            }
        )
    return {"exit": answer["exit"], "printouts": printouts}


def verdicts(paths: list[Path], jobs: int) -> Iterator[tuple[str, Any]]:
    def judge(path: Path) -> tuple[str, Any]:
        return path.name, read_verdicts(command(["verify", "--json", str(path)]))

    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(judge, paths)


def texts_section(source: Path, jobs: int) -> Iterator[tuple[str, Any]]:
    with tempfile.TemporaryDirectory() as work:
        paths = []
        with gzip.open(source / "pages.jsonl.gz", "rt", encoding="utf-8") as pages:
            lines = pages.readlines()
        for line in lines:
            page = json.loads(line)
            paths.append(Path(work) / f"{page['name']}.txt")
            paths[-1].write_text(page["ocr_psm6"], encoding="utf-8")
        yield from verdicts([*paths, *sorted((source / "cases").iterdir())], jobs)


def pictures_section(sources: list[Path], every: int, jobs: int) -> Iterator[tuple[str, Any]]:
    paths = [
        path
        for source in sources
        for path in sorted(source.iterdir())
        if path.suffix in (".png", ".jpg")
    ]
    yield from verdicts(paths[:: every or max(1, len(paths) // 120)], jobs)


SCENE_FILE = """units = "us"
MA = 3091
MB = 4669
IA = "estimate"
IB = "estimate"
DA = 4.5
DB = 4
GA = 0
PA = 0
PB = -40
TA = 0
TB = 90
E = 0.1
MU = 0.5
EM = -1
UX = "-25 +- 2"
UY = 0
WA = 0
VX = 0
VY = "40 +- 2"
WB = 0
"""
AFTER_FILE = """MA = 143.5
MB = 95.8
IA = 3728
IB = 1961
DA = 7.59
DB = 3.44
GA = -30
PA = -19.8
PB = -38.7
TA = 0
TB = 60
E = "0 .. 0.2"
MU = 0.911
EM = -0.715
WA = 0
WB = 0
VAX = "-13.3 +- 1"
VAY = "3.4 +- 1"
VBX = "-9.1 +- 1"
VBY = "20 +- 1"
"""
REAR_END = "MA = 100\nMB = 90\nUN = 0\nVN = 40\nE = 0.2\n"

COMMANDS: tuple[str, ...] = (
    "--help",
    "--version",
    "help verify",
    "help reconstruct",
    "nonsense",
    "run --sample 1",
    "run --sample 2",
    "run --sample 3 --json",
    "run --sample 1 --arithmetic float64",
    "run --sample 1 --raw",
    "run --sample 1 --no-dos",
    "run crash.toml --set MU=.5 --set UX=-25 --set VY=40",
    "run --sample 1 --set MA=0",
    "run --sample 1 --set MA=1E39",
    "run --sample 1 --move-contact=-1,0",
    "run nowhere.toml",
    "scene",
    "scene --units us",
    "scene --sample 2",
    "solve cases.csv",
    "solve cases.csv --to jsonl --outputs VAX,VAY,STATUS",
    "solve cases.csv --arithmetic applesoft --results-only",
    "solve cases.csv --set MU=-10 --errors bad.csv",
    "solve --sample 1 --sweep MU=0:1:11 --outputs DVA,LOSS",
    "solve --sample 1 --units us --to jsonl",
    "solve bad.csv",
    "bounds --sample 1 --range MU=.7..1 --samples 2000",
    "bounds crash.toml --set E=.1 --samples 2000 --outputs DVA,DVB",
    "bounds crash.toml --samples 2000 --json",
    "bounds --sample 3 --reconstruct --range VBY=41.5+-1.5 --samples 2000",
    "reconstruct --template",
    "reconstruct after.toml --samples 0",
    "reconstruct after.toml --samples 500 --json",
    "reconstruct crash.toml --samples 0",
    "reconstruct --sample 1 --set UX= --set VAX=-13.263 --samples 0",
    "reconstruct --sample 1 --set E= --set VBX=-9.114 --samples 0 --contact-time .15",
    "figure scene --sample 1 -o scene.svg",
    "report crash.toml -o case.html --samples 500",
    "verify page.txt",
    "verify --brief page.txt other.txt",
    "verify --json other.txt",
    "verify cases.csv",
    "verify - --sample 1",
    "oracle --vectors 12",
    "oracle --vectors 6 --class failure --no-reference",
    "oracle --vectors 6 --to csv",
    "oracle --validation",
    "compare theirs.csv --no-causes",
    "compare theirs.csv --json",
    "compare moved.csv",
    "compare moved.csv --json",
    "compare cases.csv",
    "selfcheck",
    "basic program.bas",
    "basic broken.bas",
    "chapter colinear rear-end.toml",
    "chapter barrier --sample 1",
    "chapter delta-v crash.toml --set LOSS=40",
    "chapter staged --table 1",
    "chapter example",
    "schema",
    "schema conventions",
    "schema compare",
    "completion tcsh",
)
"""Command lines, each in a folder with the files below."""


def command_files(folder: Path) -> dict[str, str]:
    """Return the files that the command lines read, made once by the tree that is recorded."""
    scenes = read_scenes(folder)["casework"]
    rows = decimal_texts(scenes, 12)
    cases = "\n".join(
        [",".join(rows), *(",".join(row) for row in zip(*rows.values(), strict=True))]
    )
    page = command(["run", "--sample", "1"])["out"]
    results = impact88.solve({name: values[:12] for name, values in scenes.items()})
    wanted = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")
    theirs = {**rows, **{name: [repr(x) for x in results[name].tolist()] for name in wanted}}
    moved = {**theirs, "VAX": theirs["VAY"], "VAY": theirs["VAX"]}

    def table(columns: dict[str, list[str]]) -> str:
        lines = [",".join(columns), *(",".join(r) for r in zip(*columns.values(), strict=True))]
        return "\n".join(lines) + "\n"

    return {
        "crash.toml": SCENE_FILE,
        "after.toml": AFTER_FILE,
        "rear-end.toml": REAR_END,
        "cases.csv": cases + "\n",
        "bad.csv": cases.replace("\n", "\nx", 1) + "\n",
        "page.txt": page,
        "other.txt": page.replace("-13.263", "-13.253").replace("17.35", "18.36"),
        "theirs.csv": table(theirs),
        "moved.csv": table(moved),
        "program.bas": "10 FOR I = 1 TO 5\n20 PRINT I, SQR(I), SIN(I)\n30 NEXT\n",
        "broken.bas": "10 PRINT 1/0\n",
    }


WRITTEN = ("scene.svg", "case.html", "bad-rows.csv", "bad.csv")
"""Files that command lines write."""


def commands_section(folder: Path, jobs: int) -> Iterator[tuple[str, Any]]:
    files = json.loads((folder / "files.json").read_text())

    def answer(line: str) -> tuple[str, Any]:
        with tempfile.TemporaryDirectory() as work:
            for name, text in files.items():
                (Path(work) / name).write_text(text)
            given = command(line.split(), files["page.txt"], Path(work))
            given["out"] = re.sub(r"(?m)^(time +)[0-9.]+ s$", r"\1...", given["out"])
            for name in WRITTEN:
                path = Path(work) / name
                if path.exists() and path.read_text() != files.get(name):
                    given[name] = path.read_text()
            return line, given

    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(answer, COMMANDS)


def problems(folder: Path) -> dict[str, str]:
    """Return 60 reconstructions, ID -> TOML: cars hit, and something of it is measured."""
    try:
        from impact88.mechanics.accuracy.populations import scenes as population
    except ImportError:  # trees of before
        from impact88.bench.populations import scenes as population

    scenes = population("casework", 20 * SCENES, 60)
    sound = np.flatnonzero(np.asarray(impact88.solve(scenes, "STATUS")["STATUS"]) == 0)[:60]
    scenes = {name: values[sound] for name, values in scenes.items()}  # vehicles can collide so
    texts = decimal_texts(scenes, 60)
    results = impact88.solve(scenes)
    rng = np.random.default_rng(60)
    made = {}
    after = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")
    for row in range(60):
        kind = ("exact", "tolerances", "ranges", "few", "redundant", "conflicting")[row % 6]
        scene = {name: values[row] for name, values in texts.items()}
        measured = {name: float(results[name][row]) for name in after}
        gone = VELOCITIES if kind == "exact" else rng.permutation(VELOCITIES)[:4].tolist()
        lines = [f"{n} = {text}" for n, text in scene.items() if n not in gone and n != "M"]
        for name, value in measured.items():
            if kind == "exact":
                lines.append(f"{name} = {value!r}")
            elif kind == "few" and name in ("VBX", "WAF", "WBF"):
                continue
            elif kind == "ranges":
                lines.append(f'{name} = "{value - 2:.2f} .. {value + 3:.2f}"')
            else:
                off = 25.0 if kind == "conflicting" and name == "VAY" else 0.3 * rng.normal()
                lines.append(f'{name} = "{value + off:.2f} +- 1"')
        if kind == "redundant":
            lines = [line for line in lines if not line.startswith(("E ", "MU "))]
            lines += ['E = "0 .. 0.5"', 'SA = "40 +- 30"']
        made[f"{row:02d}-{kind}"] = "\n".join(lines) + "\n"
    return made


def reconstructions_section(folder: Path, jobs: int) -> Iterator[tuple[str, Any]]:
    given = json.loads((folder / "problems.json").read_text())

    def answer(item: tuple[str, str]) -> tuple[str, Any]:
        arguments = ["reconstruct", "-", "--samples", "2000"]
        return item[0], command(arguments, item[1])

    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(answer, given.items())


# -- writing and comparing

ARRAYS: dict[str, Callable[[Path], dict[str, np.ndarray]]] = {
    "solve": solve_section,
    "replay": replay_section,
}
SECTIONS = (*ARRAYS, "runs", "texts", "pictures", "commands", "reconstructions")


def write_inputs(folder: Path) -> None:
    """Write what both trees are asked; what is there already stays."""
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "scenes.npz").exists():
        flat = {f"{p}/{n}": v for p, columns in populations().items() for n, v in columns.items()}
        np.savez_compressed(folder / "scenes.npz", **flat)
    for name, make in (("files.json", command_files), ("problems.json", problems)):
        if not (folder / name).exists():
            (folder / name).write_text(json.dumps(make(folder), indent=0))


def entries(section: str, folder: Path, options: argparse.Namespace) -> Iterator[tuple[str, Any]]:
    if section == "texts":
        return texts_section(options.texts, options.jobs)
    if section == "pictures":
        return pictures_section(options.pictures, options.every, options.jobs)
    return {
        "runs": runs_section,
        "commands": commands_section,
        "reconstructions": reconstructions_section,
    }[section](folder, options.jobs)


def write(section: str, inputs: Path, folder: Path, options: argparse.Namespace) -> None:
    """Write what this tree gives; a picture at a time, so that much of an hour is kept."""
    if section in ARRAYS:
        np.savez_compressed(folder / f"{section}.npz", **ARRAYS[section](inputs))
        return
    with (folder / f"{section}.jsonl").open("w", encoding="utf-8") as target:
        for key, value in entries(section, inputs, options):
            target.write(json.dumps([key, value]) + "\n")
            target.flush()


def array_differences(old: Path, new: Path) -> Iterator[str]:
    before, after = dict(np.load(old)), dict(np.load(new))
    for key in sorted(before.keys() | after.keys()):
        if key not in before or key not in after:
            yield f"{key}: only {'before' if key in before else 'now'}"
            continue
        a, b = before[key], after[key]
        if a.shape != b.shape or a.dtype != b.dtype:
            yield f"{key}: {a.dtype}{list(a.shape)} before, {b.dtype}{list(b.shape)} now"
            continue
        same = a == b
        if a.dtype.kind == "f":
            same = (same & (np.signbit(a) == np.signbit(b))) | (np.isnan(a) & np.isnan(b))
        if same.all():
            continue
        rows = np.flatnonzero(~same)
        row = rows[0]
        largest = ""
        if a.dtype.kind == "f":
            with np.errstate(all="ignore"):
                errors = np.abs(a[rows] - b[rows]) / np.abs(a[rows])
            finite = errors[np.isfinite(errors)]
            largest = f", largest relative difference {finite.max():.1e}" if len(finite) else ""
        where = f"first in row {row}: {a[row]!r} before, {b[row]!r} now"
        yield f"{key}: {len(rows)} of {len(a)} differ{largest}; {where}"


def as_lines(value: Any) -> list[str]:
    if isinstance(value, str):
        return value.splitlines()
    if isinstance(value, dict) and "out" in value:
        parts = [f"exit {value['exit']}"]
        for name, text in value.items():
            if name != "exit":
                parts += [f"-- {name}", *text.splitlines()]
        return parts
    return json.dumps(value, indent=1, ensure_ascii=False).splitlines()


def text_differences(old: Path, new: Path) -> Iterator[str]:
    def read(path: Path) -> dict[str, Any]:
        return dict(json.loads(line) for line in path.read_text(encoding="utf-8").splitlines())

    before, after = read(old), read(new)
    for key, value in after.items():
        if key not in before:
            yield f"{key}: only now"
        elif before[key] != value:
            old_lines, new_lines = as_lines(before[key]), as_lines(value)
            changes = difflib.unified_diff(old_lines, new_lines, "before", "now", n=0, lineterm="")
            yield f"{key}:\n    " + "\n    ".join(changes)
    for key in before.keys() - after.keys():
        yield f"{key}: only before"


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("action", choices=("write", "compare", "sections", "numpy"))
    parser.add_argument("record", type=Path, nargs="?")
    parser.add_argument("sections", nargs="*", metavar="SECTION")
    parser.add_argument("--texts", type=Path)
    parser.add_argument("--pictures", type=Path, action="append", default=[])
    parser.add_argument("--every", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    if options.action == "sections":
        print(*SECTIONS, sep="\n")
        return 0
    if options.action == "numpy":  # a process of its own, without the compiled part
        scenes = read_scenes(options.record)
        chosen = {name: scenes[name] for name in ("mixed", "broken")}
        np.savez(options.sections[0], **solved(chosen))
        return 0
    sections = options.sections or list(SECTIONS)
    if unknown := set(sections) - set(SECTIONS):
        parser.error(f"no section {', '.join(sorted(unknown))}; there are {', '.join(SECTIONS)}")
    if "texts" in sections and not options.texts:
        parser.error("texts: --texts FOLDER is missing")
    if "pictures" in sections and not options.pictures:
        parser.error("pictures: --pictures FOLDER is missing")
    print(f"impact88 from {Path(impact88.__file__).parent}", file=sys.stderr)
    if options.action == "write":
        write_inputs(options.record)
        for section in sections:
            write(section, options.record, options.record, options)
        return 0
    differs = False
    with tempfile.TemporaryDirectory() as work:
        folder = options.keep or Path(work)
        folder.mkdir(parents=True, exist_ok=True)
        for section in sections:
            write(section, options.record, folder, options)
            suffix, compare = (
                ("npz", array_differences) if section in ARRAYS else ("jsonl", text_differences)
            )
            found = list(
                compare(options.record / f"{section}.{suffix}", folder / f"{section}.{suffix}")
            )
            differs |= bool(found)
            print(f"== {section}: {len(found) or 'no'} differences", *found, sep="\n")
    return int(differs)


if __name__ == "__main__":
    sys.exit(main())
