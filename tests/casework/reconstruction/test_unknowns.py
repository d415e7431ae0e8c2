"""`reconstruction.unknowns`: the equations as the chapter prints them, solved for any unknowns."""

from __future__ import annotations

import os
from collections.abc import Sequence
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from reference_cases import Case, cases_of

from impact88 import sample, solve, solve_for
from impact88.casework.reconstruction.adjustment import reconstruct
from impact88.casework.reconstruction.derived import without_noise
from impact88.casework.reconstruction.system import System
from impact88.casework.reconstruction.unknowns import UnsolvableError
from impact88.collision.uncertain import fixed_value
from impact88.errors import UserError
from impact88.bench.populations import scenes
from impact88.mechanics.closedform.general import quantities, typed_friction
from impact88.mechanics.outcome import initial_impact, outcome
from impact88.names import COEFFICIENTS, FINAL_STATE, VELOCITIES

VEHICLES = ("DA", "DB", "GA", "PA", "PB", "TA", "TB", "MA", "MB", "IA", "IB")


def table_3() -> dict[str, float]:
    """Table 3's scene with its final velocities and its signed friction."""
    scene = {name: float(text) for name, text in sample(3).items()}
    after = solve(scene, (*FINAL_STATE, "MUP"))
    return scene | {name: float(value) for name, value in after.items()}


def without(values: dict[str, float], *names: str) -> dict[str, float]:
    """``values`` but for ``names``, and for MU: MUP says more."""
    return {name: value for name, value in values.items() if name not in (*names, "MU", "M")}


def generically_solvable(unknown: Sequence[str]) -> bool:
    """Whether the equations determine ``unknown`` for almost every scene: of a random one."""
    rng = np.random.default_rng(1988)
    scene = {n: rng.uniform(0.5, 2.0) for n in ("DA", "DB", "MA", "MB", "IA", "IB")}
    scene |= {n: rng.uniform(-90.0, 90.0) for n in ("GA", "PA", "PB", "TA", "TB")}
    scene |= {"E": 0.37, "EM": -0.61, "MUP": 0.43}
    scene |= {n: rng.uniform(-2.0, 2.0) for n in (*VELOCITIES, *FINAL_STATE)}
    try:
        solve_for({n: v for n, v in scene.items() if n not in unknown}, unknown)
    except UnsolvableError:
        return False
    return True


def residuals(s: dict[str, Any]) -> list[float]:
    """Equations 13 to 18 as printed, each relative to the size of its terms."""
    g = np.radians(s["GA"])
    b, a = np.radians(s["TB"] + s["PB"]), np.radians(s["TA"] + s["PA"])
    d1, d2 = s["DB"] * np.sin(b), s["DB"] * np.cos(b)
    d3, d4 = s["DA"] * np.sin(a), s["DA"] * np.cos(a)
    ma, mb, ia, ib, mu, e, em = (s[n] for n in ("MA", "MB", "IA", "IB", "MUP", "E", "EM"))
    vax, vay, wa, vbx, vby, wb = (s[n] for n in VELOCITIES)
    Vax, Vay, Wa, Vbx, Vby, Wb = (s[n] for n in FINAL_STATE)
    approach = [
        (vay - d4 * wa - vby - d2 * wb) * np.sin(g),
        (vax + d3 * wa - vbx + d1 * wb) * np.cos(g),
    ]
    rebound = [
        (Vay - d4 * Wa - Vby - d2 * Wb) * np.sin(g),
        (Vax + d3 * Wa - Vbx + d1 * Wb) * np.cos(g),
    ]
    equations = [
        [ma * Vax, mb * Vbx, -ma * vax, -mb * vbx],
        [ma * Vay, mb * Vby, -ma * vay, -mb * vby],
        [*rebound, *(e * part for part in approach)],
        [
            ma * (Vay - vay) * (np.cos(g) - mu * np.sin(g)),
            mb * (Vbx - vbx) * (np.sin(g) + mu * np.cos(g)),
        ],
        [
            ib * (Wb - wb),
            ia * (Wa - wa),
            mb * (d1 + d3) * (Vbx - vbx),
            ma * (d2 + d4) * (Vay - vay),
        ],
        [
            (Wb - Wa) * (1 - em),
            em * (Wa - wa),
            -em * ma * d3 * (Vax - vax) / ia,
            em * ma * d4 * (Vay - vay) / ia,
            -em * (Wb - wb),
            -em * mb * d1 * (Vbx - vbx) / ib,
            em * mb * d2 * (Vby - vby) / ib,
        ],
    ]
    speed = max(abs(s[n]) for n in (*VELOCITIES, *FINAL_STATE))
    sizes = [(ma + mb), (ma + mb), 1, ma + mb, (ia + ib), 1 + ma / ia + mb / ib]
    return [
        abs(sum(terms)) / max(size * speed, *map(abs, terms))
        for terms, size in zip(equations, sizes, strict=True)
    ]


