"""Reconstructions that several tests and pages ask for are computed once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from impact88.reconstruction import answer, bounds

Function = Callable[..., Any]
RESULTS: dict[str, Any] = {}
"""Results by function and arguments, of this process."""


def share(function: Function) -> Function:
    """Return a function that computes the result of each set of arguments once."""

    def compute(*arguments: Any, **keywords: Any) -> Any:
        key = repr((function.__name__, arguments, keywords))
        if key not in RESULTS:
            RESULTS[key] = function(*arguments, **keywords)
        return RESULTS[key]

    return compute


@pytest.fixture(autouse=True, scope="module")
def reconstructions_are_shared() -> Iterator[None]:
    """Share reconstructions and bounds between the tests of this folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(answer, "reconstruct", share(answer.reconstruct))
        patch.setattr(bounds, "bounds", share(bounds.bounds))
        yield
