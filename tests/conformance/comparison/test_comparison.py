"""Comparing another program's results: what agrees, and what is wrong where it does not.

The programs compared are those of `wrongprograms`, which share no code with the
package. By default each mistake is looked for in one table; with IMPACT88_SWEEP=1 in several.
"""

from __future__ import annotations

import csv
import io
import json
import math
import os
import re
import warnings
from collections.abc import Sequence
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from installed import impact88
from wrongprograms import CATALOGUE, CONVENTIONS, Wrong, answers

from impact88.conformance.comparison import diagnosis
from impact88.conformance.comparison.agreement import read_theirs
from impact88.conformance.comparison.compare import Comparison, compare
from impact88.conformance.comparison.reasons import (
    NO_RESULT,
    NO_SCENE,
    NOTHING_HERE,
    NOTHING_THERE,
    REFUSED,
)
from impact88.conformance.comparison.tablehypotheses import (
    INFINITE,
    SINGLE,
    UNKNOWN,
    TableHypothesis,
)
from impact88.conformance.comparison.vectors import CASEWORK, FAILURE, scenes
from impact88.errors import UserError
from impact88.mechanics.accuracy import errorbound
from impact88.mechanics.closedform.solve import solve
from impact88.names import FINAL_VELOCITIES, SCENE
from impact88.program.replay import replay
from impact88.tables.cells import TableUnits
from impact88.tables.rows import Rows

ROWS = [scene for kind, _, scene in scenes(90, seed=11) if kind == CASEWORK]
MIXED = [scene for _, _, scene in scenes(45, seed=4)]
TEXTS = {name: [scene[name] for scene in ROWS] for name in SCENE}
NUMBERS = {name: np.array(list(map(float, column))) for name, column in TEXTS.items()}
OURS = {name: column.astype(float) for name, column in solve(NUMBERS).items()}
SWEEP = os.environ.get("IMPACT88_SWEEP")
RESULTS = (*FINAL_VELOCITIES, *"XAF YAF XBF YBF KI KF LOSS DVA DVB PN PT".split())
RIGHT = Wrong("on_a")
PLACE = "ax*s - ay*c, by*c - bx*s, -E*closing"
"""Of the restitution in that program."""


def table(results: dict[str, list[str]], rows: Sequence[dict[str, str]] = ROWS) -> str:
    """A CSV of scenes with another program's results."""
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow([*SCENE, *results])
    for index, scene in enumerate(rows):
        cells = [column[index] for column in results.values()]
        writer.writerow([*(scene[name] for name in SCENE), *cells])
    return out.getvalue()


