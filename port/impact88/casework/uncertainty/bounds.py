"""Upper and lower bounds from ranges of the data (chapter, Section V: "reasonable ranges of these
variables should be used ... to provide upper and lower bounds on vehicle speed").

The values of one scene are known within limits (`collision.uncertain`). The box that the limits
span is searched (`optimization.extremes`) for each sign that line 400 can give MU, regardless of
correlations. Every bound is attained at the inputs kept with it; that no value lies farther is
likely, not proven. Where the equations become singular inside, a bound is infinite. In addition
there are seeded Monte Carlo draws (`Spread`) and the effect of each input alone (`Drive`).

The forward problem goes from initial to final velocities (Equations 13-18); the reconstruction from
the six final velocities back, with MUP, the signed P_t/P_n, in place of MU: line 400's sign rule
needs initial velocities."""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ... import status
from ...collision.case import check_mapping
from ...collision.geometry import MOVES, coordinate_names, resolve_contact_point
from ...collision.mappings import base_system, within_limits
from ...collision.needs import needs_sentences
from ...collision.uncertain import (
    Uncertain,
    columns_of,
    correlation_root,
    fixed_value,
    random_numbers,
)
from ...errors import UserError
from ...mechanics.closedform.general import quantities, share_typed
from ...mechanics.closedform.omitted import not_given
from ...mechanics.closedform.solve import solve
from ...mechanics.outcome import forward_model, reconstruction_model
from ...mechanics.posed import line_of_motion
from ...messages.arguments import explains_arguments
from ...names import FINAL_VELOCITIES, PIVOT, RESULTS, SCENE, VELOCITIES, check_names, split_names
from ..optimization.extremes import MAX_FULL_CORNERS, Extremes, Piece, merge
from .boundstable import Bound, Bounds, Drive, Spread
from .ranges import complete, read_correlations

Array = NDArray[np.float64]
PROBLEMS = ("forward", "reconstruction")
FORWARD_OUTPUTS = (*FINAL_VELOCITIES, "DVA", "DVB", "LOSS")
RECONSTRUCTION_OUTPUTS = (*VELOCITIES, "SA", "SB", "DVA", "DVB", "LOSS")
RECONSTRUCTED = (*RECONSTRUCTION_OUTPUTS, "KI", "KF", "PN", "PT", "PM", "MUC")
WARNINGS = {bit.name or "": int(bit) for bit in status.Status}  # name of a warning -> its bit
QUANTILES = (0.025, 0.05, 0.5, 0.95, 0.975)  # the median, the middle 90 and 95 % of the draws
CHUNK = 1 << 15  # draws at a time, as fit the processor's cache; changes what a seed gives
# Draws used for rank correlations, at most. Their standard error is 0.007 (with twice as many
# 0.005), and they are printed to 0.01.
RANKED_DRAWS = 20_000
SWEEP_POINTS = 41  # the top of a parabola is missed by 6e-4 of its height at most
MAX_DRAWS = 100_000_000  # of all outputs together, 800 MB


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
        ``"forward"`` or ``"reconstruction"``.
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
        Warnings (names of `WARNINGS`) whose scenes are left out of the bounds and draws, but not of
        the sweeps.
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
    # eleven arguments, and not split: the options of `impact88 bounds`, each used once
    check_mapping(values)
    inputs = dict(values)
    pairs = dict(correlations or {})
    if isinstance(text := inputs.pop("correlations", None), str):
        pairs = read_correlations(text, "correlations") | pairs
    box = _Box(inputs, outputs, problem, sigmas, exclude)
    _check(samples, sigmas, quantiles, len(box.outputs))
    root = correlation_root(pairs, box.inputs)
    nominal = box.nominal()
    sweeps = box.sweeps()
    extremes = box.extremes(random_numbers(seed, 0))
    rng = random_numbers(seed, 1)
    draws, ranked_inputs, flags = _monte_carlo(box, rng, samples, root, progress)
    usable = np.all([np.isfinite(column) for column in draws.values()], axis=0)
    if not usable.any():
        raise UserError("none of the draws has a finite result; expected narrower ranges")
    usable_ranked = usable[:RANKED_DRAWS]
    input_ranks = {name: _ranks(column[usable_ranked]) for name, column in ranked_inputs.items()}
    output_ranks = {
        name: _ranks(column[:RANKED_DRAWS][usable_ranked]) for name, column in draws.items()
    }
    return Bounds(
        problem=problem,
        inputs=box.inputs,
        limits=box.limits,
        bounds={
            name: _bound(box, extremes, place, nominal[name])
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
            name: fraction
            for name, bit in WARNINGS.items()
            if (fraction := float(np.count_nonzero(flags & bit) / samples))
        },
        unusable=float(1 - np.count_nonzero(usable) / samples),
        samples=samples,
        seed=seed,
        sigmas=sigmas,
        evaluations=extremes.evaluations,
        corners_in_full=len(box.inputs) <= MAX_FULL_CORNERS,
        correlations=pairs,
        draws=draws if keep_draws else {},
        units=base_system(values),
    )


