"""Every impact, in the order of physics: problems of exact values, seen from elsewhere, and what
more than one impact agrees with; the posterior against rejection by its own mechanics."""

import math

import numpy as np
import pytest
from longer import long_but

from impact88.casework.reconstruction.adjustment import reconstruct
from impact88.casework.reconstruction.answer import Answer
from impact88.casework.reconstruction.answerremarks import remarks_on
from impact88.casework.reconstruction.answertable import text_of
from impact88.casework.reconstruction.drawsandbounds import draws, ranges
from impact88.collision.casescene import sample
from impact88.collision.geometry import GEOMETRY
from impact88.collision.uncertain import read
from impact88.mechanics.closedform.solve import solve
from impact88.mechanics.state import State

SCENE = {name: float(text) for name, text in sample(1).items()}
FINAL = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")
VEHICLES = {n: SCENE[n] for n in (*GEOMETRY, "M")}
PROBLEMS = (
    ("SA", "SB", "HB", "DVA", "WA", "WB", "E", "EM", "MUP"),
    ("DVA", "SBF", "EL", "SA", "EM", "WA", "WB", "UY", "HB"),
    ("SAF", "SBF", "SA", "SB", "WA", "WB", "E", "EM", "MUP"),
)


def everything(scene, names=None):
    after = {n: float(v) for n, v in solve(scene).items()}
    state = State({**scene, **after})
    names = names or {name for problem in PROBLEMS for name in problem}
    own = {**scene, **after}
    return {n: own[n] if n in ("E", "EM", "MUP") else float(np.ravel(state[n])[0]) for n in names}


def mirrored(scene):
    turned = {n: -scene[n] for n in ("GA", "PA", "PB", "TA", "TB", "UY", "VY", "WA", "WB")}
    return {**scene, **turned}


def rotated(scene, angle=37.0):
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    turned = {n: scene[n] + angle for n in ("GA", "TA", "TB")}
    for x, y in (("UX", "UY"), ("VX", "VY")):
        turned |= {x: c * scene[x] - s * scene[y], y: s * scene[x] + c * scene[y]}
    return {**scene, **turned}


def exchanged(scene):
    pairs = [("UX", "VX"), ("UY", "VY"), ("WA", "WB"), ("DA", "DB"), ("PA", "PB")]
    pairs += [("MA", "MB"), ("IA", "IB")]
    new = dict(scene)
    for a, b in pairs:
        new |= {a: scene[b], b: scene[a]}
    # at TA = 0 the front of A points to 180°, at TB = 0 that of B to 0°
    new |= {"TA": scene["TB"] + 180, "TB": scene["TA"] + 180}
    return {**new, "GA": scene["GA"] + 180}


def written_otherwise(scene):
    return {**scene, "GA": scene["GA"] + 360, "TA": scene["TA"] - 360, "PB": scene["PB"] + 720}


def in_meters(scene):
    new = {
        n: v * 0.3048 if n in ("DA", "DB", "UX", "UY", "VX", "VY") else v for n, v in scene.items()
    }
    return {**new, "IA": scene["IA"] * 0.3048**2, "IB": scene["IB"] * 0.3048**2}


@pytest.mark.parametrize("names", PROBLEMS)
def test_the_truth_is_among_them_and_no_impossible_impact_stands_before_it(names):
    values = everything(SCENE)
    found = reconstruct({**VEHICLES, **{n: values[n] for n in names}})
    assert any(abs(s.values["UX"] - SCENE["UX"]) < 1e-5 for s in found)
    broken = [bool(s.impossible) for s in found]
    assert broken == sorted(broken)
    assert not broken[0]
    search = found[0].search
    assert search.impacts == len(found)
    assert search.solutions - search.nonreal >= len(found)
    assert search.text().endswith("the equations have no other")