def largest_error(found: Any, expected: dict[str, float]) -> float:
    scale = max(abs(value) for value in expected.values())
    return max(abs(float(found[name]) - value) for name, value in expected.items()) / scale


# -- the reference cases


@pytest.mark.parametrize("case", cases_of("forward", "inverse", "mixed", "three"), ids=str)
def test_reference_cases_to_1e_12_of_their_condition(case: Case) -> None:
    (found,) = solve_for(case.given)
    assert largest_error(found, case.velocities) <= 1e-12 * max(1.0, float(found.worst))


@pytest.mark.parametrize("case", cases_of("inverse"), ids=str)
def test_the_closed_form_inverse_too(case: Case) -> None:
    found = initial_impact(case.given)
    amplification = float(solve_for(case.given)[0].worst)
    assert largest_error(found, case.velocities) <= 1e-12 * amplification


@pytest.mark.parametrize("case", cases_of("forward friction", "forward pivot"), ids=str)
def test_what_follows_from_a_solution(case: Case) -> None:
    (found,) = solve_for(case.given)
    values = outcome({**case.given, **found.values})
    close = pytest.approx
    assert float(values["LOSS"]) == close(float(case.result["KE_loss_percent"]), rel=1e-12)
    assert float(values["KI"]) == close(float(case.result["KE_initial"]), rel=1e-12)
    for name, text in case.result["contact_final"].items():
        assert float(values[f"{name}F"]) == close(float(text), rel=1e-11, abs=1e-12)
    for key, name in (("Pn", "PN"), ("Pt", "PT"), ("M", "PM")):
        assert float(found[name]) == close(float(case.result["impulses"][key]), rel=1e-12, abs=1e-9)
    if case.kind.startswith("forward pivot"):
        ratio = float(case.result["impulses"]["Pt"]) / float(case.result["impulses"]["Pn"])
        assert float(values["MUC"]) == close(ratio, rel=1e-12)


# -- which sets can be solved


def test_640_of_the_924_sets_of_six_velocities_are_generically_solvable() -> None:
    # IMPACT88_SETS=1 tries all of them
    every = 1 if os.environ.get("IMPACT88_SETS") else 56
    sets = list(combinations((*VELOCITIES, *FINAL_STATE), 6))[::every]
    assert sum(map(generically_solvable, sets)) == {1: 640, 56: 12}[every]


@pytest.mark.parametrize("vehicle", ["A", "B"])
def test_all_six_of_one_vehicle_are_refused(vehicle: str) -> None:
    at = 0 if vehicle == "A" else 3
    names = (*VELOCITIES[at : at + 3], *FINAL_STATE[at : at + 3])
    assert not generically_solvable(names)
    with pytest.raises(UnsolvableError, match=f"all velocities of {vehicle} are unknown"):
        solve_for(without(table_3(), *names))


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"E": 0.0}, r"^E = 0: Equation 15"),
        ({"EM": 0.0}, r"^EM = 0: Equation 18"),
        ({"MUP": -10.0}, r"^MU = -10 \(pivot\)"),
        ({"E": 0.0, "EM": 0.0}, r"^E = 0.*; and EM = 0"),
    ],
)
def test_a_reconstruction_without_solution_is_refused_with_the_reason(
    changes: dict[str, float], reason: str
) -> None:
    known = without(table_3(), *VELOCITIES)
    solve_for(known)
    with pytest.raises(UnsolvableError, match=reason):
        solve_for(known | changes)