def _bound(box: "_Box", extremes: Extremes, place: int, nominal: float) -> Bound:
    """Return the bounds of one output, the one in column ``place``."""
    lower, upper = extremes.bound[:, place].tolist()
    corner_lower, corner_upper = extremes.corner[:, place].tolist()
    point_lower, point_upper = extremes.at[:, place]
    return Bound(
        nominal=nominal,
        lower=lower,
        upper=upper,
        at_lower=box.inputs_at(point_lower),
        at_upper=box.inputs_at(point_upper),
        corner_lower=corner_lower,
        corner_upper=corner_upper,
        lower_warnings=box.warnings_at(point_lower),
        upper_warnings=box.warnings_at(point_upper),
    )


def _ranks(values: Array) -> Array:
    """Return ranks less their mean; equal values share the mean of theirs."""
    order = np.argsort(values)
    sorted_values = values[order]
    first = np.concatenate([[True], sorted_values[1:] != sorted_values[:-1]]).nonzero()[0]
    counts = np.diff(first, append=len(values))
    ranks = np.empty(len(values))
    ranks[order] = np.repeat(first + (counts - 1) / 2, counts)
    return np.asarray(ranks - ranks.mean())


def _product(first: Array, second: Array) -> float:
    """Return the inner product. BLAS would wake its threads for so many numbers, which then
    spin."""
    return float(np.einsum("i,i", first, second))


def _drive(sweep: Array, first: Array, second: Array) -> Drive:
    """Return the effect of one input on one output, from its sweep and the ranks of both."""
    size = np.sqrt(_product(first, first) * _product(second, second))
    correlation = _product(first, second) / float(size) if size > 0 else float("nan")
    finite = sweep[np.isfinite(sweep)] if np.isfinite(sweep).any() else np.array([np.nan])
    ends = (sweep[0], sweep[-1], finite.min(), finite.max())
    return Drive(correlation, *(float(end) for end in ends))


def _check(samples: int, sigmas: float, quantiles: Sequence[float], outputs: int) -> None:
    """Raise UserError for numbers that cannot be used."""
    reason = ""
    if samples < 2:
        reason = f"{samples} samples are too few; expected 2 or more"
    elif not 0 < sigmas < np.inf:
        reason = f"{sigmas:g} standard deviations span nothing; expected above 0"
    elif bad_quantiles := [q for q in quantiles if not 0 <= q <= 1]:
        reason = f"{bad_quantiles[0]:g} is not a quantile; expected 0 ... 1"
    elif samples * outputs > MAX_DRAWS:
        reason = (
            f"{samples:,} samples of {outputs} outputs are more than {MAX_DRAWS:,} numbers; "
            "expected fewer samples, or fewer outputs"
        )
    if reason:
        raise UserError(reason)


