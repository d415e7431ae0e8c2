"""A correct program is never called different; a wrong digit is, in every system of units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from otherprograms import answers

import impact88
from impact88.comparison import spellings
from impact88.comparison.agreement import elimination_bounds, reference
from impact88.comparison.evaluation import Program
from impact88.comparison.kit import frozen_vectors
from impact88.comparison.numbers import numbers, units
from impact88.comparison.spellings import COLUMNS, COMPARED, VELOCITIES

VECTORS = [vector for vector in frozen_vectors() if vector["class"] != "failure"]
TEXTS = [vector["scene"] for vector in VECTORS]
SCENE = {name: np.array([float(scene[name]) for scene in TEXTS]) for name in COLUMNS}
SYSTEMS = {  # length, mass, time of a unit, in feet, slugs, seconds
    "ft slug s": (1, 1, 1),
    "m kg s": (0.3048, 14.5939, 1),
    "in lb s": (12, 32.174, 1),
    "mm g s": (304.8, 14593.9, 1),
    "km t h": (3.048e-4, 0.0145939, 1 / 3600),
    "mile lb h": (1 / 5280, 32.174, 1 / 3600),
    "cm kg ms": (30.48, 14.5939, 1000),
}


def convert(
    columns: Mapping[str, Any], system: tuple[float, float, float]
) -> dict[str, np.ndarray]:
    """Return columns in a system of units."""
    length, mass, time = system
    size = {"length": length, "mass": mass, "time": time, "length/time": length / time}
    size |= {"rad/time": 1 / time, "mass·length²": mass * length**2}
    names = impact88.names.SCENE | impact88.names.RESULTS
    return {name: c * size.get(names[name].unit, 1.0) for name, c in columns.items()}


class TestSpellings:
    @pytest.mark.parametrize("name", spellings.NAMES)
    def test_all_compute_what_solve_does(self, name: str) -> None:
        with np.errstate(all="ignore"):
            program = Program(name, SCENE)
            ours = reference(SCENE)
            losses = elimination_bounds(SCENE, COMPARED)
        for result in COMPARED:
            if result not in program.base:
                continue
            off = np.abs(program.base[result] - ours.values[result])
            limit = np.fmax(ours.bounds[result] + losses[result], 1e-10 * ours.scales[result])
            assert not (off > limit)[~ours.ties].any(), result

    def test_the_closed_forms_keep_to_the_bound(self) -> None:
        ours = reference(SCENE, VELOCITIES)
        for name in ("impulses", "engine"):
            program = Program(name, SCENE)
            for velocity in VELOCITIES:
                off = np.abs(program.base[velocity] - ours.values[velocity])
                assert (off <= ours.bounds[velocity])[~ours.ties].all()

    def test_every_statement_has_a_subject(self) -> None:
        for name in spellings.NAMES:
            assert all(s.subject for s in spellings.spelling(name).statements)


class TestBound:
    @pytest.mark.parametrize("system", SYSTEMS)
    def test_relative_errors_are_judged_alike_in_all_units(self, system: str) -> None:
        rows = slice(0, None, 6)
        scene = {name: column[rows] for name, column in SCENE.items()}
        scene = convert(scene, SYSTEMS[system])
        right = impact88.solve(scene, VELOCITIES)
        notes = []
        for factor in (1e-15, 1e-12, 1e-8):
            theirs = {name: column * (1 + factor) for name, column in right.items()}
            comparison = impact88.compare({**scene, **theirs}, causes=False)
            notes.append((comparison.passed, comparison.notes[:1]))
        loses_digits = ("rows that agree, but lose digits to rounding: 112",)
        assert notes == [(True, ()), (True, loses_digits), (False, ())]

    @pytest.mark.parametrize("digits", range(2, 8))
    def test_printed_digits_agree_and_a_unit_more_does_not(self, digits: int) -> None:
        right = impact88.solve(SCENE, VELOCITIES)
        texts = {n: np.array([f"{x:.{digits}g}" for x in c]) for n, c in right.items()}
        assert impact88.compare({**SCENE, **texts}, causes=False).passed
        row = 7
        value = float(texts["VAX"][row])
        unit = 10 ** (np.floor(np.log10(abs(value))) - digits + 1)
        texts["VAX"][row] = f"{value + unit:.{digits}g}"
        comparison = impact88.compare({**SCENE, **texts}, causes=False)
        assert comparison.differing_rows == (row + 1,)

    @pytest.mark.parametrize("program", ["on_a", "four", "nine", "jacobian", "ratio", "si"])
    def test_correct_programs_pass(self, program: str) -> None:
        theirs = {n: np.array(c) for n, c in answers(TEXTS[:250], program).items()}
        scene = {name: column[:250] for name, column in SCENE.items()}
        assert impact88.compare({**scene, **theirs}, causes=False).passed

    def test_a_tie_may_slide_either_way_and_nothing_else_is_excused(self) -> None:
        ties = reference(SCENE, VELOCITIES).ties & (SCENE["MU"] > 0)
        scene = {name: column[ties] for name, column in SCENE.items()}
        theirs = impact88.solve({**scene, "MU": -scene["MU"]}, VELOCITIES)
        assert impact88.compare({**scene, **theirs}, causes=False).passed
        theirs["VAX"] = theirs["VAX"] + 1
        assert not impact88.compare({**scene, **theirs}, causes=False).agreeing

    def test_a_rigid_barrier_is_compared(self) -> None:
        scene = {**impact88.sample(1).numbers(), "MB": np.inf, "IB": np.inf, "VX": 0, "VY": 0}
        right = {name: float(x) for name, x in impact88.solve(scene, VELOCITIES).items()}
        assert impact88.compare({**scene, **right}).passed
        assert not impact88.compare({**scene, **right, "VAX": right["VAX"] + 1e-6}).passed


class TestDigits:
    def test_the_longest_number_of_a_column_tells_its_digits(self) -> None:
        steps = units({"VAX": ["1.25", "10.5", "-3"], "WAF": ["0", "0.0"], "VBX": ["1.5E3"]})
        assert steps["VAX"].tolist() == [0.01, 0.1, 0.01]
        assert steps["WAF"].tolist() == [0.01, 0.01]
        assert steps["VBX"].tolist() == [100.0]

    def test_doubles_are_exact(self) -> None:
        assert units({"VAX": [1.0, 2 / 3]})["VAX"].max() <= 1e-16

    def test_exponents_of_fortran_are_numbers(self) -> None:
        assert numbers(["1.25D+01", "-2d0", ""])[:2].tolist() == [12.5, -2.0]

    def test_decimals_count_beside_a_number_of_many_digits(self) -> None:
        assert units({"VAX": ["20120764048486.502", "5.517"]})["VAX"].tolist() == [1e-3, 1e-3]

    def test_a_factor_converts_number_and_digit(self) -> None:
        scene = impact88.sample(1).numbers()
        mph = float(impact88.solve(scene, "VAX")["VAX"]) * 15 / 22
        row = {**scene, "VAX [mph]": f"{mph:.3f}"}
        assert impact88.compare(row, units="chapter").passed
        wrong = impact88.compare({**row, "VAX [mph]": "1.000"}, units="chapter", causes=False)
        assert wrong.disagreements[0].ours == pytest.approx(mph)
