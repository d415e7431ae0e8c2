"""Upper and lower bounds from ranges of the data (chapter, Section V: "reasonable ranges of these
variables should be used ... to provide upper and lower bounds on vehicle speed").

Of one scene whose values are known within limits (`collision.uncertain`), the box the ranges span
is searched (`optimization.extremes`) for each sign that line 400 can give MU, correlations or not.
Every bound is attained at the inputs kept beside it; that none lies farther is likely, not proven.
Where the equations become singular inside, a bound is infinite. Beside it stand seeded Monte Carlo
(`Spread`) and what each input does alone (`Drive`).

The forward problem goes from initial to final velocities (Equations 13-18); the reconstruction from
the six final velocities back, with MUP, the signed P_t/P_n, for MU: line 400's sign rule needs
initial velocities.
"""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from .. import status
from ..collision.case import check_mapping
from ..collision.geometry import MOVES, resolve_contact_point
from ..collision.mappings import base_system, within_limits
from ..collision.uncertain import (
    Uncertain,
    columns_of,
    correlation_root,
    fixed_value,
    random_numbers,
)
from ..errors import UserError
from ..mechanics.closedform.solve import quantities, share_typed
from ..mechanics.outcome import forward_model, reconstruction_model
from ..messages.arguments import explains_arguments
from ..names import FINAL_VELOCITIES, PIVOT, RESULTS, VELOCITIES, check_names, split_names
from ..optimization.extremes import MAX_FULL_CORNERS, Extremes, Piece, merge
from .boundstable import Bound, Bounds, Drive, Spread
from .ranges import complete, read_correlations

Array = NDArray[np.float64]
PROBLEMS = ("forward", "reconstruction")
FORWARD_OUTPUTS = (*FINAL_VELOCITIES, "DVA", "DVB", "LOSS")
RECONSTRUCTION_OUTPUTS = (*VELOCITIES, "SA", "SB", "DVA", "DVB", "LOSS")
RECONSTRUCTED = (*RECONSTRUCTION_OUTPUTS, "KI", "KF", "PN", "PT", "PM", "MUC")
"""What a reconstruction can be asked for."""
WARNINGS = {bit.name or "": int(bit) for bit in status.Status}
"""Name of a warning -> its bit."""
QUANTILES = (0.025, 0.05, 0.5, 0.95, 0.975)
"""The median, and the middle 90 and 95 % of the draws."""
CHUNK = 1 << 15
"""Draws evaluated at a time: what the processor's cache holds. Part of what a seed means."""
RANKED = 20_000
"""Draws the rank correlations are taken over at most: their standard error is 0.007, of twice as
many 0.005, and they are printed to 0.01."""
SWEEP_POINTS = 41
"""The top of a parabola is missed by 6e-4 of its height at most, by a quarter of that with twice as
many."""
MOST_DRAWS = 100_000_000
"""Draws of all outputs together that are kept: 800 MB."""


