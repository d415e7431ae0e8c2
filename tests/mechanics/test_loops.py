"""What is generated for the compiler is of the formulas as they are, and no larger than it must be;
with or without a compiler."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from captures import ROOT

from impact88.mechanics import loops, native
from impact88.names import RESULTS

SIX = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")


def test_what_is_compiled_is_what_the_formulas_say(file_regression, request):
    file = ROOT / "port" / "impact88" / "mechanics" / "native" / "loops.h"
    rewrite = "python -m impact88.mechanics.loops"
    try:
        file_regression.check(loops.text(), fullpath=file, encoding="ascii")
    except AssertionError:
        if request.config.getoption("force_regen"):
            raise
        pytest.fail(f"loops.h is not of the formulas as they are; next step: {rewrite}")
    assert loops.digest() == native.FORMULAS, (
        f'next step: FORMULAS = "{loops.digest()}" in mechanics/native/__init__.py'
    )
    is_built = any(Path(native.__file__).parent.glob("_machine.*"))
    if is_built and os.environ.get(native.VARIABLE) != "0":
        assert native.library, "the library is of other formulas; next step: pip install -e ."


@pytest.mark.parametrize("kind", loops.KINDS)
def test_little_is_executed_that_the_results_do_not_need(kind):
    """Operations, counted: of each result, of the sets people ask for, and of any sets."""
    rng = np.random.default_rng(51)
    sets = [(name,) for name in RESULTS] + [SIX, tuple(RESULTS), ("DVA", "DVB", "LOSS", "STATUS")]
    for _ in range(300):
        sets.append(tuple(rng.choice(list(RESULTS), rng.integers(2, 12), replace=False)))
    for names in sets:
        executed, needed = loops.operations(kind, names)
        assert needed <= executed <= (1.2 if names in (SIX, ("LOSS",)) else 1.5) * needed, names
