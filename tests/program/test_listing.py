"""The port: the page line for line, every captured run, errors with their line, stopping."""

from __future__ import annotations

import compileall
import re
import shutil
import subprocess
import sys

import captures
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from impact88.apple.captured import memory_contents
from impact88.files import packaged_text
from impact88.names import SCENE
from impact88.program import arithmetics
from impact88.program.run import run
from impact88.program.scene import sample

CASES = captures.scenes()
OVERFLOWS = {"UX": 210, "VY": 230, "EM": 280, "TB": 290, "IA": 310, "M": 350}


def test_every_basic_line_is_there_once_in_order():
    rows = packaged_text("impact88.program", "listing.py").splitlines()
    comments = [match.groups() for row in rows if (match := re.match(r" +# (\d+) (.*)", row))]
    lines = packaged_text("impact88.legacy", "impact.bas").splitlines()
    assert comments == [tuple(line.split(" ", 1)) for line in lines]


@pytest.mark.captures
def test_captured_runs():
    for case in CASES:
        result = run(case["scene"], dos=False)
        assert result.printout == case["printout"], case["id"]
        assert memory_contents(result.reals, result.A) == memory_contents(case["reals"], case["A"])


@pytest.mark.captures
def test_a_changed_bit_is_seen():
    case = CASES[0]
    result = run(case["scene"], dos=False)
    name, value = next((n, v) for n, v in case["reals"].items() if not v.startswith("00"))
    alteration = {**case["reals"], name: f"{int(value, 16) ^ 1:010x}"}
    assert memory_contents(result.reals, result.A) != memory_contents(alteration, case["A"])


@pytest.mark.parametrize(
    ("changes", "error"),
    [
        ({"IA": "0"}, "?DIVISION BY ZERO ERROR IN 480"),
        ({"IB": "0"}, "?DIVISION BY ZERO ERROR IN 480"),
        (
            dict.fromkeys(("UX", "UY", "WA", "VX", "VY", "WB"), "0"),
            "?DIVISION BY ZERO ERROR IN 690",
        ),
        ({"M": "7"}, "?BAD SUBSCRIPT ERROR IN 500"),
        ({"M": "-2"}, "?ILLEGAL QUANTITY ERROR IN 500"),
        ({"UX": "1E30"}, "?OVERFLOW ERROR IN 320"),
    ],
)
def test_errors_read_like_the_originals(changes, error):
    result = run(sample(1).replaced(changes))
    assert result.error == error
    assert result.printout.endswith("\n" + error.replace(" IN", "\a IN"))


@pytest.mark.parametrize(("name", "line"), OVERFLOWS.items())
def test_too_large_a_number_is_an_error_of_its_line(name, line):
    result = run(sample(1).replaced({name: "1E39"}))
    assert result.error == f"?OVERFLOW ERROR IN {line}"
    assert result.reals[name] == "00" * 5  # made, and left at zero


@pytest.mark.parametrize("m", ["5", "4.5", "1", "0", "-1", "2.5", "3"])
def test_any_m_the_listing_would_run(m):
    result = run(sample(1).replaced({"M": m}))
    assert result.error is None or result.line == 500 or result.line >= 1000


def test_zero_determinant_is_a_normal_end():
    result = run(sample(1).replaced({"MA": "0"}))
    assert result.zero_determinant
    assert result.error is None
    assert result.printout.endswith("\nZERO DETERMINANT\n")


def test_what_an_unfinished_line_printed_stays():
    result = run(sample(1).replaced(dict.fromkeys(("UX", "UY", "WA", "VX", "VY", "WB"), "0")))
    assert "INITIAL KE= 0 KE LOSS= \n?DIVISION" in result.printout


def test_stopping_after_every_line():
    stops = []
    result = run(sample(1), after_line=lambda line, left: stops.append((line, left)))
    lines = [line for line, _ in stops]
    assert lines[:4] == [190, 200, 210, 220]
    assert lines[-1] == 780
    assert {400, 410, 570, 1010, 1040, 1150, 760} <= set(lines)
    assert not {430, 440, 520, 1160, 1170} & set(lines)
    assert lines.count(570) == 1
    assert lines.count(1030) == 30
    after_280 = stops[lines.index(280)][1]
    assert arithmetics.APPLESOFT.write(after_280.reals["MU"]) == ".911"
    assert "DA" not in after_280.reals
    assert after_280.A is None
    assert stops[-1][1].reals["MX"].to_bytes().hex() == result.reals["MX"]


digits = st.text("0123456789", min_size=1, max_size=4)
typed = st.one_of(
    st.sampled_from(["0", "-10", "10", ".", "-0", "1E38", "-1E38", "1E-38", "1E39", "4", "6", "5"]),
    st.builds(
        "{}{}.{}{}".format,
        st.sampled_from(["", "-", "+"]),
        digits,
        digits,
        st.sampled_from(["", "", "E5", "E-9", "E19", "E-30"]),
    ),
)
any_scene = st.fixed_dictionaries({name: typed for name in SCENE if name != "M"}).flatmap(
    lambda values: st.sampled_from(["6", "4", "5", "7", "0", "-1", "2.5"]).map(
        lambda m: {**values, "M": m}
    )
)


@settings(max_examples=50)
@given(any_scene, st.sampled_from(["applesoft", "float64"]))
def test_whatever_the_numbers_only_applesoft_errors(values, arithmetic):
    result = run(values, arithmetic)
    assert result.error is None or result.error.endswith(f" ERROR IN {result.line}")


SOURCELESS = """
import gzip, json, sys
sys.path[:0] = sys.argv[1:2]
import impact88
assert impact88.__file__.startswith(sys.argv[1]) and impact88.__file__.endswith(".pyc")
from impact88.apple.captured import memory_contents
from impact88.program.run import run
cases = [json.loads(line) for line in gzip.open(sys.argv[2], "rt")]
for case in cases[:: int(sys.argv[3])]:
    result = run(case["scene"], dos=False)
    assert result.printout == case["printout"], case["id"]
    contents = memory_contents(result.reals, result.A)
    assert contents == memory_contents(case["reals"], case["A"]), case["id"]
seen = []
run(cases[0]["scene"], after_line=lambda line, left: seen.append(line))
assert len(seen) > 50
error = run({**cases[0]["scene"], "IA": "0"})
assert error.line == 480 and error.printout.endswith("IN 480"), error.printout
"""


@pytest.mark.captures
def test_compiled_files_alone_run_the_captures(tmp_path):
    """A package without its sources but that of the port, as a freezing installer makes it."""
    root = captures.ROOT / "port" / "impact88"
    packages = {"apple", "program"}
    shutil.copytree(
        root,
        tmp_path / "impact88",
        ignore=lambda folder, names: {
            name for name in names if (root / name).is_dir() and name not in packages
        },
    )
    assert compileall.compile_dir(tmp_path, quiet=1, legacy=True)
    for source in tmp_path.rglob("*.py"):
        if source.name != "listing.py":  # read for its comments
            source.unlink()
    scenes = captures.folder() / "scenes.jsonl.gz"
    step = max(1, len(CASES) // 60)
    subprocess.run(
        [sys.executable, "-S", "-c", SOURCELESS, str(tmp_path), str(scenes), str(step)],
        check=True,
        cwd=tmp_path,
        timeout=120,
    )
