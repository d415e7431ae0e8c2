"""Making cases: for every kind of input something near to usual, then spoilt.

A case is a function of its kind and its seed alone.
"""

from __future__ import annotations

import io
import json
import random
import struct
import zipfile
from collections.abc import Callable
from contextlib import suppress
from functools import cache

import captures
import emulator_fuzz
import numpy as np

from impact88.apple.applesoft.decimaltext import is_number
from impact88.collision.case import VALUE_LIMIT
from impact88.collision.case import Case as SceneCase
from impact88.collision.casescene import sample
from impact88.collision.scenefile import template
from impact88.errors import UserError
from impact88.interface.commands.cli import COMMANDS
from impact88.names import CHAPTER, RESULTS, SCENE

from .case import Case

Random = random.Random

NUMBERS = [
    *"0 1 -1 .5 5. -0 +3 1E5 1e-5 143.5 -29.04 90 180 360 -10 10 4 6 1e9 7e8 1E38 1E39".split(),
    *"1e308 1e309 -1e400 1e-320 1e-400 1E+99 1E-99 1e160 1E155 0x10 1_000 nan inf -inf E5".split(),
    *"1E 1E+ - + . +- 1,5 1.2.3 ١٢ ½ − ∞ null 1e 1e-39 1E999999999 00001 1234567890123".split(),
    "1" * 310,
    "9" * 5000,
    "1e-" + "9" * 400,
    "." + "0" * 229 + "5",
    "1" + "0" * 30 + "E-99",
    "1 2",
    "",
    " ",
    "- 5",
    "1e5 ",
]
"""What stands where a number should."""
SCRAPS = [
    *("\x00", "\x1b[31m", "\x07", "\x7f", "\x9b", "\r", "\n", "\r\n", "\t", "\\", "'", '"', '"""'),
    *"; : = # [ ] [[ { } ( ) $ % & < > @ / ../x ~ - -- ? ?? * ***** O l | .. +- , ,,".split(),
    *("\ufeff", "\u202e", "\u2028", "é", "µ", "😀", "sep=;", "normal", "uniform", "title"),
    *"MA= PA PB TA TB GA VAX= LOSS= ENTER 10 GOTO PRINT INPUT A$ FOR NEXT NaN Infinity".split(),
    "[" * 300,
    '{"a":' * 300,
    "A" * 3000,
    "0" * 3000,
    "- " * 500,
]
SIZES = [
    "1",
    "2",
    "0",
    "-1",
    "7",
    "1e9",
    "1000000000",
    "1000000000000",
    "9" * 30,
    "x",
    "",
    "nan",
    "1.5",
]


def number(rng: Random) -> str:
    """A number, nearly always."""
    if rng.random() < 0.6:
        return f"{rng.uniform(-200, 200):.{rng.randint(0, 4)}f}"
    return rng.choice(NUMBERS)


def spoilt(rng: Random, data: bytes, most: int = 6) -> bytes:
    """``data`` with some edits: flipped, cut, doubled, moved, and scraps put in."""
    for _ in range(rng.randint(0, most)):
        at = rng.randrange(len(data) + 1)
        to = min(len(data), at + rng.choice((1, 1, 2, 5, 20, 200)))
        match rng.randrange(8):
            case 0:
                data = data[:at] + bytes([rng.randrange(256)]) + data[at + 1 :]
            case 1:
                data = data[:at] + data[to:]
            case 2:
                data = data[:at] + data[at:to] * rng.choice((2, 2, 3, 50)) + data[to:]
            case 3:
                data = data[:at] + rng.choice(SCRAPS).encode() + data[at:]
            case 4:
                data = data[:at] + rng.choice(NUMBERS).encode() + data[to:]
            case 5:
                data = data[:at]
            case 6:
                lines = data.split(b"\n")
                i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
                lines[i], lines[j] = lines[j], lines[i]
                data = b"\n".join(lines)
            case 7:
                data = (
                    data[:at]
                    + bytes(rng.randrange(256) for _ in range(rng.randint(1, 6)))
                    + data[at:]
                )
    if rng.random() < 0.02:
        data = data.decode("utf-8", "replace").encode(
            rng.choice(("utf-16", "utf-16-le", "utf-8-sig"))
        )
    return data


