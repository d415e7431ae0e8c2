"""Sizes of packages, and names that must not collide; import-linter holds the order of imports."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from captures import ROOT

import impact88

PACKAGE = ROOT / "port" / "impact88"


def node_count(path: Path) -> int:
    """Return the syntax-tree nodes of a module, without docstrings and contexts of names."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        first = body[0] if isinstance(body, list) and body else None
        value = getattr(first, "value", None) if isinstance(first, ast.Expr) else None
        if isinstance(value, ast.Constant) and isinstance(value.value, str):
            body[0] = ast.Pass()
    contexts = (ast.Load, ast.Store, ast.Del)
    return sum(not isinstance(node, contexts) for node in ast.walk(tree))


def package_sizes() -> Counter[str]:
    """Return the nodes of each package; "." is the modules at the top."""
    sizes: Counter[str] = Counter()
    for path in PACKAGE.rglob("*.py"):
        parts = path.relative_to(PACKAGE).parts
        sizes[parts[0] if len(parts) > 1 else "."] += node_count(path)
    return sizes


def recorded_sizes() -> dict[str, int]:
    """Return the sizes in port/sizes.txt."""
    lines = (ROOT / "port" / "sizes.txt").read_text(encoding="utf-8").splitlines()
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    return {row[0]: int(row[1]) for row in rows}


def test_no_package_is_larger_than_recorded() -> None:
    recorded = recorded_sizes()
    larger = {
        name: (size, recorded.get(name, 0))
        for name, size in package_sizes().items()
        if size > recorded.get(name, 0)
    }
    assert not larger, "sizes beyond port/sizes.txt; state there what a user gets for it"


def test_counting_leaves_docstrings_out(tmp_path: Path) -> None:
    module = tmp_path / "module.py"
    module.write_text('def f(x):\n    """Return x."""\n    return x\n', "utf-8")
    with_docstring = node_count(module)
    module.write_text("def f(x):\n    pass\n    return x\n", "utf-8")
    assert with_docstring == node_count(module)


def test_no_package_has_the_name_of_a_public_function() -> None:
    """Importing a subpackage binds its name in `impact88`, over a function of that name."""
    public = {name for name in impact88.__all__ if callable(getattr(impact88, name))}
    packages = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    assert not packages & public


@pytest.mark.parametrize("module", ["run", "listing", "scene"])
def test_the_1988_program_needs_no_third_party_library(module: str) -> None:
    code = f"import sys, impact88.program.{module}; print('numpy' in sys.modules)"
    output = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert output.stdout.strip() == "False"
