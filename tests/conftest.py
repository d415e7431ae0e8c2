"""Golden files: pytest-regressions, with its data folder in golden/.

``pytest --force-regen`` writes anew the golden printouts that differ, and fails, so that somebody
looks at the difference before committing it.

Files of tests are shared out among processes, those that take longest first, so that none is begun
when all others are done.
"""

from __future__ import annotations

import os

# as the command does, before numpy is loaded: threads of small products wait for each other
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import random
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from pathlib import Path

import pytest
from captures import ROOT
from hypothesis import HealthCheck, settings
from pytest_regressions.file_regression import FileRegressionFixture

from impact88.mechanics import native

LONGEST = (
    "comparison",
    "causes",
    "scan",
    "desk_browser",
    "desk",
    "scan_pages",
    "installed",
    "fuzz",
    "figures",
    "verification",
    "reconstruction",
    "reading",
    "labels",
    "listing_copies",
    "replay_scenes",
    "native",
    "collision_report",
    "solve",
    "witness",
    "readme",
    "stability",
    "oracle",
    "verdicts",
    "one_case",
    "sizes",
    "every_impact",
    "tables",
    "files",
    "doors",
    "public",
    "desk_numbers",
    "schemas",
    "uncertainty",
    "units_everywhere",
    "prepared",
    "emulator",
    "bench",
    "unknowns",
)
"""Files of tests that take more than some seconds (``--durations=0`` has the times)."""

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
    """Put the files that take longest first, and leave out what is marked as long; with
    IMPACT88_SHUFFLE, a number, files and tests in any order: none may need another."""
    if not any(map(os.environ.get, LONGER)):
        for item in items:
            if item.get_closest_marker("long"):
                item.add_marker(pytest.mark.skip(reason="IMPACT88_LONG is not set"))
    ranks = {f"test_{name}.py": rank for rank, name in enumerate(LONGEST)}
    items.sort(key=lambda item: ranks.get(item.path.name, len(LONGEST)))
    if seed := os.environ.get("IMPACT88_SHUFFLE"):
        random.Random(seed).shuffle(items)


@pytest.fixture(scope="module")
def original_datadir() -> Path:
    """Where pytest-regressions keeps its files; the plugin's way of choosing the folder."""
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


@pytest.fixture
def verdicts_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Verifications without what a page cannot show: it takes a good part of the time, and has
    tests of its own (`printouts/test_scan.py`)."""
    from impact88.printouts.judging import beside

    monkeypatch.setattr(beside, "unseen", lambda *given: [])


@pytest.fixture
def brief_search() -> Iterator[None]:
    """Reconstructions draw from a tenth of the points and search from them once: for tests of what
    doors show and of two doors that must show the same, not of the bounds themselves."""
    from impact88.casework.optimization.effort import Effort, granting

    brief = Effort(
        particles=400,
        burn_in_moves=8,
        draws_of_bounds=200,
        spread_points=200,
        spread_steps=3,
        starts=1,
        rounds=1,
    )
    with granting(brief):
        yield


@pytest.fixture(scope="module", params=["compiled", "numpy"])
def both_machines(request: pytest.FixtureRequest) -> Iterator[None]:
    """Every test of the module twice: on the compiled machine, and on numpy alone."""
    if request.param == "compiled" and native.library is None:
        pytest.skip("built without a C compiler")
    with native.switched_off() if request.param == "numpy" else nullcontext():
        yield