EXCHANGED = {"SA": "SB", "SB": "SA", "HB": "HA", "DVA": "DVB", "WA": "WB", "WB": "WA"}
EXCHANGED |= {"SAF": "SBF", "SBF": "SAF", "UY": "VY", "VX": "UX", "VY": "UY", "WAF": "WBF"}
EXCHANGED |= {"VBX": "VAX", "DVAR": "DVBR"}
TIED = ("WAF", "KI", "VBX", "DVAR", "VY", "SA", "E", "VX", "KF")
TIED_SCENE = {
    "M": 6.0,
    "GA": -167.7,
    "MA": 106.5,
    "MB": 138.8,
    "IA": 2382.0,
    "IB": 2808.0,
    "DA": 6.411,
    "DB": 3.081,
    "TA": 156.7,
    "PA": -356.7,
    "TB": 50.16,
    "PB": -250.2,
    "UX": 29.13,
    "UY": -5.091,
    "VX": -16.32,
    "VY": -25.43,
    "WA": -0.09661,
    "WB": 0.0,
    "E": 0.3224,
    "EM": -0.278,
    "MU": -0.06387,
}
"""Of these two impacts agree, alike in all before the impact, e and energies: the first one was
another where an angle was written with 360° more."""
CHANGES = (mirrored, rotated, in_meters, exchanged, written_otherwise)


@pytest.mark.parametrize("change", long_but(CHANGES))
@pytest.mark.parametrize(
    ("scene", "names"), [*((SCENE, names) for names in PROBLEMS), (TIED_SCENE, TIED)]
)
def test_the_first_impact_is_the_same_from_elsewhere(scene, names, change):
    if change is rotated and {"UY", "VX"} & {*names}:
        return  # a component is another quantity there
    values = everything(scene, names)
    first = reconstruct({**{n: scene[n] for n in VEHICLES}, **values})[0]
    scene = change(scene)
    own = [EXCHANGED.get(n, n) for n in names] if change is exchanged else names
    values = everything(scene, own)
    seen = reconstruct({**{n: scene[n] for n in VEHICLES}, **values})[0]
    factor = 0.3048 if change is in_meters else 1.0
    for a, b in (("SA", "SB"), ("SAF", "SBF"), ("DVA", "DVB")):
        sizes = [seen.values[a] / factor, seen.values[b] / factor]
        here = [first.values[a], first.values[b]]
        assert sizes[:: -1 if change is exchanged else 1] == pytest.approx(here, rel=1e-6)


def test_more_than_needed_that_agrees_exactly_hides_no_branch():
    """Ten values with tolerances, true to the last digit: both speeds and spins before make the
    kinetic energy of every impact of the other nine, so that it excludes none of them."""
    truth, names = everything(SCENE), PROBLEMS[0]
    exact = reconstruct({**VEHICLES, **{n: truth[n] for n in names}})
    truth["KI"] = exact[0].values["KI"]
    known = {n: f"{truth[n]!r} +- {0.03 * max(abs(truth[n]), 0.05)!r}" for n in (*names, "KI")}
    loose = reconstruct({**VEHICLES, **known})
    assert loose[0].search.reached > 1
    assert f"starts {loose[0].search.reached} led to" in loose[0].search.text()
    assert len(exact) > 1
    for impact in exact:
        x = impact.values["VAX"]
        assert any(s.values["VAX"] == pytest.approx(x, abs=1e-5) for s in loose)


def test_equivalent_barrier_speeds_are_the_energies_they_stand_for():
    after = {n: float(v) for n, v in solve(SCENE).items()}
    state = State({**SCENE, **after})
    lost = float(state["EL"])
    speeds = {v: math.sqrt(2 * p * lost / SCENE["M" + v]) for v, p in (("A", 0.4), ("B", 0.6))}
    known = {n: v for n, v in SCENE.items() if n not in ("UX", "E", "MU")}
    known |= {"MUP": after["MUP"], "SA": 29.04, "HA": 180.0}
    found = reconstruct({**known, "EBSA": speeds["A"], "EBSB": speeds["B"]})
    assert min(abs(s.values["E"] - SCENE["E"]) for s in found) < 1e-6


def test_a_car_of_unknown_speed_along_an_axis_has_no_course():
    """B's velocities give the whole impulse; A's speed along x stays open."""
    after = {n: float(v) for n, v in solve(SCENE, FINAL).items()}
    known = {**VEHICLES, **{n: SCENE[n] for n in ("UY", "WA", "VX", "VY", "WB")}}
    known |= {n: after[n] for n in ("VBX", "VBY", "WBF")}
    (found,) = reconstruct(known)
    assert "UX" in found.undetermined
    assert "HA" not in found.values


