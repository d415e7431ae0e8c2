"""The verdict on the evidence: probabilities by simulation, what is at odds by leaving it out."""

import json
import math
import re

import numpy as np
import pytest

from impact88.casework.reconstruction.adjustment import reconstruct
from impact88.casework.reconstruction.answer import Answer
from impact88.casework.reconstruction.answerremarks import remarks_on
from impact88.casework.reconstruction.evidence import ROUNDED, chi_square_tail, weigh
from impact88.collision.casescene import sample
from impact88.collision.uncertain import Uncertain, fixed_value
from impact88.interface.commands.cli import main
from impact88.mechanics.closedform.solve import solve

SCENE = {name: float(text) for name, text in sample(1).items()}
MEASURED = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")
UNKNOWN = ("UX", "VY", "MU", "E", "EM")


def known_with(errors):
    """The final velocities of the first published run, each in error by so many deviations of
    1 (spins .05), three initial velocities and nothing else but the vehicles."""
    after = solve(SCENE, MEASURED)
    known = {n: fixed_value(v) for n, v in SCENE.items() if n not in UNKNOWN}
    for name, error in zip(MEASURED, errors, strict=True):
        sd = 0.05 if name in ("WAF", "WBF") else 1.0
        value = float(after[name]) + error * sd
        known[name] = Uncertain("normal", value, -math.inf, math.inf, sd)
    return known


@pytest.mark.parametrize("freedom", [1, 2, 3, 4, 7, 10])
def test_probability_is_that_of_simulated_sums(freedom):
    sums = np.square(np.random.default_rng(1988).standard_normal((100_000, freedom))).sum(axis=1)
    for squares in (0.1, 1.0, 3.0, 9.0, 20.0):
        share = float((sums >= squares).mean())
        assert chi_square_tail(squares, freedom) == pytest.approx(share, abs=0.006)


@pytest.mark.long
def test_true_measurements_are_hardly_ever_accused_and_false_ones_are():
    rng = np.random.default_rng(42)
    verdicts = []
    for _ in range(40):
        errors = rng.standard_normal(6)
        verdicts.append(reconstruct(known_with(errors))[0].evidence.verdict)
    assert "contradict" not in verdicts
    assert verdicts.count("agree poorly") <= 6
    for at in range(6):
        errors = np.zeros(6)
        errors[at] = 25.0
        evidence = reconstruct(known_with(errors))[0].evidence
        # what cannot be seen in the redundancy cannot be accused
        if evidence.squares > 30:
            assert evidence.contradictory


def test_the_value_at_odds_is_the_one_whose_absence_lessens_the_sum_most():
    errors = np.array([0.5, -1.0, 0.3, 0.2, -12.0, 0.4])
    known = known_with(errors)
    whole = reconstruct(known)[0]
    gains = {}
    for name in MEASURED:
        rest = reconstruct({n: v for n, v in known.items() if n != name})[0]
        gains[name] = whole.squares - rest.squares
    worst = whole.evidence.at_odds[0]
    assert worst.name in [n for n, gain in gains.items() if gain > 0.9 * max(gains.values())]
    assert worst.residual**2 == pytest.approx(gains[worst.name], rel=0.05)


def test_without_redundancy_nothing_is_called_checked():
    known = {n: v for n, v in known_with(np.zeros(6)).items() if n not in ("WBF",)}
    evidence = reconstruct(known)[0].evidence
    assert evidence.verdict == "not checked"
    assert "no measurement tests another" in evidence.text()


def test_verdict_comes_first_and_deviations_are_widened(tmp_path, capsys):
    (tmp_path / "a.toml").write_text(
        "".join(
            f'{n} = "{"normal " if x.varies else ""}{x.nominal!r}'
            f'{f" {x.deviation}" if x.varies else ""}"\n'
            for n, x in known_with([0, 0, 0, 0, 40.0, 0]).items()
        )
    )
    main(["reconstruct", str(tmp_path / "a.toml"), "--samples", "0"])
    text = capsys.readouterr().out
    assert re.search("^EVIDENCE +these measurements contradict one another; together", text, re.M)
    main(["reconstruct", str(tmp_path / "a.toml"), "--samples", "0", "--json"])
    (record,) = json.loads(capsys.readouterr().out)["solutions"]
    evidence = record["evidence"]
    assert evidence["verdict"] == "contradict"
    assert evidence["most_at_odds"][0]["name"] in {row["name"] for row in record["adjusted"]}
    (solution,) = reconstruct(known_with([0, 0, 0, 0, 40.0, 0]))
    shown = Answer(solution, 0).deviations
    plain = solution.deviations([*shown])
    factor = math.sqrt(solution.squares / solution.redundancy)
    for name, value in shown.items():
        assert value == pytest.approx(plain[name] * factor, rel=1e-9)


def test_a_search_for_draws_that_finds_nothing_accuses_nobody(monkeypatch):
    """An impact within all limits was found: that draws were not is no contradiction."""
    from impact88.casework.reconstruction.posterior import Posterior

    known = {n: v for n, v in sample(1).items() if n not in ("UX", "MU")}
    known |= {"MUP": "0.911", "VAX": "-13.3 +- 1", "VBX": "-9 +- 3", "VBY": "20 +- 3"}
    monkeypatch.setattr(Posterior, "sample", lambda *_: None)
    for off, contradictory in ((0.0, False), (40.0, True)):
        own = {**known, "VBX": f"{-9 + off} +- 3"}
        found = Answer(reconstruct(own)[0], 100)
        assert found.evidence.contradictory == contradictory
        lines = " ".join(remarks_on(found))
        assert ("found none there" in lines) != contradictory


@pytest.mark.parametrize("is_exact", [True, False])
def test_deviations_are_those_of_the_misfit_of_exact_values(is_exact):
    """Also of values that miss one another by rounding alone; tolerances are widened by a
    contradiction only."""
    values = {"UX": (30.0, 30.01, 0.01, 0.5)}
    evidence = weigh(4 * 0.01**2, 4, values, exact=is_exact, speed=0.03 / ROUNDED)
    assert not evidence.contradictory
    assert evidence.widening == pytest.approx(0.01 if is_exact else 1.0)


def test_amounts_of_the_verdict_are_written_out():
    """No exponent for an energy, no probability smaller than tolerances can mean, the unit with
    both amounts, and what was exact was given, not measured."""
    from impact88.casework.reconstruction.evidence import weigh
    from impact88.collision.units import SYSTEMS

    energy = {"EL": (4e5, 205_812.0, -9.0, 0.5), "HAF": (140.0, 156.6, 2.0, 0.5)}
    text = weigh(1470.2, 2, energy).text(SYSTEMS["us"])
    assert (
        "kinetic energy lost EL (400,000 ft-lb measured, 11,620 ft-lb by the others, 18 sd" in text
    )
    assert "1,470 where about 2 is expected; probability below 1e-12" in text
    text = weigh(1470.2, 2, energy, exact=True).text(SYSTEMS["us"])
    assert "(400,000 ft-lb given, " in text
    text = weigh(14.0, 2, {"HAF": (140.0, 156.6, 2.0, 0.5)}).text(SYSTEMS["us"])
    assert "course of A after impact HAF (140° measured, 173.2° by the others, 4 sd away)" in text
