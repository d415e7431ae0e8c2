"""Command lines that cannot be used end with status 2 and one line, whatever is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import command

SCENE = 'units = "us"\nMA = 3091\nMB = 4669\n'
FILES = {
    "empty.toml": b"",
    "few.toml": SCENE.encode(),
    "binary.toml": bytes(range(256)),
    "nested.toml": b"a = " + b"[" * 5000,
    "unknown.toml": b"MASS = 3",
    "units.toml": b'units = "furlongs"\nMA = 1',
    "mixed.toml": b'MA = "3 kg"\nMB = "3 lb"',
    "enormous.toml": b'units = "us"\nMA = 3\nMB = 4\nUX = "1e308"',
    "word.toml": b'MA = "heavy"',
    "huge.toml": b'MA = "1E-999999999"',
    "long.toml": b'MA = "' + b"9" * 100_000 + b'"',
    "reversed.toml": b'units = "us"\nMA = "5 .. 3"',
    "control.toml": b'MA = "\\u001b[2J"',
    "table.csv": b"MA,MB\n1,2\n",
    "ragged.csv": b"MA,MB\n1\n1,2,3\n",
    "twice.csv": b"MA,MA\n1,2\n",
    "lines.jsonl": b'{"MA": 1\nnot json\n',
    "broken.parquet": b"PAR1 and no more",
    "picture.gif": b"GIF89a",
    "text.bas": b"no line number",
    "page.html": b"x",
}
LINES = """
nonsense
run nonsense.toml
run --sample 1 few.toml
run --sample
run binary.toml
run .
run --sample 1 --set MU
run --sample 1 --set MU=much
run --sample 1 --set XX=1
run --sample 1 --set MU=1 --set MU=2
run --sample 1 --set MU=1e999
run --json
verify page.html --listing text.bas
run --sample 1 -o .
run --sample 1 -o missing/folder/page.txt
solve
solve few.toml -o few.toml
solve nested.toml
solve unknown.toml
solve enormous.toml
solve units.toml
solve mixed.toml
solve word.toml
solve huge.toml
solve long.toml
solve reversed.toml
solve control.toml
solve --sample 1 --results NOTHING
solve --sample 1 --set M=5
solve --sample 1 --sweep MU=0:1
solve --sample 1 --sweep MU=0:1:99999999999
solve table.csv
solve table.csv --sweep MU=0:1:3
solve ragged.csv
solve twice.csv
solve lines.jsonl
solve broken.parquet
report --sample 1 -o page.pdf
report empty.toml -o page.html
scene barrier --sample 1
verify
verify picture.gif
verify page.html --report page.html
oracle nothing.jsonl
compare
basic text.bas
chapter colinear
chapter delta-v --set MA=3
help nonsense
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("hostile")
    for name, data in FILES.items():
        (folder / name).write_bytes(data)
    return folder


@pytest.mark.parametrize("line", LINES.strip().splitlines())
def test_unusable_input_is_one_line(line: str, folder: Path) -> None:
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    outcome = command(*line.split(), folder=folder)
    assert outcome.status == 2, outcome
    assert outcome.out == ""
    *_, last = outcome.err.splitlines()
    assert last.startswith("impact88")
    assert "Traceback" not in outcome.err
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
