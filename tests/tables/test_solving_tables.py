"""Rows solved in both arithmetics: units, constants, bad rows, remarks, sweeps."""

import csv
import math
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import impact88
from impact88.cases import Case, View
from impact88.errors import UserError
from impact88.mechanics.solve import solve
from impact88.status import Status
from impact88.tables.solving import Solver
from impact88.tables.sweeping import sweep_table
from impact88.tables.textformats import Block, Table

SAMPLE = dict(impact88.sample(1))
CHAPTER = View("chapter")
PLAIN = Case.of({})
NUMBERS = {name: float(text) for name, text in SAMPLE.items()}
VAX = solve(NUMBERS, "VAX")["VAX"]


def solve_columns(columns, results, case=PLAIN, as_text=True, **options):
    """Return results by heading, bad rows, and the solver."""
    solver = Solver(Table([*columns], iter(())), case, results.split(), **options)
    count = len(next(iter(columns.values())))
    out = solver.solve(Block([*columns.values()], range(1, 1 + count)), as_text)
    return out, solver.listed, solver


def scene(count: int = 1, **columns: list[object]) -> dict[str, list[object]]:
    return {**{name: [text] * count for name, text in SAMPLE.items()}, **columns}


def test_cells_and_headings_with_units() -> None:
    columns = scene(3, UX=["-29.04", "-19.8 mph", "-8.851392 m/s"])
    columns = {CHAPTER.heading(name): column for name, column in columns.items()}
    out, bad, _ = solve_columns(columns, "VAX", Case.of({}, view=CHAPTER))
    assert (bad, out["VAX [ft/s]"]) == ([], pytest.approx([VAX] * 3, rel=1e-13))
    columns = {f"{n.lower()} ({CHAPTER.unit(n) or '-'})": c for n, c in scene().items()}
    out, _, _ = solve_columns(columns, "VAX KI", Case.of({"units": "us"}))
    assert list(out)[-2:] == ["VAX [mph]", "KI [ft-lb]"]
    with pytest.raises(UserError, match=r"^table: DA is in ft; expected units = .* \(--units\)"):
        solve_columns(columns, "VAX")
    with pytest.raises(UserError, match=r"^table: UX and ux are two columns of UX"):
        solve_columns({**scene(), "ux": ["1"]}, "VAX")
    (bad,) = solve_columns(scene(UX=["25 mph"]), "VAX")[1]
    assert bad.startswith("table, row 1: UX = '25 mph': UX is in mph; expected units =")


@pytest.mark.parametrize(
    ("cell", "reason"),
    [
        ("much", "= 'much' is not an amount"),
        (None, "is empty; expected a number"),
        ("3 .. 5", "= '3 .. 5': expected one number"),
        ("1e999", "beyond the range of doubles"),
        ("1 0", "= '1 0' is not an amount"),
        (math.nan, "is empty"),
    ],
)
@pytest.mark.parametrize("arithmetic", ["float64", "applesoft"])
def test_bad_rows_do_not_stop_the_others(cell: object, reason: str, arithmetic: str) -> None:
    columns = scene(3, UX=[SAMPLE["UX"], cell, SAMPLE["UX"]])
    out, (bad,), _ = solve_columns(columns, "KI", arithmetic=arithmetic)
    assert bad.startswith("table, row 2: UX ")
    assert reason in bad
    assert np.isnan(out["KI"]).tolist() == [False, True, False]
    assert out["KI"][[0, 2]] == pytest.approx(solve(NUMBERS, "KI")["KI"], rel=1e-8)
    assert solve_columns(columns, "STATUS")[0]["STATUS"].tolist() == [0, Status.NOT_FINITE, 0]


def test_scenes_that_are_no_impact_are_bad_rows() -> None:
    for name, cell in (("MA", "0"), ("M", "5"), ("MA", "inf")):
        out, (bad,), _ = solve_columns(scene(2, **{name: [SAMPLE[name], cell]}), "VAX KI")
        assert bad.startswith("table, row 2: no impact has these values; expected M = 6 or 4")
        assert np.isnan(out["KI"]).tolist() == [False, True]


