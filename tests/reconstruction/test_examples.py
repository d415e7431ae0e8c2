"""The examples in the docstrings of the public functions."""

import doctest
import importlib

import pytest

import impact88

MODULES = (
    "reconstruction.answer",
    "reconstruction.bounds",
    "reconstruction.unknowns",
    "reconstruction.words",
    "chapter.colinear",
    "chapter.barrier",
    "chapter.deltav",
    "chapter.validation",
)


@pytest.mark.parametrize("name", MODULES)
def test_examples(name):
    module = importlib.import_module(f"impact88.{name}")
    failures, attempts = doctest.testmod(module, extraglobs={"impact88": impact88})
    assert (failures, attempts > 0) == (0, True)
