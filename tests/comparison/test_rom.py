"""The listing and the arithmetic on an Apple II Plus ROM image, where IMPACT88_ROM names one.

The 6502 is py65's, which must be installed.
"""

from __future__ import annotations

import os

import pytest
from romapple import read_image
from romsession import Session

from impact88.apple import captured
from impact88.program.run import run
from impact88.program.scene import sample

IMAGE = os.environ.get("IMPACT88_ROM", "")
CALLS = 20  # of each routine, evenly spread over the captures


@pytest.mark.skipif(not IMAGE, reason="IMPACT88_ROM names no ROM image")
class TestImage:
    @pytest.fixture(scope="class")
    def session(self) -> Session:
        return Session(read_image(IMAGE))

    @pytest.mark.parametrize("number", [1, 2, 3])
    def test_it_prints_the_published_runs(self, session: Session, number: int) -> None:
        record, reference = session.run_scene(sample(number)), run(sample(number), dos=False)
        assert record["printout"] == reference.printout
        assert captured.memory_contents(record["reals"], record["A"]) == captured.memory_contents(
            reference.reals, reference.A
        )

    def test_it_computes_the_captured_calls(self, session: Session) -> None:
        for rows in captured.calls(captured.golden()).values():
            for row in rows[:: len(rows) // CALLS]:
                assert captured.result(session.calculate(*row[:4])) == captured.result(row[4])
