"""`import impact88`: what the outside sees, by name and by type."""

from __future__ import annotations

import ast
import inspect
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import consumer
import numpy as np
import pytest
from captures import ROOT

import impact88

SOURCE = ROOT / "port" / "impact88" / "__init__.py"
CONSUMER = Path(consumer.__file__)


def typed_imports() -> dict[str, tuple[str, str]]:
    """Public name -> module and the name there, of the imports that type checkers alone see."""
    imports = {}
    for node in ast.walk(ast.parse(SOURCE.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module != "version":
            for alias in node.names:
                imports[alias.asname or alias.name] = (node.module or "", alias.name)
    return imports


def test_checkers_see_what_python_finds() -> None:
    lazy = {}
    for name, place in impact88._LAZY.items():
        module, _, inner = place.partition(":")
        lazy[name] = (module, inner or name)
    assert typed_imports() == lazy
    assert set(impact88.__all__) == {*lazy, "__version__"}


@pytest.mark.parametrize("name", impact88.__all__)
def test_a_public_name_is_there_and_says_what_it_is(name: str) -> None:
    value = getattr(impact88, name)
    assert name in ("__version__", "accelerated") or inspect.getdoc(value)
    assert name == "__version__" or re.search(rf"\b{name}\b", impact88.__doc__ or "")


def test_completion_lists_no_plumbing() -> None:
    assert dir(impact88) == sorted(impact88.__all__)
    with pytest.raises(AttributeError, match="no attribute 'files_of'"):
        _ = impact88.files_of


def test_functions_stay_functions_once_their_rooms_are_imported() -> None:
    script = (
        "import impact88, impact88.program.replay\n"
        "import impact88.casework.uncertainty.bounds\n"
        "print(callable(impact88.replay), callable(impact88.bounds), callable(impact88.run))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.stdout.split() == ["True"] * 3, done.stderr


def test_the_consumer_s_script_does_what_it_says() -> None:
    assert consumer.printed_loss(".5") == "INITIAL KE= 100904.929 KE LOSS= 44.43 %"
    assert consumer.losses(np.array([0.911])).round(2).tolist() == [57.47]
    low, high = consumer.spread()
    assert 50 < low < high < 60
    assert len(consumer.replayed().split()) == 2
    text = (ROOT / "legacy" / "run1-as-printed.txt").read_text(encoding="utf-8")
    assert consumer.judged(text) == ["IDENTICAL"]
    assert set(consumer.solved_for()) == set(impact88.names.VELOCITIES)
    assert consumer.looked_up() == 1
    assert "missing" in consumer.refused()


CACHE = ROOT / ".mypy_cache" / "consumer"
MYPY = ["mypy", "--strict", "--follow-imports=silent", "--cache-dir", str(CACHE)]


@pytest.mark.long
@pytest.mark.parametrize("checker", [MYPY, ["pyright"]], ids=lambda c: c[0])
def test_type_checkers_see_the_signatures(checker: list[str], tmp_path: Path) -> None:
    """Strict on the script as it is; and a wrong use of each kind is found."""
    if find_spec(checker[0]) is None:
        pytest.skip(f"{checker[0]} is not installed (extra: lint)")
    wrong = tmp_path / "wrong.py"
    wrong.write_text(
        "import impact88\n"
        "impact88.run(3)\n"
        "impact88.sample('1')\n"
        "impact88.solve({}, threads='two')\n"
        "x: int = impact88.verify\n"
        "impact88.nothing\n",
        encoding="utf-8",
    )

    # an editable installation is found by Python alone
    (tmp_path / "impact88").symlink_to(ROOT / "port" / "impact88")
    script = tmp_path / "consumer.py"
    script.write_text(CONSUMER.read_text(encoding="utf-8"), encoding="utf-8")

    done = subprocess.run(
        [sys.executable, "-m", *checker, str(script), str(wrong)],
        capture_output=True,
        text=True,
        cwd=tmp_path,
    )
    said = done.stdout + done.stderr
    assert "consumer.py:" not in said, said
    for line in range(2, 7):
        assert f"wrong.py:{line}" in said, said


def test_what_is_returned_is_told_in_a_line() -> None:
    """A session shows what a call returns: one line, not every number in it."""
    scene = impact88.sample(1)
    page = impact88.run(scene).page
    returned = [
        *impact88.verify(page),
        *impact88.reconstruct({**scene, "VAX": "-13 +- 1"}),
        impact88.bounds({**scene, "MU": ".7 .. .9"}, samples=10),
        impact88.bounds({**scene, "MU": ".7 .. .9"}, ["DVA"], samples=10),
    ]
    for value in returned:
        assert len(repr(value)) < 200
        assert repr(value).startswith("<")
        assert "\n" not in repr(value)