def scene(rng: Random) -> dict[str, str]:
    """Texts of a scene: a sample's, some changed."""
    texts = dict(sample(rng.randint(1, 3)))
    for name in rng.sample(list(SCENE), rng.choice((0, 1, 2, 5, 21))):
        texts[name] = number(rng)
    if rng.random() < 0.1:
        texts.pop(rng.choice(list(texts)))
    return texts


def toml(rng: Random) -> bytes:
    """A scene file."""
    texts = scene(rng)
    whole = {**sample(1), **texts}
    title = rng.choice(("", "A title", "\x1b", "[["))
    text = ""
    if rng.random() < 0.5:
        with suppress(UserError):  # a text that is no amount has no case to be written from
            text = template(SceneCase({**whole, "title": title}))
    if not text:
        text = "".join(f'{name} = "{value}"\n' for name, value in texts.items())
    return spoilt(rng, text.encode(), rng.choice((0, 1, 6)))


def argument(rng: Random, command: str) -> list[str]:
    """An option with something for its value."""
    name = rng.choice([*SCENE, *RESULTS, *CHAPTER, "XX", "ua", ""])
    ranges = (
        f"{number(rng)} .. {number(rng)}",
        f"+- {number(rng)}",
        f"+-{number(rng)}%",
        f"normal {number(rng)} {number(rng)}",
        f"triangular {number(rng)} {number(rng)} {number(rng)}",
        rng.choice(SCRAPS).strip("\x00"),
    )
    every = [
        ["--set", f"{name}={number(rng)}"],
        ["--set", rng.choice(SCRAPS)],
        ["--json"],
        ["--outputs", rng.choice([name, "VAX,LOSS", ",", "DVA", ""])],
    ]
    special: dict[str, list[list[str]]] = {
        "bounds": [
            ["--range", f"{name}={rng.choice(ranges)}"],
            ["--samples", rng.choice(SIZES)],
            ["--seed", rng.choice(SIZES)],
            ["--sigmas", number(rng)],
            ["--correlation", f"{name},UX={number(rng)}"],
            ["--exclude", rng.choice(("ENERGY_GAINED", "XX", ""))],
            ["--reconstruct"],
        ],
        "oracle": [["--vectors", rng.choice(SIZES)], ["--seed", rng.choice(SIZES)]],
        "bench": [
            ["--scenes", rng.choice(SIZES)],
            ["--repeats", rng.choice(SIZES)],
            ["--seed", "-1"],
        ],
        "reconstruct": [
            ["--outputs", f"{name},UX"],
            ["--contact-time", number(rng)],
            ["--template"],
        ],
        "barrier": [["--contact-time", number(rng)], ["--template"]],
        "colinear": [["--contact-time", number(rng)], ["--template"]],
        "delta-v": [["--like", "rear"], ["--as-printed"]],
        "run": [["--no-dos"], ["--slot", rng.choice("0123456789x")], ["--arithmetic", "float64"]],
    }
    special["figure"] = special["bounds"]
    return rng.choice(special.get(command, every) + every)


def _options(rng: Random, command: str, most: int = 3) -> list[str]:
    return [part for _ in range(rng.randint(0, most)) for part in argument(rng, command)]


# --- kinds ---------------------------------------------------------------------------------------


def toml_case(rng: Random) -> Case:
    """A scene file to a command that takes one."""
    solving = ["run", "run", "reconstruct", "barrier", "colinear", "delta-v"]
    command = rng.choice([*solving, "scene"])
    data = toml(rng)
    if command == "scene":
        return Case("toml", ["figure", "scene", "s.toml", "-o", "o.svg"], files={"s.toml": data})
    options = _options(rng, command, 2)
    if rng.random() < 0.3:
        return Case("toml", [command, "-", *options], stdin=data)
    return Case("toml", [command, "s.toml", *options], files={"s.toml": data})


