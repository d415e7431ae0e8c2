"""The commands reconstruct, barrier, colinear, delta-v, staged and example, as users meet them."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

from impact88.casework.chapter.deltav import ERROR
from impact88.casework.chapter.staged import collisions
from impact88.interface.commands.cli import main

TABLE_3_AFTER = """
title = "Table 3, after"
MA = 96
MB = 145
IA = 1970
IB = 3770
DA = 4.5
DB = 4
GA = 0
PA = 0
PB = -40
TA = 0
TB = 90
E = 0.25
EM = -0.9
MU = ".89"
VAX = -7.46
VAY = 25.994
VBX = -19.338
VBY = 41.456
WAF = -2.9027
WBF = "-.885"
UX = ""            # as in a template: not known
"""
SECTION_7 = {"UY": 0, "VX": 0, "VAX": -10, "VAY": 20, "VBX": -20, "VBY": 45}
CAR = "MA=143.5 IA=3728 DA=7.59 PA=-19.8 TA=0 GA=-30 E=.005 MU=.911 EM=-.715 UX=-29.04 UY=0 WA=0"
REAR_END = "MA=154.7 MB=99.1 E=.071 MUP=-.008 UN=-56.76 UT=0 VN=0 VT=0"


@pytest.fixture
def after(tmp_path: Path) -> str:
    path = tmp_path / "after.toml"
    path.write_text(TABLE_3_AFTER, encoding="utf-8")
    return str(path)


def sets(pairs: str) -> list[str]:
    return [part for pair in pairs.split() for part in ("--set", pair)]


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Status, stdout, and stderr without the remarks on what is hardly meant."""
    status = main(arguments)
    captured = capsys.readouterr()
    lines = captured.err.splitlines(keepends=True)
    err = "".join(x for x in lines if "no moment is EM = 1" not in x and "off the way it" not in x)
    return status, captured.out, err


def as_json(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    status, out, err = run(capsys, *arguments, "--json")
    assert (status, err) == (0, "")

    def refuse(text: str) -> None:
        pytest.fail(f"{text} is not JSON")

    return json.loads(out, parse_constant=refuse)


def test_reconstruct_shows_both_solutions_of_table_3(
    after: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = run(capsys, "reconstruct", "--full", after, "--contact-time", ".15")
    assert (status, err) == (0, "")
    assert "SOLUTION 1 OF 2" in out
    assert "SOLUTION 2 OF 2" in out
    assert "-36.6661*" in out
    assert "length/time" in out
    assert "! friction is above the critical value" in out
    assert "11 o'clock" in out
    assert all(len(line) <= 100 for line in out.splitlines())
    first, second = as_json(capsys, "reconstruct", after, "--contact-time", ".15")["solutions"]
    assert first["values"]["UX"] == pytest.approx(-36.6660802138826215, rel=1e-12)
    assert first["solved_for"] == ["UX", "UY", "WA", "VX", "VY", "WB"]
    assert first["values"]["DVA"] == pytest.approx(39.098, abs=1e-3)
    assert first["values"]["FA"] == pytest.approx(first["values"]["P"] / 0.15)
    assert first["units"]["FA"] == "mass·length/time²"
    assert first["warnings"] == []
    assert second["values"]["MUP"] == -0.89
    assert second["status"] == 4096


def test_reconstruct_for_some_unknowns_only(after: str, capsys: pytest.CaptureFixture[str]) -> None:
    vehicles = [f"{n}=" for n in ("E", "EM", "MU", "WAF", "WBF")]
    known = " ".join([*vehicles, *(f"{n}={v}" for n, v in SECTION_7.items())])
    status, out, err = run(capsys, "reconstruct", "--full", after, *sets(known))
    assert (status, err) == (0, "")
    assert re.search("^NOT FOUND +spins, E, EM: give WAF, WBF and WA$", out, re.M)
    (solution,) = as_json(capsys, "reconstruct", after, *sets(known), "--outputs", "ux,vy")[
        "solutions"
    ]
    assert solution["values"]["UX"] == pytest.approx(-40.2083333333333333)
    assert solution["values"]["VY"] == pytest.approx(58.2413793103448276)
    assert "E" not in solution["values"]


def test_reconstruct_flags_what_errors_do(after: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "reconstruct", "--full", after, "--set", "E=.005")
    assert status == 0
    assert "! badly conditioned: errors of the known velocities are amplified" in out
    _, out, _ = run(capsys, "reconstruct", "--full", after, *sets("UX=-36 UY=0 VX=0 VY=58.7"))
    assert "! the known values contradict one another" in out


@pytest.mark.parametrize(
    ("setting", "law"),
    [("E=0", "restitution does not hold: the error is 9.166"), ("EM=0", "moment")],
)
def test_reconstruct_says_which_law_exact_values_miss(
    setting: str, law: str, after: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """With E = 0 the velocities of Table 3 do not separate: they and E cannot all be true."""
    _, out, _ = run(capsys, "reconstruct", "--full", after, "--set", setting)
    evidence = " ".join(out.partition("EVIDENCE")[2].partition("BEFORE IMPACT")[0].split())
    assert "these exact values contradict one another" in evidence
    assert law in evidence


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "nothing is known"),
        (["nowhere.toml"], "nowhere.toml: cannot be read"),
        (["AFTER", "--set", "MU=-10", "--outputs", "UX"], "MU = -10 (pivot)"),
        (
            ["AFTER", "--set", "E=abc"],
            "--set: E: 'abc' is not an amount; expected a number, a number with its unit",
        ),
        (["AFTER", "--set", "e5"], "--set e5: expected NAME=VALUE"),
        (["AFTER", "--set", "FOO=1"], "'FOO' is not a name used here"),
        (["AFTER", "--set", "E=.1", "--set", "E=.2"], "E is given twice"),
        (["AFTER", "--set", "MA="], "missing MA (mass of A)"),
        (["AFTER", "--set", "MA=-1"], "MA is not positive"),
        (["AFTER", "--set", "M=5"], "M must be 6"),
        (["AFTER", "--outputs", "XA"], "'XA' is not a result"),
        (["AFTER", "--contact-time", "0"], "contact time 0.0 is not positive"),
        (["AFTER", "--contact-time", "x"], "--contact-time"),
    ],
)
def test_reconstruct_refuses_in_one_line(
    arguments: list[str], message: str, after: str, capsys: pytest.CaptureFixture[str]
) -> None:
    replaced = [after if argument == "AFTER" else argument for argument in arguments]
    status, out, err = run(capsys, "reconstruct", *replaced)
    assert (status, out) == (2, "")
    assert message in err
    assert err.startswith("impact88 reconstruct: ")
    assert err.count("\n") == 1


