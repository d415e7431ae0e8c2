"""The methods compared: each takes a population's scenes and gives their final velocities."""

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..apple.applesoft.operators import Real
from ..casework.figures.drawing import BLACK, BLUE, GREY, ORANGE, VERMILION
from ..collision.casescene import Scene
from ..mechanics import native
from ..mechanics.accuracy.elimination import changes, eliminate, fill, lapack
from ..mechanics.accuracy.errorbound import APPLESOFT, DOUBLE
from ..mechanics.closedform.solve import solve
from ..names import FINAL_VELOCITIES
from ..program.replay import replay
from ..program.run import run
from . import plainc
from .populations import Columns, texts

Floats = NDArray[np.float64]


class Method(NamedTuple):
    """``solve``: from what ``prepare`` makes of the scenes, untimed, to an (n, 6) array or six
    columns by name, NaN where there is no answer. ``mark`` (open with a blank) and ``colour``: in
    figures; ``timed``: how many scenes to time; ``roundoff``: the unit roundoff of its numbers;
    ``compiled``: whether by the compiled machine where it was built; ``plain``: whether in C that
    is compiled for the benchmark, and knows no pivot."""

    key: str
    name: str
    mark: str
    colour: str
    timed: int
    solve: Callable[[Any], Floats | dict[str, Floats]]
    prepare: Callable[[Columns], Any] = dict
    roundoff: float = DOUBLE
    threads: int = 1
    compiled: bool = True
    plain: bool = False

    def run(self, prepared: Any) -> Floats | dict[str, Floats]:
        with nullcontext() if self.compiled else native.switched_off():
            return self.solve(prepared)

    def velocities(self, columns: Columns) -> Floats:
        """The final velocities of scenes, (n, 6)."""
        velocities = self.run(self.prepare(columns))
        return (
            velocities
            if isinstance(velocities, np.ndarray)
            else np.stack([*velocities.values()], axis=1)
        )


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


def _scenes(columns: Columns) -> list[Scene]:
    cells = texts(columns)
    rows = zip(*cells.values(), strict=True)
    return [Scene.from_mapping(dict(zip(cells, row, strict=True))) for row in rows]


def _replay(columns: dict[str, list[str]]) -> Floats:
    replay_result = replay(columns)
    return np.stack([replay_result.floats(name) for name in FINAL_VELOCITIES], axis=1)


def _listing_elimination(matrices: tuple[Floats, Floats]) -> Floats:
    """Lines 1000 to 1170 on matrices made with exact pi: what is left is the elimination's."""
    out = np.full(matrices[1].shape, np.nan)
    for i, (A, b) in enumerate(zip(matrices[0].tolist(), matrices[1].tolist(), strict=True)):
        solution = eliminate([[*row, right] for row, right in zip(A, b, strict=True)], 1e-9)
        if solution is not None:
            out[i] = solution
    return out


def _changes(columns: Columns) -> tuple[Floats, Floats, Floats]:
    A, _ = fill(columns)
    return (A, *changes(columns, A))


def _closed_form(columns: Columns) -> dict[str, Floats]:
    return solve(columns, FINAL_VELOCITIES, threads=1)


_float64 = _port("float64", float)
_applesoft = _port("applesoft", lambda x: float(Real.from_stored(x)))
_TEXTS: dict[str, Any] = {"prepare": texts, "roundoff": APPLESOFT}
METHODS: Sequence[Method] = (
    Method("applesoft", "Applesoft port", "s ", VERMILION, 200, _applesoft, _scenes, APPLESOFT),
    Method("replay", "replay (Applesoft, arrays)", "s", VERMILION, 20_000, _replay, **_TEXTS),
    Method("float64", "port in float64", "o ", BLUE, 500, _float64, _scenes),
    Method(
        "elimination",
        "listing's elimination, pi exact",
        "v",
        BLUE,
        2000,
        _listing_elimination,
        fill,
    ),
    Method(
        "lapack",
        "LAPACK, matrices ready",
        "^",
        GREY,
        100_000,
        lambda m: lapack(*m),
        fill,
    ),
    Method(
        "lapack-changes",
        "LAPACK, velocity changes",
        ">",
        GREY,
        100_000,
        lambda made: made[2] + lapack(*made[:2]),
        _changes,
    ),
    Method(
        "lapack-fill",
        "LAPACK, filled and solved",
        "^ ",
        GREY,
        100_000,
        lambda columns: lapack(*fill(columns)),
    ),
    Method("closed-form", "closed form, one core", "D", ORANGE, 1_000_000, _closed_form),
    Method(
        "closed-form-2",
        "closed form, two cores",
        "D ",
        BLACK,
        1_000_000,
        lambda columns: solve(columns, FINAL_VELOCITIES, threads=2),
        threads=2,
    ),
    Method(
        "closed-form-numpy",
        "closed form, numpy alone",
        "D ",
        ORANGE,
        200_000,
        _closed_form,
        compiled=False,
    ),
    *(
        Method(
            key,
            name,
            mark,
            BLACK,
            200_000,
            partial(plainc.solve, flags=flags),
            plainc.prepare,
            plain=True,
        )
        for key, name, mark, flags in zip(
            ("plain", "plain-fast"),
            ("plain C, -O3", "plain C, -ffast-math"),
            ("^", "^ "),
            plainc.FLAGS,
            strict=True,
        )
    ),
    Method(
        "replay-numpy",
        "replay, numpy alone",
        "P ",
        VERMILION,
        20_000,
        _replay,
        **_TEXTS,
        compiled=False,
    ),
)
"""In the order of the table; the reference itself is measured beside them."""


def relative_errors(
    computed: Floats, hi: Floats, lo: Floats, sizes: Floats | None = None
) -> Floats:
    """Every scene's largest error, velocities by the largest velocity, spins by the larger spin, or
    each by its own size (n, 6); infinite where there is no answer."""
    if sizes is None:
        groups = (np.abs(hi[:, group]).max(axis=1) for group in [slice(0, 4), slice(4, 6)])
        sizes = np.repeat(np.stack([*groups], axis=1), [4, 2], axis=1)
    with np.errstate(all="ignore"):
        error = np.abs((computed - hi) - lo)
        largest: Floats = np.where(error == 0, 0.0, error / sizes).max(axis=1)
    largest[np.isnan(largest)] = np.inf
    return largest