def test_what_cannot_be_typed_is_a_bad_row() -> None:
    for name, cell, fault in (("UX", "0." + "1" * 80, "longer"), ("MA", "inf", "be typed")):
        columns = {**scene(1), name: [cell]}
        assert fault in solve_columns(columns, "KI", arithmetic="applesoft")[1][0]
    columns, us = scene(2, UX=["1", "1e999"]), Case.of({"units": "us"})
    assert "row 2: UX " in solve_columns(columns, "VAX", case=us, arithmetic="applesoft")[1][0]
    points = {**scene(1, MA=["inf"], UX=["0"]), "M": ["4"]}
    assert "cannot be typed" in solve_columns(points, "KI", arithmetic="applesoft")[1][0]
    for name, arithmetic in product(("EM", "IA", "WA"), ("float64", "applesoft")):
        both_kinds = scene(2, M=["4", "6"])
        del both_kinds[name]  # a row of 6 equations needs it
        bad = solve_columns(both_kinds, "KI", arithmetic=arithmetic)[1]
        assert bad == [f"table, row 2: {name} is empty; expected a number"]


def test_applesoft_has_the_bits_of_replay_and_reports_errors() -> None:
    columns = scene(4, MU=[".911", "1E38", "x", ".5"], UX=["-29.04", "1E30", "1", "-29.040"])
    out, bad, _ = solve_columns(columns, "VAX KI", arithmetic="applesoft")
    for at in (0, 3):
        reference = impact88.replay({n: str(c[at]) for n, c in columns.items()})
        assert out["KI"][at] == reference.floats("KI")[0]
    assert out["ERROR"][1] == "?OVERFLOW ERROR IN 320"
    assert out["LINE"][1] > 0
    assert (out["ERROR"][2], out["LINE"][2]) == ("", 0)
    assert [text[:14] for text in bad] == ["table, row 3: "]
    with pytest.raises(UserError, match="'COND' is not a result of --arithmetic applesoft"):
        solve_columns(columns, "COND", arithmetic="applesoft")


def test_applesoft_takes_the_units_of_headings_and_cells() -> None:
    us, chapter = Case.of({**SAMPLE, "units": "us"}), Case.of({**SAMPLE, "units": "chapter"})
    in_headings = {us.view.heading(n): [t] for n, t in SAMPLE.items()}
    in_cells = scene(UX=["-19.8 mph"], MA=["4617 lb"])
    typed = chapter.with_(UX="-19.8 mph", MA="4617 lb")
    for columns, case in ((in_headings, us), (in_cells, typed)):
        view = Case.of({}, view=case.view)
        out, bad, _ = solve_columns(columns, "VAX KI", view, arithmetic="applesoft")
        assert not bad
        assert out["KI [ft-lb]"][0] == impact88.replay(dict(case.texts)).floats("KI")[0]


def test_constants_fill_and_replace_columns() -> None:
    columns = scene(2)
    del columns["MU"], columns["M"]
    with pytest.raises(UserError, match="no column MU; --set NAME=VALUE gives one for all rows"):
        solve_columns(columns, "VAX")
    out, _, _ = solve_columns(columns, "VAX", Case.of({"MU": ".911"}))
    assert out["VAX"].tolist() == [VAX] * 2
    out, _, _ = solve_columns(scene(2), "VAX", case=Case.of({"MU": "-10"}), replaced=["MU"])
    assert out["VAX"].tolist() == [solve({**NUMBERS, "MU": -10}, "VAX")["VAX"]] * 2
    assert out["MU"].tolist() == [-10, -10]
    assert not solve_columns(scene(2), "VAX", case=Case.of({"MU": ""}), replaced=["MU"])[1]
    case = Case.of({"UX": "10 m/s", "units": "si"})
    columns = {"UX [km/h]" if n == "UX" else n: c for n, c in scene().items()}
    out, _, _ = solve_columns(columns, "VAX", case, replaced=["UX"])
    assert out["UX [km/h]"].tolist() == [36]


def test_estimates_courses_and_shares_are_those_of_each_row() -> None:
    out, _, _ = solve_columns(scene(2, MU=["50 %", ".5"]), "MUP MUC", as_text=False)
    assert abs(out["MUP"][0]) == pytest.approx(0.5 * abs(out["MUC"][0]), rel=1e-15)
    assert out["MU"] == ["50 %", ".5"]
    columns = scene(3, MA=["3000", "2000", "900"])
    for name in ("IA", "TA", "MU"):
        del columns[name]
    case = Case.of({"units": "us", "IA": "estimate", "MA": "3000", "TA": "course", "MU": "85 %"})
    out, bad, _ = solve_columns(columns, "VAX MUP MUC", case=case)
    assert [text[:17] for text in bad] == ["table, row 3: IA "]
    for at in (0, 1):
        row_case = case.with_(**{n: c[at] for n, c in columns.items()})
        shown = row_case.view.shown("VAX", solve(row_case.numbers, "VAX")["VAX"])
        assert out["VAX [mph]"][at] == pytest.approx(shown, rel=1e-12)