def compared(tmp_path, results: dict[str, list[str]], rows=ROWS, **options) -> Comparison:
    path = tmp_path / "theirs.csv"
    path.write_text(table(results, rows), encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return compare(str(path), "csv", **options)


def answered(program: Wrong, rows=ROWS, names=RESULTS, places=None) -> dict[str, list[str]]:
    """What a program prints for scenes, every digit or so many places."""
    found = answers(rows, program.program, program.edits)
    if places is not None:
        found = {n: [t and f"{float(t):.{places}f}" for t in found[n]] for n in names}
    return {name: found[name] for name in names}


def exactly(found: dict[str, np.ndarray], names=FINAL_VELOCITIES) -> dict[str, list[str]]:
    return {name: list(map(repr, found[name].tolist())) for name in names}


def skipped(done: Comparison) -> dict[str, list[int]]:
    assert all(one.rows == len(one.first) for one in done.not_compared.values())
    return {reason: one.first for reason, one in done.not_compared.items()}


def main_cause(done: Comparison) -> str:
    """The cause named for nearly all rows that disagree."""
    cause, count = done.causes.most_common(1)[0]
    assert count >= 0.9 * done.differing, done.causes
    return cause


# --- what agrees -----------------------------------------------------------------------------


def test_our_own_results_agree_to_the_double(tmp_path) -> None:
    names = [name for name in OURS if name not in ("COND", "STATUS")]
    done = compared(tmp_path, exactly(OURS, names))
    assert (done.agreeing, done.differing) == (len(ROWS), 0)
    assert all(tally.double == tally.compared > 0 for tally in done.tallies.values())


def test_a_correct_elimination_in_double_precision_passes(tmp_path) -> None:
    """Every class of vectors; where elimination loses digits, that is told, and not as a fault."""
    rows = [scene for _, _, scene in scenes(300, seed=7)]
    done = compared(tmp_path, answered(RIGHT, rows), rows)
    assert done.differing == 0
    assert set(done.not_compared) <= {NO_RESULT}
    assert done.agreeing + done.not_compared[NO_RESULT].rows == len(rows)
    loose = done.elimination
    assert 0 < loose.rows < 0.1 * len(rows)
    assert float(rows[loose.worst_row - 1]["MB"]) < 1e-9 or loose.worst_relative < 1e-3
    assert done.silent == []


def test_more_than_elimination_loses_is_not_forgiven(tmp_path) -> None:
    found = answered(RIGHT)
    for factor, differing in ((1 + 4e-15, 0), (1 + 1e-10, 1)):
        row = int(np.argmax(np.abs(OURS["VAX"])))
        made = {name: list(column) for name, column in found.items()}
        made["VAX"][row] = repr(float(made["VAX"][row]) * factor)
        assert compared(tmp_path, made, causes=False).differing == differing


@pytest.mark.parametrize("places", [2, 5, 9])
def test_rounded_results_agree_to_the_digits_claimed(tmp_path, places: int) -> None:
    done = compared(tmp_path, answered(RIGHT, names=FINAL_VELOCITIES, places=places))
    assert done.differing == 0
    assert done.tallies["VAX"].digits > 0


NUMBER = st.one_of(
    st.just(""),
    st.sampled_from(
        ["\udfff", "½", "1.", "-.5", "+3", "-0.0", "007.50", "1E5", "1.25e-7", "3.e2", ".5E+3"]
    ),
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
    st.decimals(-9, 9, places=12).map(str),
)


@given(st.lists(NUMBER, min_size=1, max_size=9))
def test_plain_numbers_are_read_as_beside_a_cell_that_needs_a_closer_look(cells) -> None:
    units = TableUnits(["VAX"], None, None, ["VAX"], "")
    plain = read_theirs(Rows(len(cells), {"VAX": cells}), "VAX", units)
    closer = read_theirs(Rows(len(cells) + 1, {"VAX": [*cells, "n/a"]}), "VAX", units)
    for column, other in zip(plain, closer, strict=True):
        np.testing.assert_array_equal(column, other[:-1])


def test_a_tolerance_of_ones_own(tmp_path) -> None:
    made = {name: [repr(float(x) * (1 + 1e-6)) for x in OURS[name]] for name in FINAL_VELOCITIES}
    assert compared(tmp_path, made, causes=False).differing == len(ROWS)
    assert compared(tmp_path, made, rtol=2e-6, causes=False).differing == 0
    assert compared(tmp_path, made, rtol=1e-7, causes=False).differing > 0


@pytest.mark.parametrize("share", [1e-11, 1e-12])
def test_a_row_that_agrees_but_for_its_last_digits_is_given_no_cause(
    tmp_path, share: float
) -> None:
    """Its own numbers, to fewer digits, come before any other row's, and before any mistake."""
    signs = np.random.default_rng(5).choice((-1.0, 1.0), (len(FINAL_VELOCITIES), len(ROWS)))
    made = {
        n: OURS[n] * (1 + share * sign) for n, sign in zip(FINAL_VELOCITIES, signs, strict=True)
    }
    for columns in (made, {**OURS, "VAX": made["VAX"]}):
        done = compared(tmp_path, exactly(columns))
        assert done.differing > 0
        assert not done.programs
        assert all(re.fullmatch("agrees to 1[0-9] digits", cause) for cause in done.causes)
        assert "likely cause" not in done.summary


@pytest.mark.parametrize("text", ["inf", "-Infinity", "1.#INF"])
def test_an_infinite_number_is_an_answer_and_a_wrong_one(tmp_path, text: str) -> None:
    made = exactly(OURS)
    made["VAX"][:5] = [text] * 5
    done = compared(tmp_path, made)
    assert (done.agreeing, done.differing, done.silent) == (len(ROWS) - 5, 5, [])
    assert done.causes == {INFINITE: 5}
    json.dumps(done.as_json(), allow_nan=False)


# --- what is wrong ---------------------------------------------------------------------------


@pytest.mark.long
@pytest.mark.parametrize("what", CONVENTIONS if SWEEP else list(CONVENTIONS)[4:5])
def test_a_mistake_is_named(tmp_path, what: str) -> None:
    done = compared(tmp_path, answered(CONVENTIONS[what], MIXED), MIXED)
    says = "next step: its line in variants.txt or readings.txt of equations/"
    assert main_cause(done) == what, says
    assert done.evidence[0].agreeing <= done.agreeing


@pytest.mark.skipif(not SWEEP, reason="IMPACT88_SWEEP is not set")
@pytest.mark.parametrize("what", CONVENTIONS)
def test_a_mistake_is_named_in_other_tables(tmp_path, what: str) -> None:
    """Many rows, casework alone, few results with few digits; where it shows at all."""
    many = [scene for _, _, scene in scenes(1000, seed=7)]
    work = [scene for kind, _, scene in scenes(1000, seed=11) if kind == CASEWORK]
    for rows, names, places in (
        (many, RESULTS, None),
        (work, RESULTS, None),
        (many, FINAL_VELOCITIES, 3),
        (work[:100], ("VAX", "VAY", "WAF", "LOSS", "DVA", "KI"), 2),
    ):
        done = compared(tmp_path, answered(CONVENTIONS[what], rows, names, places), rows)
        if done.differing:
            assert main_cause(done) == what


@pytest.mark.long
def test_two_mistakes_in_one_table_are_both_named(tmp_path, monkeypatch) -> None:
    """Rows from one program, then rows from another."""
    if not SWEEP:  # no pair explains them, and to find that out takes long
        monkeypatch.setattr(diagnosis, "find_pairs", lambda *_: iter(()))
    one, other = "e squared", "masses exchanged"
    half = len(ROWS) // 2
    first, second = answered(CONVENTIONS[one]), answered(CONVENTIONS[other])
    made = {name: first[name][:half] + second[name][half:] for name in RESULTS}
    done = compared(tmp_path, made)
    assert set(done.causes) == {
        f"{one} in the rows up to row {half}",
        f"{other} in the rows after row {half}",
    }
    assert done.causes[f"{other} in the rows after row {half}"] == len(ROWS) - half


@pytest.mark.parametrize("is_contradicted", [False, True])
def test_rows_that_agree_speak_against_a_program(tmp_path, monkeypatch, is_contradicted) -> None:
    """It explains every row that disagrees: half of all. The other half it predicts, or not."""

    def fits(case):
        return case.wrong | (not is_contradicted)

    found = TableHypothesis("a mistake", fits, cost=10.0)
    monkeypatch.setattr(diagnosis.Diagnosis, "_programs", lambda _: iter([found]))
    odd = np.arange(len(ROWS)) % 2
    done = compared(tmp_path, exactly({name: OURS[name] + odd for name in FINAL_VELOCITIES}))
    says = UNKNOWN if is_contradicted else "a mistake"
    assert all(cause.startswith(says) for cause in done.causes), done.causes


@pytest.mark.long
def test_a_program_that_most_rows_contradict_is_not_named(tmp_path, monkeypatch) -> None:
    """A third of the rows from a program with a mistake, the rest from none: numbers by chance."""
    monkeypatch.setattr(diagnosis, "find_pairs", lambda *_: iter(()))
    monkeypatch.setattr(diagnosis, "MAX_SECONDS", 0.0)  # no second mistake is looked for
    rng = np.random.default_rng(4)
    squared = answered(CONVENTIONS["e squared"], names=FINAL_VELOCITIES)
    is_squared = rng.random(len(ROWS)) < 1 / 3
    made = {
        name: [
            text if is_known else repr(float(text) + rng.normal())
            for text, is_known in zip(column, is_squared, strict=True)
        ]
        for name, column in squared.items()
    }
    done = compared(tmp_path, made)
    assert not done.programs
    assert all(cause.startswith(UNKNOWN) for cause in done.causes)


IN_ONE_EQUATION = {
    "cosine of Γ .* and the sine of Γ .* exchanged in .*Equation 15": (
        (PLACE, "ax*c - ay*s, by*s - bx*c, -E*(dvx*s + dvy*c)"),
        ("[c, s, -c, -s, ax", "[s, c, -s, -c, ax"),
    ),
    r"B's inertia \(ib\) has the wrong sign in .*Equation 17": (
        ("0, 0, ia, ib, hx*vax", "0, 0, ia, -ib, hx*vax"),
        ("+ ia*wa + ib*wb]", "+ ia*wa - ib*wb]"),
    ),
    r"ib\*WB is left out in .*Equation 17": (("+ ia*wa + ib*wb]", "+ ia*wa]"),),
}
"""What is said -> edits."""


@pytest.mark.parametrize("says", list(IN_ONE_EQUATION)[: None if SWEEP else 1])
@pytest.mark.long
def test_a_mistake_in_one_equation_is_named(tmp_path, says: str) -> None:
    program = Wrong("on_a", IN_ONE_EQUATION[says])
    done = compared(tmp_path, answered(program, names=FINAL_VELOCITIES))
    assert re.search(says, main_cause(done))
    (evidence,) = done.evidence
    assert evidence.explains == evidence.disagreeing == done.differing
    assert evidence.fits == evidence.agreeing == done.agreeing
    assert done.unexplained == {}


BUGS = [*CATALOGUE["bugs"], *CATALOGUE["pairs of bugs"]]


@pytest.mark.parametrize("which", BUGS if SWEEP else BUGS[-1:], ids=str)
@pytest.mark.long
def test_a_bug_written_before_the_search_is_named(tmp_path, which: Wrong) -> None:
    """The program named gives the bug's final velocities in scenes that the table does not have.
    With IMPACT88_SWEEP, all are looked for: at most one in fifty may be named wrongly (`-s` shows
    what is said)."""
    rows = [scene for _, _, scene in scenes(240 if SWEEP else 90, seed=4)]
    done = compared(tmp_path, answers(rows, which.program, which.edits), rows)
    print(main_cause(done))
    fresh = [scene for kind, _, scene in scenes(300, seed=99) if kind != FAILURE]
    numbers = {name: np.array([float(scene[name]) for scene in fresh]) for name in SCENE}
    mine = done.programs[0].results(numbers)
    theirs = answers(fresh, which.program, which.edits)
    for name in FINAL_VELOCITIES:
        column = np.array([float(text) if text else math.nan for text in theirs[name]])
        off = np.abs(mine[name] - column) > 1e-6 * (1 + np.abs(column))
        assert off.mean() <= 0.03


SQUARED = CONVENTIONS["e squared"].edits
TWO_CONVENTIONS = [
    ("e squared", "final spins in degrees per unit of time"),
    ("inertias halved", "final velocities converted, ft/s to mph"),
]


@pytest.mark.parametrize("says", TWO_CONVENTIONS[: None if SWEEP else 1])
@pytest.mark.long
def test_two_mistakes_in_one_program_are_both_named(tmp_path, says) -> None:
    first, second = (CONVENTIONS[one].edits for one in says)
    done = compared(tmp_path, answered(Wrong("on_a", first + second), names=FINAL_VELOCITIES))
    assert set(main_cause(done).split("; and ")) == set(says)


@pytest.mark.skipif(not SWEEP, reason="IMPACT88_SWEEP is not set")
def test_three_mistakes_are_not_called_two(tmp_path) -> None:
    others = ("def run(g):", 'def run(g):\n    g = {**g, "WA": 0.0, "WB": 0.0, "GA": -g["GA"]}')
    program = Wrong("on_a", (*SQUARED, others))
    done = compared(tmp_path, answered(program, names=FINAL_VELOCITIES))
    unknown = sum(n for cause, n in done.causes.items() if cause.startswith(UNKNOWN))
    assert unknown >= 0.9 * done.differing, done.causes


@pytest.mark.long
def test_rows_shifted_are_named(tmp_path) -> None:
    rows = [ROWS[-1], *ROWS[:-1]]
    done = compared(tmp_path, answered(RIGHT, rows, FINAL_VELOCITIES))
    assert main_cause(done) == "the scene of the row before"


@pytest.mark.long
def test_an_unknown_mistake_gets_the_equations_it_violates(tmp_path) -> None:
    odd = Wrong("on_a", (("-E*closing", "-(E**3/2 + 0.01*abs(vax))*closing"),))
    done = compared(tmp_path, answered(odd, names=FINAL_VELOCITIES))
    assert main_cause(done) == f"{UNKNOWN}, but only Equation 15 is violated"
    broken = {number for number, (_, violated) in done.equations.items() if violated}
    assert broken == {"15"}
    assert done.equations["15"] == (len(ROWS), len(ROWS))
    kinds = done.unexplained.values()
    assert sum(kind.rows for kind in kinds) == len(ROWS)
    assert all(kind.violated == {"15": kind.rows} for kind in kinds)


@pytest.mark.long
def test_noise_is_given_no_cause(tmp_path) -> None:
    rng = np.random.default_rng(1)
    if SWEEP:
        noise = {name: OURS[name] * rng.normal(1, 0.3, len(ROWS)) for name in FINAL_VELOCITIES}
        done = compared(tmp_path, exactly(noise))
        assert all(cause.startswith(UNKNOWN) for cause in done.causes), done.causes
    slight = {name: OURS[name] + 1e-5 * rng.normal(size=len(ROWS)) for name in FINAL_VELOCITIES}
    done = compared(tmp_path, exactly(slight))
    assert all(cause.startswith(UNKNOWN) for cause in done.causes), done.causes


def test_point_masses_need_no_inertias_to_be_explained(tmp_path, monkeypatch) -> None:
    """The 1988 program cannot be run on such rows, to see whether the numbers are its own."""
    monkeypatch.setattr(diagnosis.Diagnosis, "_programs", lambda _: iter(()))
    light = {"M": "4", "DA": "0", "DB": "0", "IA": "", "IB": ""}
    done = compared(tmp_path, {"VAX": ["1", "2"]}, [{**scene, **light} for scene in ROWS[:2]])
    assert (done.differing, done.bad) == (2, [])


@pytest.mark.long
def test_one_wrong_cell_is_no_convention(tmp_path) -> None:
    """A number to one decimal is met by chance by some slip among hundreds: it names none."""
    found = answered(RIGHT, names=("VAX",), places=1)
    found["VAX"][5] = f"{float(found['VAX'][5]) + 2.3:.1f}"
    done = compared(tmp_path, found)
    assert done.differing == 1
    assert next(iter(done.causes)).startswith(UNKNOWN)


def test_printed_digits_floors_and_cuts_are_told_apart(tmp_path) -> None:
    replayed = replay(TEXTS)
    printed = {name: replayed.printed(name).tolist() for name in ("XA", "YA", "XB", "VAX", "VBY")}
    done = compared(tmp_path, printed)
    assert set(done.causes) == {"digits of the 1988 printout, which floors"}
    names = ("VAX", "VAY", "VBX", "VBY")
    for cut, says in ((math.floor, "floored"), (math.trunc, "cut off")):
        made = {name: [f"{cut(x * 1e5) / 1e5:.5f}" for x in OURS[name]] for name in names}
        done = compared(tmp_path, made)
        assert done.differing > 0
        assert all(one.startswith(says) or one.startswith("floored") for one in done.causes)
        assert any(one.startswith(says) for one in done.causes)


@pytest.mark.long
def test_the_pi_of_the_listing_is_recognised(tmp_path) -> None:
    listing = Wrong("on_a", (("(radians(g[n]) for", "(g[n]*3.14159265/180 for"),))
    assert "3.14159265" in main_cause(compared(tmp_path, answered(listing)))


@pytest.mark.long
def test_rounding_the_results_alone_is_no_single_precision_arithmetic_but_named_so(
    tmp_path,
) -> None:
    single = {name: [repr(float(np.float32(x))) for x in OURS[name]] for name in FINAL_VELOCITIES}
    assert main_cause(compared(tmp_path, single)) == SINGLE


# --- nothing in silence ----------------------------------------------------------------------


def test_what_is_not_compared_is_named(tmp_path) -> None:
    rows = [*ROWS[:4], {**ROWS[4], "IA": "0"}, {**ROWS[5], "MA": "0"}]
    found = {name: list(column) for name, column in answered(RIGHT, rows).items()}
    for name in RESULTS:
        found[name][1] = ""
        found[name][5] = "1"
    found["KI"][2] = ""
    more = {"vax": found["VAX"], "VAY_mph": found["VAY"], "mood": ["x"] * len(rows)}
    done = compared(tmp_path, {**found, **more}, rows)
    assert skipped(done) == {NO_RESULT: [5], NO_SCENE: [6], NOTHING_THERE: [2]}
    assert done.summary.startswith("6 rows: 3 agree, 0 disagree, 1 refused, 2 not compared")
    assert done.unknown == {"vax": "VAX", "VAY_mph": "VAY", "mood": ""}
    assert done.tallies["KI"].missing == 1
    assert len(done.silent) == 6
    assert done.agreeing == 3


def test_a_scene_that_is_none_is_named_by_its_label(tmp_path) -> None:
    singular = {**ROWS[3], "EM": "0.5", "DA": "0", "DB": "0"}
    rows = [ROWS[0], {**ROWS[1], "MA": "-1"}, {**ROWS[2], "IB": "-5"}, singular]
    found = {name: list(column) for name, column in answered(RIGHT, rows).items()}
    for name in FINAL_VELOCITIES:
        found[name][1:] = ["1"] * 3
    found = {name: found[name] for name in FINAL_VELOCITIES}
    done = compared(tmp_path, {**found, "label": ["usual", "MA < 0", "IB < 0", "EM"]}, rows)
    assert skipped(done) == {NO_SCENE: [2, 3], NOTHING_HERE: [4]}
    assert done.not_compared[NO_SCENE].labels == ["MA < 0", "IB < 0"]


def test_a_program_may_refuse_a_failure_and_nothing_else(tmp_path) -> None:
    found = {name: list(column) for name, column in answered(RIGHT).items()}
    for name in RESULTS:
        found[name][0] = found[name][1] = ""
    kinds = ["failure", "casework", *["edge"] * (len(ROWS) - 2)]
    done = compared(tmp_path, {**found, "class": kinds})
    assert skipped(done) == {REFUSED: [1], NOTHING_THERE: [2]}
    assert len(done.silent) == 1


def test_strict_makes_silence_a_failure(tmp_path) -> None:
    path = tmp_path / "theirs.csv"
    found = answered(RIGHT)
    path.write_text(table({**found, "note": ["x"] * len(ROWS)}), encoding="utf-8")
    done = impact88("compare", str(path))
    assert done.returncode == 0
    assert "column note is not recognised" in done.stderr
    assert impact88("compare", str(path), "--strict").returncode == 1
    path.write_text(table(found), encoding="utf-8")
    done = impact88("compare", str(path), "--strict")
    assert (done.returncode, done.stderr) == (0, "")


def test_worst_rows_come_first(tmp_path) -> None:
    made = exactly(OURS)
    made["VAX"][3] = repr(float(OURS["VAX"][3]) * 1.5)
    made["VBY"][7] = repr(float(OURS["VBY"][7]) + 1e-6)
    done = compared(tmp_path, made, causes=False)
    assert [one.row for one in done.worst] == [4, 8]
    assert (done.worst[0].result, done.worst[0].line) == ("VAX", 5)


def test_command_and_junit(tmp_path) -> None:
    path, junit = tmp_path / "theirs.jsonl", tmp_path / "junit.xml"
    lines = [
        {**scene, "id": index, "VAX": repr(float(OURS["VAX"][index])), "note": "x"}
        for index, scene in enumerate(ROWS[:3])
    ]
    path.write_text("\n".join(map(json.dumps, lines)) + "\n", encoding="utf-8")
    done = impact88("compare", str(path), "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["unknown_columns"] == {"note": ""}
    lines[1]["VAX"] = "12.345"
    path.write_text("\n".join(map(json.dumps, lines)) + "\nrubbish\n", encoding="utf-8")
    done = impact88("compare", str(path), "--no-causes", "--junit", str(junit))
    assert done.returncode == 1
    assert "row 2 (line 2), id 1: VAX 12.345" in done.stdout
    assert "row 4 (line 4)" in done.stderr
    suite = ElementTree.parse(junit).getroot()
    assert (suite.get("failures"), suite.get("errors")) == ("1", "1")
    (failure,) = suite.findall("testcase/failure")
    assert "VAX 12.345" in failure.get("message", "")


def test_a_table_without_results_is_refused(tmp_path) -> None:
    with pytest.raises(UserError, match="no column of results"):
        compared(tmp_path, {})
    with pytest.raises(UserError, match="VAX_mph for VAX"):
        compared(tmp_path, {"VAX_mph": ["1"] * len(ROWS)})
    done = impact88("compare", "x.csv", "--rtol", "2")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)


def test_bounds_are_those_of_the_condition(tmp_path) -> None:
    """The share of the double's bound is the same here and in the oracle's answers."""
    done = compared(tmp_path, exactly(OURS))
    assert done.elimination.rows == 0
    assert errorbound.relative_bounds(OURS["COND"]).max() < 1e-9


# --- what is not a number -----------------------------------------------------------------------


def test_refusals_in_the_words_of_other_languages(tmp_path) -> None:
    words = ["-nan", "nan(ind)", "-nan(ind)", "#DIV/0!", "#NUM!", "#N/A", "NaN", "Infinity", "-inf"]
    rows = [{**scene, "IA": "0"} for scene in ROWS[: len(words)]]
    found = {name: [*words, repr(float(OURS[name][-1]))] for name in FINAL_VELOCITIES}
    done = compared(tmp_path, found, [*rows, ROWS[-1]], causes=False)
    assert skipped(done) == {NO_RESULT: [*range(1, len(words) + 1)]}
    assert (done.bad, done.silent, done.agreeing) == ([], [], 1)
    found["VAX"][0] = "heavy"
    assert len(compared(tmp_path, found, [*rows, ROWS[-1]], causes=False).bad) == 1


def test_a_spin_of_ours_that_is_zero_is_measured_finitely(tmp_path) -> None:
    rest = dict.fromkeys(("UX", "UY", "VX", "VY", "WA", "WB", "DA", "DB"), "0")
    rows = [{**ROWS[0], **rest}, *ROWS[1:]]
    found = exactly(OURS)
    for name in FINAL_VELOCITIES:
        found[name][0] = "0" if name != "WAF" else "0.25"
    done = compared(tmp_path, found, rows, causes=False)
    assert (done.differing, done.tallies["WAF"].largest) == (1, 1.0)
    json.dumps(done.as_json(), allow_nan=False)


def test_a_wrong_critical_friction_is_a_difference(tmp_path) -> None:
    for names in (("MUC",), (*FINAL_VELOCITIES, "MUC")):
        made = exactly(OURS, names)
        made["MUC"] = [repr(float(x) * 1.01) for x in OURS["MUC"]]
        assert compared(tmp_path, made).differing == len(ROWS)


def test_formulas_never_computed_are_named(tmp_path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append([*SCENE, "VAX"])
    book.active.append([*(float(ROWS[0][name]) for name in SCENE), "=O2*2"])
    book.save(tmp_path / "theirs.xlsx")
    done = impact88("compare", str(tmp_path / "theirs.xlsx"))
    assert done.returncode == 2
    assert "V2 has a formula that was never computed" in done.stderr


@pytest.mark.parametrize(
    "wrong",
    [{"format": 5}, {"format": "pdf"}, {"values": 3}, {"rtol": "x"}, {"rtol": 2}, {"encoding": 7},
     {"units": 5}],
    ids=str,
)  # fmt: skip
def test_arguments_of_the_wrong_kind_are_said(tmp_path, wrong: dict) -> None:
    path = tmp_path / "theirs.csv"
    path.write_text(table(exactly(OURS)), encoding="utf-8")
    with pytest.raises(UserError):
        compare(path, **wrong)
    for nothing in (None, 5, b"x"):
        with pytest.raises(UserError):
            compare(nothing)  # type: ignore[arg-type]