def test_the_one_value_of_e_that_makes_the_mixed_problem_singular_is_named() -> None:
    # point masses, v_a and V_b unknown: (1 + e)(V_a - v_b)n + P_n (1/m_b - e/m_a) = 0
    known = {"M": 4, "MA": 100, "MB": 200, "GA": 20, "MUP": 0.3}
    known |= {"VAX": -5.0, "VAY": 1.0, "VX": 2.0, "VY": 3.0}
    with pytest.raises(UnsolvableError, match=r"E = 0.5: at exactly this value"):
        solve_for(known | {"E": 0.5})
    (found,) = solve_for(known | {"E": 0.5001})
    assert float(found.worst) > 1000
    assert found.badly_conditioned


def test_too_many_unknowns_are_counted_and_what_is_determined_is_named() -> None:
    known = without(table_3(), "UX", "VY", "WA", "WB", "WAF", "WBF", *COEFFICIENTS)
    with pytest.raises(UnsolvableError, match="9 quantities are unknown") as refusal:
        solve_for(known)
    assert "UX VY MUP could be found alone; give at least 3 more" in str(refusal.value)
    (found,) = solve_for(known, ["UX", "VY"])
    assert float(found["UX"]) == pytest.approx(-36.667, abs=1e-12)
    assert "E" not in found.values


def test_coefficients_of_nothing_have_no_value() -> None:
    still = dict.fromkeys((*VELOCITIES, *FINAL_STATE), 0.0)
    known = {name: table_3()[name] for name in VEHICLES} | still
    with pytest.raises(UnsolvableError) as refusal:
        solve_for(known)
    for reason in ("gn = 0", "Pn = 0", "Equation 18"):
        assert reason in str(refusal.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"MA": -1.0}, "MA is not positive"),
        ({"MA": float("nan")}, "MA is not finite"),
        ({"UX": float("inf")}, "UX is not finite"),
        ({"SPEED": 1.0}, "'SPEED' is not a value of an impact"),
        ({"vax": 1.0}, "did you mean VAX"),
        ({"M": 5.0}, "M must be 6"),
        ({"MU": 0.5}, "MU and MUP are both given"),
        ({"UX": "fast"}, "UX: 'fast' is not a number"),
    ],
)
def test_unusable_values_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(UserError, match=message):
        solve_for(without(table_3(), *FINAL_STATE) | changes)


def test_arrays_that_do_not_fit_and_bodies_that_cannot_be_are_refused() -> None:
    known = without(table_3(), *VELOCITIES)
    with pytest.raises(UserError, match="do not broadcast together: E"):
        solve_for(known | {"E": np.ones(3), "VAX": np.ones(2)})
    with pytest.raises(UserError, match="MA and MB are both infinite"):
        solve_for(known | {"MA": np.inf, "MB": np.inf})
    with pytest.raises(UserError, match=r"pivot's -10 in some scenes only"):
        solve_for(known | {"MUP": np.array([0.5, -10.0])})
    with pytest.raises(UnsolvableError):
        solve_for(known | {"MA": 1e-320, "MB": 1e-320})
    assert solve_for(known | {"E": np.empty((0, 2))}) == []


def test_missing_vehicles_and_wrong_wishes_are_refused() -> None:
    known = without(table_3(), *FINAL_STATE)
    with pytest.raises(UserError, match="missing MA"):
        solve_for(without(known, "MA", "MU"))
    with pytest.raises(UserError, match="UX is both known and wanted"):
        solve_for(known, ["UX"])
    with pytest.raises(UserError, match="'XA' is not a quantity that may be unknown"):
        solve_for(known, ["XA"])
    with pytest.raises(UserError, match="nothing is unknown"):
        solve_for(without(table_3()))


# -- friction known in size only


