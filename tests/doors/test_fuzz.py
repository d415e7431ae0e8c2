"""Hostile input to every command: what was ever found, and some seconds of new cases.

IMPACT88_FUZZ_SECONDS says how long it takes: 36000 goes on for a night. A case that goes wrong is
shown as JSON: with a name it is a line of tests/support/fuzzing/corpus.jsonl.
"""

from __future__ import annotations

import os
import random
import time
from collections import Counter

import pytest
from fuzzing.case import Case, read_corpus
from fuzzing.judge import faults
from fuzzing.kinds import KINDS, make

SECONDS = float(os.environ.get("IMPACT88_FUZZ_SECONDS", "1"))
LEAST = 15
"""Cases that are run, however slow the machine."""
LONG = (
    "reconstruct-na",
    "reconstruct-no",
    "verify-scene-1",
    "verify-scene-2",
    "printout-5",
    "printout-70",
    "printout-decimals",
    "csv-row-of-quotes",
    "compare-every-result-zero",
    "extremes-a.1066",
    "extremes-e.5751",
    "printout-number-of-many-digits",
    "verify-scene-plus-sign",
    "typed-5.0.353",
)
"""Beginnings of the names of cases that take seconds, and have quicker ones of their kind beside
them: run where the seconds are more than the default's."""
CORPUS = {
    name: case for name, case in read_corpus().items() if SECONDS > 2 or not name.startswith(LONG)
}


@pytest.mark.parametrize("name", CORPUS)
def test_what_was_ever_found_goes_well(name: str) -> None:
    assert faults(CORPUS[name]) == []


def test_new_cases_go_well() -> None:
    """A number of the day for a seed would find more, and fail for those who changed nothing."""
    rng = random.Random(SECONDS)
    weights = [weight for _, weight in KINDS.values()]
    began, counts = time.monotonic(), Counter[str]()
    while counts.total() < LEAST or time.monotonic() - began < SECONDS:
        (kind,) = rng.choices(list(KINDS), weights)
        case = make(kind, f"test {counts.total()}")
        counts[kind] += 1
        assert faults(case) == [], case.to_json()


def test_a_case_is_the_same_from_its_seed_and_from_its_file() -> None:
    for kind in KINDS:
        case = make(kind, "7")
        assert case == make(kind, "7")
        assert case == Case.from_json(case.to_json())


@pytest.mark.parametrize(
    ("source", "fault"),
    [
        ("raise ValueError('x')", "status 3"),
        ("import sys; print('impact88: \\x1b[2J', file=sys.stderr); return 2", "control"),
        ("import warnings; warnings.warn('overflow', RuntimeWarning)", "status 3"),
        ("open('a.part', 'w').close(); return 0", "left behind"),
        ("open('t.csv', 'w').close(); return 0", "an input was changed"),
        ("open('o.csv', 'w').close(); return 2", "status 2 and written"),
        ("print('no'); return 2", "status 2 with"),
        ("raise MemoryError", "memory"),
    ],
)
def test_the_judge_sees_what_it_is_for(
    monkeypatch: pytest.MonkeyPatch, source: str, fault: str
) -> None:
    from impact88.interface.commands import cli

    space: dict[str, object] = {}
    exec(f"def broken(arguments):\n    {source}", space)
    monkeypatch.setattr(cli, "_dispatch", space["broken"])
    wrong = faults(Case("csv", ["solve", "t.csv"], files={"t.csv": b"MA\n1\n"}))
    assert any(fault in one for one in wrong), wrong


def test_every_piece_of_a_printout_on_a_page_has_its_time():
    page = b"VBX= -19.338 VBY= 41.456\n" * 50
    assert Case("printout", ["verify", "p.txt"], files={"p.txt": page}).printouts() == 50
    assert Case("printout", ["solve", "p.txt"], files={"p.txt": page}).printouts() == 0
