"""Equations 1-12: the direct colinear impact, forward and inverse."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference_cases import Case, cases_of

from impact88 import colinear, colinear_inverse, solve
from impact88.casework.chapter.colinear import FINAL, INITIAL
from impact88.errors import UserError

NAMES = {
    **{"ma": "MA", "mb": "MB", "e": "E", "mu": "MUP"},
    **{"van": "UN", "vat": "UT", "vbn": "VN", "vbt": "VT"},
    **{"Van": "VAN", "Vat": "VAT", "Vbn": "VBN", "Vbt": "VBT"},
}

masses = st.floats(10.0, 1000.0)
speeds = st.floats(-100.0, 100.0)
scenes = st.fixed_dictionaries(
    {"MA": masses, "MB": masses, "E": st.floats(0.05, 1.0), "MUP": st.floats(-1.0, 1.0)}
    | dict.fromkeys(INITIAL, speeds)
)


@pytest.mark.parametrize("case", cases_of("colinear"), ids=str)
def test_reference_cases_to_1e_12(case: Case) -> None:
    given = {NAMES[key]: value for key, value in case.given.items()}
    inverse = "inverse" in case.kind
    found = (colinear_inverse if inverse else colinear)(given)
    largest = max(abs(float(value)) for value in case.result.values())
    condition = 1 / given["E"] if inverse else 1.0
    for key, text in case.result.items():
        error = abs(float(found[NAMES[key]]) - float(text))
        assert error <= 1e-12 * condition * largest


@given(scenes)
def test_the_inverse_undoes_the_forward_solution(scene: dict[str, float]) -> None:
    forward = colinear(scene)
    common = {name: scene[name] for name in ("MA", "MB", "E", "MUP")}
    back = colinear_inverse(common | {name: forward[name] for name in FINAL})
    for name in INITIAL:
        assert float(back[name]) == pytest.approx(scene[name], abs=1e-10 / scene["E"])
    for name in ("PN", "PT", "DVA", "DVB", "KI", "KF"):
        assert float(back[name]) == pytest.approx(float(forward[name]), rel=1e-8, abs=1e-6)


@given(scenes)
def test_equations_1_to_8_hold(scene: dict[str, float]) -> None:
    s = scene | {name: float(value) for name, value in colinear(scene).items()}
    size = 1e-11 * (s["MA"] + s["MB"]) * 200
    assert s["MA"] * (s["VAN"] - s["UN"]) == pytest.approx(s["PN"], abs=size)
    assert s["MA"] * (s["VAT"] - s["UT"]) == pytest.approx(s["PT"], abs=size)
    assert s["MB"] * (s["VBN"] - s["VN"]) == pytest.approx(-s["PN"], abs=size)
    assert s["MB"] * (s["VBT"] - s["VT"]) == pytest.approx(-s["PT"], abs=size)
    assert s["VAN"] - s["VBN"] == pytest.approx(-s["E"] * (s["UN"] - s["VN"]), abs=1e-9)
    friction = s["MUP"] * s["MB"] * (s["VBN"] - s["VN"]) + s["MA"] * (s["VAT"] - s["UT"])
    assert friction == pytest.approx(0.0, abs=size)


@given(scenes)
def test_it_is_the_point_mass_impact_with_the_contact_plane_along_y(
    scene: dict[str, float],
) -> None:
    found = {name: float(value) for name, value in colinear(scene).items()}
    mu = -scene["MUP"] if scene["UT"] - scene["VT"] > 0 else scene["MUP"]
    columns = {"M": 4, "GA": 0, "MA": scene["MA"], "MB": scene["MB"], "E": scene["E"], "MU": mu}
    columns |= {"UX": scene["UN"], "UY": scene["UT"], "VX": scene["VN"], "VY": scene["VT"]}
    names = ("VAX", "VAY", "VBX", "VBY", "LOSS", "MUC", "DVA", "DVB", "PN", "PT")
    planar = solve({**columns, "WA": 0, "WB": 0}, names)
    ours = ("VAN", "VAT", "VBN", "VBT", *names[4:])
    for mine, theirs in zip(ours, names, strict=True):
        if np.isfinite(found[mine]) and abs(scene["UN"] - scene["VN"]) > 1e-3:
            assert found[mine] == pytest.approx(float(planar[theirs]), rel=1e-8, abs=1e-8)


def test_arrays_broadcast_and_e_0_is_nan_among_others_but_refused_alone() -> None:
    given = {"MA": 100.0, "MB": np.array([50.0, 100.0, 200.0]), "MUP": 0.0}
    given |= {"VAN": -3.0, "VAT": 0.0, "VBN": -3.5, "VBT": 0.0}
    found = colinear_inverse({**given, "E": np.array([0.1, 0.0, 0.2])})
    assert np.isfinite(found["UN"]).tolist() == [True, False, True]
    alone = colinear_inverse({**given, "E": 0.2, "MB": 200.0})
    assert found["UN"][2] == alone["UN"]
    with pytest.raises(UserError, match="E = 0"):
        colinear_inverse({**given, "E": 0.0})