def options_case(rng: Random) -> Case:
    """Any command with any options."""
    command = rng.choice([*COMMANDS, "", "frob\x1b"])
    arguments = [command, *_options(rng, command, 4)]
    match command:
        case "witness" | "selfcheck" | "staged" | "example" | "desk":
            arguments = [command, "--no-such"]
        case "bench":
            arguments += ["--scenes", rng.choice(("0", "-1", "1e12", "9" * 15))]
        case "basic":
            arguments += ["--max-statements", "100"]
        case "oracle":
            arguments += ["--vectors", rng.choice(("0", "-5", "1e9", "2"))]
        case "bounds" | "figure":
            arguments = [
                "bounds",
                *arguments[1:],
                "--samples",
                rng.choice(("0", "-1", "1e9", "9" * 15)),
            ]
        case "run" | "scene" if rng.random() < 0.7:
            arguments += ["--sample", rng.choice("1234")]
        case "solve" | "compare":
            arguments += [rng.choice(("no.csv", ".", "-", "", "x.npz", "x.zip"))]
    return Case("options", arguments, stdin=spoilt(rng, b"1,2,3\n4,5,6\n"))


def _rows(rng: Random) -> list[dict[str, str]]:
    return [scene(rng) for _ in range(rng.choice((0, 1, 2, 3, 8)))]


def _table_case(rng: Random, kind: str, ending: str, data: bytes) -> Case:
    if rng.random() < 0.35:
        options = ["--json"] if rng.random() < 0.5 else []
        arguments = ["compare", f"t.{ending}", *options]
    else:
        arguments = ["solve", f"t.{ending}"]
        if rng.random() < 0.7 or ending == "npz":
            arguments += ["-o", f"o.{rng.choice(('csv', 'jsonl', 'npz'))}"]
        if rng.random() < 0.5:
            arguments += ["--outputs", rng.choice(("VAX", "VAX,LOSS,STATUS", "LOSS", "X"))]
        if rng.random() < 0.25:
            arguments += ["--arithmetic", "applesoft"]
        if rng.random() < 0.2:
            arguments += ["--results-only"]
        if rng.random() < 0.2:
            arguments += ["--errors", rng.choice(("bad.csv", "o.csv", f"t.{ending}"))]
        arguments += _options(rng, "solve", 1) if rng.random() < 0.3 else []
    if rng.random() < 0.2 and ending != "npz":
        arguments[1] = "-"
        arguments += ["--from" if arguments[0] == "solve" else "--format", ending]
        return Case(kind, arguments, stdin=data)
    return Case(kind, arguments, files={f"t.{ending}": data})


def csv_case(rng: Random) -> Case:
    """A CSV table."""
    rows = _rows(rng)
    names = [
        *SCENE,
        *rng.sample(["id", "note", "VAX", "LOSS", "STATUS", "KF", "x y"], rng.randint(0, 3)),
    ]
    if rng.random() < 0.2:
        names = [rng.choice((name, name.lower(), f"{name} [ft]")) for name in names]
    between = rng.choice((",", ",", ",", ";", "\t"))
    lines = [between.join(names)]
    lines += [between.join(row.get(name, number(rng)) for name in names) for row in rows]
    text = "\n".join(lines) + "\n"
    if rng.random() < 0.1:
        text = "sep=;\n" + text
    return _table_case(rng, "csv", "csv", spoilt(rng, text.encode(), rng.choice((0, 2, 6))))


def _json_value(rng: Random, text: str) -> object:
    try:
        value = float(text)
    except ValueError:
        return text
    return rng.choice((text, value, text, value, True, None, [value], {"a": text}, "\ud800"))


def _json_lines(rng: Random) -> list[str]:
    lines = []
    for row in _rows(rng):
        found: dict[str, object] = {name: _json_value(rng, text) for name, text in row.items()}
        if rng.random() < 0.8:
            found = dict(row)
        if rng.random() < 0.5:
            found[rng.choice(("id", "note", "VAX", "\ud800", "", "LOSS"))] = rng.choice(
                (1, "x", "\x1b[0m", "\udfff", None, [[]], {"MA": 1}, True)
            )
        lines.append(json.dumps(found))
    return lines


def jsonl_case(rng: Random) -> Case:
    """A JSON Lines table."""
    text = "\n".join(_json_lines(rng)) + "\n"
    return _table_case(rng, "jsonl", "jsonl", spoilt(rng, text.encode(), rng.choice((0, 2, 6))))


