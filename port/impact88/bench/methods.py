"""The methods compared: each takes a population's scenes and gives their final velocities."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..accuracy.elimination import ORDER, changes, eliminate, fill, lapack
from ..applesoft.operators import Real
from ..closedform.solve import solve
from ..program.run import run
from ..replay import replay
from ..scene import Scene
from .populations import Columns, texts

Floats = NDArray[np.float64]

DOUBLE = 2.0**-53
APPLESOFT = 2.0**-32


class Prepared(NamedTuple):
    """Scenes in the form a method takes, made outside the timing."""

    size: int
    columns: Columns
    texts: dict[str, list[str]]


def prepare(columns: Columns) -> Prepared:
    return Prepared(len(columns["MA"]), columns, texts(columns))


class Method(NamedTuple):
    """``ready`` turns scenes into what ``solve`` takes, untimed; ``solve`` gives an (n, 6) array or
    six columns by name, NaN where there is no answer. ``timed``: how many scenes to time;
    ``roundoff``: the unit roundoff of its numbers; ``threads``: how many it uses; ``compiled``:
    whether by the compiled machine where it was built."""

    key: str
    name: str
    roundoff: float
    timed: int
    solve: Callable[[Any], Floats | dict[str, Floats]]
    ready: Callable[[Prepared], Any] = lambda prepared: prepared
    threads: int = 1
    compiled: bool = True

    def velocities(self, prepared: Prepared) -> Floats:
        """The final velocities of scenes, (n, 6)."""
        found = self.solve(self.ready(prepared))
        return found if isinstance(found, np.ndarray) else np.stack([*found.values()], axis=1)


def _port(arithmetic: str, read: Callable[[Any], float]) -> Callable[[list[Scene]], Floats]:
    def solve_each(scenes: list[Scene]) -> Floats:
        out = np.full((len(scenes), 6), np.nan)
        for i, scene in enumerate(scenes):
            result = run(scene, arithmetic)
            if result.error is None and not result.zero_determinant and result.A is not None:
                # the last column of A(6,7), first subscript fastest
                rows = result.A["dims"][0]
                out[i] = [read(x) for x in result.A["data"][-rows:][1:]]
        return out

    return solve_each


def _scene_list(prepared: Prepared) -> list[Scene]:
    names, columns = list(prepared.texts), list(prepared.texts.values())
    rows = zip(*columns, strict=True)
    return [Scene.from_mapping(dict(zip(names, row, strict=True))) for row in rows]


def _texts(prepared: Prepared) -> dict[str, list[str]]:
    return prepared.texts


def _filled(prepared: Prepared) -> tuple[Floats, Floats]:
    return fill(prepared.columns)


def _replay(columns: dict[str, list[str]]) -> Floats:
    replayed = replay(columns)
    return np.stack([replayed.floats(name) for name in ORDER], axis=1)


def _listing_elimination(matrices: tuple[Floats, Floats]) -> Floats:
    """Lines 1000 to 1170 on matrices made with exact pi: what is left is the elimination's."""
    out = np.full(matrices[1].shape, np.nan)
    for i, (A, b) in enumerate(zip(matrices[0].tolist(), matrices[1].tolist(), strict=True)):
        solution = eliminate([[*row, right] for row, right in zip(A, b, strict=True)], 1e-9)
        if solution is not None:
            out[i] = solution
    return out


def _changes_ready(prepared: Prepared) -> tuple[Floats, Floats, Floats]:
    A, _ = fill(prepared.columns)
    return (A, *changes(prepared.columns, A))


def _closed_form(threads: int) -> Callable[[Prepared], dict[str, Floats]]:
    return lambda prepared: solve(prepared.columns, ORDER, threads=threads)


METHODS: Sequence[Method] = (
    Method(
        "applesoft",
        "Applesoft port",
        APPLESOFT,
        200,
        _port("applesoft", lambda x: float(Real.from_stored(x))),
        _scene_list,
    ),
    Method("replay", "replay (Applesoft, arrays)", APPLESOFT, 20_000, _replay, _texts),
    Method("float64", "port in float64", DOUBLE, 500, _port("float64", float), _scene_list),
    Method(
        "elimination",
        "listing's elimination, pi exact",
        DOUBLE,
        2000,
        _listing_elimination,
        _filled,
    ),
    Method("lapack", "LAPACK, matrices ready", DOUBLE, 100_000, lambda m: lapack(*m), _filled),
    Method(
        "lapack-changes",
        "LAPACK, velocity changes",
        DOUBLE,
        100_000,
        lambda made: made[2] + lapack(*made[:2]),
        _changes_ready,
    ),
    Method(
        "lapack-fill",
        "LAPACK, filled and solved",
        DOUBLE,
        100_000,
        lambda prepared: lapack(*_filled(prepared)),
    ),
    Method("closed-form", "closed form, one core", DOUBLE, 1_000_000, _closed_form(1)),
    Method(
        "closed-form-2", "closed form, two cores", DOUBLE, 1_000_000, _closed_form(2), threads=2
    ),
    Method(
        *("closed-form-numpy", "closed form, numpy alone", DOUBLE, 200_000, _closed_form(1)),
        compiled=False,
    ),
    Method(
        *("replay-numpy", "replay, numpy alone", APPLESOFT, 20_000, _replay, _texts),
        compiled=False,
    ),
)
"""In the order of the table; the reference itself is measured beside them."""


COMPONENTS = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF", "PN", "PT", "PM", "LOSS", "DVA", "MUC")
"""Results whose errors are listed one by one."""


def reference(prepared: Prepared, names: Sequence[str] = ORDER) -> tuple[Floats, Floats]:
    """Results to 50 digits, a column for each of ``names``, each number as the sum of two doubles
    (hi, lo); NaN where there is none."""
    from ..accuracy.digits import fifty_digits

    hi, lo = (np.full((prepared.size, len(names)), np.nan) for _ in range(2))
    for i in range(prepared.size):
        true = fifty_digits({name: float(values[i]) for name, values in prepared.columns.items()})
        for j, name in enumerate(names):
            if name in true:
                hi[i, j] = float(true[name])
                lo[i, j] = float(true[name] - hi[i, j])
    return hi, lo


def relative_errors(computed: Floats, hi: Floats, lo: Floats) -> Floats:
    """Every scene's largest relative error, velocities by the largest velocity, spins by the larger
    spin; infinite where there is no answer."""
    with np.errstate(all="ignore"):
        error = np.abs((computed - hi) - lo)
        parts = []
        for group in (slice(0, 4), slice(4, 6)):
            scale = np.abs(hi[:, group]).max(axis=1)
            worst = error[:, group].max(axis=1)
            parts.append(np.where(worst == 0, 0.0, worst / scale))
    largest = np.maximum(*parts)
    return np.where(np.isnan(largest), math.inf, largest)
