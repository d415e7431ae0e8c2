"""Golden files: pytest-regressions, with its data folder in golden/.

``pytest --force-regen`` writes anew the golden printouts that differ, and fails, so that somebody
looks at the difference before committing it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import nullcontext
from pathlib import Path

import pytest
from pytest_regressions.file_regression import FileRegressionFixture

from captures import ROOT
from impact88 import native


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


@pytest.fixture(scope="module", params=["compiled", "numpy"])
def both_machines(request: pytest.FixtureRequest) -> Iterator[None]:
    """Every test of the module twice: on the compiled machine, and on numpy alone."""
    if request.param == "compiled" and native.library is None:
        pytest.skip("built without a C compiler")
    with native.switched_off() if request.param == "numpy" else nullcontext():
        yield
