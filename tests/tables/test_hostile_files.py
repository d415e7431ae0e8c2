"""Damaged and hostile files end in a result or in one line, soon."""

import random
import time
from pathlib import Path

import numpy as np
import pytest

import impact88
from impact88.cases import Case
from impact88.errors import UserError
from impact88.tables.engine import write_table
from impact88.tables.solving import Solver

PIECES = [b'"', b"'", b",", b";", b"\n", b"\r", b"\0", b"\xff", b"[" * 90, b"{", b"=", b"9" * 400]
PIECES += [b"1e999999999", b"1e-999999999", b"nan", b"inf", b"..", b"+-", b"\xff\xfe", b"," * 2000]
SCENE = """units = "us"
MA = "2,000 lb"
MA_source = "x"
IA = "estimate +- 20 %"
DA = "6 ft 6 in"
UX = "normal 30 2 mph"
UY = 3
TA = "course"
SAF = "skid 62 ft at 0.7 +- 0.05"
"""


def damage(data: bytes, rng: random.Random) -> bytes:
    for _ in range(rng.choice((1, 2, 5))):
        at, to = sorted(rng.randrange(len(data) + 1) for _ in range(2))
        piece = rng.choice((rng.choice(PIECES), data[at:to], rng.randbytes(1)))
        data = data[:at] + piece + data[at + rng.choice((0, 1, 40)) :]
    return data


@pytest.mark.parametrize("kind", ["toml", "csv", "jsonl", "xlsx", "parquet"])
def test_damaged_files(tmp_path: Path, kind: str) -> None:
    rng, path = random.Random(kind), tmp_path / f"file.{kind}"
    target = str(tmp_path / "out.csv")
    if kind == "toml":
        path.write_text(SCENE)
    else:
        scene = impact88.sample(1).numbers()
        write_table(str(path), [{name: np.full(9, number) for name, number in scene.items()}])
    data = path.read_bytes()
    for _ in range(10):
        path.write_bytes(damage(data, rng))
        start, message = time.process_time(), path.name
        try:
            if kind == "toml":
                Case.load(str(path))
            else:
                arithmetic = rng.choice(("float64", "applesoft"))
                Solver(str(path), Case.of({}), arithmetic=arithmetic).write(target)
        except UserError as error:
            message = str(error)
        assert path.name in message
        assert "\n" not in message
        assert time.process_time() - start < 2
