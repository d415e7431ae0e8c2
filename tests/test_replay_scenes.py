"""The captured scenes through the array engine: every stored real, every element of A, every error
with its line, and every printed field."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import captures
import impact88
from impact88.names import SCENE
from impact88.replay import Replay, field_names

LEFT_IN_VARIABLES = ("KI", "KF", "XA", "YA", "XB", "YB")


def columns_of(scenes: list[dict[str, str]]) -> dict[str, list[str]]:
    return {name: [scene[name] for scene in scenes] for name in SCENE}


def zero_or(stored: str) -> str:
    """A stored real; a zero is zero whatever its other bytes."""
    return "0" * 10 if stored.startswith("00") else stored


def error_of(printout: str) -> str:
    found = re.search(r"\n(\?[A-Z ]+ ERROR)\a( IN \d+)$", printout)
    return "".join(found.groups()) if found else ""


def printed_fields(printout: str) -> dict[str, str]:
    """The fields of the printout after the prompts, by the names of the array engine."""
    body = printout.partition("PR# 0\n")[2]
    before, _, after = body.partition("*****")
    fields = dict(re.findall(r"(\w+)= (\S+)", before.replace("KE LOSS= ", "LOSS= ")))
    number = r"\s+(\S+)" * 5
    angles = re.search(r"PA PB TA TB GA\n" + number, before)
    if angles:
        fields |= dict(zip(("PA", "PB", "TA", "TB", "GA"), angles.groups(), strict=True))
    for old, new in (("KE", "KI"), ("MU", "MUP")):
        if old in fields:
            fields[new] = fields.pop(old)
    for mark, name in (("VAX", "A"), ("VBX", "B")):
        line = re.search(rf"{mark}= (\S+) V{name}Y= (\S+) \(X{name}=(\S+) Y{name}= (\S+)\)", after)
        if line:
            names = (f"V{name}X", f"V{name}Y", f"X{name}F", f"Y{name}F")
            fields |= dict(zip(names, line.groups(), strict=True))
    spins = re.search(r" WA= (\S+) WB= (\S+)", after)
    if spins:
        fields |= {"WAF": spins.group(1), "WBF": spins.group(2)}
    return fields


@pytest.fixture(scope="module")
def runs() -> list[dict[str, Any]]:
    return captures.scenes()


@pytest.fixture(scope="module")
def replayed(runs: list[dict[str, Any]]) -> Replay:
    return impact88.replay(columns_of([run["scene"] for run in runs]))


@pytest.mark.captures
def test_errors_and_lines(runs: list[dict[str, Any]], replayed: Replay) -> None:
    assert replayed.error.tolist() == [error_of(run["printout"]) for run in runs]
    zero = ["ZERO DETERMINANT" in run["printout"] for run in runs]
    assert replayed.zero_determinant.tolist() == zero


@pytest.mark.captures
def test_reals(runs: list[dict[str, Any]], replayed: Replay) -> None:
    """What the variables held at the end. XA ... YB are replaced in lines 700 and 710."""
    stored = {name: replayed.reals(name) for name in replayed.names}
    present = {name: replayed.present(name) for name in replayed.names}
    errors = replayed.error
    wrong = []
    for i, run in enumerate(runs):
        expected = {name: zero_or(value) for name, value in run["reals"].items()}
        if "MU" in expected:
            expected["MUP"] = expected.pop("MU")
        for name in (*LEFT_IN_VARIABLES, "MUP"):
            mine = name + "F" if name + "F" in stored and present[name + "F"][i] else name
            got = f"{stored[mine][i]:010x}" if present[mine][i] else None
            known = expected.get(name)
            if got is None and errors[i] and known == "0" * 10:
                continue  # the ROM makes a variable before it works out what to assign
            if got != known:
                wrong.append((run["id"], name, expected.get(name), got))
        if present["VAX"][i]:
            size = 7
            column = int(run["scene"]["M"]) + 1
            for row, name in enumerate(("VAX", "VAY", "VBX", "VBY", "WAF", "WBF"), 1):
                if present[name][i]:
                    element = zero_or(run["A"]["data"][row + size * column])
                    if f"{stored[name][i]:010x}" != element:
                        wrong.append((run["id"], name, element, f"{stored[name][i]:010x}"))
    assert not wrong, (len(wrong), wrong[:10])


@pytest.mark.captures
def test_printed_fields(runs: list[dict[str, Any]], replayed: Replay) -> None:
    printed = {name: replayed.printed(name).tolist() for name in field_names()}
    wrong = []
    for i, run in enumerate(runs):
        expected = printed_fields(run["printout"])
        got = {name: column[i] for name, column in printed.items() if column[i]}
        if got != expected:
            wrong.append((run["id"], set(got.items()) ^ set(expected.items())))
    assert not wrong, (len(wrong), wrong[:5])


def test_floats_are_the_reals() -> None:
    replayed = impact88.replay(dict(impact88.sample(1)))
    for name in replayed.names:
        packed = int(replayed.reals(name)[0])
        e, sign, m = packed >> 32, packed >> 31 & 1, packed & 0x7FFFFFFF | 0x80000000
        value = 0.0 if e == 0 else (-1) ** sign * m * 2.0 ** (e - 160)
        assert replayed.floats(name)[0] == value
        assert not np.isnan(value)