@np.errstate(all="ignore")
@explains_arguments
def bounds(
    values: Mapping[str, Uncertain | float | str],
    outputs: Sequence[str] | str | None = None,
    *,
    problem: str = "forward",
    samples: int = 100_000,
    seed: int = 0,
    correlations: Mapping[tuple[str, str], float] | None = None,
    sigmas: float = 3.0,
    quantiles: Sequence[float] = QUANTILES,
    exclude: Sequence[str] = (),
    keep_draws: bool = False,
    progress: Callable[[int], object] | None = None,
) -> Bounds:
    """Return bounds, random draws and sensitivities of a scene known within limits.

    Parameters
    ----------
    values : mapping of str to float, str or Uncertain
        Every input of the problem by name; M is 6 where left out. A number is exact; a text such as
        "41 +- 2" or "0.7 .. 0.9", or an `Uncertain`, is known within limits. Units are the scene's.
    outputs : sequence of str, or str, optional
        Result names; for a reconstruction also UX ... WB, SA and SB (speeds). All by default.
    problem : str, default "forward"
        The problem: "forward", or a reconstruction.
    samples : int, default 100000
        Random draws.
    seed : int, default 0
        Random seed.
    correlations : mapping of tuple of str to float, optional
        Correlations of pairs of inputs.
    sigmas : float, default 3
        Cut-off for unbounded normal inputs in the search for bounds, in standard deviations.
    quantiles : sequence of float, optional
        Quantiles of the draws.
    exclude : sequence of str, optional
        Warnings (names of `WARNINGS`) whose scenes are left out of bounds and draws alike, sweeps
        excepted.
    keep_draws : bool, default False
        Keep the draws.
    progress : callable, optional
        Called with the number of draws done after each chunk.

    Returns
    -------
    Bounds
        Bounds, quantiles and sensitivities by output.

    Raises
    ------
    UserError
        For a missing, unknown or unusable value, an unknown output, correlations that contradict
        one another, and when the nominal inputs have no finite result.

    Examples
    --------
    >>> found = impact88.bounds({**impact88.sample(1), "GA": "-30 +- 5"}, ["DVA"], samples=100)
    >>> round(found.bounds["DVA"].lower, 2), round(found.bounds["DVA"].upper, 2)
    (13.42, 18.37)
    """
    check_mapping(values)
    given = dict(values)
    pairs = dict(correlations or {})
    if isinstance(text := given.pop("correlations", None), str):
        pairs = read_correlations(text, "correlations") | pairs
    box = _Box(given, outputs, problem, sigmas, exclude)
    _check(samples, sigmas, quantiles, len(box.outputs))
    correlated = correlation_root(pairs, box.inputs)
    nominal = box.nominal()
    sweeps = box.sweeps()
    searched = box.extremes(random_numbers(seed, 0))
    rng = random_numbers(seed, 1)
    draws, ranked, flags = _monte_carlo(box, rng, samples, correlated, progress)
    usable = np.all([np.isfinite(column) for column in draws.values()], axis=0)
    if not usable.any():
        raise UserError("none of the draws has a finite result; expected narrower ranges")
    some = usable[:RANKED]
    input_ranks = {name: _ranks(column[some]) for name, column in ranked.items()}
    output_ranks = {name: _ranks(column[:RANKED][some]) for name, column in draws.items()}
    return Bounds(
        problem=problem,
        inputs=box.inputs,
        limits=box.limits,
        bounds={
            name: Bound(
                nominal[name],
                *searched.bound[:, place].tolist(),
                *map(box.inputs_at, searched.at[:, place]),
                *searched.corner[:, place].tolist(),
                *map(box.warnings_at, searched.at[:, place]),
            )
            for place, name in enumerate(box.outputs)
        },
        spreads={name: Spread.of(draws[name][usable], quantiles) for name in box.outputs},
        drives={
            output: {
                name: _drive(sweeps[name][output], input_ranks[name], output_ranks[output])
                for name in box.inputs
            }
            for output in box.outputs
        },
        warnings={
            name: share
            for name, bit in WARNINGS.items()
            if (share := float(np.count_nonzero(flags & bit) / samples))
        },
        unusable=float(1 - np.count_nonzero(usable) / samples),
        samples=samples,
        seed=seed,
        sigmas=sigmas,
        evaluations=searched.evaluations,
        corners_in_full=len(box.inputs) <= MAX_FULL_CORNERS,
        correlations=pairs,
        draws=draws if keep_draws else {},
        units=base_system(values),
    )


def _ranks(values: Array) -> Array:
    """Ranks from 0, equal values sharing the mean of theirs, less the mean of all."""
    order = np.argsort(values)
    ordered = values[order]
    first = np.concatenate([[True], ordered[1:] != ordered[:-1]]).nonzero()[0]
    many = np.diff(first, append=len(values))
    ranks = np.empty(len(values))
    ranks[order] = np.repeat(first + (many - 1) / 2, many)
    return np.asarray(ranks - ranks.mean())


def _product(first: Array, second: Array) -> float:
    """The inner product. BLAS would wake its threads for so many numbers, which then spin."""
    return float(np.einsum("i,i", first, second))


def _drive(sweep: Array, first: Array, second: Array) -> Drive:
    size = np.sqrt(_product(first, first) * _product(second, second))
    correlation = _product(first, second) / float(size) if size > 0 else float("nan")
    finite = sweep[np.isfinite(sweep)] if np.isfinite(sweep).any() else np.array([np.nan])
    ends = (sweep[0], sweep[-1], finite.min(), finite.max())
    return Drive(correlation, *(float(end) for end in ends))


def _check(samples: int, sigmas: float, quantiles: Sequence[float], outputs: int) -> None:
    reason = ""
    if samples < 2:
        reason = f"{samples} samples are too few; expected 2 or more"
    elif not 0 < sigmas < np.inf:
        reason = f"{sigmas:g} standard deviations span nothing; expected above 0"
    elif wrong := [q for q in quantiles if not 0 <= q <= 1]:
        reason = f"{wrong[0]:g} is not a quantile; expected 0 ... 1"
    elif samples * outputs > MOST_DRAWS:
        reason = (
            f"{samples:,} samples of {outputs} outputs are more than {MOST_DRAWS:,} numbers; "
            "expected fewer samples, or fewer outputs"
        )
    if reason:
        raise UserError(reason)


