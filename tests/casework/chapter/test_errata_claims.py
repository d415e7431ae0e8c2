"""What ERRATA.md's fifth section says the program does, against what it prints."""

from __future__ import annotations

import re

import pytest

from impact88.casework.chapter.staged import collisions, forward
from impact88.casework.reconstruction.unknowns import solve_for
from impact88.collision.casescene import sample
from impact88.errors import UserError
from impact88.mechanics.closedform.solve import solve
from impact88.names import FINAL_STATE, VELOCITIES
from impact88.program.run import Run, run


def run1(**changes: str) -> Run:
    """The Appendix's first run with some values changed."""
    return run(sample(1).replaced(changes))


def printed(label: str, printout: str) -> list[float]:
    """The numbers printed after a label, in order."""
    return [float(text) for text in re.findall(rf"\b{label}= ?(-?[.\dE+-]+)", printout)]


def test_small_mass_units_end_in_zero_determinant() -> None:
    """Run 1 in units of 10^12 slug; line 1080's 1E-9 knows no units."""
    tiny = {"MA": "143.5E-12", "MB": "95.8E-12", "IA": "3728E-12", "IB": "1961E-12"}
    assert run1(**tiny).zero_determinant
    assert not run1().zero_determinant


def test_turning_the_normal_round_gains_energy() -> None:
    assert "KE LOSS= -40.98 %\n" in run1(GA="150").printout


def test_only_the_sign_typed_is_flipped() -> None:
    """Run 1's sliding leaves MU alone, so a negative one drives; with GA turned it is flipped."""
    assert printed("MU", run1(MU="-.911").printout) == [-0.911]
    assert printed("MU", run1(MU="-.911", GA="150").printout) == [0.911]
    assert printed("KE LOSS", run1(MU="-.911").printout) < printed("KE LOSS", run1().printout)


def test_without_sliding_the_typed_sign_stands() -> None:
    still = {"UY": "0", "VX": "0", "VY": "0", "GA": "0"}
    assert printed("MU", run1(MU=".5", **still).printout) == [0.5]
    assert printed("MU", run1(MU="-.5", **still).printout) == [-0.5]


def test_a_straight_head_on_is_solved_with_either_sign() -> None:
    straight = {"GA": "0", "PA": "20", "PB": "10", "TA": "0", "TB": "0", "E": ".1", "EM": "-.7"}
    straight |= {"UX": "-30", "UY": "0", "VX": "30", "VY": "0"}
    scene = sample(1).replaced({**straight, "MU": "0"}).numbers()
    assert float(solve(scene, "MUC")["MUC"]) == pytest.approx(0.161, abs=5e-4)
    for mu in (".3", "-.3"):
        done = run1(**straight, MU=mu)
        assert done.error is None
        assert printed("MU", done.printout) == [float(mu)]


def test_table_2_and_the_critical_friction() -> None:
    beyond = {
        collision.number: tuple(round(float(found[name]), 3) for name in ("MUP", "MUC"))
        for collision in collisions()
        if (found := forward(collision))["STATUS"]
    }
    assert set(beyond) == {3, 8, 9, 10, 11, 12}
    assert beyond[3] == (-0.069, -0.060)
    assert beyond[11] == (0.049, 0.029)
    assert beyond[12] == (-0.009, 0.024)


def test_spins_before_cannot_be_found_at_em_0() -> None:
    scene = sample(3).replaced({"EM": "0"}).numbers()
    after = {name: float(value) for name, value in solve(scene, (*FINAL_STATE, "MUP")).items()}
    known = {n: v for n, v in {**scene, **after}.items() if n not in (*VELOCITIES, "MU")}
    with pytest.raises(UserError):
        solve_for(known)


@pytest.mark.parametrize(
    ("typed", "ga", "zeroed"),
    [
        ("10", "150", True),  # flipped to -10
        ("10", "-30", False),
        ("-11", "-30", True),
        ("-11", "150", False),  # flipped to 11
    ],
)
def test_friction_of_minus_ten_or_less_loses_its_right_hand_side(
    typed: str, ga: str, zeroed: bool
) -> None:
    """Line 520 is reached though line 410 has filled the row: stopped just before line 540."""
    seen = []

    def after_line(line: int, names: object, *rest: object) -> None:
        seen.append(line)

    run(sample(1).replaced({"MU": typed, "GA": ga}), after_line=after_line)
    assert 410 in seen
    assert (520 in seen) is zeroed


def test_moment_coefficient_of_minus_one_reverses_no_spin() -> None:
    spins = {em: run1(EM=em).printout for em in ("-1", "0", "1")}
    relative = {em: printed("WA", p)[-1] - printed("WB", p)[-1] for em, p in spins.items()}
    assert relative["0"] == 0
    assert relative["-1"] * relative["1"] > 0


def test_point_masses_with_distances_print_velocities_that_mean_nothing() -> None:
    assert "(XA=4710.22 YA= 13129.6)" in run1(M="4").printout


def test_point_masses_with_spins_print_another_energy_loss() -> None:
    spinning = run1(M="4", DA="0", DB="0", WA="1").printout
    assert printed("VAX", spinning) == printed("VAX", run1(M="4", DA="0", DB="0").printout)
    assert "KE LOSS= 60.01 %" not in spinning


def test_no_motion_at_all_is_a_division_by_zero_in_690() -> None:
    still = dict.fromkeys(("UX", "UY", "WA", "VX", "VY", "WB"), "0")
    assert run1(**still).error == "?DIVISION BY ZERO ERROR IN 690"
