"""Golden files: pytest-regressions, with its data folder in golden/.

``pytest --force-regen`` writes anew the golden printouts that differ, and fails, so that somebody
looks at the difference before committing it.
"""

from __future__ import annotations

import os

# as the command does, before numpy is loaded: threads of small products wait for each other
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import random
from collections.abc import Callable
from pathlib import Path

import pytest
from captures import ROOT
from hypothesis import HealthCheck, settings
from pytest_regressions.file_regression import FileRegressionFixture

LONGER = ("IMPACT88_LONG", "IMPACT88_SWEEP", "IMPACT88_CASES", "IMPACT88_SETS")
"""Environment variables with which what is marked as long is run too."""

settings.register_profile(
    "run",
    max_examples=int(os.environ.get("IMPACT88_EXAMPLES") or 40),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],  # a busy machine fails no test
)
settings.load_profile("run")

# processes that tests start need not compile the package each for itself
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_configure(config: pytest.Config) -> None:
    """Have pytest-xdist keep the order of the tests; its own begins with the most tests."""
    config.option.loadscopereorder = False


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave out what is marked as long; with IMPACT88_SHUFFLE, a number, run tests in any order."""
    if not any(map(os.environ.get, LONGER)):
        for item in items:
            if item.get_closest_marker("long"):
                item.add_marker(pytest.mark.skip(reason="IMPACT88_LONG is not set"))
    if seed := os.environ.get("IMPACT88_SHUFFLE"):
        random.Random(seed).shuffle(items)


@pytest.fixture(scope="module")
def original_datadir() -> Path:
    """Return the folder of the golden files; the plugin's way of choosing the folder."""
    return ROOT / "golden" / "printouts"


def _same_characters(obtained: Path, expected: Path) -> None:
    assert obtained.read_bytes().decode() == expected.read_bytes().decode()


@pytest.fixture
def golden_printout(file_regression: FileRegressionFixture) -> Callable[[str, str], None]:
    """``golden_printout(text, name)``: the text is golden/printouts/NAME.txt, every character.

    Compared as bytes: a printout holds form feeds, which a comparison by lines would take for
    line ends.
    """

    def check(printout: str, name: str) -> None:
        file_regression.check(
            printout.encode(),
            binary=True,
            extension=".txt",
            basename=name,
            check_fn=_same_characters,
        )

    return check