class _Box:
    """The problem over the box of its inputs' limits, k inputs that vary and m outputs; ``share``:
    MU is a share of the critical friction."""

    def __init__(
        self,
        values: Mapping[str, Uncertain | float | str],
        outputs: Sequence[str] | str | None,
        problem: str,
        sigmas: float,
        exclude: Sequence[str],
    ) -> None:
        check_names([problem], PROBLEMS, "problem")
        given = within_limits(values)
        given.setdefault("M", fixed_value(6.0))
        _check_values(given, problem)
        self.inputs = {name: item for name, item in given.items() if item.varies}
        self.known = {name: item.nominal for name, item in given.items() if not item.varies}
        usual, allowed = _outputs(problem, given["M"].nominal == 4)
        self.outputs = tuple(dict.fromkeys(usual if outputs is None else split_names(outputs)))
        check_names(self.outputs, allowed, "result")
        if not self.outputs:
            raise UserError(f"no result is asked for; expected some of {' '.join(allowed)}")
        self.limits = {name: item.limits(sigmas) for name, item in self.inputs.items()}
        for name, (low, high) in self.limits.items():
            if not high - low < float("inf"):
                raise UserError("its limits are too far apart for double precision", name)
        self.forward = problem == "forward"
        self.model = forward_model if self.forward else reconstruction_model
        check_names(exclude, WARNINGS, "warning")
        self.excluded = sum({WARNINGS[name] for name in exclude})
        self.share = "MU" in given and given["MU"].share

    # points are n x k, of the unit cube

    def columns(self, point: Array) -> dict[str, Array]:
        return columns_of(self.limits, point)

    def inputs_at(self, point: Array) -> dict[str, float]:
        return {name: float(column[0]) for name, column in self.columns(point[None]).items()}

    def solved(self, columns: Mapping[str, Array], outputs: Sequence[str]) -> dict[str, Array]:
        """The outputs at n sets of inputs, n each (a lone number where nothing varies)."""
        return self.model(self.scenes(columns), outputs, None)[0]

    def scenes(self, columns: Mapping[str, Array]) -> Mapping[str, Array | float]:
        values = resolve_contact_point({**self.known, **columns})
        return {**values, "MU": share_typed(values, values["MU"])} if self.share else values

    def extremes(self, rng: np.random.Generator) -> Extremes:
        count = len(self.inputs)
        friction = self.known.get("MU")
        # a share of the critical friction has the sign that ends the sliding, whatever gt is
        if not self.forward or friction in (0.0, PIVOT) or self.share:
            return self.piece(None).extremes(count, rng)
        slip = Piece(lambda points: self.slip(points)[:, None], 1).extremes(count, rng)
        (lowest, highest), pieces = slip.bound[:, 0], []
        for sign in (1.0, -1.0):
            # kept where gt <= 0, changed where gt > 0
            if lowest <= 0 if sign > 0 else highest > 0:
                pieces.append(self.piece(sign).extremes(count, rng, slip.at[:, 0]))
        searched = merge(pieces)
        return searched._replace(evaluations=searched.evaluations + slip.evaluations)

    def piece(self, sign: float | None) -> Piece:
        """The outputs with MU's sign kept (+1) or changed (-1) throughout, and where line 400 does
        that. None: with the sign the scene gives it."""
        names = (*self.outputs, "STATUS") if self.excluded else self.outputs

        def values(points: Array) -> Array:
            columns = self.scenes(self.columns(points))
            solved, denominators = self.model(columns, names, sign)
            results = [solved[name] for name in self.outputs]
            if self.excluded:
                left_out = self.left_out(solved)
                results = [np.where(left_out, np.nan, column) for column in results]
            every = [np.broadcast_to(column, len(points)) for column in (*results, *denominators)]
            return np.stack(every, axis=1)

        def margin(points: Array) -> Array:
            slip = self.slip(points)  # at gt = 0 the sign is kept
            return slip - math.ulp(0.0) if sign == -1.0 else -slip

        return Piece(values, len(self.outputs), None if sign is None else margin)

    def slip(self, points: Array) -> Array:
        values = quantities(self.scenes(self.columns(points)), ["gt"])["gt"]
        return np.broadcast_to(values, len(points))

    def left_out(self, solved: Mapping[str, Array]) -> NDArray[np.bool_]:
        return np.asarray(np.asarray(solved["STATUS"], np.int64) & self.excluded, bool)

    def warnings_at(self, point: Array) -> tuple[str, ...]:
        bits = int(np.ravel(self.solved(self.columns(point[None]), ["STATUS"])["STATUS"])[0])
        return tuple(name for name, bit in WARNINGS.items() if bits & bit)

    def nominal(self) -> dict[str, float]:
        columns = {name: np.array([item.nominal]) for name, item in self.inputs.items()}
        solved = self.solved(columns, self.outputs)
        result = {name: float(np.ravel(solved[name])[0]) for name in self.outputs}
        for name, value in result.items():
            if not np.isfinite(value):
                raise UserError(f"{name} has no finite value at the nominal inputs")
        return result

    def sweeps(self) -> dict[str, dict[str, Array]]:
        """input -> output -> its values as that input alone runs from its lower limit to its
        upper, `SWEEP_POINTS` of them."""
        rest = {name: np.full(SWEEP_POINTS, item.nominal) for name, item in self.inputs.items()}
        result = {}
        for name, ends in self.limits.items():
            solved = self.solved({**rest, name: np.linspace(*ends, SWEEP_POINTS)}, self.outputs)
            result[name] = {n: np.broadcast_to(solved[n], SWEEP_POINTS) for n in self.outputs}
        return result