class _Box:
    """A problem over the box of its inputs' limits: k inputs that vary and m outputs. Points are n
    x k, of the unit cube. ``share``: True if MU is a fraction of the critical friction."""

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
        self.judged = 0xFFFF
        if problem == "forward" and (lacking := self._lacking()):
            usual = self._do_without(given, lacking, usual, outputs)
        self.outputs = tuple(dict.fromkeys(usual if outputs is None else split_names(outputs)))
        check_names(self.outputs, allowed, "result")
        if not self.outputs:
            raise UserError(f"no result is asked for; expected some of {' '.join(allowed)}")
        self.limits = {name: item.limits(sigmas) for name, item in self.inputs.items()}
        for name, (low, high) in self.limits.items():
            if not high - low < float("inf"):
                raise UserError("the range is too wide for double precision", name)
        self.forward = problem == "forward"
        self.model = forward_model if self.forward else reconstruction_model
        check_names(exclude, WARNINGS, "warning")
        self.excluded = sum({WARNINGS[name] for name in exclude})
        self.share = "MU" in given and given["MU"].share

    def _lacking(self) -> list[str]:
        """Return the inputs that are not given, in whichever coordinates."""
        names = {**self.known, **dict.fromkeys(self.inputs)}
        scene = {name: x for name, x in names.items() if name in SCENE}
        return [n for n in not_given(scene) if coordinate_names((n,), names) == (n,)]

    def _do_without(
        self,
        given: Mapping[str, Uncertain],
        lacking: Sequence[str],
        usual: Sequence[str],
        outputs: Sequence[str] | str | None,
    ) -> tuple[str, ...]:
        """Set what stands in for inputs that are not given, and return the usual outputs that do
        not use them. Raises UserError for an output asked for that does."""
        wanted = usual if outputs is None else split_names(outputs)
        line, _ = line_of_motion(given)
        if line is not None:
            self.known |= {"GA": line, "MU": 0.0} if "GA" in lacking else {"MU": 0.0}
            lacking = [name for name in lacking if name not in self.known]
        nominal = {name: item.nominal for name, item in given.items()} | self.known
        absent = getattr(solve(nominal, tuple(RESULTS)), "absent", {}) if lacking else {}
        if outputs is not None and (needs := {n: absent[n] for n in wanted if n in absent}):
            raise UserError("; ".join(needs_sentences(needs)))
        self.known |= dict.fromkeys(lacking, 0.0)
        if lacking:  # nothing is judged by what stands in
            self.judged = int(status.Status.NOT_FINITE)
            self.judged |= 0 if "KF" in absent else int(status.Status.ENERGY_GAINED)
        return tuple(name for name in usual if name not in absent)

    def columns(self, point: Array) -> dict[str, Array]:
        """Return the inputs that vary at points of the cube, n values each."""
        return columns_of(self.limits, point)

    def inputs_at(self, point: Array) -> dict[str, float]:
        """Return the inputs that vary at one point."""
        return {name: float(column[0]) for name, column in self.columns(point[None]).items()}

    def solve(self, columns: Mapping[str, Array], outputs: Sequence[str]) -> dict[str, Array]:
        """Return the outputs for n sets of inputs, n each (one number where nothing varies)."""
        scenes = self.scenes(columns)
        if self.forward:  # without the model's divisors the compiled library does it
            return solve(scenes, outputs)
        return self.model(scenes, outputs, None)[0]

    def scenes(self, columns: Mapping[str, Array]) -> Mapping[str, Array | float]:
        """Return all values of the scenes with these inputs, MU as a number."""
        values = resolve_contact_point({**self.known, **columns})
        return {**values, "MU": share_typed(values, values["MU"])} if self.share else values

    def extremes(self, rng: np.random.Generator) -> Extremes:
        """Search for the extremes of the outputs, on both sides of the surface where line 400
        changes MU's sign (gt = 0)."""
        count = len(self.inputs)
        friction = self.known.get("MU")
        # a share of the critical friction has the sign that ends the sliding, whatever gt is
        if not self.forward or friction in (0.0, PIVOT) or self.share:
            return self.piece(None).extremes(count, rng)
        slip = Piece(lambda points: self.slip(points)[:, None], 1).extremes(count, rng)
        (lowest, highest), pieces = slip.bound[:, 0], []
        # line 400 keeps MU's sign where gt <= 0 and changes it where gt > 0
        for sign, is_reached in ((1.0, lowest <= 0), (-1.0, highest > 0)):
            if is_reached:
                pieces.append(self.piece(sign).extremes(count, rng, slip.at[:, 0]))
        extremes = merge(pieces)
        return extremes._replace(evaluations=extremes.evaluations + slip.evaluations)

    def piece(self, sign: float | None) -> Piece:
        """Return the outputs as a `Piece` with MU's sign kept (+1) or changed (-1) throughout,
        limited to where line 400 does that. None: everywhere, with the sign that each scene
        gives.

        The outputs are followed by the model's denominators, where the outputs may have poles."""
        names = (*self.outputs, "STATUS") if self.excluded else self.outputs

        def values(points: Array) -> Array:
            columns = self.scenes(self.columns(points))
            results, denominators = self.model(columns, names, sign)
            output_columns = [results[name] for name in self.outputs]
            if self.excluded:
                is_excluded = self.is_excluded(results)
                output_columns = [
                    np.where(is_excluded, np.nan, column) for column in output_columns
                ]
            all_columns = [
                np.broadcast_to(column, len(points)) for column in (*output_columns, *denominators)
            ]
            return np.stack(all_columns, axis=1)

        def margin(points: Array) -> Array:
            # A point belongs to the piece where the margin is >= 0. At gt = 0 the sign is kept:
            # less the smallest subnormal number, only gt > 0 counts as changed.
            slip = self.slip(points)
            return slip - math.ulp(0.0) if sign == -1.0 else -slip

        return Piece(values, len(self.outputs), None if sign is None else margin)

    def slip(self, points: Array) -> Array:
        """Return the sliding gt before the impact, whose sign line 400 tests."""
        values = quantities(self.scenes(self.columns(points)), ["gt"])["gt"]
        return np.broadcast_to(values, len(points))

    def is_excluded(self, solved: Mapping[str, Array]) -> NDArray[np.bool_]:
        """Return True for each scene that has an excluded warning."""
        return np.asarray(
            np.asarray(solved["STATUS"], np.int64) & self.excluded & self.judged, bool
        )

    def warnings_at(self, point: Array) -> tuple[str, ...]:
        """Return the names of the warnings of one point."""
        bits = int(np.ravel(self.solve(self.columns(point[None]), ["STATUS"])["STATUS"])[0])
        bits &= self.judged
        return tuple(name for name, bit in WARNINGS.items() if bits & bit)

    def nominal(self) -> dict[str, float]:
        """Return the outputs at the nominal inputs."""
        columns = {name: np.array([item.nominal]) for name, item in self.inputs.items()}
        results = self.solve(columns, self.outputs)
        result = {name: float(np.ravel(results[name])[0]) for name in self.outputs}
        for name, value in result.items():
            if not np.isfinite(value):
                raise UserError(f"{name} has no finite value at the nominal inputs")
        return result

    def sweeps(self) -> dict[str, dict[str, Array]]:
        """Return by input, then output: `SWEEP_POINTS` values of the output as that input alone
        runs from its lower limit to its upper."""
        nominal_columns = {
            name: np.full(SWEEP_POINTS, item.nominal) for name, item in self.inputs.items()
        }
        result = {}
        for name, ends in self.limits.items():
            results = self.solve(
                {**nominal_columns, name: np.linspace(*ends, SWEEP_POINTS)}, self.outputs
            )
            result[name] = {n: np.broadcast_to(results[n], SWEEP_POINTS) for n in self.outputs}
        return result


