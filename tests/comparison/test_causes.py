"""The mistake of another program is named as the edit to undo, or none is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from otherprograms import answers

import impact88
from impact88.comparison import constants, diagnosis
from impact88.comparison.evaluation import Edit, Program
from impact88.comparison.kit import frozen_vectors
from impact88.comparison.mutants import describe, models, sites
from impact88.comparison.spellings import COLUMNS, NAMES, VELOCITIES

long = pytest.mark.long
TEXTS = [v["scene"] for v in frozen_vectors() if v["class"] != "failure"][:240]
SCENE = {name: np.array([float(scene[name]) for scene in TEXTS]) for name in COLUMNS}


def table_of(program: str, *edits: tuple[str, str], digits: str = "") -> dict[str, Any]:
    """Return what a program with edits answers, beside the scenes."""
    theirs = {n: np.array(c) for n, c in answers(TEXTS, program, edits).items()}
    if digits:
        theirs = {
            name: np.array([digits % float(x) if x else "" for x in column])
            for name, column in theirs.items()
        }
    return {**SCENE, **theirs}


def right_table(names: tuple[str, ...] = VELOCITIES) -> dict[str, np.ndarray]:
    return {**SCENE, **impact88.solve(SCENE, names)}


class TestMistakes:
    @pytest.mark.parametrize(
        ("program", "edit", "words"),
        [
            ("impulse", ("rn = -(1 + E)*gn + k", "rn = -(1 + E)*gn - k"), "restitution"),
            pytest.param(
                "on_a",
                ("slip = dvy*c - dvx*s", "slip = dvy*c + dvx*s"),
                "sliding velocity",
                marks=long,
            ),
            pytest.param(
                "jacobian",
                ("rhs[0] = -(1 + e)*u[0]", "rhs[0] = -(1 - e)*u[0]"),
                "1 - E, should be 1 + E",
                marks=long,
            ),
            pytest.param("four", ("sliding > 0", "sliding < 0"), "sign rule", marks=long),
        ],
    )
    def test_an_edit_of_the_velocities_is_named(
        self, program: str, edit: tuple[str, str], words: str
    ) -> None:
        comparison = impact88.compare(table_of(program, edit))
        (cause, *_) = comparison.causes
        assert words in " ".join([cause.edit, *cause.alternatives])
        assert cause.rows >= 0.96 * cause.of

    @pytest.mark.parametrize(
        ("edit", "results", "words"),
        [
            (("LOSS = 100*(KI - KF)/KI", "LOSS = 100*(KI - KF)/KF"), ("LOSS",), "KF"),
            (("0.5*ib*WBF**2", "0.5*ia*WBF**2"), ("KF", "LOSS"), "ia, should be ib"),
            (("VBX - vbx, VBY", "VBX - vax, VBY"), ("DVB",), "UX, should be VX"),
            (("VBX - vbx, VBY - vby", "VBX - vax, VBY - vay"), ("DVB",), "VBX - UX, VBY - UY"),
        ],
    )
    def test_an_edit_of_a_result_is_named(
        self, edit: tuple[str, str], results: tuple[str, ...], words: str
    ) -> None:
        comparison = impact88.compare(table_of("on_a", edit))
        (cause,) = comparison.causes
        assert cause.results == results
        assert words in " ".join([cause.edit, *cause.alternatives])

    @pytest.mark.parametrize(
        ("results", "edit"),
        [
            ({"VC": lambda x: -x["VC"]}, "VC with the opposite sign, as shown"),
            ({"DVB": lambda x: x["DVA"]}, "DVA in place of DVB, as shown"),
        ],
    )
    def test_a_result_is_computed_from_more_digits_than_are_shown(
        self, results: dict[str, Any], edit: str
    ) -> None:
        theirs = right_table((*VELOCITIES, "VC", "DVA", "DVB"))
        theirs |= {name: formula(theirs) for name, formula in results.items()}
        texts = {name: np.char.mod("%.6g", theirs[name]) for name in theirs.keys() - SCENE.keys()}
        (cause,) = impact88.compare({**SCENE, **texts}).causes
        assert cause.edit == edit

    def test_the_first_rows_left_unexplained_are_listed(self) -> None:
        theirs = impact88.solve({**SCENE, "UX": -SCENE["UX"]}, VELOCITIES)
        theirs["VAY"][[7, 70, 71, 72, 150, 151]] += 3
        comparison = impact88.compare({**SCENE, **theirs})
        assert comparison.causes[0].unexplained_rows == (8, 71, 72, 73, 151, 152)
        assert "6 remain unexplained (row 8, 71, 72, 73, 151, ...)" in str(comparison)

    @long
    def test_a_limit_is_named_with_its_number(self) -> None:
        scene = {**SCENE, "MU": np.where(SCENE["MU"] == -10, -10, np.minimum(SCENE["MU"], 0.6))}
        theirs = impact88.solve(scene, VELOCITIES)
        texts = {n: np.array([f"{x:.3f}" for x in c]) for n, c in theirs.items()}
        (cause,) = impact88.compare({**SCENE, **texts}).causes
        assert cause.edit == "MU limited to 0.6, as read"

    @long
    def test_a_mistake_under_a_condition_is_named_with_it(self) -> None:
        slow = SCENE["UX"] ** 2 < 1000
        theirs = impact88.solve({**SCENE, "E": np.where(SCENE["UX"] > 10, 0, SCENE["E"])})
        assert slow.any()
        (cause,) = impact88.compare({**SCENE, **{n: theirs[n] for n in VELOCITIES}}).causes
        assert "E" in cause.edit
        assert cause.where.startswith("where UX is above")

    @long
    def test_a_unit_is_named(self) -> None:
        theirs = impact88.solve({**SCENE, "WA": SCENE["WA"] * np.pi / 30}, VELOCITIES)
        (cause,) = impact88.compare({**SCENE, **theirs}).causes
        assert "WA" in cause.edit
        assert "revolutions per minute" in cause.edit

    @long
    def test_a_unit_of_rounded_results_is_named(self) -> None:
        theirs = impact88.solve({**SCENE, "MB": SCENE["MB"] * 32.174}, VELOCITIES)
        texts = {name: np.char.mod("%.3f", column) for name, column in theirs.items()}
        (cause,) = impact88.compare({**SCENE, **texts}).causes
        assert cause.edit == "MB multiplied by 32.174, as read (weight for mass, in ft and s)"

    @long
    def test_the_listings_rounding_down_is_named(self) -> None:
        theirs = {}
        for name, column in impact88.solve(SCENE, VELOCITIES).items():
            unit = 1e4 if name in ("WAF", "WBF") else 1e3
            theirs[name] = np.char.mod("%.4f", np.floor(column * unit) / unit)
        (cause,) = impact88.compare({**SCENE, **theirs}).causes
        assert "rounded down, as lines 730-760" in cause.edit

    @long
    def test_sine_and_cosine_exchanged_are_named(self) -> None:
        theirs = impact88.solve({**SCENE, "PA": 90 - SCENE["PA"] - 2 * SCENE["TA"]}, VELOCITIES)
        (cause,) = impact88.compare({**SCENE, **theirs}).causes
        assert cause.edit == "sine and cosine of A's direction TA + PA exchanged"


class TestEdits:
    @pytest.mark.parametrize("pi", [3.14, 3.1416, 3.14159, 22 / 7])
    def test_a_wrong_pi_has_a_name(self, pi: float) -> None:
        _, meaning = constants._digits_and_meaning(pi / np.pi, constants.FACTOR)
        assert meaning.endswith("for pi)")

    @pytest.mark.parametrize("factor", [1 + 1e-7, 1 - 1e-7, 3.14158 / np.pi, 3.143 / np.pi])
    def test_another_factor_has_none(self, factor: float) -> None:
        assert constants._digits_and_meaning(factor, constants.FACTOR)[1] == ""

    def test_a_second_edit_changes_rows(self) -> None:
        columns = {**SCENE, "row": np.arange(len(TEXTS)) + 1.0}
        inputs = {"UX": 2 * SCENE["UX"], "VY": SCENE["VY"] * (1 + (columns["row"] > 99))}
        theirs = impact88.solve({**SCENE, **inputs}, VELOCITIES)
        limits = {name: 1e-6 + 1e-6 * np.abs(column) for name, column in theirs.items()}
        sample = diagnosis.Sample(columns, theirs, limits, np.ones(len(TEXTS), bool))
        base = (Edit("UX doubled", {"< UX": "2 * UX"}),)
        plain = sample.given_by("impulses", base)
        assert plain.sum() == 99
        candidates = diagnosis.search(sample, "velocities", ("impulses",), base)
        assert any("VY" in candidate.text for candidate in candidates)
        assert all((candidate.rows != plain).any() for candidate in candidates)

    @pytest.mark.parametrize(
        ("name", "target", "text", "words"),
        [
            (
                "equations",
                "eq13",
                "MA*VAX + MA*VBX - (MA*UX + MB*VX)",
                "MA * VBX, should be MB * VBX",
            ),
            ("closed", "sn", "bn + an", "bn + an, should be an + bn"),
            (
                "closed",
                "gn",
                "ux*c + uy*s + an*WA - bn*WB",
                "... - bn * WB, should be ... + bn * WB",
            ),
        ],
    )
    def test_the_change_is_told_apart_from_equal_expressions(
        self, name: str, target: str, text: str, words: str
    ) -> None:
        sentence = describe(Edit("", {target: text}), name)
        assert f": {words}, in {target} = " in sentence


class TestNoCause:
    @long
    def test_noise_has_none(self) -> None:
        table = right_table()
        noise = np.random.default_rng(1)
        table |= {n: table[n] * (1 + 0.01 * noise.random(len(TEXTS))) for n in VELOCITIES}
        comparison = impact88.compare(table)
        assert comparison.differing
        assert comparison.causes == ()

    @pytest.mark.parametrize("count", [1, pytest.param(2, marks=long)])
    def test_one_row_alone_has_none_and_two_have(self, count: int) -> None:
        is_pivot = SCENE["MU"] == -10
        rows = np.concatenate([np.flatnonzero(~is_pivot)[:30], np.flatnonzero(is_pivot)[:count]])
        scene = {name: column[rows] for name, column in SCENE.items()}
        theirs = impact88.solve({**scene, "MU": np.where(is_pivot[rows], 10, scene["MU"])})
        comparison = impact88.compare({**scene, **{n: theirs[n] for n in VELOCITIES}})
        assert comparison.differing == count
        assert len(comparison.causes) == (count > 1)
        note = "one row alone disagrees: no cause is named"
        assert (note in comparison.notes) == (count == 1)

    @long
    def test_two_edits_do_not_explain_six_rows(self) -> None:
        edit = ("if slide(start) > 0.0", "if slide(base) > 0.0")
        comparison = impact88.compare(table_of("si", edit))
        assert comparison.differing == 6
        assert comparison.causes == ()

    def test_a_table_of_critical_coefficients_alone_has_none(self) -> None:
        coefficients = impact88.solve(SCENE, "MUC")["MUC"]
        comparison = impact88.compare({**SCENE, "MUC": 2 * coefficients})
        assert comparison.differing
        assert comparison.causes == ()

    def test_too_few_digits_tell_no_cause(self) -> None:
        table = {name: column[:1] for name, column in right_table(("VAX",)).items()}
        table["VAX"] = np.array([f"{table['VAX'][0] + 1.0:.1f}"])
        comparison = impact88.compare(table)
        assert comparison.differing == 1
        assert not comparison.causes


class TestTables:
    def test_an_empty_column_is_named(self) -> None:
        table = right_table()
        table["WAF"] = np.full(len(TEXTS), "")
        comparison = impact88.compare(table)
        assert not comparison.passed
        assert "WAF has no number in any row" in comparison.notes

    @pytest.mark.parametrize(
        "order", [lambda n: np.roll(np.arange(n), 1), np.random.default_rng(2).permutation]
    )
    def test_rows_in_another_order_are_named(self, order: Any) -> None:
        table = right_table()
        places = order(len(TEXTS))
        table |= {name: table[name][places] for name in VELOCITIES}
        (cause,) = impact88.compare(table).causes
        assert "order of the rows" in cause.edit

    def test_cut_digits_are_named(self) -> None:
        table: dict[str, Any] = right_table()
        for name in VELOCITIES:
            table[name] = np.array([f"{np.trunc(x * 1000) / 1000:.3f}" for x in table[name]])
        (cause,) = impact88.compare(table).causes
        assert cause.edit == "the last digit is cut or rounded down, not rounded"

    def test_single_precision_is_named(self) -> None:
        table = right_table()
        table |= {n: table[n].astype(np.float32).astype(float) for n in VELOCITIES}
        (cause,) = impact88.compare(table).causes
        assert "single precision" in cause.edit

    def test_missing_results_do_not_pass(self) -> None:
        table: dict[str, Any] = right_table()
        table["VAX"] = table["VAX"].astype(object)
        table["VAX"][3] = None
        comparison = impact88.compare(table)
        assert not comparison.passed
        assert comparison.notes[0] == "rows that lack a result where there is one: 1"
        assert "row 4: VAX = ''; expected a number" in comparison.notes[1]


class TestMutants:
    def test_every_edit_says_what_is_written(self) -> None:
        for name in NAMES:
            for site in sites(name, "velocities")[::97]:
                assert ", should be " in describe(site.edit(0), name)

    @np.errstate(all="ignore")
    def test_a_law_is_tried_as_it_is_written(self) -> None:
        columns = {**{n: c[:40] for n, c in SCENE.items()}, "row": np.arange(40) + 1.0}
        program = Program("impulses", columns)
        for edit in models():
            tried = program.run({key: [text] for key, text in edit.changes.items()})
            written = Program("impulses", columns, (edit,)).base
            for name in VELOCITIES:
                assert np.array_equal(tried[name], written[name], equal_nan=True), edit.says

    def test_models_edit_names_that_exist(self) -> None:
        from impact88.comparison.spellings import spelling

        targets: Mapping[str, str] = {s.target: "" for s in spelling("impulses").statements}
        for edit in models():
            for key in edit.changes:
                assert key in targets or key[2:] in {*targets, *COLUMNS}
