"""The filter of STATUS decides only what the results decide alike, and decides nearly every scene.

Its programs are run by numpy: in scenes of all populations, and in scenes made to lie on each
threshold or a few units of rounding beside it.
"""

import numpy as np
import pytest

from impact88.mechanics.accuracy.populations import POPULATIONS, scenes
from impact88.mechanics.closedform.impactprograms import BODIES, FILTERS, program_for
from impact88.mechanics.closedform.plan import Plan
from impact88.mechanics.closedform.solve import quantities, solve
from impact88.mechanics.closedform.statusbits import FRICTION_TOLERANCE
from impact88.mechanics.closedform.statusfilter import LARGEST_E, MODERATE, UNDECIDED
from impact88.names import PIVOT, SCENE, VELOCITIES
from impact88.status import Status

COUNT = 4000
FAULTS = Status.FRICTION_ABOVE_CRITICAL | Status.FRICTION_WRONG_DIRECTION


def status_of(columns, body, source):
    """STATUS of scenes by the program of a body."""
    program = program_for(BODIES[body], ("STATUS",), status_from=source)
    found = np.empty(len(columns["MA"]), np.uint16)
    values = [np.ascontiguousarray(columns[name]) for name in program.columns]
    with np.errstate(all="ignore"):
        Plan(program).run(values, {"STATUS": found}, {}, 4096)
    return found


def population(name, count=COUNT, seed=17):
    rng = np.random.default_rng(seed)
    columns = {k: np.array(v, float) for k, v in scenes(name, count, seed).items() if k in SCENE}
    for body in "AB":
        spin = columns[f"W{body}"] + rng.uniform(-2, 2, count)
        columns[f"W{body}"] = np.where(np.isinf(columns[f"I{body}"]), 0.0, spin)
    # what the limits of columns leave to the full kernels
    within = np.abs(columns["E"]) <= LARGEST_E
    for column in columns.values():
        within &= (np.abs(column) <= MODERATE) | np.isinf(column)
    return {k: v[within] for k, v in columns.items()}


def of_body(columns, body):
    """The scenes as those of a body: with friction, pivots, or every third a pivot."""
    slides = np.where(columns["MU"] == PIVOT, 0.4, columns["MU"])
    some = {"friction": 0, "pivot": 1, "mixed": 3}[body]
    pivots = np.arange(len(slides)) % some == 0 if some else np.zeros(len(slides), bool)
    return {**columns, "MU": np.where(pivots, PIVOT, slides)}


def undecided(columns):
    """Scene -> whether each filter leaves it undecided, once the others are seen to be equal."""
    left = {}
    for name, (body, source) in FILTERS.items():
        given = of_body(columns, body)
        found, full = status_of(given, name, source), status_of(given, body, "results")
        left[body, source] = (found & UNDECIDED) != 0
        decided = ~left[body, source]
        np.testing.assert_array_equal(found[decided], full[decided], f"{name}")
    return left


@pytest.mark.parametrize("name", sorted(POPULATIONS))
def test_what_is_decided_is_what_the_results_decide(name):
    left = undecided(population(name))
    if name in ("casework", "units", "barriers", "cancelling"):
        for case, scenes_left in left.items():
            assert scenes_left.mean() < 1e-3, case


@pytest.mark.parametrize("bit", [Status.SINGULAR, Status.NOT_FINITE])
def test_what_no_filter_looks_for_is_marked(bit):
    columns = population("singular" if bit == Status.SINGULAR else "casework")
    if bit == Status.NOT_FINITE:  # no energy that a part could be lost of
        columns |= dict.fromkeys(VELOCITIES, np.zeros(len(columns["MA"])))
    for filter_name, (body, source) in FILTERS.items():
        given = of_body(columns, body)
        flagged = (status_of(given, body, "results") & bit) != 0
        assert ((status_of(given, filter_name, source)[flagged] & UNDECIDED) != 0).all()
        assert flagged.any() or body == "pivot"


def steps(rng, size):
    """Factors that are 1, or differ from it by a few to many roundings."""
    return 1.0 + rng.choice([-1.0, 0.0, 1.0], size) * 2.0 ** rng.integers(-53, -20, size)


def critical_friction(columns, rng):
    """MU at the critical value, or as far above it as is allowed, or beside these."""
    found = quantities({**columns, "MU": np.full(len(columns["MA"]), PIVOT)}, ("MUC", "gt"))
    critical = np.abs(found["MUC"]) * steps(rng, len(columns["MA"]))
    above = critical + rng.choice([0.0, FRICTION_TOLERANCE, 2 * FRICTION_TOLERANCE], len(critical))
    mu = np.where(np.isfinite(above), above, 0.1)
    return {**columns, "MU": mu * rng.choice([-1.0, 1.0], len(mu))}


def vanishing(quantity, velocity, mu=None):
    """A maker of scenes in which a quantity that is linear in a velocity is nearly 0."""

    def make(columns, rng):
        size = len(columns["MA"])

        def found(value):
            given = {**columns, velocity: value}
            if mu is not None:
                given["MU"] = np.full(size, mu)
            return quantities(given, (quantity,))[quantity]

        value = np.where(np.isinf(columns["MA"]), 0.0, columns[velocity])
        for _ in range(3):
            slope = found(value + 1.0) - found(value)
            value = value - found(value) / slope
        value = np.where(np.isfinite(value) & np.isfinite(columns["MA"]), value, 0.0)
        made = {**columns, velocity: value * steps(rng, size)}
        made["MU"] = columns["MU"] * rng.choice([-1.0, 1.0], size)
        return made

    make.__name__ = f"{quantity}_of_{velocity}_vanishing_{mu}"
    return make


