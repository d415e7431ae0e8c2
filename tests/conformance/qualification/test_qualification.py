"""The record of an installation qualification, and that it can fail."""

from __future__ import annotations

import gzip
import json
import shutil
from hashlib import sha256
from pathlib import Path

import captures
import numpy as np
import pytest

from impact88.casework.report.frame import capture_hashes, hashes
from impact88.conformance.qualification import selfcheck
from impact88.interface.commands.selfcheck_command import _line
from impact88.mechanics.accuracy import errorbound
from impact88.mechanics.closedform import solve

GOLDEN = captures.ROOT / "golden"
FEW = 12


def lines(path: Path) -> list[str]:
    return gzip.decompress(path.read_bytes()).decode().splitlines()


def write(path: Path, texts: list[str]) -> None:
    path.write_bytes(gzip.compress(("\n".join(texts) + "\n").encode()))


@pytest.fixture
def few(tmp_path) -> Path:
    """A folder of captures with a few cases of each kind."""
    for name in ("scenes", "fuzz", "vectors"):
        write(tmp_path / f"{name}.jsonl.gz", lines(GOLDEN / f"{name}.jsonl.gz")[:FEW])
    (tmp_path / "arithmetic").mkdir()
    for path in (GOLDEN / "arithmetic").glob("*.gz"):
        write(tmp_path / "arithmetic" / path.name, lines(path)[:FEW])
    (tmp_path / "programs").mkdir()
    for path in sorted((GOLDEN / "programs").glob("arith_*")):
        shutil.copy(path, tmp_path / "programs" / path.name)
    shutil.copytree(GOLDEN / "printouts", tmp_path / "printouts")
    return tmp_path


def failing(folder: Path) -> set[str]:
    found = list(selfcheck.checks(folder))
    assert [check.name for check in found] == list(selfcheck.CHECKS)
    assert selfcheck.record(found)["passed"] == all(check.passed for check in found)
    for check in found:
        assert ("FAIL" in _line(check)) is not check.passed
    return {check.name for check in found if not check.passed}


def test_captures_pass(few: Path) -> None:
    assert failing(few) == set()


def test_one_bit_of_arithmetic_fails(few: Path) -> None:
    path = few / "arithmetic" / "mul.tsv.gz"
    rows = lines(path)
    *call, result = rows[0].split("\t")
    digit = "1" if result[-1] != "1" else "2"
    write(path, ["\t".join([*call, result[:-1] + digit]), *rows[1:]])
    assert failing(few) == {"arithmetic"}


def test_one_digit_of_a_printout_fails(few: Path) -> None:
    path = few / "scenes.jsonl.gz"
    rows = [json.loads(line) for line in lines(path)]
    at = rows[3]["printout"].index("KE= ") + 4
    text = rows[3]["printout"]
    rows[3]["printout"] = text[:at] + str((int(text[at]) + 1) % 10) + text[at + 1 :]
    write(path, list(map(json.dumps, rows)))
    assert failing(few) == {"port", "replay"}


def test_one_bit_of_a_variable_fails(few: Path) -> None:
    path = few / "scenes.jsonl.gz"
    rows = [json.loads(line) for line in lines(path)]
    rows[0]["reals"]["KI"] = f"{int(rows[0]['reals']['KI'], 16) ^ 1:010x}"
    write(path, list(map(json.dumps, rows)))
    assert failing(few) == {"port"}


def test_one_character_of_a_program_fails(few: Path) -> None:
    path = next(path for path in (few / "programs").glob("*.out") if path.stat().st_size > 4)
    path.write_bytes(b"x" + path.read_bytes()[1:])
    assert failing(few) == {"emulator"}


def test_a_changed_published_run_fails(few: Path) -> None:
    path = few / "printouts" / "run1.txt"
    path.write_bytes(path.read_bytes().replace(b"57.47", b"57.48"))
    assert failing(few) == {"published"}


@pytest.mark.parametrize(("old", "new"), [("0.357402897", "0.357402898"), ("2.15329228\n", "")])
def test_a_changed_number_of_1980_fails(few: Path, old: str, new: str) -> None:
    path = few / "printouts" / "compute1980.txt"
    path.write_text(path.read_text("utf-8").replace(old, new), "utf-8")
    assert failing(few) == {"published 1980"}


def test_missing_captures_fail(few: Path) -> None:
    (few / "scenes.jsonl.gz").unlink()
    assert failing(few) == {"port", "replay"}


def test_one_digit_of_a_vector_fails(few: Path) -> None:
    path = few / "vectors.jsonl.gz"
    rows = [json.loads(line) for line in lines(path)]
    wbf = rows[0]["results"]["WBF"]
    wbf["reference"] = f"{float(wbf['reference']) * (1 + 1e-11)!r}"
    write(path, list(map(json.dumps, rows)))
    assert failing(few) == {"solve"}


@pytest.mark.parametrize("name", ["E", "MU", "EM"])
def test_a_law_that_solve_has_wrong_fails(few: Path, monkeypatch, name: str) -> None:
    """Restitution, friction and the moment: momentum is conserved all the same."""

    correct = solve.solve

    def wrong(scene, *outputs):
        changed = np.where(scene["MU"] == -10, scene[name], scene[name] + 1e-9)
        return correct({**scene, name: changed}, *outputs)

    monkeypatch.setattr(errorbound, "solve", wrong)
    monkeypatch.setattr(solve, "solve", wrong)
    assert failing(few) == {"solve"}


def test_nothing_to_compare_is_no_pass(few: Path) -> None:
    shutil.rmtree(few / "arithmetic")
    (few / "arithmetic").mkdir()
    assert failing(few) == {"arithmetic"}


def test_hashes_are_those_of_the_files() -> None:
    listing = (captures.ROOT / "legacy" / "impact.bas").read_bytes()
    assert hashes()["listing"] == sha256(listing).hexdigest()
    by_path = dict(capture_hashes())
    scenes = (GOLDEN / "scenes.jsonl.gz").read_bytes()
    assert by_path["scenes.jsonl.gz"] == sha256(scenes).hexdigest()
    assert len(by_path) == sum(
        1
        for path in GOLDEN.rglob("*")
        if path.is_file()
        and (path.parent.name in ("arithmetic", "programs") or path.name.endswith(".jsonl.gz"))
        and not {"__pycache__", "corners", "scans.jsonl.gz", "vectors.jsonl.gz"} & set(path.parts)
    )