def oracle_case(rng: Random) -> Case:
    """Questions to the oracle."""
    lines = [
        json.dumps({"id": rng.choice((1, "a", None, "\ud800", "\x1b")), "scene": json.loads(line)})
        for line in _json_lines(rng)[:3]
    ]
    data = spoilt(rng, "\n".join(lines).encode(), rng.choice((0, 2, 6)))
    options = ["--no-reference"] if rng.random() < 0.9 else []
    return Case("oracle", ["oracle", *options], stdin=data)


def _odd_array(rng: Random, count: int) -> np.ndarray:
    kind = rng.choice(["c16", "f2", "longdouble", [("a", "f8")], "M8[s]", "?", "S3", "U2", "i8"])
    shape = rng.choice([(2, 2), (), (count,), (count,), (7,), (0,)])
    return np.zeros(shape, kind)


def npz_case(rng: Random) -> Case:
    """An .npz table."""
    count = rng.choice((0, 1, 2, 3))
    arrays: dict[str, np.ndarray] = {}
    for name, text in scene(rng).items():
        try:
            value = float(text)
        except ValueError:
            value = 1.0
        arrays[name] = np.full(rng.choice((count, count, 1)), value)
    for _ in range(rng.choice((0, 0, 1, 3))):
        name = rng.choice([*SCENE, "note", "file", "VAX", "a/b", ""])
        arrays[name] = _odd_array(rng, count)
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", rng.choice((0, 0, 0, 0, 8, 8, 8, 12, 14))) as archive:
        for name, array in arrays.items():
            one = io.BytesIO()
            np.lib.format.write_array(one, array)
            data = one.getvalue()
            if rng.random() < 0.05:
                data = spoilt(rng, data)
            if rng.random() < 0.02:
                data = data.replace(b"'shape': (", b"'shape': (9" + b"9" * rng.randint(0, 12))
            archive.writestr((name + rng.choice([".npy"] * 30 + ["", ".txt"])) or "x", data)
    data = file.getvalue()
    if rng.random() < 0.4:
        data = spoilt(rng, data)
    if rng.random() < 0.03:
        data = one.getvalue()
    return _table_case(rng, "npz", "npz", data)


@cache
def _programs() -> list[bytes]:
    folder = captures.ROOT / "golden" / "programs"
    found = [path.read_bytes() for path in sorted(folder.glob("*.bas"))]
    found.append((captures.ROOT / "legacy" / "impact.bas").read_bytes())
    return found


@cache
def _typist() -> emulator_fuzz.Cases:
    return emulator_fuzz.Cases(0)


def _typed(rng: Random) -> list[str]:
    """Lines of a program and commands, as the emulator's own fuzzer types them."""
    typist = _typist()
    typist.random = rng
    return typist.case()[0]


def program_case(rng: Random) -> Case:
    """A program to run, and what is typed to it."""
    if rng.random() < 0.5:
        data = rng.choice(_programs())
    else:
        lines = [line for line in _typed(rng) if line[:1].isdigit()]
        data = "\n".join(lines).encode("utf-8", "replace")
    data = spoilt(rng, data)
    replies = spoilt(rng, b"-29.04,0,0\n14.52,25.15,0\n1\nA\n")
    options = rng.choice(([], [], ["--prompt"], ["--no-dos"]))
    arguments = ["basic", "p.bas", "--max-statements", "400", *options]
    return Case("program", arguments, stdin=replies, files={"p.bas": data})


def session_case(rng: Random) -> Case:
    """Lines typed at the prompt."""
    lines = _typed(rng)
    lines += rng.choices(
        ["RUN", "LIST", "NEW", "LOAD p.bas", "SAVE q.bas", "SAVE .", "CONT", "SAVE p\0"], k=3
    )
    rng.shuffle(lines)
    data = spoilt(rng, "\n".join(lines).encode("utf-8", "replace"))
    return Case("session", ["basic", "--max-statements", "400"], data, {"p.bas": _programs()[0]})


def replies_case(rng: Random) -> Case:
    """What is typed to the 1988 program."""
    replies = [",".join(number(rng) for _ in range(rng.choice((3, 3, 3, 1, 5)))) for _ in range(3)]
    options = rng.choice(([], ["--json"], ["--no-dos"], ["--arithmetic", "float64"]))
    return Case("replies", ["run", *options], spoilt(rng, "\n".join(replies).encode()))


