"""Least squares within the admissible set: what fits best where the best fit of all is no impact,
and what would have to move where none agrees, against sums done by hand."""

import math
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from impact88.casework.reconstruction.adjustment import reconstruct
from impact88.casework.reconstruction.admissible import APPROACH, ENERGY, PUSH, Admissible
from impact88.casework.reconstruction.answer import Answer
from impact88.casework.reconstruction.answerremarks import remarks_on
from impact88.casework.reconstruction.answertable import first_lines
from impact88.casework.reconstruction.nearest import is_admissible
from impact88.collision.uncertain import Uncertain
from impact88.collision.units import RULES
from impact88.status import Status

MASSES = {"MA": 100.0, "MB": 80.0}


def along_a_line(deviation, **measured):
    """Return what is known of two points on a line: four velocities, with this deviation."""
    known = {"M": 4.0, **MASSES, "GA": 180.0, **dict.fromkeys(("UY", "VY", "VAY", "VBY"), 0.0)}
    for name, value in measured.items():
        known[name] = Uncertain("normal", value, -math.inf, math.inf, deviation)
    return known


def squares_stuck_together(ux, vx, vax, vbx, deviation):
    """Return the least sum of squares with one velocity after the impact: three unknowns joined by
    momentum, by its normal equations."""
    ma, mb = MASSES.values()
    design = np.array([[1.0, 0.0], [0.0, 1.0], *2 * [[ma / (ma + mb), mb / (ma + mb)]]])
    return np.linalg.lstsq(design, [ux, vx, vax, vbx], rcond=None)[1][0] / deviation**2


def test_a_fit_ends_where_restitution_would_be_negative():
    measured = {"UX": 20.0, "VX": -5.0, "VAX": 9.0, "VBX": 7.0}
    best, free = reconstruct(along_a_line(1.0, **measured))
    assert best.limited == ("E",)
    assert not best.impossible
    assert best.values["E"] == pytest.approx(0.0, abs=1e-9)
    assert best.values["VAX"] == pytest.approx(best.values["VBX"])
    assert best.squares == pytest.approx(squares_stuck_together(*measured.values(), 1.0))
    assert free.impossible == Status.E_OUT_OF_RANGE
    assert free.squares < best.squares
    shown = Answer(best, 1000)
    assert shown.draws is not None
    assert "fit best where E would leave 0 ... 1" in " ".join(remarks_on(shown))
    beside = Answer(free, 1000, like=shown)
    assert (beside.draws, beside.ranges) == (None, {})


@pytest.mark.parametrize(("vbx", "count"), [(8.4, 2), (9.6, 1)])
def test_a_fit_that_counts_is_left_as_it_is(vbx, count):
    found = reconstruct(along_a_line(1.0, UX=20.0, VX=-5.0, VAX=9.0, VBX=vbx))
    assert len(found) == count
    assert [is_admissible(impact) for impact in found] == [True, False][:count]
    assert bool(found[0].limited) == (count == 2)


def test_where_no_impact_agrees_that_is_said_with_what_would_have_to_move():
    (free,) = reconstruct(along_a_line(0.1, UX=20.0, VX=-5.0, VAX=9.0, VBX=7.0))
    assert free.impossible == Status.E_OUT_OF_RANGE
    assert free.nearest is not None
    assert free.nearest.squares == pytest.approx(squares_stuck_together(20, -5, 9, 7, 0.1))
    shown = Answer(free, 1000)
    text = dict(first_lines(shown, RULES))["NO IMPACT"]
    ratio = (free.values["VBX"] - free.values["VAX"]) / (free.values["UX"] - free.values["VX"])
    assert f"E is {ratio:.3g}, not from 0 to 1" in text
    both = free.nearest.values["VBX"]
    assert f"VBX at {both:.4g}, not 7 ({(both - 7) / 0.1:.1f} sd)" in text
    assert (shown.draws, shown.ranges) == (None, {})


def test_what_hardly_moves_is_no_value_that_would_have_to_move():
    """Two speeds that are known a hundred times as well as the others move by less than one of
    their deviations."""
    known = along_a_line(0.1, UX=20.0, VX=-5.0, VAX=9.0, VBX=7.0)
    sure = {
        n: Uncertain("normal", known[n].nominal, -math.inf, math.inf, 1e-3) for n in ("UX", "VX")
    }
    (free,) = reconstruct({**known, **sure})
    _, moves = dict(first_lines(Answer(free, 0), RULES))["NO IMPACT"].split("The nearest one has ")
    assert sorted(move.split()[0] for move in moves.split("; ")) == ["VAX", "VBX"]