def test_a_file_with_a_wrong_key_is_told_with_its_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "scene.toml"
    path.write_text("ma = 96\n", encoding="utf-8")
    status, _, err = run(capsys, "reconstruct", str(path))
    assert status == 2
    assert f"{path}: 'ma' is not a name used here; did you mean MA?" in err
    path.write_text("MA = .5\n", encoding="utf-8")
    status, _, err = run(capsys, "reconstruct", str(path))
    assert "line 1: MA = .5 is not TOML; write 0.5" in err


def test_barrier_forward_and_back(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "barrier", *sets(CAR), "--contact-time", ".1")
    assert status == 0
    assert "7.3903*" in out
    assert "peak force, at three times the average" in out
    assert "B before" not in out
    (there,) = as_json(capsys, "barrier", *sets(CAR))["solutions"]
    values = there["values"]
    assert values["VAX"] == pytest.approx(7.39034095247408067757753284521, rel=1e-12)
    assert values["LOSS"] == pytest.approx(77.043776782084758018970643083, rel=1e-12)
    assert "DVB" not in values
    rebound = [f"{n}={values[n]!r}" for n in ("VAX", "VAY", "WAF")]
    known = " ".join([*CAR.split()[:7], "EM=-.715", "E=.005", "MUP=.911", *rebound])
    known = " ".join(dict.fromkeys(p for p in known.split() if not p.startswith("MU=")))
    (back,) = as_json(capsys, "barrier", *sets(known))["solutions"]
    assert back["values"]["UX"] == pytest.approx(-29.04, abs=1e-9)
    assert back["badly_conditioned"]
    status, _, err = run(capsys, "barrier", "--set", "VX=1")
    assert status == 2
    assert "'VX' is not a name used here" in err


POINT_MASSES = "M=4 MA=100 MB=80 GA=0 E=.1 UX=-10 UY=0 VX=0 VY=3"


@pytest.mark.parametrize(
    ("command", "pairs", "after"),
    [
        ("reconstruct --full", f"{POINT_MASSES} MU=.1", "-5.1111*"),
        ("barrier", "M=4 MA=143.5 GA=-30 E=.005 MU=.4 UX=-29.04 UY=0", "-2.0961*"),
    ],
)
def test_point_masses_have_no_spins(
    command: str, pairs: str, after: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = run(capsys, *command.split(), *sets(pairs))
    assert (status, err) == (0, "")
    assert after in out
    assert not any(word in out for word in ("spin ", "EM ", "PM ", "contact point", "CAX"))


def test_barrier_without_mass_is_told_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "barrier", *sets(CAR.replace("MA=143.5", "MA=0")))
    assert (status, out) == (2, "")
    assert err == "impact88 barrier: MA is not positive; expected mass of A [mass]\n"