def test_both_signs_of_friction_are_returned_where_both_agree() -> None:
    known = without(table_3(), *VELOCITIES, "MUP") | {"MU": 0.89}
    solutions = solve_for(known)
    assert [float(s["MUP"]) for s in solutions] == [0.89, -0.89]
    assert [float(s["MU"]) for s in solutions] == [0.89, 0.89]
    for solution in solutions:
        scene = {**known, **{name: float(solution[name]) for name in VELOCITIES}}
        again = solve(
            {name: scene[name] for name in (*VEHICLES, "E", "MU", "EM", *VELOCITIES)}, FINAL_STATE
        )
        assert largest_error(again, {n: known[n] for n in FINAL_STATE}) < 1e-13


def test_a_sign_that_disagrees_with_its_own_sliding_is_not_returned() -> None:
    # with little friction only the sign that opposes the sliding of Table 3 remains
    scene = {name: float(text) for name, text in sample(3).items()} | {"MU": 0.1}
    after = {name: float(value) for name, value in solve(scene, FINAL_STATE).items()}
    known = {n: v for n, v in scene.items() if n not in VELOCITIES} | after
    (found,) = solve_for(known)
    assert float(found["MUP"]) == 0.1
    assert float(found["UX"]) == pytest.approx(-36.667)


def test_the_forward_problem_applies_line_400() -> None:
    known = {name: float(text) for name, text in sample(1).items()}
    assert float(solve_for(known)[0]["MUP"]) == 0.911
    turned = known | {"GA": 150.0}  # gt > 0: the sign changes
    (found,) = solve_for(turned)
    assert float(found["MUP"]) == -0.911
    expected = {n: float(v) for n, v in solve(turned, FINAL_STATE).items()}
    assert largest_error(found, expected) < 1e-14


def test_the_mu_to_type_gives_back_the_impact_where_nothing_slides_but_by_rounding() -> None:
    """Head-ons in any direction: the slip before is 0 but for rounding, of either sign."""
    slips = []
    for angle in np.random.default_rng(4).uniform(-180, 180, 12):
        x, y = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        scene = sample(3).numbers() | {"GA": angle, "TA": angle, "TB": angle, "PA": 20.0, "PB": 0.0}
        scene |= {"UX": -30 * x, "UY": -30 * y, "VX": 20 * x, "VY": 20 * y, "WA": 0.0, "WB": 0.0}
        slips.append(float(quantities({**scene, "MU": 0.0}, ("gt",))["gt"]))
        for mup in (0.2, -0.2):
            known = {n: v for n, v in scene.items() if n not in (*VELOCITIES, "MU")}
            known |= {"MUP": mup, **solve({**scene, "MU": typed_friction(scene, mup)}, FINAL_STATE)}
            found = [solve_for(known)[0].values, reconstruct(known)[0].scene()]
            for values in found:
                typed = {**scene, **{n: values[n] for n in (*VELOCITIES, "MU")}}
                assert float(solve(typed, ("MUP",))["MUP"]) == mup
    assert min(slips) < 0 < max(slips)
    assert np.abs(slips).max() < 1e-13


# -- arrays


def test_arrays_give_what_each_scene_gives_alone_and_nan_where_there_is_nothing() -> None:
    known = without(table_3(), *VELOCITIES)
    e = np.array([[0.0, 0.1], [0.25, 0.5]])
    (found,) = solve_for(known | {"E": e})
    assert found["UX"].shape == (2, 2)
    assert np.isnan(found["UX"][0, 0])
    assert found.agrees.tolist() == [[False, True], [True, True]]
    for index in ((0, 1), (1, 0), (1, 1)):
        (alone,) = solve_for(known | {"E": e[index]})
        for name in VELOCITIES:
            assert found[name][index] == pytest.approx(float(alone[name]), rel=1e-13, abs=1e-12)
    with pytest.raises(UnsolvableError, match="E = 0"):
        solve_for(known | {"E": np.zeros(3)})