@cache
def _printouts() -> list[bytes]:
    paths = [*(captures.ROOT / "legacy").glob("*-as-printed.txt")]
    paths += (captures.ROOT / "golden" / "printouts").glob("*.txt")
    return [path.read_bytes() for path in sorted(paths)]


def printout_case(rng: Random) -> Case:
    """A printout to verify, often with its inputs apart."""
    data = rng.choice(_printouts())
    arguments = [
        "verify",
        "p.txt",
        *rng.choice(([], ["--brief"], ["--json"], ["--report", "r.html"])),
    ]
    files = {}
    if rng.random() < 0.4:
        texts = dict(sample(rng.randint(1, 3)))
        for name in rng.sample(list(SCENE), rng.choice((0, 0, 1, 2, 5))):
            texts[name] = rng.choice(EXTREMES) if rng.random() < 0.5 else number(rng)
        for name in rng.sample(list(SCENE), rng.choice((0, 0, 1, 3))):
            texts.pop(name, None)
        files["s.toml"] = "".join(f"{n} = {json.dumps(t)}\n" for n, t in texts.items()).encode()
        arguments += ["--scene", "s.toml"]
        lines = data.split(b"\n")
        if rng.random() < 0.7:
            data = b"\n".join(lines[rng.randint(0, len(lines)) :])
    if "--report" in arguments and rng.random() < 0.5:
        arguments += [f"{rng.choice(('--case', '--date', '--examiner'))}={rng.choice(SCRAPS)}"]
    files["p.txt"] = spoilt(rng, data, rng.choice((1, 3, 12)))
    return Case("printout", arguments, files=files)


def bounds_case(rng: Random) -> Case:
    """Ranges."""
    arguments = ["bounds", "--sample", rng.choice("123"), "--samples", "50", "--outputs", "DVA"]
    name = rng.choice(list(SCENE))
    arguments += ["--range", f"{name}=+- {number(rng)}", *_options(rng, "bounds", 2)]
    return Case("bounds", arguments)


EXTREMES = [
    *"0 -0 1e155 -1e155 1e-155 1e308 -1.7e308 1e-308 5e-324 1e77 1e103 1e20 -1e20 1e-20".split(),
    *"1e16 90 -90 180 360 1 -1 .5 1e30 1e-30 1e200 1e-200 inf -10 4 1e5".split(),
    *"1e999999999 1e-999999999".split(),
]
"""Numbers at which arithmetic in doubles has its ends and its corners."""


_UNITS = (" mph", " lb", " kg", "ft", " m/s", " deg", " %", "%", " ft-lb", " in")
_SYSTEMS = [["--units", name] for name in ("us", "si", "metric", "chapter")]
_HOW = {
    "reconstruct": [
        ["--contact-time"],
        ["--outputs", "UX"],
        ["--write-scene", "o.toml"],
        *_SYSTEMS,
    ],
    "barrier": [["--contact-time"], *_SYSTEMS],
    "colinear": [["--contact-time"], *_SYSTEMS],
    "delta-v": [["--as-printed"], ["--like", "rear"]],
    "run": [["--arithmetic", "float64"], ["--move-contact=1e20,-1"], ["--raw"]],
}