def test_pivot_tells_what_ends_the_sliding(capsys: pytest.CaptureFixture[str]) -> None:
    """Typed as MU, the ratio told is critical: it ends the sliding, and a pivot does the same."""
    status, out, _ = run(capsys, "reconstruct", "--full", *sets(f"{POINT_MASSES} MU=-10"))
    assert status == 0
    (line,) = [line for line in out.splitlines() if line.startswith("MUP")]
    ratio = line.partition("P_t/P_n = ")[2].split()[0]
    pivot = as_json(capsys, "reconstruct", *sets(f"{POINT_MASSES} MU=-10"))["solutions"][0]
    friction = as_json(capsys, "reconstruct", *sets(f"{POINT_MASSES} MUP={ratio}"))["solutions"][0]
    assert friction["values"]["VAY"] == pytest.approx(pivot["values"]["VAY"], abs=1e-5)
    assert friction["values"]["VAY"] == pytest.approx(friction["values"]["VBY"], abs=1e-5)


@pytest.mark.parametrize(("em", "ratio"), [("-1", 1 / 3), ("0", 0.0), ("1", 1.0), ("3.49", 0.5836)])
def test_what_the_moment_leaves_of_the_spin(
    em: str, ratio: float, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without any lever arm nothing but the moment turns the vehicles: the spins tell R/R0."""
    scene = "DA=0 DB=0 PA=0 PB=0 TA=0 TB=0 GA=0 MA=9 MB=7 IA=20 IB=30 E=.1 MU=0 UX=-9 UY=0 WA=3"
    (found,) = as_json(capsys, "reconstruct", *sets(f"{scene} VX=0 VY=0 WB=1 EM={em}"))["solutions"]
    values = found["values"]
    assert values["RR0"] == pytest.approx(ratio, abs=1e-4)
    assert (values["WAF"] - values["WBF"]) / (3 - 1) == pytest.approx(values["RR0"])


def test_the_help_shows_a_scene_without_fault(capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = run(capsys, "barrier", "--help")
    command = out.partition("examples:")[2].replace("\\\n", " ").splitlines()[1].split()[3:]
    (found,) = as_json(capsys, "barrier", *command)["solutions"]
    assert found["warnings"] == []


def test_colinear_forward_and_back(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "colinear", *sets(REAR_END), "--contact-time", ".12")
    assert status == 0
    assert "-33.0237*" in out
    assert "average force during contact" in out
    there = as_json(capsys, "colinear", *sets(REAR_END))["values"]
    assert there["VBN"] == pytest.approx(-37.0536123404255319, rel=1e-13)
    after = " ".join(f"{n}={there[n]!r}" for n in ("VAN", "VAT", "VBN", "VBT"))
    back = as_json(capsys, "colinear", *sets(" ".join(REAR_END.split()[:4])), *sets(after))
    assert back["solved_for"] == ["UN", "UT", "VN", "VT"]
    assert back["values"]["UN"] == pytest.approx(-56.76, rel=1e-12)


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        ("MA=1", "missing MB E UN VN"),
        (f"{REAR_END} VAN=1", "are both given"),
        (REAR_END.replace("MA=154.7", "MA=0"), "MA is not positive"),
        ("MA=1 MB=1 E=0 MUP=0 VAN=1 VAT=0 VBN=1 VBT=0", "E = 0: the vehicles move on together"),
    ],
)
def test_colinear_refuses_in_one_line(
    pairs: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = run(capsys, "colinear", *sets(pairs))
    assert (status, out) == (2, "")
    assert message in err
    assert err.count("\n") == 1


SPEEDS = "MA=96 MB=145 SA=36.667 SB=58.667"


def test_delta_v_says_which_equation_19(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "delta-v", *sets(f"{SPEEDS} LOSS=37.4"))
    assert status == 0
    assert "39.0981" in out
    assert "with the factor 2/3" in out
    status, out, _ = run(capsys, "delta-v", *sets(f"{SPEEDS} LOSS=37.4"), "--as-printed")
    assert "58.647" in out
    assert "as printed, without the factor 2/3" in out
    found = as_json(capsys, "delta-v", *sets(SPEEDS), "--like", "90-side")
    assert [e["LOSS"] for e in found["estimates"]] == [38.9, 41.5]
    assert "collisions 8, 9, 10" in found["loss_from"]
    fraction = as_json(capsys, "delta-v", *sets(f"{SPEEDS} DT=.374"))["estimates"]
    assert fraction == as_json(capsys, "delta-v", *sets(f"{SPEEDS} LOSS=37.4"))["estimates"]
    as_json(capsys, "delta-v", *sets(f"{SPEEDS} LOSS=1"))  # the least percentage taken as such
    velocities = as_json(
        capsys, "delta-v", *sets("MA=96 MB=145 UX=-36.667 UY=0 VX=0 VY=58.667 LOSS=37.4")
    )
    assert velocities["estimates"][0]["DVA"] == pytest.approx(39.0981, abs=1e-4)
    for beyond in ("SA=30 SB=0 DVA=1E200", "SA=30 SB=1E308 LOSS=0"):
        status, out, err = run(capsys, "delta-v", *sets(f"MA=96 MB=145 {beyond}"))
        assert (status, out) == (2, "")
        assert "beyond the range of doubles" in err


FINALS = "MA=96 MB=145 VAX=-10 VAY=20 VBX=-20 VBY=45"


def test_delta_v_finds_the_speeds_of_section_7(capsys: pytest.CaptureFixture[str]) -> None:
    """-43.6 and 61.5 rest on Table 3's own speeds and loss: an analyst has neither."""
    known = f"{FINALS} SA=36.667 SB=58.667 LOSS=37.4037"
    first, repeated = as_json(capsys, "delta-v", *sets(known))["estimates"]
    change = {"A": 39.1002, "B": 25.8870}
    assert first["DVA"] == pytest.approx(change["A"], abs=1e-3)
    assert first["UX"] == pytest.approx(-10 - (change["A"] ** 2 - 20**2) ** 0.5, abs=1e-3)
    assert round(first["UX"], 1) == -43.6
    assert first["VY"] == pytest.approx(45 + (change["B"] ** 2 - 20**2) ** 0.5, abs=1e-3)
    momentum = (96**2 * repeated["UX"] ** 2 + 145**2 * repeated["VY"] ** 2) ** 0.5
    assert repeated["DVA"] == pytest.approx(2 / 3 * 0.374037**0.5 * momentum / 96, rel=1e-6)
    assert (repeated["UX"] + 10) ** 2 + 400 == pytest.approx(repeated["DVA"] ** 2)
    status, out, _ = run(capsys, "delta-v", *sets(f"{FINALS} DT=.4"))
    assert status == 0
    assert "those of Equations 13 and 14" in out
    assert "rms 3.8, largest 8.2 ft/s" in out


def test_delta_v_tells_the_loss(capsys: pytest.CaptureFixture[str]) -> None:
    told = as_json(capsys, "delta-v", *sets(f"{SPEEDS} DVA=39.0981 DVB=25.8856"))["LOSS_from"]
    assert told["DVA"] == pytest.approx(37.4, abs=1e-3)
    assert told["DVB"] == pytest.approx(37.4, abs=1e-3)
    energy = 0.374 * (96 * 36.667**2 + 145 * 58.667**2) / 2
    (estimate,) = as_json(capsys, "delta-v", *sets(f"{SPEEDS} EL={energy}"))["estimates"]
    assert estimate["LOSS"] == pytest.approx(37.4)
    assert estimate["DVA"] == pytest.approx(39.0981, abs=1e-4)


def test_the_error_told_of_equation_19_is_table_2_s() -> None:
    """Predicted minus measured, Table 2's own printed cells."""
    off = [c.table2[f"dV{v}_pred"] - c.table2[f"dV{v}_exp"] for c in collisions() for v in "ab"]
    assert len(off) == 22
    assert round((sum(x * x for x in off) / 22) ** 0.5, 1) == 3.8
    assert round(max(map(abs, off)), 1) == 8.2
    assert ERROR.startswith("rms 3.8, largest 8.2 ft/s")


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        (f"{FINALS} LOSS=5", "less than the final velocity"),
        (f"{SPEEDS} DVA=3 LOSS=4", "both a loss and a velocity change"),
        (f"{SPEEDS} EL=1E9", "percent of the initial kinetic energy"),
        ("MA=96", "MB is missing"),
        ("MA=96 MB=145 SA=1", "SB is missing; expected it, or VX and VY"),
        (SPEEDS, "LOSS is missing"),
        (f"{SPEEDS} LOSS=140", "LOSS is outside 0 ... 100"),
        (f"{SPEEDS} LOSS=.4", "the chapter writes the fraction, DT = 0.4"),
        (f"{SPEEDS} LOSS=.999", "less than one percent"),
        (f"{SPEEDS} DT=1.2", "DT is outside 0 ... 1"),
        (f"{SPEEDS} DT=.4 LOSS=40", "DT and LOSS are both given"),
        ("MA=96 MB=145 SA=-1 SB=1 LOSS=4", "SA is negative"),
    ],
)
def test_delta_v_refuses_in_one_line(
    pairs: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = run(capsys, "delta-v", *sets(pairs))
    assert (status, out) == (2, "")
    assert message in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ([], ["72 of 77 agree", "36.6 36.49!", "22.9  lost!", "factor 2/3"]),
        (["--cells"], ["10/B, I: emended: 3008 -> 3808", "9/B, vy: emended: 31.9 -> 31.09"]),
        (["--table", "1"], ["3808*", "lost*", "m slug"]),
        (["--table", "2"], ["28.0*", "signed P_t/P_n"]),
    ],
)
def test_staged_shows_its_tables(
    options: list[str], expected: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = run(capsys, "staged", *options)
    assert (status, err) == (0, "")
    for text in expected:
        assert text in out
    for collision in collisions():
        assert any(line.startswith(str(collision.number)) for line in out.splitlines()) or (
            options == ["--cells"]
        )


def test_staged_as_json_holds_everything(capsys: pytest.CaptureFixture[str]) -> None:
    found = as_json(capsys, "staged")
    assert len(found["collisions"]) == 11
    assert len(found["comparison"]) == 77
    eighth = next(c for c in found["collisions"] if c["number"] == 8)
    assert eighth["measured"]["VAX"] is None


def test_example_step_by_step(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "example")
    assert (status, err) == (0, "")
    for text in ("-40.21", "58.24", "36.2", "24.0", "39.1", "25.9", "-43.6", "61.5"):
        assert text in out
    assert "DIFFERS" not in out
    steps = as_json(capsys, "example")["steps"]
    assert len(steps) == 7
    last = {n["name"]: n["value"] for n in steps[-1]["numbers"]}
    # Equations 15 and 16 over the estimates by hand: contact velocities along x, impulse on A
    beta = 50 * 3.14159265358979 / 180
    d1 = 4 * math.sin(beta)
    closing = -40.2083333333 - 0.0
    opening = (-10 - 0.0) - (-20 - d1 * -0.9)
    assert last["E"] == pytest.approx(-opening / closing, rel=1e-9)
    assert last["MUP"] == pytest.approx(20 / 30.2083333333, rel=1e-9)
    d2 = 4 * math.cos(beta)
    missed = 3770 * -0.9 + 1970 * -2.9 + 145 * d1 * -20 + 96 * (d2 + 4.5) * 20
    assert last["17"] == pytest.approx(missed, rel=1e-9)


def test_claims_of_the_chapter(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "staged", "--claims")
    assert status == 0
    assert "-35.5 ... 23.3" in out
    assert "false for the side impacts" in out


@pytest.mark.parametrize(
    "command", ["reconstruct", "barrier", "colinear", "delta-v", "staged", "example"]
)
def test_help_has_examples_and_units(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, command, "--help")
    assert status == 0
    assert "examples:" in out
    assert "nits" in out
    assert "exit status" in out


@pytest.mark.parametrize(
    ("command", "pairs", "expected"),
    [("barrier", CAR, "7.3903*"), ("colinear", REAR_END, "-33.0237*")],
)
def test_a_template_filled_in_is_a_problem(
    command: str, pairs: str, expected: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, text, _ = run(capsys, command, "--template")
    assert status == 0
    for pair in pairs.split():
        name, value = pair.split("=")
        assert f'\n{name} = ""' in text
        text = text.replace(f'\n{name} = ""', f'\n{name} = "{value}"')
    path = tmp_path / "filled.toml"
    path.write_text(text, encoding="utf-8")
    status, out, err = run(capsys, command, str(path))
    assert (status, err) == (0, "")
    assert expected in out


def test_the_reconstruction_template_names_everything_that_can_be_known(
    capsys: pytest.CaptureFixture[str],
) -> None:
    _, text, _ = run(capsys, "reconstruct", "--template")
    for name in ("MA", "GA", "E", "MU", "MUP", "UX", "WB", "VAX", "WBF"):
        assert f'\n{name} = ""' in text
    assert "rad/time" in text