def test_arrays_with_friction_known_in_size_say_where_each_sign_agrees() -> None:
    known = without(table_3(), *VELOCITIES, "MUP")
    mu = np.array([0.02, 0.3, 0.7, 0.89])
    found = {float(s["MUP"][0]) > 0: s for s in solve_for(known | {"MU": mu})}
    masks = {sign: solution.agrees.tolist() for sign, solution in found.items()}
    assert masks[True] != masks.get(False)
    for i, size in enumerate(mu):
        try:
            alone = solve_for(known | {"MU": size})
        except UnsolvableError as refusal:
            assert "neither sign of MU agrees" in str(refusal)  # noqa: PT017
            alone = []
        for sign in (True, False):
            agreeing = [s for s in alone if (float(s["MUP"]) > 0) is sign]
            assert bool(agreeing) is (sign in masks and masks[sign][i])
            for solution in agreeing:
                assert float(found[sign]["UX"][i]) == pytest.approx(float(solution["UX"]))


def test_closed_form_reconstruction_over_arrays_agrees_with_the_general_solver() -> None:
    rng = np.random.default_rng(3)
    known = without(table_3(), *VELOCITIES)
    columns = {n: v * rng.uniform(0.9, 1.1, 200) for n, v in known.items()} | {"MUP": 0.3}
    (general,) = solve_for(columns)
    closed = initial_impact(columns)
    for name in (*VELOCITIES, "PN", "PT", "PM"):
        np.testing.assert_allclose(closed[name], general[name], rtol=1e-10, atol=1e-10)
    assert not np.isfinite(initial_impact(columns | {"MUP": -10.0})["UX"]).any()


# -- errors


def test_amplification_is_the_error_that_known_errors_make() -> None:
    known = without(table_3(), "UX", "VY", "WBF", *COEFFICIENTS)
    (found,) = solve_for(known)
    step = 1e-5
    squares = dict.fromkeys(found.unknown, 0.0)
    for name in (*VELOCITIES, *FINAL_STATE):
        if name not in known:
            continue
        unit = step / float(found.gyration) if name.startswith("W") else step
        up, down = (solve_for(known | {name: known[name] + s * unit})[0] for s in (1, -1))
        for wanted in found.unknown:
            change = float(up[wanted] - down[wanted]) / (2 * step)
            squares[wanted] += change**2
    closing = np.hypot(36.667, 58.667)
    for wanted, total in squares.items():
        scale = {"WBF": float(found.gyration), "UX": 1.0, "VY": 1.0}.get(wanted, closing)
        assert float(found.amplification[wanted]) == pytest.approx(scale * total**0.5, rel=1e-5)


def test_a_small_restitution_is_flagged_as_badly_conditioned() -> None:
    known = without(table_3(), *VELOCITIES)
    assert not solve_for(known)[0].badly_conditioned
    (found,) = solve_for(known | {"E": 0.005})
    assert found.badly_conditioned
    assert float(found.worst) == pytest.approx(1 / 0.005, rel=0.5)


def test_fewer_unknowns_than_equations_are_fitted_and_the_mismatch_told() -> None:
    complete = without(table_3(), *COEFFICIENTS)
    (exact,) = solve_for(complete)
    assert not exact.contradictory
    assert [float(exact[n]) for n in ("E", "MUP", "EM")] == pytest.approx([0.25, 0.89, -0.9])
    (fitted,) = solve_for(complete | {"VAX": -7.0})
    assert fitted.contradictory
    assert 0.01 < float(fitted.mismatch) < 1.0
    # least squares: moving any unknown makes the mismatch no smaller; here: of five velocities
    five = without(table_3(), "VAY", "WAF", "VBX", "VBY", "WBF") | {"VAX": -7.0}
    (fitted,) = solve_for(five)
    assert fitted.contradictory
    assert float(fitted["VAY"]) == pytest.approx(26.2, abs=0.05)


# -- properties

unit = st.floats(0.0, 1.0)


