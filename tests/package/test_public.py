"""`import impact88`: the public names."""

from __future__ import annotations

import ast
import inspect
import re

import pytest
from captures import ROOT

import impact88

SOURCE = ROOT / "port" / "impact88" / "__init__.py"


def typed_imports() -> dict[str, str]:
    """Return public name -> module of the imports that type checkers alone see."""
    imports = {}
    for node in ast.walk(ast.parse(SOURCE.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module != "version":
            imports |= {alias.asname or alias.name: node.module or "" for alias in node.names}
    return imports


def test_type_checkers_see_what_python_imports() -> None:
    assert typed_imports() == impact88._LAZY
    assert set(impact88.__all__) == {*impact88._LAZY, "__version__"}


@pytest.mark.parametrize("name", impact88.__all__)
def test_a_public_name_exists_and_has_a_docstring(name: str) -> None:
    value = getattr(impact88, name)
    assert name in ("__version__", "accelerated") or inspect.getdoc(value)
    assert name == "__version__" or re.search(rf"\b{name}\b", impact88.__doc__ or "")


def test_completion_lists_public_names_only() -> None:
    assert dir(impact88) == sorted(impact88.__all__)
    with pytest.raises(AttributeError, match="no attribute 'no_such_name'"):
        _ = impact88.no_such_name
