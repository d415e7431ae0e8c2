"""Many scenes at once: the captured runs of the real ROM, errors, and columns that cannot be used."""

from __future__ import annotations

import captures
import pytest

from impact88.apple.captured import normalize_zero
from impact88.errors import UserError
from impact88.names import SCENE
from impact88.program import kernel
from impact88.program.replay import PRINTED, Replay, replay
from impact88.program.run import run
from impact88.program.scene import sample

CASES = captures.scenes()
COLUMNS = {name: [case["scene"][name] for case in CASES] for name in SCENE}
DISK_COMMANDS = ("\x04PR# 0\n", "\x04PR#0\n")  # a disk system takes them out of the page


def without_commands(page: str) -> str:
    for command in DISK_COMMANDS:
        page = page.replace(command, "")
    return page


@pytest.fixture(params=["library", "port"])
def part(request, monkeypatch) -> slice:
    """The scenes to replay by each way; the port is three hundred times slower."""
    if request.param == "library":
        if kernel.library is None:
            pytest.skip("the compiled library is not there")
        return slice(None)
    monkeypatch.setattr(kernel, "library", None)
    return slice(None, None, 12)


@pytest.mark.captures
def test_captured_runs_of_the_rom(part):
    cases = CASES[part]
    results = replay({name: column[part] for name, column in COLUMNS.items()}, pages=True)
    assert results.pages == [without_commands(case["printout"]) for case in cases]
    for name in ("KI", "KF", "D1", "AR", "MX"):
        values = (normalize_zero(case["reals"].get(name, "0" * 10)) for case in cases)
        stored = [f"{value:010x}" for value in results.reals(name).tolist()]
        if name == "KF":  # lines 580 and 590 both set it
            absent = ~results.present(name)
            values = ("0" * 10 if gone else v for v, gone in zip(values, absent, strict=True))
        assert stored == list(values)