def direct_impact(n, rng):
    """A rear end of point masses along x with exact masses: u, v flat, e uniform; the exit speed of
    B normal, the energy lost normal. All in closed form, one dimension."""
    u, v = rng.uniform(-20, 90, n), rng.uniform(-60, 60, n)
    strikes = u > v
    u, v = u[strikes], v[strikes]
    n = len(u)
    e = rng.uniform(0.0, 0.4, n)
    ma, mb = 100.0, 80.0
    impulse = (1 + e) * (u - v) / (1 / ma + 1 / mb)
    after_b = v + impulse / mb
    lost = 0.5 * ma * mb / (ma + mb) * (1 - e * e) * (u - v) ** 2
    log = -0.5 * ((after_b - 30) / 2) ** 2 - 0.5 * ((lost - 9000) / 2500) ** 2
    inside = (np.abs(after_b - 30) <= 6) & (np.abs(lost - 9000) <= 7500)
    kept = inside & (rng.random(n) < np.exp(log))
    return u[kept], v[kept]


@pytest.mark.long
def test_draws_are_those_of_rejection_over_approaching_impacts():
    """B is struck: that it runs away backwards meets the crush as well, and is no impact."""
    known = {"M": 4.0, "MA": 100.0, "MB": 80.0, "GA": 180.0, "UY": 0.0, "VY": 0.0, "MUP": 0.0}
    known |= {"E": read("0 .. .4", "E"), "VBX": read("normal 30 2", "VBX")}
    known |= {"EL": read("normal 9000 2500", "EL")}
    u, v = direct_impact(2_000_000, np.random.default_rng(1988))
    (first, *_) = reconstruct(known)
    for seed in (0, 1):
        drawn = draws(first, ["UX", "VX", "VC"], 8000, seed)
        assert drawn.values["VC"].min() > 0
        for name, other in (("UX", u), ("VX", v)):
            own = drawn.values[name]
            assert own.std() / other.std() == pytest.approx(1, abs=0.06)
            assert abs(own.mean() - other.mean()) < 0.12 * other.std()
    bounds = ranges(first, ["UX", "VX"], 0, drawn)
    for name, other in (("UX", u), ("VX", v)):
        assert bounds[name].lower <= min(other.min(), drawn.values[name].min())
        assert bounds[name].upper >= max(other.max(), drawn.values[name].max())


@pytest.mark.long
def test_a_car_that_may_have_stood_still_has_a_least_speed_of_0():
    """B's speed has a kink there; where it was hit on the move the least speed is that."""
    known = {"M": 4.0, "MA": 100.0, "MB": 80.0, "GA": 170.0, "MUP": 0.1, "UY": 0.0}
    known |= {"E": read("0 .. .3", "E"), "SA": read("55 .. 65", "SA"), "HA": 0.0}
    for across, least in (("-3 .. 3", 0.0), ("4 .. 6", 4.0)):
        own = {**known, "VY": read(across, "VY"), "DVB": read("28 .. 40", "DVB")}
        bound = ranges(reconstruct(own)[0], ["SB"])["SB"]
        assert bound.lower == pytest.approx(least, abs=1e-6)
        ma, mb, c = 100.0, 80.0, math.cos(math.radians(10))
        # of a standing B: its change of velocity lies within the limits for some e and speed
        change = (1 + 0.15) * 60 * c / (1 / ma + 1 / mb) / mb * math.hypot(1, 0.1)
        assert 28 < change < 40


@pytest.mark.long
def test_a_vehicle_that_stands_by_its_speed_stands_by_its_components():
    known = {"M": 4.0, "MA": 100.0, "MB": 80.0, "SA": read("8 .. 9", "SA"), "HA": 0.0}
    known |= {"SB": 0.0, "E": 0.2}
    shown = Answer(reconstruct(known)[0], 1000)
    assert not shown.solution.folded
    # (1 + e) m_b / (m_a + m_b) of the closing speed
    factor = 1.2 * 80 / 180
    assert shown.ranges["DVA"].lower == pytest.approx(8 * factor, rel=1e-6)
    assert shown.ranges["DVA"].upper == pytest.approx(9 * factor, rel=1e-6)