def _check_values(values: Mapping[str, Uncertain], problem: str) -> None:
    """Raise UserError for missing or unknown values and ranges that a problem cannot have."""
    names = complete(values, problem, point=values["M"].nominal == 4)
    check_names(values, (*names, *MOVES), f"value of the {problem} problem")
    if values["M"].varies or values["M"].nominal not in (4, 6):
        raise UserError("expected 6, or 4 for point masses", "M")
    name = "MU" if problem == "forward" else "MUP"
    friction = values.get(name, fixed_value(0.0))
    if friction.varies and friction.low <= -10 <= friction.high and friction.kind != "normal":
        raise UserError("a range must not include -10, the code for the pivot", name)
    if problem != "forward":
        _check_invertible(values)


def _check_invertible(values: Mapping[str, Uncertain]) -> None:
    """Raise UserError where no reconstruction exists: pivot, e = 0, e_m = 0."""
    if values["MUP"].nominal == PIVOT:
        raise UserError(
            "the pivot has five equations for the six initial velocities; expected the signed "
            "P_t/P_n",
            "MUP",
        )
    for name in ("E", "EM"):
        if name == "EM" and values["M"].nominal == 4:
            continue
        if values[name].low <= 0 <= values[name].high and values[name].kind != "normal":
            raise UserError(
                f"there is no reconstruction at {name} = 0, and near it the bounds become "
                "infinite; expected a range that does not include 0",
                name,
            )


def _outputs(problem: str, point_masses: bool) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the default outputs of a problem, and all that can be asked for."""
    defaults: tuple[str, ...] = FORWARD_OUTPUTS if problem == "forward" else RECONSTRUCTION_OUTPUTS
    if point_masses:
        defaults = tuple(name for name in defaults if name not in ("WA", "WB", "WAF", "WBF"))
    results = tuple(name for name in RESULTS if name != "STATUS")
    return defaults, results if problem == "forward" else RECONSTRUCTED


def _monte_carlo(
    box: _Box,
    rng: np.random.Generator,
    samples: int,
    correlation: tuple[list[str], Array],
    progress: Callable[[int], object] | None,
) -> tuple[dict[str, Array], dict[str, Array], NDArray[np.int64]]:
    """Return the outputs of each draw, the inputs of the first `RANKED_DRAWS`, and the STATUS of
    each draw. ``correlation``: names of correlated inputs and the root of their correlation
    matrix."""
    names, root = correlation
    draws = {name: np.empty(samples) for name in box.outputs}
    ranked_inputs = {name: np.empty(min(samples, RANKED_DRAWS)) for name in box.inputs}
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
        results = box.solve(columns, (*box.outputs, "STATUS"))
        is_excluded = box.is_excluded(results) if box.excluded else False
        for name in box.outputs:
            draws[name][chunk] = np.where(is_excluded, np.nan, results[name])
        flags[chunk] = results["STATUS"].astype(np.int64) & box.judged
        if first < RANKED_DRAWS:
            for name, column in ranked_inputs.items():
                part = column[chunk]
                part[:] = columns[name][: len(part)]
        if progress is not None:
            progress(count)
    return draws, ranked_inputs, flags
