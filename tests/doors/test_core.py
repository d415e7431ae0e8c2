"""The core alone, and commands whose wing is missing: in copies from which wings are left out."""

from __future__ import annotations

import ast
import json
import os
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from captures import ROOT
from test_installed import BUILD, unpacked
from test_rooms import CORE, PACKAGE, WINGS

import impact88

ONLY = """
import sys
from pathlib import Path
sys.meta_path[:] = [f for f in sys.meta_path if "editable" not in getattr(f, "__module__", "")]
folder = sys.argv.pop(1)
sys.path[:] = [folder, *(p for p in sys.path if not (Path(p) / "impact88").is_dir())]
"""
"""The package of a folder and no other, however this one was installed."""


def linked(folder: Path, without: set[str]) -> Path:
    """A folder with the package as links, some wings left out."""
    package = folder / "impact88"
    package.mkdir()
    parts = {"legacy": ROOT / "legacy", "golden": ROOT / "golden"}  # as pyproject.toml maps them
    parts |= {part.name: part for part in PACKAGE.iterdir() if part.name not in without}
    for name, part in parts.items():
        (package / name).symlink_to(part)
    return folder


ASK = """
import contextlib, io, json
from impact88.interface.commands import COMMANDS
from impact88.interface.commands.cli import main
answers = {}
for command in [*([name, "--help"] for name in COMMANDS), *json.loads(sys.argv[1])]:
    talk = io.StringIO()
    with contextlib.redirect_stderr(talk), contextlib.redirect_stdout(io.StringIO()):
        status = main(command)
    answers[" ".join(command)] = status, talk.getvalue()
print(json.dumps(answers))
"""


def answers(folder: Path, *commands: list[str]) -> dict[str, tuple[int, str]]:
    done = subprocess.run(
        [sys.executable, "-c", ONLY + ASK, str(folder), json.dumps(commands)],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_command_whose_wing_is_missing_says_so(tmp_path: Path) -> None:
    page = str(ROOT / "legacy" / "run1-as-printed.txt")
    works = ["run", "--sample", "1"], ["scene", "--sample", "2"]
    lacks = {
        "casework": ["bounds", "--sample", "1", "--set", "E=0 .. .1"],
        "printouts": ["verify", page],
        "conformance": ["oracle", "--published"],
        "tables": ["solve", "--sample", "1"],
        "bench": ["bench"],
    }
    found = answers(linked(tmp_path, set(WINGS) - {*CORE, "interface"}), *works, *lacks.values())
    for command in works:
        assert found[" ".join(command)] == [0, ""]
    for wing, command in lacks.items():
        status, talk = found[" ".join(command)]
        assert status == 2
        assert f"impact88.{wing} is not installed" in talk
    for command, (status, talk) in found.items():
        assert status in (0, 2), (command, talk)
        assert status == 0 or re.fullmatch(r"impact88 .*: impact88\.\w+ is not .*\n", talk), talk


@cache
def wings_of(path: Path) -> frozenset[str]:
    """The wings that a test file needs, also by what it has from `tests/support` and conftest."""
    places = {name: module for name, module in impact88._LAZY.items() if module}
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module == "impact88":
            names = [f"impact88.{places.get(alias.name, alias.name)}" for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names = [node.module or ""]
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            names = [f"impact88.{places.get(node.attr)}"] if node.value.id == "impact88" else []
        for name in names:
            support = ROOT / "tests" / "support" / f"{name}.py"
            if name.startswith("impact88."):
                found |= {name.split(".")[1]} & set(WINGS)
            elif support.exists() and support != path:
                found |= wings_of(support)
    return frozenset(found)


def test_most_tests_of_the_core_need_the_core_alone() -> None:
    files = [path for wing in CORE for path in (ROOT / "tests" / wing).rglob("test_*.py")]
    own = [path for path in files if wings_of(path) <= set(CORE)]
    assert {path.relative_to(ROOT / "tests").parts[0] for path in own} == set(CORE)
    assert 3 * len(own) > 2 * len(files), sorted(path.name for path in files if path not in own)


RUN = """
import pytest
class Once:
    '''Every test with one of its parameters: all of them have run in the checkout.'''
    def pytest_collection_modifyitems(self, items):
        once = {(item.path, item.originalname): item for item in reversed(items)}
        items[:] = reversed(once.values())
raise SystemExit(pytest.main(sys.argv[1:], plugins=[Once()]))
"""


@pytest.mark.long
def test_the_core_stands_alone(tmp_path: Path) -> None:
    """Every other wing and its tests deleted, it is built, installed and passes its own tests, each
    with one of its parameters."""
    source, site = tmp_path / "source", tmp_path / "site"
    cruft = shutil.ignore_patterns("__pycache__", "*.egg-info", "build", "docs", "*.so", "scans")
    for name in ("port", "legacy", "golden", "tests", ".ci"):
        shutil.copytree(ROOT / name, source / name, ignore=cruft)
    shutil.copy(ROOT / "README.md", source)
    for wing in set(WINGS) - set(CORE):
        shutil.rmtree(source / "port" / "impact88" / wing)
        shutil.rmtree(source / "tests" / wing, ignore_errors=True)
    shutil.rmtree(source / "tests" / "doors")
    for path in (source / "tests").rglob("test_*.py"):
        if not wings_of(ROOT / path.relative_to(source)) <= set(CORE):
            path.unlink()
    gone = "|".join(set(WINGS) - set(CORE))
    kept = [
        line.replace('"-O2"', '"-O1"')  # the compiler's time
        for line in (ROOT / "pyproject.toml").read_text("utf-8").splitlines(keepends=True)
        if not re.match(rf'\s*"impact88\.({gone})[."]', line)
    ]
    (source / "pyproject.toml").write_text("".join(kept), "utf-8")
    subprocess.run(
        [sys.executable, "-c", BUILD, str(tmp_path)],
        cwd=source,
        env={**os.environ, "SOURCE_DATE_EPOCH": "600000000"},
        capture_output=True,
        check=True,
    )
    unpacked(next(tmp_path.glob("*.whl")), site)
    there = {path.name for path in (site / "impact88").iterdir() if path.is_dir()}
    assert there == {*CORE, "messages", "legacy", "golden"}
    done = subprocess.run(
        [sys.executable, "-c", ONLY + RUN, str(site), "-n", "0", "-q"],
        cwd=source,
        env={name: text for name, text in os.environ.items() if name != "IMPACT88_LONG"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-1000:]
