"""The search for every impact that agrees with what is known, or comes nearest to it.

Impacts of exact values are the real solutions of quadratic equations, all of which homotopy
continuation finds (`quadrics`); of other equations, and of values with tolerances, those that
iterations from many starts lead to (`leastsquares`)."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY
from ...collision.uncertain import Uncertain
from .laws import describe_laws, missed_laws
from .leastsquares import DISTINCT_TOL, PENALTIES, descend, polish, pseudo_inverse
from .nearest import CANDIDATE_TOL, DUPLICATE_TOL, with_nearest
from .quadrics import MAX_EQUATIONS, Paths, follow_paths, quadratic_equations
from .solution import RESIDUAL_TOL, Reconstruction, describe, invariants
from .system import PARAMETERS, System
from .unknowns import UnsolvableError

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]
Progress = Callable[[int], object]

EXACT_STARTS = 240  # in a batch of the search for exact impacts
MAX_BATCHES = 8  # of that search, where impacts go on being found only once
FIT_STARTS = 60  # through all penalties, and as many through all but the first
FEW_STARTS = 12  # where all lead to an impact, or none does
MAX_OMITTED_SETS = 8  # sets of redundant measurements left out to find starts of a fit
MAX_OPEN_ENDS = 8  # end points polished where something is undetermined
MAX_FAILURES = 12  # ends near which Newton's method finds no minimum
MAX_SQUARES_RATIO = 4.0  # impacts with up to this many times the least sum of squares are reported


class Search:
    """Search for the impacts nearest to what is known, friction signed, each once.

    ``system``: the equations; ``exact``: the impacts that agree exactly with all nominal values
    (scaled variables, a column each); ``assumed``: exact values contradict one another, and the
    known velocities were given tolerances; ``starts``: number of starts; ``paths``: where
    all solutions of exact values were found."""

    def __init__(self, known: Mapping[str, Uncertain], progress: Progress) -> None:
        self.rng = np.random.default_rng(1988)
        self.starts = 0
        self.paths: Paths | None = None
        exact_system = System(known, adjusted=False, progress=progress)
        inputs_vary = any(known[name].varies for name in PARAMETERS if name in known)
        self.linear = exact_system.linear and not inputs_vary  # one valley, without bends
        exact, self.counts = self._exact_impacts(exact_system)
        self.assumed = not exact.shape[1] and not any(item.varies for item in known.values())
        self.system = (
            exact_system.with_equal_tolerances()
            if self.assumed
            else System(known, adjusted=True, progress=progress)
        )
        self.exact = self.system.starts_at(exact_system, exact, self.rng)
        self.minima = _Minima(self.system, self.assumed)

    @property
    def single(self) -> bool:
        """True where there is one impact, or a continuum of them: no search is needed or
        possible."""
        return self.linear or not (self.starts or self.paths)

    # -- impacts of exact values

    def _exact_impacts(self, system: System) -> tuple[Floats, Counts]:
        """Return the impacts with every known value at its nominal value, a column each, and the
        number of starts that led to each."""
        impacts, counts = np.empty((len(system.variables), 0)), np.empty(0, int)
        equations = None if self.linear else quadratic_equations(system)
        if equations is not None and equations.size <= MAX_EQUATIONS:
            paths = follow_paths(equations, self.rng)
            impacts, counts = _distinct_solutions(system, paths.real, impacts, counts)
            if not paths.lost:
                self.paths = paths
                return impacts, counts
        if self.linear:
            start = system.random_starts(self.rng, 1)
            return _distinct_solutions(system, start, impacts, counts)
        if len(system.conditions) > len(system.variables):
            few = system.random_starts(self.rng, FEW_STARTS)
            impacts, counts = _distinct_solutions(system, few, impacts, counts)
            if not impacts.shape[1]:
                return impacts, counts
        return self._random_search(system, impacts, counts)

    def _random_search(
        self, system: System, impacts: Floats, counts: Counts
    ) -> tuple[Floats, Counts]:
        """Return exact impacts that random starts lead to. The search ends when each was found more
        than once: by Good and Turing's rule another is then improbable."""
        for _ in range(MAX_BATCHES):
            starts = system.random_starts(self.rng, EXACT_STARTS)
            impacts, counts = _distinct_solutions(system, starts, impacts, counts)
            self.starts += EXACT_STARTS
            is_open = impacts.shape[1] and not _is_isolated(system, impacts[:, :1])
            if is_open or (counts > 1).all():
                break
        return impacts, counts

    # -- fits

    def run(self) -> list[Reconstruction]:
        """Return the solutions. Raise UnsolvableError where there are none."""
        minima = self.minima
        if self.exact.shape[1]:
            minima.add(self.exact, self.counts)
        else:
            self.paths = None  # a fit is no solution of the equations
            minima.add(self._fits())
        if not minima.is_finite:
            raise np.linalg.LinAlgError("not finite")
        if not minima.has_candidates:
            known = self.system.known
            exact = {name: item.nominal for name, item in known.items() if not item.varies}
            laws = describe_laws(missed_laws(exact))
            raise UnsolvableError(
                f"no impact agrees with all that is known exactly{': ' * bool(laws)}{laws}; "
                "expected tolerances ('+- D') for what is measured"
            )
        if not (minima.closed or minima.open):
            raise UnsolvableError(
                "the search for the impact nearest to the known values did not converge; expected "
                "wider tolerances, or fewer values"
            )
        return with_nearest(minima.solutions(), self.rng, FIT_STARTS)

    def _fits(self) -> Floats:
        """Return the ends of iterations from random starts, half of them without the first penalty,
        which makes one valley of several, and from impacts of fewer measurements."""
        system = self.system
        if self.linear:
            return descend(system, system.random_starts(self.rng, 1))
        starts = system.random_starts(self.rng, 2 * FIT_STARTS)
        first, others = np.split(starts, 2, axis=1)
        first = descend(system, first, PENALTIES[:1])
        roots = starts[:, :0] if self.assumed else self._impacts_of_fewer_measurements()
        self.starts += starts.shape[1] + roots.shape[1]
        return descend(system, np.concatenate([first, others, roots], axis=1), PENALTIES[1:])

    def _impacts_of_fewer_measurements(self) -> Floats:
        """Return the impacts that agree exactly with as many measured values as determine an
        impact, for several choices of the redundant ones."""
        known = self.system.known
        measured = [n for n, item in known.items() if item.varies and n not in GEOMETRY]
        exact_system = System(known, adjusted=False)
        surplus = len(exact_system.conditions) - len(exact_system.variables)
        impacts = np.empty((len(self.system.variables), 0))
        if not 0 <= surplus <= len(measured):
            return impacts
        omissions = [*combinations(measured, surplus)]
        for omitted in omissions[:: -(-len(omissions) // MAX_OMITTED_SETS)]:
            system = System({n: known[n] for n in known if n not in omitted}, adjusted=False)
            equations = quadratic_equations(system)
            if equations is not None and equations.size <= MAX_EQUATIONS:
                paths = follow_paths(equations, self.rng)
                roots = np.concatenate([paths.real, paths.near], axis=1)
                impacts = np.concatenate(
                    [impacts, self.system.starts_at(system, roots, self.rng)], axis=1
                )
        return impacts


class _Minima:
    """The minima of one search, polished, each once.

    ``closed``: those that determine everything; ``open``: the best one that leaves something
    undetermined, as good as any other point of its continuum; ``has_candidates``: True if
    conditions were nearly met anywhere."""

    def __init__(self, system: System, assumed: bool) -> None:
        self.system, self.assumed = system, assumed
        self.closed: list[Reconstruction] = []
        self.open: list[Reconstruction] = []
        self.open_count = self.failures = 0
        self.has_candidates = self.is_finite = False
        self._ends: list[tuple[Floats, int | None]] = []

    def add(self, ends: Floats, counts: Counts | None = None) -> None:
        """Add the minima near the ends of iterations, a column each, the best first. ``counts``:
        how many starts led to each end, by default 1."""
        count = self.system.condition_count
        residual = self.system.residuals(self.system.state(ends))
        violation = np.abs(residual[:count]).max(axis=0, initial=0.0)
        squares = np.square(residual[count:]).sum(axis=0)
        self.is_finite |= bool(np.isfinite(violation).any())
        candidates = violation <= CANDIDATE_TOL
        self.has_candidates |= bool(candidates.any())
        for i in np.argsort(squares, kind="stable"):
            if self.failures >= MAX_FAILURES or (
                self.open_count >= MAX_OPEN_ENDS and not self.closed
            ):
                break
            if candidates[i]:
                self._add_near(ends[:, i : i + 1], 1 if counts is None else int(counts[i]))

    def _add_near(self, end: Floats, starts: int) -> None:
        """Polish the end of iterations, and keep the minimum if it is new and likely."""
        for other, index in self._ends:
            if np.abs(end - other).max(initial=0.0) < DUPLICATE_TOL:
                self._count(index, starts)
                return
        try:
            x = polish(self.system, end)
            index = None if x is None else self._add(x)
            self._count(index, starts)
        except np.linalg.LinAlgError:
            x = index = None  # something is not finite there
        self.failures += x is None
        self._ends.append((end, index))

    def _count(self, index: int | None, starts: int) -> None:
        if index is not None:
            minimum = self.closed[index]
            self.closed[index] = replace(minimum, reached=minimum.reached + starts)

    def _add(self, x: Floats) -> int | None:
        """Keep a minimum. Return its index among those that determine everything."""
        system, count = self.system, self.system.condition_count
        residual = system.residuals(system.state(x))[:, 0]
        if not np.abs(residual[:count]).max(initial=0.0) <= RESIDUAL_TOL:
            return None
        for index, minimum in enumerate(self.closed):
            if np.abs(x - minimum.x).max(initial=0.0) < DISTINCT_TOL:
                return index
        if not _is_isolated(system, x):
            squares = float(np.square(residual[count:]).sum())
            least_squares = min((minimum.squares for minimum in self.closed), default=math.inf)
            # skip an unlikely fold, and the continuum that was found before
            if squares > MAX_SQUARES_RATIO * least_squares + 1e-9:
                return None
            if self.open_count >= MAX_OPEN_ENDS and squares > self.open[0].squares - 1e-9:
                return None
        solution = describe(system, x, self.assumed)
        if not solution.undetermined:
            self.closed.append(solution)
            return len(self.closed) - 1
        self.open_count += 1
        candidates = (*self.open, solution)
        self.open = [min(candidates, key=_order_of_open)]
        return None

    def solutions(self) -> list[Reconstruction]:
        """Return the minima. An open one counts where all others contradict the measurements."""
        least_squares = min((solution.squares for solution in self.closed), default=math.inf)
        likely = [s for s in self.open if MAX_SQUARES_RATIO * s.squares + 1e-9 < least_squares]
        return likely + self.closed


def _order_of_open(solution: Reconstruction) -> tuple[float, ...]:
    """Return what minima that leave something undetermined are put in order by: equally good ones
    of two continua by what is the same seen from elsewhere."""
    squares = float(f"{max(solution.squares, 1e-9):.6e}")
    return squares, solution.impossible != 0, *invariants(solution.values)


def _distinct_solutions(
    system: System, starts: Floats, impacts: Floats, counts: Counts
) -> tuple[Floats, Counts]:
    """Return the columns of ``impacts`` and the exact impacts, different from all before, that
    iterations lead to, and how often each was found."""
    ends, counts = descend(system, starts), counts.copy()
    residual = np.abs(system.residuals(system.state(ends))).max(axis=0, initial=0.0)
    for end in ends[:, residual <= RESIDUAL_TOL].T:
        same = np.abs(impacts - end[:, None]).max(axis=0, initial=0.0) < DISTINCT_TOL
        if same.any():
            counts[same.argmax()] += 1
        else:
            impacts, counts = np.column_stack([impacts, end]), np.append(counts, 1)
    return impacts, counts


def _is_isolated(system: System, x: Floats) -> bool:
    """Return True if an impact is isolated from others: its Jacobian has full column rank."""
    return not pseudo_inverse(system.jacobian(x))[1].shape[1]
