"""Docstrings of the public names hold numpydoc's rules; each function and class has an example."""

from __future__ import annotations

import enum
import inspect
import re
import sys
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cached_property

import pytest

import impact88

pytest.importorskip("numpydoc")
from numpydoc.validate import validate

NOT_ASKED_FOR = {
    "ES01",  # an extended summary: one line is often enough
    "GL01",  # before numpydoc 1.11: a summary on the line below the quotes
    "SA01",  # a section See Also
    "SA04",  # a description of each entry of See Also
}
NOT_ASKED_OF_MEMBERS = {"EX01", "RT01", "RT03", "PR01"}  # what one line of summary says
RETURNED = {"Replay"}  # classes that a function makes
MEMBERS = (staticmethod, classmethod, property, cached_property)

CALLABLE = [name for name in impact88.__all__ if callable(getattr(impact88, name))]
CLASSES = [name for name in CALLABLE if inspect.isclass(getattr(impact88, name))]


def members_of(cls: type) -> Iterator[str]:
    """Yield the public methods and properties that this package defines for a class."""
    for base in inspect.getmro(cls):
        if base.__module__.startswith("impact88."):
            for name, member in vars(base).items():
                plain = inspect.isfunction(member) or isinstance(member, MEMBERS)
                if plain and not name.startswith("_"):
                    yield name


MEMBER_NAMES = [
    f"{name}.{member}"
    for name in CLASSES
    for member in dict.fromkeys(members_of(getattr(impact88, name)))
]


@pytest.mark.parametrize("name", [*CALLABLE, *MEMBER_NAMES])
def test_docstring_holds_numpydoc_s_rules(name: str) -> None:
    allowed = NOT_ASKED_FOR | (NOT_ASKED_OF_MEMBERS if "." in name else set())
    if name in RETURNED:
        allowed |= {"PR01"}
    errors = validate(f"impact88.{name}")["errors"]
    assert [f"{code}: {text}" for code, text in errors if code not in allowed] == []


def returned_types(function: Callable[..., object]) -> Iterator[type]:
    """Yield the classes of this package that a function's annotation says it returns."""
    annotation = inspect.signature(function).return_annotation
    text = annotation if isinstance(annotation, str) else inspect.formatannotation(annotation)
    for word in re.findall(r"[\w.]+", text):
        module, _, name = word.rpartition(".")
        found = vars(sys.modules[module]) if module in sys.modules else function.__globals__
        value = found.get(name)
        if inspect.isclass(value) and value.__module__.startswith("impact88."):
            yield value


FUNCTIONS = [name for name in CALLABLE if name not in CLASSES]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_what_a_public_function_returns_is_public(name: str) -> None:
    function = inspect.unwrap(getattr(impact88, name))
    public = [getattr(impact88, name) for name in CLASSES]
    assert [cls for cls in returned_types(function) if cls not in public] == []


def test_returned_types_are_found() -> None:
    assert list(returned_types(impact88.solve_for)) == [impact88.Solution]
    assert list(returned_types(impact88.verify)) == [impact88.Verification]
    assert list(returned_types(inspect.unwrap(impact88.prepared))) == [impact88.Prepared]


def plain(value: object) -> bool:
    """Return whether a default shows in a signature as it would be written."""
    if isinstance(value, tuple):
        return all(map(plain, value))
    return value is None or isinstance(value, bool | int | float | str | enum.Enum | Fraction)


@pytest.mark.parametrize("name", [*FUNCTIONS, *MEMBER_NAMES])
def test_defaults_show_as_they_would_be_written(name: str) -> None:
    """A signature in `help` holds no lambda and no object's address."""
    value: object = impact88
    for part in name.split("."):
        value = (
            inspect.getattr_static(value, part) if value is not impact88 else getattr(value, part)
        )
    if isinstance(value, property | cached_property):
        return
    function = getattr(value, "__func__", value)
    parameters = inspect.signature(function).parameters.values()
    empty = inspect.Parameter.empty
    assert [p for p in parameters if p.default is not empty and not plain(p.default)] == []
