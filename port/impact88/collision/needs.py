"""Inputs that results need and lack, in words; and ordinary numbers to find them out with."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..names import ANGLE, INERTIA, LENGTH, MASS, NUMBER, RESULTS, SCENE, SPIN, VELOCITY, quantity

ORDINARY_RANGES: dict[str, tuple[float, float]] = {
    ANGLE: (-180.0, 180.0),
    LENGTH: (1.0, 9.0),
    MASS: (50.0, 200.0),
    INERTIA: (800.0, 4000.0),
    VELOCITY: (-60.0, 60.0),
    SPIN: (-3.0, 3.0),
    NUMBER: (0.1, 0.9),
}
"""Ordinary numbers, by the rule of their unit."""


def ordinary(name: str, rng: np.random.Generator, count: int) -> NDArray[np.float64]:
    """Return ordinary numbers for a value of an impact."""
    values = rng.uniform(*ORDINARY_RANGES[quantity(name).unit], count)
    return np.asarray(-values if name == "EM" else values)


def needs_in_words(needs: Mapping[str, Collection[str]]) -> list[tuple[list[str], str]]:
    """Return sentences on what results need, those with the same needs together.

    Parameters
    ----------
    needs : mapping of str to collection of str
        Results, each with the inputs it needs that are not given.

    Returns
    -------
    list of (list of str, str)
        Results and their sentence.

    Examples
    --------
    >>> for _, sentence in needs_in_words({"PDOFA": ["TA"], "E": ["GA"], "VC": ["GA"]}):
    ...     print(sentence)
    PDOFA needs TA, the way A faces; TA = "course" takes the way it travels
    E and VC need GA (angle of the impact surface from the y axis)
    """
    groups: dict[tuple[str, ...], list[str]] = {}
    for result, inputs in needs.items():
        names = tuple(name for name in (*SCENE, *RESULTS) if name in inputs)
        groups.setdefault(names, []).append(result)
    return [(results, _sentence(results, inputs)) for inputs, results in groups.items()]


def _sentence(results: Sequence[str], inputs: Sequence[str]) -> str:
    verb = "needs" if len(results) == 1 else "need"
    return f"{join_words(results)} {verb} {_describe_inputs(inputs)}"


def needs_sentences(needs: Mapping[str, Collection[str]]) -> list[str]:
    """Return the sentences of `needs_in_words`."""
    return [sentence for _, sentence in needs_in_words(needs)]


def join_words(names: Sequence[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def _describe_inputs(inputs: Sequence[str]) -> str:
    if len(inputs) == 1 and inputs[0] in ("TA", "TB"):
        vehicle = inputs[0][1]
        return (
            f'{inputs[0]}, the way {vehicle} faces; {inputs[0]} = "course" takes the way it travels'
        )
    if len(inputs) == 1:
        return f"{inputs[0]} ({quantity(inputs[0]).meaning})"
    return join_words(inputs)