def test_neither_a_touch_without_impulse_nor_one_without_approach_is_an_impact():
    """Both are beyond their borders, not on them; no loss of energy is on its border."""
    best, *_ = reconstruct(along_a_line(1.0, UX=20.0, VX=-5.0, VAX=9.0, VBX=7.0))
    touch = SimpleNamespace(values={"PN": 0.0}, relative_before=(0.0,), energy_lost=0.0)
    admissible = Admissible(best.system)
    ends = [admissible.ends(touch, name)[0] for name in (APPROACH, PUSH, ENERGY)]
    assert max(ends[:2]) < 0.0 == ends[2]


def test_of_several_nearest_impacts_the_nearest_is_told():
    """Speeds, whose directions are open: of each choice of signs another impact is nearest. The
    nearest of all has the vehicles stick together."""
    speeds = {"SA": 11.0, "SB": 3.0, "SAF": 3.0, "SBF": 0.0}
    known = along_a_line(1.0, **speeds)
    (free, *_) = reconstruct(known)
    assert free.nearest is not None
    signed = product(*({speed, -speed} for speed in speeds.values()))
    assert free.nearest.squares == pytest.approx(
        min(squares_stuck_together(*values, 1.0) for values in signed)
    )
    assert free.nearest.values["E"] == pytest.approx(0, abs=1e-8)


@pytest.mark.parametrize(("beyond", "count"), [(0.3, 2), (0.5, 1)])
def test_an_impact_that_fits_much_worse_than_another_is_not_listed(beyond, count):
    """B's speed of 3 has either direction, and v_B' = c v + k u with k = (1 + e) m_a / (m_a + m_b),
    c = 1 - k. The sums of squares of the two are (c 3 -+ beyond)^2 / (1 + c^2), where v_B' is
    measured beyond k u; one with more than four times the other's is left out."""
    known = along_a_line(1.0, SB=3.0) | {"UX": 20.0, "E": 0.1}
    k = 1.1 * MASSES["MA"] / sum(MASSES.values())
    known["VBX"] = Uncertain("normal", 20 * k + beyond, -math.inf, math.inf, 1.0)
    squares = [(3 * (1 - k) - sign * beyond) ** 2 / (1 + (1 - k) ** 2) for sign in (1, -1)]
    found = sorted(impact.squares for impact in reconstruct(known))
    assert found == pytest.approx(squares[:count])


def test_vehicles_that_separate_are_no_impact():
    (free,) = reconstruct(along_a_line(0.1, UX=-5.0, VX=20.0, VAX=-4.0, VBX=19.0))
    text = dict(first_lines(Answer(free, 0), RULES))["NO IMPACT"]
    assert "E is -0.921, not from 0 to 1" in text  # with A on the other side of the plane


@pytest.mark.parametrize("plane", [0.0, 180.0])
def test_vehicles_that_pull_one_another_are_no_impact(plane):
    """They approach at 25 and go on at 27, as if through one another; the plane's other side has
    them separate before, which is told of neither."""
    known = along_a_line(0.1, UX=20.0, VX=-5.0, VAX=21.0, VBX=-6.0)
    (free,) = reconstruct({**known, "GA": plane})
    text = dict(first_lines(Answer(free, 0), RULES))["NO IMPACT"]
    assert "the impulse pulls" in text
    assert "separate" not in text


def test_an_impact_with_more_friction_than_there_is_stands_behind_one_that_counts():
    """The truth has UX = -49.4 and P_t/P_n = 0.68. Another impact fits better, with a P_t/P_n of -3
    where friction along the sliding is positive."""
    known = {"M": 6.0, "DA": 4.0252, "DB": 4.9666, "GA": -83.919, "PA": 15.293, "PB": -53.596}
    known |= {"TA": -173.98, "TB": 45.392, "MA": 108.43, "MB": 91.696, "IA": 2372.2, "IB": 1895.1}
    known |= {"WA": 0.0, "WB": 0.0, "VAX": "-42.381 .. -37.185", "VAY": "normal 42.426 1.5"}
    known |= {"VBX": "-26.263 .. -21.067", "VBY": "39.944 .. 45.14", "EL": "35494 .. 46913"}
    known |= {"UY": "normal 53.744 1.5", "E": "0 .. 0.42", "EM": "-0.95 .. 0"}
    first, second = reconstruct(known)
    assert first.values["UX"] == pytest.approx(-49.4, abs=1.0)
    assert second.squares < first.squares
    assert [is_admissible(first), is_admissible(second)] == [True, False]