def test_point_masses_need_no_columns_of_bodies() -> None:
    names = ("E", "MU", "GA", "MA", "MB", "UX", "UY", "VX", "VY")
    columns = {n: [SAMPLE[n]] for n in names} | {"M": ["4"]}
    out, bad, _ = solve_columns(columns, "KI", as_text=False)
    assert (out["KI"][0] > 0, bad) == (True, [])
    del columns["E"]
    with pytest.raises(UserError, match="no column E; --set NAME=VALUE gives one for all rows"):
        solve_columns(columns, "KI")
    both_kinds = scene(2, M=["4", ""], DA=["", "7.59"])
    for arithmetic in ("float64", "applesoft"):
        out, bad, _ = solve_columns(both_kinds, "VAX", arithmetic=arithmetic)
        assert (np.isnan(out["VAX"]).any(), bad) == (False, [])
    for name in ("E", "MU", "GA"):
        columns = {**scene(2, M=["4", "4"], UY=["1", "1"]), name: [SAMPLE[name], ""]}
        out, bad, _ = solve_columns(columns, "KI VAX")
        assert bad == [f"table, row 2: {name} is empty; expected a number"]
        assert np.isnan(out["VAX"]).tolist() == [False, True]
    assert solve_columns(scene(M=["4"], WA=[""]), "WAF")[0]["WAF"].tolist() == [0]


def test_remarks_count_rows() -> None:
    _, _, solver = solve_columns(scene(5, EM=["0", "1", "0", "0", "1"]), "VAX")
    (text,) = solver.remarks()
    assert text.startswith("table, row 1: EM = 0: the moment")
    assert text.endswith(" (2 rows more)")
    heavy = scene(2, MA=["1e6", "100"])
    _, _, solver = solve_columns(heavy, "VAX", case=Case.of({}, view=CHAPTER))
    assert any("row 1: MA = 1e6: no vehicle has that mass" in text for text in solver.remarks())
    _, _, solver = solve_columns(heavy, "VAX")
    assert not any("MA" in text for text in solver.remarks())
    turned = scene(2, TB=["170", "170"], VX=["14.52", "0"], VY=["25.15", "0"])
    _, _, solver = solve_columns(turned, "VAX")
    (text,) = solver.remarks()
    assert text.startswith("table, row 1: TB = 170: B moves more")


def test_sweeps(tmp_path: Path) -> None:
    case = Case.of({**SAMPLE, "units": "chapter"})
    target = tmp_path / "out.csv"
    swept = sweep_table(case, {"MU": "0:1:3", "UX": "-29.3:-14.7:2"})
    calls = []
    Solver(swept, case, ["VAX"]).write(str(target), lambda *x: calls.append(x))
    rows = list(csv.DictReader(target.read_text().splitlines()))
    assert list(rows[0]) == ["MU", "UX [ft/s]", "VAX [ft/s]"]
    assert [row["UX [ft/s]"] for row in rows[:2]] == ["-29.3", "-14.7"]
    reference = solve({**NUMBERS, "MU": 0.5, "UX": -14.7}, "VAX")["VAX"]
    assert float(rows[3]["VAX [ft/s]"]) == pytest.approx(reference, rel=1e-13)
    assert calls == [(6, None)]
    Solver(sweep_table(case, {}), case, ["VAX"]).write(str(target))
    assert target.read_text().splitlines()[0] == "VAX [ft/s]"
    for text in ("0:1", "0:1:0", "0:1:x", "0:much:3", "0:1:99999999", "0 mph:1:2"):
        with pytest.raises(UserError, match="--sweep"):
            sweep_table(case, {"MU": text})


def test_bad_rows_are_listed_and_counted(tmp_path: Path) -> None:
    rows = [",".join({**SAMPLE, "UX": "x" if at % 2 else "1"}.values()) for at in range(60)]
    source, target = tmp_path / "in.csv", tmp_path / "out.csv"
    source.write_text("\n".join([",".join(SAMPLE), *rows]))
    solver = Solver(str(source), PLAIN, ["VAX"])
    solver.write(str(target))
    assert (solver.rows, solver.bad, len(solver.listed)) == (60, 30, 21)
    assert "in.csv, line 3: UX = 'x' is not an amount" in solver.listed[0]
    assert solver.listed[-1] == "30 rows could not be used, these first"
    rows = csv.DictReader(target.read_text().splitlines())
    assert [row["VAX"] == "" for row in rows] == [False, True] * 30