def critical_at_the_tolerance(columns, rng):
    """Central impacts whose critical friction is the tolerance, or beside it."""
    size = len(columns["MA"])
    zeros = dict.fromkeys(("DA", "DB", "GA", "VY", "WA", "WB", "EM"), np.zeros(size))
    columns = {**columns, **zeros, "UY": np.ones(size)}
    critical = quantities({**columns, "MU": np.full(size, PIVOT)}, ("MUC",))["MUC"]
    speed = np.abs(FRICTION_TOLERANCE / critical) * rng.choice([-1.0, 1.0], size)
    factor = rng.choice([0.0, 1.0, 2.0], size)
    mu = rng.choice([FRICTION_TOLERANCE, 0.3], size) * rng.choice([-1.0, 1.0], size)
    return {**columns, "UY": speed * steps(rng, size), "MU": mu * factor}


def gain_at_the_tolerance(columns, rng):
    """Elastic impacts with so little friction in the wrong direction that the gain is tolerated."""
    size = len(columns["MA"])
    columns = {**columns, "E": np.ones(size), "EM": np.ones(size), "MU": np.full(size, -1e-6)}
    lost = quantities(columns, ("LOSS",))["LOSS"]
    mu = -1e-6 * np.abs(1e-10 / lost) * steps(rng, size)
    return {**columns, "MU": np.where(np.isfinite(mu), mu, 0.0)}


def no_loss(columns, rng):
    """Elastic, without friction or moment, or nearly so."""
    size = len(columns["MA"])
    e = np.minimum(steps(rng, size), 1.0)
    return {**columns, "E": e, "MU": steps(rng, size) - 1.0, "EM": np.ones(size)}


def no_friction_needed(columns, rng):
    """Central impacts along the normal, in which no friction ends the sliding: there is none."""
    size = len(columns["MA"])
    zeros = dict.fromkeys(("DA", "DB", "GA", "UY", "VY", "WA", "WB"), np.zeros(size))
    return {**columns, **zeros, "MU": (steps(rng, size) - 1.0) * rng.choice([1.0, 1e5], size)}


def hardly_any_z(columns, rng):
    """1 - 2 EM near 0, and 1 - EM."""
    size = len(columns["MA"])
    return {**columns, "EM": rng.choice([0.5, 1.0], size) * steps(rng, size)}


def contact_beside_the_center(columns, rng):
    """The lever along the plane is 0, or the tolerance."""
    size = len(columns["MA"])
    quarter = columns["GA"] + rng.choice([-90.0, 90.0], size) * steps(rng, size)
    return {**columns, "TA": quarter, "PA": np.zeros(size)}


def at_rest(columns, rng):
    """Slow, down to what underflows, or at rest."""
    scale = 10.0 ** rng.uniform(-320, 0, len(columns["MA"]))
    return {**columns, **{name: columns[name] * scale for name in VELOCITIES}}


THRESHOLDS = [
    critical_friction,
    vanishing("gn", "UX"),
    vanishing("gt", "UY"),
    vanishing("PN", "UX"),
    vanishing("PN", "UX", PIVOT),
    vanishing("PT", "UY", PIVOT),
    critical_at_the_tolerance,
    no_loss,
    gain_at_the_tolerance,
    no_friction_needed,
    hardly_any_z,
    contact_beside_the_center,
    at_rest,
]


@pytest.mark.parametrize("name", ["casework", "heavy", "barriers"])
@pytest.mark.parametrize("threshold", THRESHOLDS)
def test_scenes_on_a_threshold(threshold, name):
    columns = of_body(population(name, seed=29), "friction")
    with np.errstate(all="ignore"):
        given = threshold(columns, np.random.default_rng(31))
    undecided(given)


def test_friction_that_may_act_forth_and_back():
    """Where the normal impulse reverses the sliding, and MU is the most this allows, or near."""
    rng = np.random.default_rng(41)
    columns = of_body(population("casework", 40_000, 43), "friction")
    found = quantities({**columns, "MU": np.zeros(len(columns["MA"]))}, ("gt", "PN", "VC"))
    low, high = np.zeros(len(columns["MA"])), np.full(len(columns["MA"]), 3.0)
    against = np.where(found["gt"] > 0, 1.0, -1.0)  # what the sign rule turns round once more

    def faulty(mu):
        return (solve({**columns, "MU": against * mu}, ("STATUS",))["STATUS"] & FAULTS) != 0

    start, end = faulty(low + 1e-6), faulty(high)
    for _ in range(70):
        mu = (low + high) / 2
        same = faulty(mu) == start
        low, high = np.where(same, mu, low), np.where(same, high, mu)
    edge = start != end
    assert edge.sum() > 100
    for factor in (1.0, 1 - 2.0**-50, 1 + 2.0**-50, 1 - 1e-9, 1 + 1e-9, 1 - 1e-6, 1 + 1e-6):
        mu = against * low * factor * steps(rng, len(low))
        undecided(
            {name: (mu if name == "MU" else column)[edge] for name, column in columns.items()}
        )