def test_no_interval_stands_about_an_impact_that_is_none():
    """A pair of values that only a pulling impact fits best; possible ones lie within limits."""
    ma, mb, k = 3000 / 32.174, 3500 / 32.174, 5280 / 3600
    known = {"MA": ma, "MB": mb, "IA": 1800.0, "IB": 2300.0, "DA": 6.5, "DB": 5.0, "EM": 0.0}
    known |= dict.fromkeys(("GA", "PA", "PB", "TA", "TB", "WA", "WB", "UY"), 0.0) | {"MU": 0.4}
    known |= {"E": read("0 .. .3", "E"), "SAF": read(f"{12 * k} +- {1.5 * k}", "SAF")}
    known |= {"SBF": read(f"{17 * k} +- {1.5 * k}", "SBF")}
    known |= {n: read(f"0 +- {k}", n) for n in ("VX", "VY")}
    shown = Answer(reconstruct(known)[0], 4000)
    assert shown.solution.impossible
    assert shown.draws.values["VC"].min() > 0
    answer = text_of(shown).partition("velocity ")[0]
    assert "between" not in answer
    assert "impacts that physics allows lie within all limits" in " ".join(answer.split())


def test_the_first_order_is_not_shown_where_it_contradicts_the_draws():
    """B may have stood still: its speed has a kink there."""
    known = {"M": 4.0, "MA": 100.0, "MB": 80.0, "GA": 170.0, "MUP": 0.1, "UY": 0.0}
    known |= {"E": read("0 .. .3", "E"), "SA": read("55 .. 65", "SA"), "HA": 0.0}
    known |= {"VY": read("-3 .. 3", "VY"), "DVB": read("28 .. 40", "DVB")}
    shown = Answer(reconstruct(known)[0], 4000)
    assert shown.first_order["SB"] is None
    assert shown.deviations["SB"] == pytest.approx(shown.draws.values["SB"].std(ddof=1))
    for name in shown.names:
        plain = shown.first_order[name]
        if plain is not None:
            assert plain == pytest.approx(shown.draws.values[name].std(), rel=0.34)


@pytest.mark.long
def test_a_second_exact_value_that_is_not_linear_is_met_by_every_draw():
    """One is solved for; the other is met within a thousandth of it."""
    after = solve(SCENE, (*FINAL, "MUP"))
    state = State({**SCENE, **{n: float(v) for n, v in solve(SCENE).items()}})
    known = {n: SCENE[n] for n in (*VEHICLES, "UY", "WA", "WB")} | {"MUP": float(after["MUP"])}
    known |= {"DVA": float(state["DVA"]), "SBF": float(state["SBF"])}
    known |= {"E": read("0 .. .1", "E"), "EM": read("-.8 .. -.6", "EM")}
    known |= {"VX": read(f"{SCENE['VX']!r} +- 2", "VX"), "VAX": read("-13.3 +- 2", "VAX")}
    drawn = draws(reconstruct(known)[0], ["DVA", "SBF", "VC", "UX"], 2000)
    assert drawn.suffice
    for name in ("DVA", "SBF"):
        width = 0.0031 * known[name]
        assert np.abs(drawn.values[name] - known[name]).max() < width
    assert drawn.values["VC"].min() > 0
    assert drawn.values["UX"].min() < SCENE["UX"] < drawn.values["UX"].max()


@pytest.mark.long
def test_where_two_branches_meet_no_first_order_deviation_is_shown():
    """The speed of A is that of its x component: UY is 0, from both sides, and within .5 ft/s of
    speed it is up to the leg of a right-angled triangle."""
    known = {n: v for n, v in SCENE.items() if n not in ("MU", "UY")}
    known |= {"GA": 0.0, "MUP": 0.3, "SA": read("29.04 +- .5", "SA")}
    alone = Answer(reconstruct(known)[0], 0)
    assert alone.first_order["UY"] is None
    assert math.isnan(alone.deviations["UY"])
    (line,) = (line for line in remarks_on(alone) if "two branches" in line)
    assert "UY about 0" in line
    drawn = Answer(reconstruct(known)[0], 200)
    leg = math.sqrt(29.54**2 - 29.04**2)
    assert drawn.ranges["UY"].upper == pytest.approx(leg, rel=1e-3)
    assert drawn.ranges["UY"].lower == pytest.approx(-leg, rel=1e-3)
    assert any("draws and bounds have both" in line for line in remarks_on(drawn))
    # well beside the fold there are two impacts, each with its own deviation
    known["SA"] = read("32 +- .01", "SA")
    for impact in reconstruct(known):
        assert impact.folded == ()
        beside = Answer(impact, 0)
        leg = math.sqrt(32**2 - 29.04**2)
        half = 0.01 / math.sqrt(3) * 32 / leg
        assert beside.first_order["UY"] == pytest.approx(half, rel=1e-6)