def _check_values(given: Mapping[str, Uncertain], problem: str) -> None:
    names = complete(given, problem)
    check_names(given, (*names, *MOVES), f"value of the {problem} problem")
    if given["M"].varies or given["M"].nominal not in (4, 6):
        raise UserError("expected 6, or 4 for point masses", "M")
    name = "MU" if problem == "forward" else "MUP"
    friction = given[name]
    if friction.varies and friction.low <= -10 <= friction.high and friction.kind != "normal":
        raise UserError("a range must keep off -10, the pivot's sign", name)
    if problem != "forward":
        _check_invertible(given)


def _check_invertible(given: Mapping[str, Uncertain]) -> None:
    """Raises UserError where no reconstruction exists: pivot, e = 0, e_m = 0."""
    if given["MUP"].nominal == PIVOT:
        raise UserError(
            "the pivot has five equations for the six initial velocities; expected the signed "
            "P_t/P_n",
            "MUP",
        )
    for name in ("E", "EM"):
        if name == "EM" and given["M"].nominal == 4:
            continue
        if given[name].low <= 0 <= given[name].high and given[name].kind != "normal":
            raise UserError(
                f"there is no reconstruction at {name} = 0, and near it the bounds are endless; "
                "expected a range that keeps off 0",
                name,
            )


def _outputs(problem: str, point_masses: bool) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The outputs taken where none are asked for, and those that can be."""
    usual: tuple[str, ...] = FORWARD_OUTPUTS if problem == "forward" else RECONSTRUCTION_OUTPUTS
    if point_masses:
        usual = tuple(name for name in usual if name not in ("WA", "WB", "WAF", "WBF"))
    results = tuple(name for name in RESULTS if name != "STATUS")
    return usual, results if problem == "forward" else RECONSTRUCTED


def _monte_carlo(
    box: _Box,
    rng: np.random.Generator,
    samples: int,
    correlated: tuple[list[str], Array],
    progress: Callable[[int], object] | None,
) -> tuple[dict[str, Array], dict[str, Array], NDArray[np.int64]]:
    """The outputs of each draw, the inputs of the first `RANKED`, and the STATUS of each draw."""
    names, root = correlated
    draws = {name: np.empty(samples) for name in box.outputs}
    ranked = {name: np.empty(min(samples, RANKED)) for name in box.inputs}
    flags = np.zeros(samples, np.int64)
    for first in range(0, samples, CHUNK):
        chunk = slice(first, min(first + CHUNK, samples))
        count = chunk.stop - first
        columns = {
            name: item.draws(rng, count) for name, item in box.inputs.items() if name not in names
        }
        if names:
            variates = np.einsum(  # BLAS would wake its threads
                "ij,jk->ik", rng.standard_normal((count, len(names))), root
            )
            for place, name in enumerate(names):
                columns[name] = box.inputs[name].from_normal(variates[:, place])
        solved = box.solved(columns, (*box.outputs, "STATUS"))
        left_out = box.left_out(solved) if box.excluded else False
        for name in box.outputs:
            draws[name][chunk] = np.where(left_out, np.nan, solved[name])
        flags[chunk] = solved["STATUS"]
        if first < RANKED:
            for name, column in ranked.items():
                part = column[chunk]
                part[:] = columns[name][: len(part)]
        if progress is not None:
            progress(count)
    return draws, ranked, flags