@st.composite
def impacts(draw: Any, point: bool = False) -> dict[str, float]:
    """A casework-like scene with the velocities after it; an approach, e and e_m off 0."""
    number = lambda low, high: low + (high - low) * draw(unit)  # noqa: E731
    scene = {
        **{name: number(0.5, 9.0) for name in ("DA", "DB")},
        **{name: number(-180.0, 180.0) for name in ("GA", "PA", "PB", "TA", "TB")},
        **{"MA": number(50.0, 200.0), "MB": number(50.0, 200.0)},
        **{"IA": number(900.0, 4500.0), "IB": number(900.0, 4500.0)},
        **{"E": number(0.1, 1.0), "MU": number(0.0, 0.9), "EM": number(-1.0, -0.1)},
        **{name: number(-80.0, 80.0) for name in ("UX", "UY", "VX", "VY")},
        **{name: number(-3.0, 3.0) for name in ("WA", "WB")},
        "M": 4.0 if point else 6.0,
    }
    after = solve(scene, (*FINAL_STATE, "MUP", "PN"))
    return scene | {name: float(value) for name, value in after.items()}


PROBLEMS = {
    "forward": FINAL_STATE,
    "reconstruction": VELOCITIES,
    "before of A, after of B": ("UX", "UY", "WA", "VBX", "VBY", "WBF"),
    "before of B, after of A": ("VX", "VY", "WB", "VAX", "VAY", "WAF"),
    "coefficients and three": ("UX", "VY", "WBF", *COEFFICIENTS),
    "coefficients and three after": ("VAX", "VBY", "WAF", *COEFFICIENTS),
    "e and five": ("E", "UX", "UY", "VBX", "VBY", "WBF"),
    "coefficients": COEFFICIENTS,
    "fewer": ("VAX", "VAY", "VBX"),
}


@pytest.mark.parametrize("problem", PROBLEMS)
@settings(max_examples=15)
@given(scene=impacts())
def test_every_problem_inverts_the_forward_solution(problem: str, scene: dict[str, float]) -> None:
    assume(np.isfinite([scene[n] for n in FINAL_STATE]).all())
    assume(abs(scene["PN"]) > 1.0)
    names = PROBLEMS[problem]
    expected = {name: scene[name] for name in names}
    known = {n: v for n, v in scene.items() if n not in (*names, "MU", "PN")}
    try:
        found = solve_for(known, names)[0]
    except UnsolvableError:
        # a scene may sit where a set is undetermined, but never for these problems
        assert problem not in ("forward", "reconstruction", "coefficients")
        assume(False)
    assume(float(found.worst) < 1e6)
    speed = max(abs(scene[n]) for n in (*VELOCITIES, *FINAL_STATE))
    tolerance = 1e-12 * max(1.0, float(found.worst)) * speed
    for name, value in expected.items():
        assert float(found[name]) == pytest.approx(value, abs=max(tolerance, 1e-12))
    assert max(residuals(scene | {n: float(v) for n, v in found.values.items()})) < 1e-9


SOLVABLE = [
    names
    for names in combinations((*VELOCITIES, *FINAL_STATE), 6)
    if not {*names} >= {*VELOCITIES[:3], *FINAL_STATE[:3]}
    and not {*names} >= {*VELOCITIES[3:], *FINAL_STATE[3:]}
]


@settings(max_examples=15)
@given(scene=impacts(), names=st.sampled_from(SOLVABLE))
def test_any_set_of_six_is_recovered_or_refused_as_its_rank_says(
    scene: dict[str, float], names: tuple[str, ...]
) -> None:
    assume(np.isfinite([scene[n] for n in FINAL_STATE]).all())
    known = {n: v for n, v in scene.items() if n not in (*names, "MU", "PN")}
    if not generically_solvable(names):
        with pytest.raises(UnsolvableError):
            solve_for(known, names)
        return
    try:
        (found,) = solve_for(known, names)
    except UnsolvableError:
        assume(False)
    assume(float(found.worst) < 1e6)
    assert max(residuals(scene | {n: float(v) for n, v in found.values.items()})) < 1e-9


