"""Comparing another program's results."""

from __future__ import annotations

import csv
import io
import json
import math

import numpy as np
import pytest

from impact88.checking.compare import CAUSES, Comparison, compare_file
from impact88.checking.vectors import CASEWORK, scenes
from impact88.closedform.solve import solve
from impact88.errors import UserError
from impact88.names import FINAL_VELOCITIES, SCENE
from impact88.replay import replay
from installed import impact88

ROWS = [scene for kind, _, scene in scenes(90, seed=11) if kind == CASEWORK]
TEXTS = {name: [scene[name] for scene in ROWS] for name in SCENE}
NUMBERS = {name: np.array(list(map(float, column))) for name, column in TEXTS.items()}
OURS = {name: column.astype(float) for name, column in solve(NUMBERS).items()}


def table(results: dict[str, list[str]]) -> str:
    """A CSV of the scenes with another program's results."""
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow([*TEXTS, *results])
    writer.writerows(zip(*TEXTS.values(), *results.values(), strict=True))
    return out.getvalue()


def compared(tmp_path, results: dict[str, list[str]]) -> Comparison:
    path = tmp_path / "theirs.csv"
    path.write_text(table(results), encoding="utf-8")
    return compare_file(str(path), "csv")


def exactly(found: dict[str, np.ndarray], names=FINAL_VELOCITIES) -> dict[str, list[str]]:
    return {name: list(map(repr, found[name].tolist())) for name in names}


def rounded(found: dict[str, np.ndarray], places: int) -> dict[str, list[str]]:
    return {name: [f"{x:.{places}f}" for x in found[name]] for name in FINAL_VELOCITIES}


def test_our_own_results_agree_to_the_double(tmp_path) -> None:
    names = [name for name in OURS if name not in ("COND", "STATUS")]
    done = compared(tmp_path, exactly(OURS, names))
    assert (done.agreeing, done.differing) == (len(ROWS), 0)
    assert all(tally.double == tally.compared > 0 for tally in done.tallies.values())


def test_a_solution_by_lapack_agrees_to_the_double(tmp_path) -> None:
    """Another way to the same numbers: the listing's elimination in IEEE double."""
    from impact88.casework import trial

    found = {name: [] for name in FINAL_VELOCITIES}
    for scene in ROWS:
        values = trial.run_whole(scene, "float64")[1]
        for name in found:
            found[name].append(repr(values[name]))
    # its pi is the listing's: that is what the comparison must say
    done = compared(tmp_path, found)
    assert set(done.causes) <= {CAUSES[0].says}


@pytest.mark.parametrize("places", [2, 5, 9])
def test_rounded_results_agree_to_the_digits_claimed(tmp_path, places: int) -> None:
    done = compared(tmp_path, rounded(OURS, places))
    assert done.differing == 0
    assert done.tallies["VAX"].digits > 0


@pytest.mark.parametrize("cause", CAUSES, ids=lambda cause: cause.says)
def test_each_cause_is_named(tmp_path, cause) -> None:
    """Results made with a slip, written with 12 digits."""
    changed = {**NUMBERS, **cause.scene(NUMBERS, OURS)}
    made = {name: column.astype(float) for name, column in solve(changed).items()}
    made |= cause.results(made)
    found = {name: [f"{x:.12g}" for x in made[name]] for name in FINAL_VELOCITIES}
    done = compared(tmp_path, found)
    assert done.differing > len(ROWS) // 4
    assert done.causes.most_common(1)[0][0] == cause.says
    assert done.causes[cause.says] >= 0.9 * done.differing


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


def test_precision_is_recognised(tmp_path) -> None:
    single = {name: [repr(float(np.float32(x))) for x in OURS[name]] for name in FINAL_VELOCITIES}
    done = compared(tmp_path, single)
    assert set(done.causes) == {"rounding in single precision"}
    noise = {
        name: [repr(float(x) * (1 + 1e-4)) for x in OURS[name]]
        if name == "VAX"
        else list(map(repr, OURS[name].tolist()))
        for name in FINAL_VELOCITIES
    }
    done = compared(tmp_path, noise)
    assert set(done.causes) <= {
        f"unexplained, but agrees to about {digits} digits" for digits in (3, 4, 5, 6)
    }


def test_worst_rows_come_first(tmp_path) -> None:
    made = exactly(OURS)
    made["VAX"][3] = repr(float(OURS["VAX"][3]) * 1.5)
    made["VBY"][7] = repr(float(OURS["VBY"][7]) + 1e-6)
    done = compared(tmp_path, made)
    assert [one.row for one in done.worst] == [4, 8]
    assert (done.worst[0].result, done.worst[0].line) == ("VAX", 5)


def test_command(tmp_path) -> None:
    path = tmp_path / "theirs.jsonl"
    lines = [
        {**scene, "id": index, "VAX": repr(float(OURS["VAX"][index])), "note": "x"}
        for index, scene in enumerate(ROWS[:3])
    ]
    path.write_text("\n".join(map(json.dumps, lines)) + "\n", encoding="utf-8")
    done = impact88("compare", str(path), "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["ignored_columns"] == ["note"]
    lines[1]["VAX"] = "12.345"
    path.write_text("\n".join(map(json.dumps, lines)) + "\nrubbish\n", encoding="utf-8")
    done = impact88("compare", str(path))
    assert done.returncode == 1
    assert "row 2 (line 2), id 1: VAX 12.345" in done.stdout
    assert "row 4 (line 4)" in done.stderr


def test_a_table_without_results_is_refused(tmp_path) -> None:
    with pytest.raises(UserError, match="no column of results"):
        compared(tmp_path, {})