def extremes_case(rng: Random) -> Case:
    """A well-formed problem with a few extreme numbers, to everything that solves one."""

    def value() -> str:
        text = rng.choice(EXTREMES) if rng.random() < 0.6 else f"{rng.uniform(-200, 200):.2f}"
        return text + (rng.choice(_UNITS) if rng.random() < 0.05 else "")

    texts = dict(sample(rng.randint(1, 3)))
    for name in rng.sample(list(SCENE), rng.choice((0, 1, 2, 3))):
        texts[name] = rng.choice(EXTREMES)
    if rng.random() < 0.3:
        texts["M"] = rng.choice("46")
    others = ["bounds", "bounds", "bounds", "figure", "barrier", "colinear", "delta-v", "run"]
    command = rng.choice(["reconstruct"] * 5 + ["oracle", *others])
    if command == "oracle":
        return Case("extremes", ["oracle"], stdin=json.dumps({"scene": texts}).encode() + b"\n")
    if command == "reconstruct":
        for name in rng.sample(["UX", "UY", "WA", "VX", "VY", "WB", "E", "MU"], rng.randint(0, 3)):
            texts.pop(name, None)
    files = {"s.toml": "".join(f'{name} = "{text}"\n' for name, text in texts.items()).encode()}
    if command == "figure":
        drawn = rng.choice(("scene", "planar"))
        return Case("extremes", ["figure", drawn, "s.toml", "-o", "o.svg"], files=files)
    arguments = [command, "s.toml"]
    if rng.random() < 0.3:
        arguments += rng.choice(_HOW.get(command, [[]]))
        if arguments[-1] == "--contact-time":
            arguments.append(value())
    for _ in range(rng.randint(0, 3)):
        text = f"{rng.choice([*SCENE, *RESULTS, *CHAPTER])}={value()}"
        if command == "reconstruct" and rng.random() < 0.5:
            text += f" +- {value()}"
        arguments += ["--set", text]
    if command == "bounds":
        form = rng.choice(("+- {}", "{} .. {}", "normal {} {}", "triangular {} {} {}"))
        text = form.format(value(), value(), value())
        arguments += ["--range", f"{rng.choice(list(SCENE))}={text}", "--samples", "40"]
        arguments += rng.choice(([], [], ["--reconstruct"]))
    if rng.random() < 0.3:
        arguments.append("--json")
    return Case("extremes", arguments, files=files)


def junk_case(rng: Random) -> Case:
    """Bytes without sense to every reader."""
    size = rng.choice((0, 1, 3, 50, 2000))
    data = struct.pack(f"{size}B", *(rng.randrange(256) for _ in range(size)))
    lines = """solve t.csv|solve t.jsonl|solve t.npz|compare t.csv|run t.csv|bounds t.csv
        basic t.csv --max-statements 99|verify t.csv|oracle t.csv|reconstruct t.csv|run
        witness --rom t.csv|solve t.csv.gz|compare t.jsonl|compare t.npz|delta-v t.csv"""
    arguments = rng.choice(lines.replace("\n", "|").split("|")).split()
    return Case("junk", arguments, data, {arguments[1]: data} if len(arguments) > 1 else {})


def replay_case(rng: Random) -> Case:
    """Scenes with columns that are shared, zero, one of two values, or all different."""
    count = rng.choice((1, 2, 3, 6))
    pool = [text for text in NUMBERS if _is_short_number(text)]
    columns = {}
    for name in SCENE:
        usual = sample(rng.randint(1, 3))[name]
        match rng.randrange(6):
            case 0:
                cells = ["0"] * count
            case 1:
                cells = [rng.choice((usual, "0")) for _ in range(count)]
            case 2 if name != "M":
                cells = [number(rng) for _ in range(count)]
                cells = [cell if _is_short_number(cell) else "0" for cell in cells]
            case 3 if name != "M":
                cells = [rng.choice(pool)] * count
            case _:
                cells = [usual] * count
        columns[name] = [rng.choice("46") for _ in range(count)] if name == "M" else cells
    rows = [",".join(columns)]
    rows += [",".join(column[at] for column in columns.values()) for at in range(count)]
    return Case("replay", [], "\n".join(rows).encode())


def _is_short_number(text: str) -> bool:
    return text.strip() != "" and len(text) <= VALUE_LIMIT and is_number(text) and "," not in text


KINDS: dict[str, tuple[Callable[[Random], Case], int]] = {
    "toml": (toml_case, 10),
    "options": (options_case, 10),
    "extremes": (extremes_case, 4),
    "csv": (csv_case, 10),
    "jsonl": (jsonl_case, 14),
    "oracle": (oracle_case, 3),
    "npz": (npz_case, 12),
    "program": (program_case, 10),
    "session": (session_case, 8),
    "replies": (replies_case, 6),
    "printout": (printout_case, 2),
    "bounds": (bounds_case, 1),
    "junk": (junk_case, 9),
    "replay": (replay_case, 1),
}
"""Kind -> what makes a case of it, and how many of a hundred are of it."""


def make(kind: str, seed: str) -> Case:
    """The case of a kind and a seed."""
    case = KINDS[kind][0](random.Random(f"{kind} {seed}"))
    case.seed = seed
    case.arguments = [
        text.encode("utf-8", "replace").decode().replace("\0", "\\0") for text in case.arguments
    ]
    return case