@settings(max_examples=20)
@given(scene=impacts())
def test_momentum_and_angular_momentum_are_conserved(scene: dict[str, float]) -> None:
    assume(np.isfinite([scene[n] for n in FINAL_STATE]).all())
    known = {n: v for n, v in scene.items() if n not in (*FINAL_STATE, "MUP", "PN")}
    s = known | {n: float(v) for n, v in solve_for(known)[0].values.items()}
    speed = max(abs(s[n]) for n in (*VELOCITIES, *FINAL_STATE))
    for before, after in ((("UX", "VX"), ("VAX", "VBX")), (("UY", "VY"), ("VAY", "VBY"))):
        momentum = [s["MA"] * s[x[0]] + s["MB"] * s[x[1]] for x in (before, after)]
        assert momentum[0] == pytest.approx(momentum[1], abs=1e-11 * speed * (s["MA"] + s["MB"]))
    # angular momentum about the contact point, from each center of gravity's place
    place = {name: float(value) for name, value in outcome(s).items()}

    def angular(ax: str, ay: str, wa: str, bx: str, by: str, wb: str) -> float:
        a = s["MA"] * (-place["CAX"] * s[ay] + place["CAY"] * s[ax]) + s["IA"] * s[wa]
        b = s["MB"] * (-place["CBX"] * s[by] + place["CBY"] * s[bx]) + s["IB"] * s[wb]
        return a + b

    size = 1e-10 * speed * 10 * (s["MA"] + s["MB"])
    assert angular("UX", "UY", "WA", "VX", "VY", "WB") == pytest.approx(
        angular("VAX", "VAY", "WAF", "VBX", "VBY", "WBF"), abs=size
    )


@settings(max_examples=15)
@given(scene=impacts(point=True))
def test_point_masses_are_reconstructed_too(scene: dict[str, float]) -> None:
    names = ("UX", "UY", "VX", "VY")
    known = {n: v for n, v in scene.items() if n not in (*names, "MU", "PN", "EM")}
    (found,) = solve_for(known)
    assert set(found.unknown) == set(names)
    closed = initial_impact({**known, "EM": scene["EM"]})
    for name in names:
        tolerance = 1e-12 * float(found.worst) * 100
        assert float(found[name]) == pytest.approx(scene[name], abs=tolerance)
        assert float(closed[name]) == pytest.approx(scene[name], abs=tolerance)


def test_a_fit_of_contradictions_does_not_stand_beside_a_solution() -> None:
    """MU known in size: with one sign the values agree, with the other a least-squares fit does
    that contradicts them. Only the first is a solution; of fits alone both are given."""
    columns = scenes("casework", 60, 3)
    tried = 0
    for number in range(50, 60):
        scene = {name: float(values[number]) for name, values in columns.items()}
        scene["MU"] = abs(scene["MU"])
        whole = scene | {name: float(v) for name, v in solve(scene, FINAL_STATE).items()}
        known = {n: v for n, v in whole.items() if n not in ("UX", "UY", "WA", "VX", "VY")}
        try:
            solutions = solve_for(known)
        except UnsolvableError:
            continue
        tried += 1
        assert not any(solution.contradictory for solution in solutions)
        assert any(float(s["UX"]) == pytest.approx(scene["UX"], rel=1e-6) for s in solutions)
        fits = solve_for({**known, "VAX": known["VAX"] + 5.0})
        assert all(solution.contradictory for solution in fits)
    assert tried > 3


def test_rounding_prints_as_nothing_and_a_heading_is_above_minus_180() -> None:
    values = {**dict.fromkeys(("UY", "VS"), -2e-14), "UX": -40.0, "SA": 40.0, "HA": -180.0}
    clean = without_noise({**values, "E": 1e-12, "MB": 90.0})
    assert (clean["UY"], clean["VS"], clean["HA"]) == (0.0, 0.0, 180.0)
    assert clean["E"] == 1e-12  # a coefficient may be small


def test_equal_tolerances_are_velocities_at_the_radius_of_gyration() -> None:
    known = {name: fixed_value(float(text)) for name, text in sample(1).items() if name != "MU"}
    system = System(known, adjusted=False)
    equal = system.with_equal_tolerances().known
    assert equal["UX"].deviation == 1
    assert equal["WA"].deviation * system.gyration == pytest.approx(1)
    assert not equal["MA"].varies
